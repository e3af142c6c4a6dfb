/* A Furuta pendulum that is kept swinging, by what an extended Kalman filter makes of noisy angles.
 *
 * What runs on the target: this file, controller.c, numerics.h, numerics.c and the emitted
 * furuta.h, furuta.c.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "furuta.h"

enum { NQ = FURUTA_NQ, NV = FURUTA_NV, NX = NQ + NV };

typedef struct {
    double model[FURUTA_NK]; /* constants of the pendulum as its model file has it */
    double x[NX];            /* the estimate, x = (q, v) */
    double P[NX * NX];       /* covariance of its error */
    double u;                /* N m, the torque since the last measurement */
} controller;

/* What is known at first: the estimate and the standard deviations of its error. */
void controller_start(controller *self, const double x[NX], const double deviation[NX]);

/* The torque at the shaft for measured angles; to be called at 200 Hz. A status other than 0: the
 * estimate is where the model or the filter has no answer. */
int controller_step(controller *self, const double q[NQ], double *u);

#endif
