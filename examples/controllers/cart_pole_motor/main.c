/* The cart-pole in closed loop, from hanging; prints its motion as CSV.
 *
 * The cart-pole that is simulated has a heavier pole than the controller takes it to have, and a
 * motor that has become warm. Once it stands, the pole is struck.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD     2e-3 /* s, of the controller */
#define SUBSTEPS   40   /* of the simulation in each: the current settles within 70 us */
#define LOGGED     5    /* periods from one line of the log to the next */
#define TIME       10.0 /* s */
#define BLOW_TIME  7.0  /* s */
#define BLOW       1.0  /* rad/s, by which the pole is faster then */
#define PI         3.141592653589793
#define GOAL_TIME  4.0  /* s, from when on the pole stands */
#define GOAL_ANGLE 0.2  /* rad, to which it does so until the end, the blow included */
#define GOAL_END   0.02 /* rad and m, in the last second */
#define GOAL_RAIL  0.5  /* m, to either side, always */

enum { SLIDE = 0, SWING = 1, CURRENT = NQ + 2 };

typedef struct {
    double model[CART_POLE_MOTOR_NK];
    double u; /* V, held over a period */
} plant;

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;

    (void)t;
    return cart_pole_motor_rhs_prepared(self->model, x, &self->u, xdot);
}

int main(void) {
    const double resolution[NQ] = {1e-5, 2.0 * PI / 4096.0};
    const int periods = (int)(TIME / PERIOD + 0.5);
    const int blow = (int)(BLOW_TIME / PERIOD + 0.5);
    cart_pole_motor_parameters other = cart_pole_motor_default_parameters;
    plant cart_pole = {{0.0}, 0.0};
    controller law;
    unsigned long long seed = 1;
    double x[NX] = {0.0};
    double farthest = 0.0;
    double up = 0.0; /* since when it is */
    double end = 0.0;
    int status;

    other.m_pole *= 1.1;
    other.J_pole *= 1.1;
    other.R *= 1.1;
    other.K *= 0.97;
    cart_pole_motor_prepare(&other, cart_pole.model);
    status = controller_start(&law, x);
    printf("t,slide,swing,current,voltage,balancing\n");
    for (int k = 0; k <= periods && status == 0; ++k) {
        const double t = k * PERIOD;
        const double off = remainder(x[SWING] - PI, 2.0 * PI);
        double q[NQ];

        up = fabs(off) > GOAL_ANGLE ? t + PERIOD : up;
        end = t > TIME - 1.0 ? fmax(end, fmax(fabs(off), fabs(x[SLIDE]))) : 0.0;
        farthest = fmax(farthest, fabs(x[SLIDE]));
        x[NQ + SWING] += k == blow ? BLOW : 0.0;
        for (int i = 0; i < NQ; ++i) {
            q[i] = numerics_quantized(x[i], resolution[i]);
        }
        cart_pole.u = controller_step(&law, q, x[CURRENT] + 0.01 * numerics_normal(&seed));
        if (k % LOGGED == 0) {
            printf("%.3f,%.9g,%.9g,%.9g,%.9g,%d\n", t, x[SLIDE], x[SWING], x[CURRENT], cart_pole.u,
                   law.balancing);
        }
        for (int i = 0; i < SUBSTEPS && status == 0; ++i) {
            const double h = PERIOD / SUBSTEPS;
            status = numerics_rk4(rates, &cart_pole, NX, t + i * h, h, x);
        }
    }
    if (status != 0) {
        fprintf(stderr, "stopped with status %d\n", status);
        return 2;
    }
    fprintf(stderr, "upright since %.2f s, at last to %.4f rad or m; within %.3f m of the middle\n",
            up, end, farthest);
    return up < GOAL_TIME && end < GOAL_END && farthest < GOAL_RAIL ? 0 : 1;
}
