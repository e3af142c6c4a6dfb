#include "controller.h"

#include <math.h>

#define PERIOD      1e-3   /* s */
#define BANDWIDTH   50.0   /* rad/s: errors obey e'' + 2 BANDWIDTH e' + BANDWIDTH^2 e = 0 */
#define FILTER      1000.0 /* rad/s, of the crank's speed */
#define LEAST_RATIO 0.02   /* of rocker's to crank's speed: below, a dead centre is near */
#define MOST        3.0    /* N m, of the motor */

enum { MOTOR = 0, SWING = 2 };

void controller_start(controller *self, const double q[FOUR_BAR_NQ]) {
    four_bar_prepare(&four_bar_default_parameters, self->model);
    for (int i = 0; i < FOUR_BAR_NQ; ++i) {
        self->q[i] = q[i];
    }
    self->crank = q[MOTOR];
    self->speed = 0.0;
}

int controller_step(controller *self, const controller_reference *wanted, double crank, double *u) {
    double q[FOUR_BAR_NQ];
    double v[FOUR_BAR_NV];
    double T[FOUR_BAR_NV];    /* v = T w, w the crank's speed */
    double rest[FOUR_BAR_NV]; /* v' = T w' + rest */
    double Mr = 0.0;
    double hr = 0.0;
    const double share = 1.0 - exp(-FILTER * PERIOD);
    int status;

    *u = 0.0;
    self->speed += share * ((crank - self->crank) / PERIOD - self->speed);
    self->crank = crank;
    status = four_bar_complete_prepared(self->model, self->q, &crank, &self->speed, q, v);
    if (status == 0) {
        status = four_bar_reduction_prepared(self->model, q, v, T, rest);
    }
    if (status == 0) {
        status = four_bar_reduced_equations_prepared(self->model, q, v, &Mr, &hr);
    }
    if (status == 0 && fabs(T[SWING]) < LEAST_RATIO) {
        status = 3;
    }
    if (status == 0) {
        const double rocker = wanted->acceleration + 2.0 * BANDWIDTH * (wanted->rate - v[SWING]) +
                              BANDWIDTH * BANDWIDTH * (wanted->angle - q[SWING]);
        const double acceleration = (rocker - rest[SWING]) / T[SWING];
        *u = fmax(-MOST,
                  fmin(Mr * acceleration + hr, MOST)); /* T^T Q is u: the motor is the crank's */
        for (int i = 0; i < FOUR_BAR_NQ; ++i) {
            self->q[i] = q[i];
        }
    }
    return status;
}
