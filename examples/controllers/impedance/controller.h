/* Impedance of an arm's tool in operational space: it moves under forces as a mass on a spring and
 * a damper.
 *
 * What runs on the target: this file, controller.c and the emitted arm.h, arm.c.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "arm.h"

enum { JOINTS = ARM_NV, TASK = 6 };

typedef struct {
    double model[ARM_NK];   /* constants of the arm as its URDF has it */
    double turned[9];       /* rotation of the tool that is to be kept */
    double posture[JOINTS]; /* rad, to which the arm is drawn where the tool does not feel it */
} controller;

/* Where the tool is to be, in ground axes: place, velocity, acceleration. */
typedef struct {
    double place[3];
    double velocity[3];
    double acceleration[3];
} controller_reference;

/* `q` is where the arm starts: the tool's rotation there is kept. */
void controller_start(controller *self, const double q[JOINTS]);

/* Torques u for measured angles q, rates v, and the force that the tool feels, in ground axes; to
 * be called at 1 kHz. A status other than 0: the tool cannot move all ways here; then u holds the
 * arm's weight. */
int controller_step(const controller *self, const controller_reference *wanted,
                    const double q[JOINTS], const double v[JOINTS], const double force[3],
                    double u[JOINTS]);

#endif
