/* The linkage in closed loop; prints its motion as CSV.
 *
 * The linkage that is simulated is heavier than the controller takes it to be, and its bearing
 * brakes more. It is simulated in the coordinates of the tree, with multipliers for the loop: what
 * the controller does by closing the loop itself is done here in another way.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD       1e-3 /* s, of the controller */
#define SUBSTEPS     4    /* of the simulation in each */
#define LOGGED       10   /* periods from one line of the log to the next */
#define TIME         4.0  /* s */
#define PI           3.141592653589793
#define GOAL_RMS     1e-3
#define GOAL_LARGEST 2e-3
#define GOAL_OPEN    1e-9 /* m and 1, of the closed loop */

enum { NQ = FOUR_BAR_NQ, NV = FOUR_BAR_NV, NS = NQ + NV, NP = FOUR_BAR_NP, SWING = 2 };

typedef struct {
    double model[FOUR_BAR_NK];
    double u; /* held over a period */
} plant;

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;
    double lam[FOUR_BAR_NC];
    int i;

    (void)t;
    for (i = 0; i < NQ; ++i) { /* hinges only: the rates of the coordinates are the velocities */
        xdot[i] = x[NQ + i];
    }
    return four_bar_forward_dynamics_prepared(self->model, x, &x[NQ], &self->u, &xdot[NQ], lam);
}

/* Swings of 1 Hz about the middle of what the rocker can do, growing from rest within a second. */
static void reference(double t, controller_reference *wanted) {
    const double middle = 1.70;
    const double most = 0.24;
    const double rate = 2.0 * PI;
    const double s = fmin(t, 1.0);
    const double size = most * s * s * s * (10.0 + s * (6.0 * s - 15.0));
    const double grows = most * 30.0 * s * s * (1.0 - s) * (1.0 - s);
    const double curves = most * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s);

    wanted->angle = middle + size * sin(rate * t);
    wanted->rate = grows * sin(rate * t) + size * rate * cos(rate * t);
    wanted->acceleration = curves * sin(rate * t) + 2.0 * grows * rate * cos(rate * t) -
                           size * rate * rate * sin(rate * t);
}

/* How far the loop is open: the largest of its constraints. */
static double opening(const plant *self, const double q[NQ]) {
    double phi[NP];
    double largest = 0.0;

    four_bar_constraints_prepared(self->model, q, phi);
    for (int i = 0; i < NP; ++i) {
        largest = fmax(largest, fabs(phi[i]));
    }
    return largest;
}

/* All angles where the rocker stands at `angle`: the crank's by Newton's method, rocker's by
 * crank's speed its derivative. */
static int start(const plant *self, double angle, double q[NQ]) {
    const double guess[NQ] = {0.8, 0.0, 1.2};
    const double unit = 1.0;
    double v[NV];
    double crank = 1.9;
    int status = four_bar_complete_prepared(self->model, guess, &crank, &unit, q, v);

    for (int round = 0; round < 20 && status == 0; ++round) {
        double next[NQ];
        crank += (angle - q[SWING]) / v[SWING];
        status = four_bar_complete_prepared(self->model, q, &crank, &unit, next, v);
        for (int i = 0; i < NQ; ++i) {
            q[i] = next[i];
        }
    }
    return status;
}

int main(void) {
    const double encoder = 2.0 * PI / 131072.0;
    const int periods = (int)(TIME / PERIOD + 0.5);
    four_bar_parameters heavier = four_bar_default_parameters;
    controller_reference wanted;
    controller law;
    plant linkage = {{0.0}, 0.0};
    double x[NS] = {0.0};
    double squares = 0.0;
    double largest = 0.0;
    double open = 0.0;
    int status;

    heavier.rho *= 1.1;
    heavier.k *= 3.0;
    four_bar_prepare(&heavier, linkage.model);
    reference(0.0, &wanted);
    status = start(&linkage, wanted.angle, x);
    controller_start(&law, x);
    printf("t,wanted,motor,elbow,swing,torque,open\n");
    for (int k = 0; k <= periods && status == 0; ++k) {
        const double t = k * PERIOD;
        double error;

        reference(t, &wanted);
        error = x[SWING] - wanted.angle;
        squares += error * error / (periods + 1.0);
        largest = fmax(largest, fabs(error));
        open = fmax(open, opening(&linkage, x));
        status = controller_step(&law, &wanted, numerics_quantized(x[0], encoder), &linkage.u);
        if (k % LOGGED == 0) {
            printf("%.3f,%.12g,%.12g,%.12g,%.12g,%.9g,%.3g\n", t, wanted.angle, x[0], x[1], x[2],
                   linkage.u, opening(&linkage, x));
        }
        for (int i = 0; i < SUBSTEPS && status == 0; ++i) {
            const double h = PERIOD / SUBSTEPS;
            status = numerics_rk4(rates, &linkage, NS, t + i * h, h, x);
        }
    }
    if (status != 0) {
        fprintf(stderr, "stopped with status %d\n", status);
        return 2;
    }
    fprintf(stderr, "rocker: RMS %.3f mrad, largest %.3f mrad; loop open by %.1e m\n",
            1e3 * sqrt(squares), 1e3 * largest, open);
    return sqrt(squares) < GOAL_RMS && largest < GOAL_LARGEST && open < GOAL_OPEN ? 0 : 1;
}
