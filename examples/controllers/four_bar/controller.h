/* Tracking of the rocker's angle of a four-bar linkage by the torque of the motor at its crank.
 *
 * What runs on the target: this file, controller.c and the emitted four_bar.h, four_bar.c.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "four_bar.h"

typedef struct {
    double model[FOUR_BAR_NK]; /* constants of the linkage as its model file has it */
    double q[FOUR_BAR_NQ];     /* all angles, as computed last: where to look for the next */
    double crank;              /* rad, as measured last */
    double speed;              /* rad/s, of the crank, estimated */
} controller;

/* Where the rocker is to be: angle, rate, acceleration. */
typedef struct {
    double angle;
    double rate;
    double acceleration;
} controller_reference;

/* `q` tells which of the two ways the linkage is assembled, and where it starts, at rest. */
void controller_start(controller *self, const double q[FOUR_BAR_NQ]);

/* Torque u for the measured angle of the crank; to be called at 1 kHz. A status other than 0: the
 * angle is none that the linkage can have, or the crank is where it cannot move the rocker; then u
 * is 0. */
int controller_step(controller *self, const controller_reference *wanted, double crank, double *u);

#endif
