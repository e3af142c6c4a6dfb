/* The pendulum in closed loop, RUNS times with other noise; prints the first run and the mean over
 * all as CSV.
 *
 * The torque is disturbed by what is drawn anew in each period, the angles are measured with noise,
 * and where the filter starts is as uncertain as it believes: of these it knows the standard
 * deviations.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD      5e-3 /* s, of the controller */
#define SUBSTEPS    5    /* of the simulation in each */
#define TIME        5.0  /* s */
#define DISTURBANCE 0.01
#define NOISE       0.01
#define FILTER      70.0 /* rad/s, of the differences that the filter is compared with */
#define GOAL_RATE   0.05 /* rad/s, RMS error of both rates */
#define GOAL_BETTER 10   /* times better than differences at least */
#define GOAL_SHARE  0.9  /* of the time at which the errors are as large as the filter believes */

/* Of the mean of the squared errors by their covariance over RUNS runs, a chi-square of 4 RUNS
 * degrees of freedom divided by RUNS: 2.5 % are below, 2.5 % above. */
enum { RUNS = 40 };
#define BELOW 3.1718
#define ABOVE 4.9229

enum { SHAFT = 0, HINGE = 1 };

typedef struct {
    double model[FURUTA_NK];
    double u; /* N m, held over a period, its disturbance included */
} plant;

typedef struct {
    plant furuta;
    controller law;
    unsigned long long seed;
    double x[NX];
    double q[NQ];          /* as measured last */
    double difference[NV]; /* rates from differences of these */
} loop;

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;

    (void)t;
    return furuta_rhs_prepared(self->model, x, &self->u, xdot);
}

static void loop_start(loop *self, unsigned long long seed) {
    const double believed[NX] = {0.0, 1.5, 0.0, 0.0};
    const double deviation[NX] = {0.05, 0.05, 0.5, 0.5};

    self->seed = seed;
    furuta_prepare(&furuta_default_parameters, self->furuta.model);
    self->furuta.u = 0.0;
    controller_start(&self->law, believed, deviation);
    for (int i = 0; i < NX; ++i) {
        self->x[i] = believed[i] + deviation[i] * numerics_normal(&self->seed);
    }
    for (int i = 0; i < NQ; ++i) {
        self->q[i] = self->x[i];
        self->difference[i] = 0.0;
    }
}

/* One period: move, measure, control. */
static int loop_step(loop *self, double t) {
    const double share = 1.0 - exp(-FILTER * PERIOD);
    double u = 0.0;
    int status = 0;

    for (int k = 0; k < SUBSTEPS && status == 0; ++k) {
        const double h = PERIOD / SUBSTEPS;
        status = numerics_rk4(rates, &self->furuta, NX, t + k * h, h, self->x);
    }
    for (int i = 0; i < NQ; ++i) {
        const double q = self->x[i] + NOISE * numerics_normal(&self->seed);
        self->difference[i] += share * ((q - self->q[i]) / PERIOD - self->difference[i]);
        self->q[i] = q;
    }
    if (status == 0) {
        status = controller_step(&self->law, self->q, &u);
    }
    if (status == 0) {
        self->furuta.u = u + DISTURBANCE * numerics_normal(&self->seed);
    }
    return status;
}

/* The squared error of the estimate by its covariance, e^T P^-1 e. */
static double normalized(const loop *self) {
    double e[NX];
    double weighted[NX];
    double sum = 0.0;

    for (int i = 0; i < NX; ++i) {
        e[i] = weighted[i] = self->law.x[i] - self->x[i];
    }
    if (numerics_solve(NX, 1, self->law.P, weighted) != 0) {
        return HUGE_VAL;
    }
    for (int i = 0; i < NX; ++i) {
        sum += e[i] * weighted[i];
    }
    return sum;
}

static void print_row(double t, const loop *first, double mean) {
    printf("%.3f", t);
    for (int i = 0; i < NX; ++i) {
        printf(",%.9g,%.9g,%.9g", first->x[i], first->law.x[i], sqrt(first->law.P[i * NX + i]));
    }
    printf(",%.9g,%.9g,%.9g,%.9g\n", first->difference[SHAFT], first->difference[HINGE],
           first->furuta.u, mean);
}

int main(void) {
    static loop loops[RUNS];
    const int periods = (int)(TIME / PERIOD + 0.5);
    double squares[2][NV] = {{0.0}}; /* of the errors of rates: of the filter, of differences */
    double within = 0.0;
    int good = 1;

    for (int run = 0; run < RUNS; ++run) {
        loop_start(&loops[run], 1000ULL * (unsigned)run);
    }
    printf("t");
    for (int i = 0; i < NX; ++i) {
        const char *const name = furuta_state_names[i];
        printf(",%s,%s_estimate,%s_deviation", name, name, name);
    }
    printf(",shaft_difference,hinge_difference,torque,mean_normalized\n");
    for (int k = 1; k <= periods; ++k) {
        double mean = 0.0;
        for (int run = 0; run < RUNS; ++run) {
            if (loop_step(&loops[run], k * PERIOD) != 0) {
                fputs("the filter has lost it\n", stderr);
                return 2;
            }
            mean += normalized(&loops[run]) / RUNS;
            for (int i = 0; i < NV && 10 * k > periods; ++i) { /* once both have settled */
                const double truth = loops[run].x[NQ + i];
                const double off[2] = {loops[run].law.x[NQ + i] - truth,
                                       loops[run].difference[i] - truth};
                squares[0][i] += off[0] * off[0] / (RUNS * 0.9 * periods);
                squares[1][i] += off[1] * off[1] / (RUNS * 0.9 * periods);
            }
        }
        within += BELOW < mean && mean < ABOVE ? 1.0 / periods : 0.0;
        print_row(k * PERIOD, &loops[0], mean);
    }
    for (int i = 0; i < NV; ++i) {
        const double filter = sqrt(squares[0][i]);
        const double difference = sqrt(squares[1][i]);
        fprintf(stderr, "%-5s RMS %.3f rad/s, by differences %.3f rad/s\n", furuta_v_names[i],
                filter, difference);
        good = good && filter < GOAL_RATE && GOAL_BETTER * filter < difference;
    }
    fprintf(stderr, "errors as large as believed %.1f %% of the time\n", 100.0 * within);
    return good && within > GOAL_SHARE ? 0 : 1;
}
