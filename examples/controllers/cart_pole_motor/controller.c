#include "controller.h"

#include <math.h>

#include "../numerics.h"

#define PERIOD 2e-3  /* s */
#define MOST   12.0  /* V */
#define FILTER 150.0 /* rad/s, of the rates */
#define PUMP   50.0  /* m/s^2/J: the cart's acceleration for what the pole lacks in energy */
#define HARD   3.5   /* m/s^2, the most of it */
#define CENTRE 5.0   /* 1/s^2, of the cart, back to the middle */
#define BRAKE  1.0   /* 1/s, of the cart */
#define CATCH  0.35  /* rad, from upright: there balancing begins */
#define SLOW   3.0   /* rad/s: and below this */
#define LOSE   0.8   /* rad: there it has failed */
#define PI     3.141592653589793

enum { SLIDE = 0, SWING = 1, CURRENT = 2 };

int controller_start(controller *self, const double q[NQ]) {
    const double upright[NQ] = {0.0, PI};
    const double rest[NV] = {0.0};
    const double off = 0.0;
    const double Q[NX] = {20.0, 10.0, 0.5, 0.5, 0.0};
    const double R[1] = {0.05};
    double A[NX * NX];
    double B[NX];
    double Ad[NX * NX];
    double Bd[NX];
    double E[3];

    cart_pole_motor_prepare(&cart_pole_motor_default_parameters, self->model);
    cart_pole_motor_energy(&cart_pole_motor_default_parameters, upright, rest, E);
    self->energy = E[0] + E[1];
    self->balancing = 0;
    for (int i = 0; i < NQ; ++i) {
        self->q[i] = q[i];
        self->rate[i] = 0.0;
    }
    if (cart_pole_motor_linearize(&cart_pole_motor_default_parameters, upright, rest, &off, A, B) !=
        0) {
        return 1;
    }
    numerics_discretize(NX, 1, A, B, PERIOD, Ad, Bd);
    return numerics_lqr(NX, 1, Ad, Bd, Q, R, self->gain);
}

/* The voltage that accelerates the cart so, its current settled: M v' + h = (0, 0, u) with slide''
 * = a and current' = 0 is linear in swing'' and the current (the velocity v[2]), so three values of
 * it say all. */
static double voltage(const controller *self, const double q[NQ], const double rate[NQ], double a) {
    double v[NV] = {rate[SLIDE], rate[SWING], 0.0};
    double acceleration[NV] = {a, 0.0, 0.0};
    double none[NV];
    double swing[NV];
    double current[NV];
    double matrix[4];
    double x[2];

    cart_pole_motor_inverse_dynamics_prepared(self->model, q, v, acceleration, none);
    acceleration[SWING] = 1.0;
    cart_pole_motor_inverse_dynamics_prepared(self->model, q, v, acceleration, swing);
    acceleration[SWING] = 0.0;
    v[CURRENT] = 1.0;
    cart_pole_motor_inverse_dynamics_prepared(self->model, q, v, acceleration, current);
    for (int i = 0; i < 2; ++i) {
        matrix[2 * i] = swing[i] - none[i];
        matrix[2 * i + 1] = current[i] - none[i];
        x[i] = -none[i];
    }
    if (numerics_solve(2, 1, matrix, x) != 0) {
        return 0.0; /* no current moves the cart here */
    }
    v[CURRENT] = x[1];
    acceleration[SWING] = x[0];
    cart_pole_motor_inverse_dynamics_prepared(self->model, q, v, acceleration, none);
    return none[CURRENT];
}

static double swing_up(const controller *self, const double q[NQ], const double rate[NQ]) {
    const double pole[NV] = {0.0, rate[SWING], 0.0}; /* moving alone: its energy and no other */
    double E[3];
    double a;

    cart_pole_motor_energy(&cart_pole_motor_default_parameters, q, pole, E);
    a = PUMP * (E[0] + E[1] - self->energy) * (rate[SWING] * cos(q[SWING]) < 0.0 ? -1.0 : 1.0);
    a = numerics_clipped(a, HARD) - CENTRE * q[SLIDE] - BRAKE * rate[SLIDE];
    return voltage(self, q, rate, a);
}

double controller_step(controller *self, const double q[NQ], double current) {
    const double share = 1.0 - exp(-FILTER * PERIOD);
    const double off = remainder(q[SWING] - PI, 2.0 * PI);
    double u;

    for (int i = 0; i < NQ; ++i) {
        self->rate[i] += share * ((q[i] - self->q[i]) / PERIOD - self->rate[i]);
        self->q[i] = q[i];
    }
    self->balancing =
        self->balancing ? fabs(off) < LOSE : fabs(off) < CATCH && fabs(self->rate[SWING]) < SLOW;
    if (self->balancing) {
        const double x[NX] = {q[SLIDE], off, self->rate[SLIDE], self->rate[SWING], current};
        numerics_product(1, NX, 1, self->gain, x, &u);
        u = -u;
    } else {
        u = swing_up(self, q, self->rate);
    }
    return numerics_clipped(u, MOST);
}
