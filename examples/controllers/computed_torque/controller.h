/* Tracking of a joint trajectory by computed torque; PD with gravity to compare with.
 *
 * What runs on the target: this file, controller.c and the emitted arm.h, arm.c.
 */
#ifndef CONTROLLER_H
#define CONTROLLER_H

#include "arm.h"

enum { JOINTS = ARM_NV };

typedef enum { COMPUTED_TORQUE, PD_GRAVITY } controller_law;

typedef struct {
    controller_law law;
    double model[ARM_NK];     /* constants of the arm as its URDF has it */
    double stiffness[JOINTS]; /* of PD_GRAVITY, N m/rad */
    double damping[JOINTS];   /* of PD_GRAVITY, N m s/rad */
} controller;

/* Where the arm is to be: angles, rates, accelerations. */
typedef struct {
    double q[JOINTS];
    double v[JOINTS];
    double a[JOINTS];
} controller_reference;

/* `q` is where the arm starts. */
void controller_start(controller *self, controller_law law, const double q[JOINTS]);

/* Torques u for measured angles q and rates v; to be called at 1 kHz. */
void controller_step(const controller *self, const controller_reference *wanted,
                     const double q[JOINTS], const double v[JOINTS], double u[JOINTS]);

#endif
