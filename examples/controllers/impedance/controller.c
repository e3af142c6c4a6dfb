#include "controller.h"

#define MASS            6.0   /* kg, what the tool seems to weigh */
#define STIFFNESS       600.0 /* N/m */
#define DAMPING         84.0  /* N s/m, 0.7 of critical */
#define TURN_RATE       30.0  /* rad/s, at which its rotation comes back, critically damped */
#define POSTURE         10.0  /* N m/rad, of what draws the arm where the tool does not feel it */
#define POSTURE_DAMPING 5.0   /* N m s/rad, of the same */

void controller_start(controller *self, const double q[JOINTS]) {
    double place[3];

    arm_prepare(&arm_default_parameters, self->model);
    arm_frame_panda_hand_tcp_pose(&arm_default_parameters, q, place, self->turned);
    for (int i = 0; i < JOINTS; ++i) {
        self->posture[i] = q[i];
    }
}

/* The vector of the small rotation from the one that is wanted to the one that is. */
static void turn(const double wanted[9], const double is[9], double e[3]) {
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3;
        const int k = (i + 2) % 3;
        e[i] = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            e[i] += 0.5 * (wanted[3 * j + axis] * is[3 * k + axis] -
                           wanted[3 * k + axis] * is[3 * j + axis]);
        }
    }
}

/* What the tool is to accelerate by: MASS (x'' - x_d'') + DAMPING (x' - x_d') + STIFFNESS (x - x_d)
 * = force. */
static void acceleration(const controller *self, const controller_reference *wanted,
                         const double q[JOINTS], const double v[JOINTS], const double force[3],
                         double a[TASK]) {
    double place[3];
    double rotation[9];
    double velocity[TASK];
    double e[3];

    arm_frame_panda_hand_tcp_pose(&arm_default_parameters, q, place, rotation);
    arm_frame_panda_hand_tcp_velocity(&arm_default_parameters, q, v, velocity);
    turn(self->turned, rotation, e);
    for (int i = 0; i < 3; ++i) {
        a[i] = wanted->acceleration[i] + (force[i] - DAMPING * (velocity[i] - wanted->velocity[i]) -
                                          STIFFNESS * (place[i] - wanted->place[i])) /
                                             MASS;
        a[3 + i] = -2.0 * TURN_RATE * velocity[3 + i] - TURN_RATE * TURN_RATE * e[i];
    }
}

int controller_step(const controller *self, const controller_reference *wanted,
                    const double q[JOINTS], const double v[JOINTS], const double force[3],
                    double u[JOINTS]) {
    const double none[JOINTS] = {0.0};
    double Lambda[TASK * TASK];
    double mu[TASK];
    double Jbar[JOINTS * TASK];
    double J[TASK * JOINTS];
    double a[TASK];
    double F[TASK]; /* what the torques are to do at the tool */
    double rest[JOINTS];
    int status;

    arm_inverse_dynamics_prepared(self->model, q, v, none, u); /* h */
    status =
        arm_frame_panda_hand_tcp_operational_space(&arm_default_parameters, q, v, Lambda, mu, Jbar);
    if (status != 0) {
        return status;
    }
    arm_frame_panda_hand_tcp_jacobian(&arm_default_parameters, q, J);
    acceleration(self, wanted, q, v, force, a);
    for (int i = 0; i < JOINTS; ++i) {
        rest[i] = u[i] - POSTURE * (q[i] - self->posture[i]) - POSTURE_DAMPING * v[i];
    }
    /* u = J^T (Lambda a + mu - force) + (1 - J^T Jbar^T) rest: the second term does not reach the
     * tool */
    for (int i = 0; i < TASK; ++i) {
        F[i] = mu[i] - (i < 3 ? force[i] : 0.0);
        for (int j = 0; j < TASK; ++j) {
            F[i] += Lambda[i * TASK + j] * a[j];
        }
        for (int j = 0; j < JOINTS; ++j) {
            F[i] -= Jbar[j * TASK + i] * rest[j];
        }
    }
    for (int j = 0; j < JOINTS; ++j) {
        u[j] = rest[j];
        for (int i = 0; i < TASK; ++i) {
            u[j] += J[i * JOINTS + j] * F[i];
        }
    }
    return 0;
}
