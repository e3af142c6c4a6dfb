/* A cart-pole with its motor: swing-up by energy, balance by the linear-quadratic regulator.
 *
 * What runs on the target: this file, controller.c, numerics.h, numerics.c and the emitted
 * cart_pole_motor.h, cart_pole_motor.c.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "cart_pole_motor.h"

enum { NQ = CART_POLE_MOTOR_NQ, NV = CART_POLE_MOTOR_NV, NX = NQ + NV };

typedef struct {
    double model[CART_POLE_MOTOR_NK]; /* constants of the cart-pole as its model file has it */
    double gain[NX];                  /* of u = -gain x about upright, x = (q, v) */
    double energy;                    /* J, of the pole that stands */
    double q[NQ];                     /* as measured last */
    double rate[NQ];                  /* estimated */
    int balancing;                    /* or still swinging up */
} controller;

/* `q` is where it starts, at rest. A status other than 0: no gain was found. */
int controller_start(controller *self, const double q[NQ]);

/* The motor's voltage for measured coordinates and current; to be called at 500 Hz. */
double controller_step(controller *self, const double q[NQ], double current);

#endif
