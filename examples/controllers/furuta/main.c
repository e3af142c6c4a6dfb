/* The Furuta pendulum in closed loop, from hanging; prints its motion as CSV.
 *
 * What is simulated has a heavier pendulum than the controller takes it to have, and bearings that
 * brake more. Once it stands, the pendulum is struck.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD     2e-3 /* s, of the controller */
#define SUBSTEPS   8    /* of the simulation in each */
#define LOGGED     5    /* periods from one line of the log to the next */
#define TIME       10.0 /* s */
#define BLOW_TIME  7.0  /* s */
#define BLOW       1.0  /* rad/s, by which the pendulum is faster then */
#define PI         3.141592653589793
#define GOAL_TIME  4.0  /* s, from when on the pendulum stands */
#define GOAL_ANGLE 0.3  /* rad, to which it does so until the end, the blow included */
#define GOAL_END   0.02 /* rad, both angles in the last second */
#define GOAL_TURN  1.5  /* rad, of the arm to either side, always */

enum { SHAFT = 0, HINGE = 1 };

typedef struct {
    double model[FURUTA_NK];
    double u; /* N m, held over a period */
} plant;

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;

    (void)t;
    return furuta_rhs_prepared(self->model, x, &self->u, xdot);
}

int main(void) {
    const double encoder = 2.0 * PI / 4096.0;
    const int periods = (int)(TIME / PERIOD + 0.5);
    const int blow = (int)(BLOW_TIME / PERIOD + 0.5);
    furuta_parameters other = furuta_default_parameters;
    plant furuta = {{0.0}, 0.0};
    controller law;
    double x[NX] = {0.0};
    double farthest = 0.0;
    double up = 0.0; /* since when it is */
    double end = 0.0;
    int status;

    other.m *= 1.1;
    other.J_transverse *= 1.1;
    other.d_shaft *= 2.0;
    other.d_hinge *= 2.0;
    furuta_prepare(&other, furuta.model);
    status = controller_start(&law, x);
    printf("t,shaft,hinge,torque,balancing\n");
    for (int k = 0; k <= periods && status == 0; ++k) {
        const double t = k * PERIOD;
        const double off = remainder(x[HINGE] - PI, 2.0 * PI);
        double q[NQ];

        up = fabs(off) > GOAL_ANGLE ? t + PERIOD : up;
        end = t > TIME - 1.0 ? fmax(end, fmax(fabs(off), fabs(x[SHAFT]))) : 0.0;
        farthest = fmax(farthest, fabs(x[SHAFT]));
        x[NQ + HINGE] += k == blow ? BLOW : 0.0;
        for (int i = 0; i < NQ; ++i) {
            q[i] = numerics_quantized(x[i], encoder);
        }
        furuta.u = controller_step(&law, q);
        if (k % LOGGED == 0) {
            printf("%.3f,%.9g,%.9g,%.9g,%d\n", t, x[SHAFT], x[HINGE], furuta.u, law.balancing);
        }
        for (int i = 0; i < SUBSTEPS && status == 0; ++i) {
            const double h = PERIOD / SUBSTEPS;
            status = numerics_rk4(rates, &furuta, NX, t + i * h, h, x);
        }
    }
    if (status != 0) {
        fprintf(stderr, "stopped with status %d\n", status);
        return 2;
    }
    fprintf(stderr, "upright since %.2f s, at last to %.4f rad; the arm within %.2f rad\n", up, end,
            farthest);
    return up < GOAL_TIME && end < GOAL_END && farthest < GOAL_TURN ? 0 : 1;
}
