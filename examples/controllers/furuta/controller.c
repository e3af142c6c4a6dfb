#include "controller.h"

#include <math.h>

#include "../numerics.h"

#define PERIOD 2e-3  /* s */
#define MOST   0.5   /* N m */
#define FILTER 150.0 /* rad/s, of the rates */
#define PUMP   400.0 /* rad/s^2/J: the arm's acceleration for what the pendulum lacks in energy */
#define MARGIN 1.1   /* of the energy it is pumped to: friction takes some on the way */
#define HARD   15.0  /* rad/s^2, the most of it */
#define CENTRE 10.0  /* 1/s^2, of the arm, back to where it began */
#define BRAKE  1.0   /* 1/s, of the arm */
#define CATCH  0.4   /* rad, from upright: there balancing begins */
#define SLOW   4.0   /* rad/s: and below this */
#define LOSE   0.8   /* rad: there it has failed */
#define PI     3.141592653589793

enum { SHAFT = 0, HINGE = 1 };

int controller_start(controller *self, const double q[NQ]) {
    const double upright[NQ] = {0.0, PI};
    const double rest[NV] = {0.0};
    const double off = 0.0;
    const double Q[NX] = {2.0, 10.0, 0.1, 0.1};
    const double R[1] = {30.0};
    double A[NX * NX];
    double B[NX];
    double Ad[NX * NX];
    double Bd[NX];
    double E[2];

    furuta_prepare(&furuta_default_parameters, self->model);
    furuta_energy(&furuta_default_parameters, upright, rest, E);
    self->energy = MARGIN * (E[0] + E[1]);
    self->balancing = 0;
    for (int i = 0; i < NQ; ++i) {
        self->q[i] = q[i];
        self->rate[i] = 0.0;
    }
    if (furuta_linearize(&furuta_default_parameters, upright, rest, &off, A, B) != 0) {
        return 1;
    }
    numerics_discretize(NX, 1, A, B, PERIOD, Ad, Bd);
    return numerics_lqr(NX, 1, Ad, Bd, Q, R, self->gain);
}

/* The torque that accelerates the arm so: M v' + h = (u, 0) with shaft'' = a is linear in hinge'',
 * so two values of it say all. */
static double torque(const controller *self, const double q[NQ], const double rate[NQ], double a) {
    double acceleration[NV] = {a, 0.0};
    double none[NV];
    double hinge[NV];

    furuta_inverse_dynamics_prepared(self->model, q, rate, acceleration, none);
    acceleration[HINGE] = 1.0;
    furuta_inverse_dynamics_prepared(self->model, q, rate, acceleration, hinge);
    return none[SHAFT] - (hinge[SHAFT] - none[SHAFT]) * none[HINGE] / (hinge[HINGE] - none[HINGE]);
}

static double swing_up(const controller *self, const double q[NQ], const double rate[NQ]) {
    const double alone[NV] = {0.0, rate[HINGE]}; /* the pendulum's energy and no other */
    double E[2];
    double a;

    furuta_energy(&furuta_default_parameters, q, alone, E);
    a = PUMP * (E[0] + E[1] - self->energy) * (rate[HINGE] * cos(q[HINGE]) < 0.0 ? -1.0 : 1.0);
    a = numerics_clipped(a, HARD) - CENTRE * q[SHAFT] - BRAKE * rate[SHAFT];
    return torque(self, q, rate, a);
}

double controller_step(controller *self, const double q[NQ]) {
    const double share = 1.0 - exp(-FILTER * PERIOD);
    const double off = remainder(q[HINGE] - PI, 2.0 * PI);
    double u;

    for (int i = 0; i < NQ; ++i) {
        self->rate[i] += share * ((q[i] - self->q[i]) / PERIOD - self->rate[i]);
        self->q[i] = q[i];
    }
    self->balancing =
        self->balancing ? fabs(off) < LOSE : fabs(off) < CATCH && fabs(self->rate[HINGE]) < SLOW;
    if (self->balancing) {
        const double x[NX] = {q[SHAFT], off, self->rate[SHAFT], self->rate[HINGE]};
        numerics_product(1, NX, 1, self->gain, x, &u);
        u = -u;
    } else {
        u = swing_up(self, q, self->rate);
    }
    return numerics_clipped(u, MOST);
}
