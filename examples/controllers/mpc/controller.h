/* Sampling model-predictive control of a cart-pole: model-predictive path integrals.
 *
 * What runs on the target: this file, controller.c, numerics.h, numerics.c and the emitted
 * cart_pole.h, cart_pole.c, with functions of many states.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "cart_pole.h"

enum { SAMPLES = 512, HORIZON = 60, NQ = CART_POLE_NQ, NV = CART_POLE_NV };

/* Some 290 kB, most of it room to compute in. */
typedef struct {
    double model[CART_POLE_NK]; /* constants of the cart-pole as its model file has it */
    double plan[HORIZON];       /* N, the forces of the periods to come */
    unsigned long long seed;
    double tried[SAMPLES * HORIZON]; /* N, plans near this one */
    double cost[SAMPLES];            /* of each of them */
    double q[SAMPLES * NQ];
    double v[SAMPLES * NV];
    double M[SAMPLES * NV * NV];
    double h[SAMPLES * NV];
} controller;

/* `seed` decides what is tried. */
void controller_start(controller *self, unsigned long long seed);

/* The force on the cart for measured coordinates and velocities; to be called at 50 Hz. */
double controller_step(controller *self, const double q[NQ], const double v[NV]);

#endif
