#include "controller.h"

#include <math.h>

#include "../numerics.h"

#define PERIOD      5e-3 /* s */
#define DISTURBANCE 0.01 /* N m, standard deviation of the torque's disturbance in each period */
#define NOISE       0.01 /* rad, standard deviation of the noise of the angles */
#define MOST        0.25 /* N m */
#define ENERGY      0.1  /* J, to which the pendulum is pumped: it comes to some 95 degrees */
#define PUMP        0.5  /* s/rad: torque for the energy that it lacks */
#define STIFFNESS   0.05 /* N m/rad, of the arm, back to where it began */
#define DAMPING     0.01 /* N m s/rad, of the arm */

enum { SHAFT = 0, HINGE = 1 };

void controller_start(controller *self, const double x[NX], const double deviation[NX]) {
    furuta_prepare(&furuta_default_parameters, self->model);
    self->u = 0.0;
    for (int i = 0; i < NX; ++i) {
        self->x[i] = x[i];
        for (int j = 0; j < NX; ++j) {
            self->P[i * NX + j] = i == j ? deviation[i] * deviation[i] : 0.0;
        }
    }
}

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const controller *self = of;

    (void)t;
    return furuta_rhs_prepared(self->model, x, &self->u, xdot);
}

/* The estimate goes as the model does, its covariance as the model linearized along it:
 * P := F P F^T + G s^2 G^T. */
static int predict(controller *self) {
    double A[NX * NX];
    double B[NX];
    double F[NX * NX];
    double G[NX];
    double FP[NX * NX];
    int status;

    status = furuta_linearize_prepared(self->model, self->x, &self->x[NQ], &self->u, A, B);
    if (status == 0) {
        status = numerics_rk4(rates, self, NX, 0.0, PERIOD, self->x);
    }
    if (status != 0) {
        return status;
    }
    numerics_discretize(NX, 1, A, B, PERIOD, F, G);
    numerics_product(NX, NX, NX, F, self->P, FP);
    for (int i = 0; i < NX; ++i) {
        for (int j = 0; j < NX; ++j) {
            double sum = DISTURBANCE * DISTURBANCE * G[i] * G[j];
            for (int k = 0; k < NX; ++k) {
                sum += FP[i * NX + k] * F[j * NX + k];
            }
            self->P[i * NX + j] = sum;
        }
    }
    return 0;
}

/* Both angles are measured: x += K (q - x_q), P -= K P_q, with K^T = (P_q + r^2)^-1 P_q, P_q the
 * first rows of P. */
static int correct(controller *self, const double q[NQ]) {
    double S[NQ * NQ];
    double gain[NQ * NX]; /* K^T */
    double P[NX * NX];

    for (int i = 0; i < NQ; ++i) {
        for (int j = 0; j < NX; ++j) {
            gain[i * NX + j] = self->P[i * NX + j];
        }
        for (int j = 0; j < NQ; ++j) {
            S[i * NQ + j] = self->P[i * NX + j] + (i == j ? NOISE * NOISE : 0.0);
        }
    }
    if (numerics_solve(NQ, NX, S, gain) != 0) {
        return 1;
    }
    for (int i = 0; i < NX; ++i) {
        for (int j = 0; j < NX; ++j) {
            P[i * NX + j] = self->P[i * NX + j];
            for (int k = 0; k < NQ; ++k) {
                P[i * NX + j] -= gain[k * NX + i] * self->P[k * NX + j];
            }
        }
    }
    const double innovation[NQ] = {q[SHAFT] - self->x[SHAFT], q[HINGE] - self->x[HINGE]};
    for (int i = 0; i < NX; ++i) {
        for (int k = 0; k < NQ; ++k) {
            self->x[i] += gain[k * NX + i] * innovation[k];
        }
        for (int j = 0; j < NX; ++j) { /* rounding leaves P a little aside of symmetric */
            self->P[i * NX + j] = 0.5 * (P[i * NX + j] + P[j * NX + i]);
        }
    }
    return 0;
}

/* Energy for the pendulum through the arm; the arm is held back gently. */
static double law(const double x[NX]) {
    const double alone[NV] = {0.0, x[NQ + HINGE]};
    double E[2];

    furuta_energy(&furuta_default_parameters, x, alone, E);
    return PUMP * (E[0] + E[1] - ENERGY) * x[NQ + HINGE] * cos(x[HINGE]) - STIFFNESS * x[SHAFT] -
           DAMPING * x[NQ + SHAFT];
}

int controller_step(controller *self, const double q[NQ], double *u) {
    int status = predict(self);

    if (status == 0) {
        status = correct(self, q);
    }
    self->u = status == 0 ? numerics_clipped(law(self->x), MOST) : 0.0;
    *u = self->u;
    return status;
}
