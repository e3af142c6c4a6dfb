/* Lets the arm fall from rest for a tenth of a second and watches its energy. */
#include <stdio.h>

#include "panda.h"

int main(void) {
    double q[PANDA_NQ] = {0.0, -0.3, 0.0, -2.2, 0.0, 2.0, 0.8, 0.02};
    double v[PANDA_NV] = {0.0};
    const double u[PANDA_NU] = {0.0};
    const double dt = 1e-4;
    double before[2];
    double after[2];

    panda_energy(q, v, before);
    for (int step = 0; step < 1000; ++step) {
        double a[PANDA_NV];
        double qdot[PANDA_NQ];
        if (panda_forward_dynamics(q, v, u, a) != 0) {
            fputs("the mass matrix is singular\n", stderr);
            return 1;
        }
        /* semi-implicit Euler: velocities first, then coordinates with the new velocities */
        for (int i = 0; i < PANDA_NV; ++i) {
            v[i] += dt * a[i];
        }
        panda_coordinate_rates(q, v, qdot);
        for (int i = 0; i < PANDA_NQ; ++i) {
            q[i] += dt * qdot[i];
        }
    }
    panda_energy(q, v, after);

    for (int i = 0; i < PANDA_NQ; ++i) {
        printf("%-22s %9.5f\n", panda_q_names[i], q[i]);
    }
    printf("energy before %.6f J, after %.6f J\n", before[0] + before[1], after[0] + after[1]);
    return 0;
}
