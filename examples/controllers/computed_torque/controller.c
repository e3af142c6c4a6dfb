#include "controller.h"

#define BANDWIDTH 60.0 /* rad/s: errors obey e'' + 2 BANDWIDTH e' + BANDWIDTH^2 e = 0 */

static const double most[JOINTS] = {87.0, 87.0, 87.0, 87.0,
                                    12.0, 12.0, 12.0}; /* N m, of the drives */

void controller_start(controller *self, controller_law law, const double q[JOINTS]) {
    double M[JOINTS * JOINTS];

    self->law = law;
    arm_prepare(&arm_default_parameters, self->model);
    arm_mass_matrix_prepared(self->model, q, M);
    for (int i = 0; i < JOINTS;
         ++i) { /* the same bandwidth, as far as that can be without a model */
        self->stiffness[i] = BANDWIDTH * BANDWIDTH * M[i * JOINTS + i];
        self->damping[i] = 2.0 * BANDWIDTH * M[i * JOINTS + i];
    }
}

static void computed_torque(const controller *self, const controller_reference *wanted,
                            const double q[JOINTS], const double v[JOINTS], double u[JOINTS]) {
    double a[JOINTS];

    for (int i = 0; i < JOINTS; ++i) {
        a[i] = wanted->a[i] + 2.0 * BANDWIDTH * (wanted->v[i] - v[i]) +
               BANDWIDTH * BANDWIDTH * (wanted->q[i] - q[i]);
    }
    arm_inverse_dynamics_prepared(self->model, q, v, a, u);
}

static void pd_gravity(const controller *self, const controller_reference *wanted,
                       const double q[JOINTS], const double v[JOINTS], double u[JOINTS]) {
    const double rest[JOINTS] = {0.0};

    arm_inverse_dynamics_prepared(self->model, q, rest, rest, u); /* at rest: gravity alone */
    for (int i = 0; i < JOINTS; ++i) {
        u[i] +=
            self->stiffness[i] * (wanted->q[i] - q[i]) + self->damping[i] * (wanted->v[i] - v[i]);
    }
}

void controller_step(const controller *self, const controller_reference *wanted,
                     const double q[JOINTS], const double v[JOINTS], double u[JOINTS]) {
    if (self->law == COMPUTED_TORQUE) {
        computed_torque(self, wanted, q, v, u);
    } else {
        pd_gravity(self, wanted, q, v, u);
    }
    for (int i = 0; i < JOINTS; ++i) {
        if (u[i] > most[i]) {
            u[i] = most[i];
        } else if (u[i] < -most[i]) {
            u[i] = -most[i];
        }
    }
}
