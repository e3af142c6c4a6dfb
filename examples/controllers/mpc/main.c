/* The cart-pole in closed loop, from hanging; prints its motion as CSV.
 *
 * The cart-pole that is simulated has a heavier pole than the controller takes it to have, and
 * friction on its rail.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD     0.02 /* s, of the controller */
#define SUBSTEPS   20   /* of the simulation in each */
#define TIME       10.0 /* s */
#define PI         3.141592653589793
#define GOAL_TIME  2.5  /* s */
#define GOAL_ANGLE 0.15 /* rad, from upright, ever after */
#define GOAL_RMS   0.05 /* rad, over the last half */
#define GOAL_RAIL  0.6  /* m, to either side, always */

enum { SLIDE = 0, SWING = 1, NS = CART_POLE_NS };

typedef struct {
    double model[CART_POLE_NK];
    double friction; /* N s/m */
    double u;        /* N, held over a period */
} plant;

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;
    const double force = self->u - self->friction * x[NQ + SLIDE];

    (void)t;
    return cart_pole_rhs_prepared(self->model, x, &force, xdot);
}

int main(void) {
    static controller law; /* too large for the stack of a small machine */
    const int periods = (int)(TIME / PERIOD + 0.5);
    cart_pole_parameters heavier = cart_pole_default_parameters;
    plant cart_pole = {{0.0}, 0.1, 0.0};
    unsigned long long seed = 1;
    double x[NS] = {0.0};
    double squares = 0.0;
    double farthest = 0.0;
    double up = 0.0; /* since when it is */
    int status = 0;

    heavier.m_pole *= 1.05;
    cart_pole_prepare(&heavier, cart_pole.model);
    controller_start(&law, 1);
    printf("t,slide,swing,slide_rate,swing_rate,force\n");
    for (int k = 0; k <= periods && status == 0; ++k) {
        const double t = k * PERIOD;
        const double off = remainder(x[SWING] - PI, 2.0 * PI);
        double q[NQ];
        double v[NV];

        up = fabs(off) > GOAL_ANGLE ? t + PERIOD : up;
        squares += 2 * k > periods ? off * off / (periods - periods / 2) : 0.0;
        farthest = fmax(farthest, fabs(x[SLIDE]));
        for (int i = 0; i < NQ;
             ++i) { /* positions to 0.1 mm and mrad, rates with noise of 10 mm/s and mrad/s */
            q[i] = numerics_quantized(x[i], 1e-4);
            v[i] = x[NQ + i] + 0.01 * numerics_normal(&seed);
        }
        cart_pole.u = controller_step(&law, q, v);
        printf("%.3f,%.9g,%.9g,%.9g,%.9g,%.9g\n", t, x[0], x[1], x[2], x[3], cart_pole.u);
        for (int i = 0; i < SUBSTEPS && status == 0; ++i) {
            const double h = PERIOD / SUBSTEPS;
            status = numerics_rk4(rates, &cart_pole, NS, t + i * h, h, x);
        }
    }
    if (status != 0) {
        fprintf(stderr, "stopped with status %d\n", status);
        return 2;
    }
    fprintf(stderr, "upright since %.2f s, then RMS %.1f mrad; within %.3f m of the middle\n", up,
            1e3 * sqrt(squares), farthest);
    return up < GOAL_TIME && sqrt(squares) < GOAL_RMS && farthest < GOAL_RAIL ? 0 : 1;
}
