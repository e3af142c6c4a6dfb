/* A Furuta pendulum: swing-up by energy, balance by the linear-quadratic regulator.
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
    double gain[NX];         /* of u = -gain x about upright, x = (q, v) */
    double energy;           /* J, of the pendulum that stands */
    double q[NQ];            /* as measured last */
    double rate[NQ];         /* estimated */
    int balancing;           /* or still swinging up */
} controller;

/* `q` is where it starts, at rest. A status other than 0: no gain was found. */
int controller_start(controller *self, const double q[NQ]);

/* The torque at the shaft for measured angles; to be called at 500 Hz. */
double controller_step(controller *self, const double q[NQ]);

#endif
