/* The arm in closed loop, once under each law; prints both motions side by side as CSV.
 *
 * The arm that is simulated carries a payload that the controller does not know, its links are not
 * those of the URDF, and its joints have friction.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD       1e-3 /* s, of the controller */
#define SUBSTEPS     2    /* of the simulation in each */
#define LOGGED       10   /* periods from one line of the log to the next */
#define MOVE         1.2  /* s, from one waypoint to the next */
#define GOAL_RMS     3e-3
#define GOAL_LARGEST 8e-3

enum { NQ = ARM_NQ, NV = ARM_NV, NS = ARM_NS, MOVES = 3, LAWS = 2 };

static const double waypoints[MOVES + 1][NQ] = {
    {0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.8},
    {0.9, 0.1, 0.4, -1.4, -0.5, 2.3, -0.2},
    {-0.5, 0.5, -0.5, -1.8, 0.6, 1.5, 1.2},
    {0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.8},
};

typedef struct {
    double model[ARM_NK];
    double friction[NV]; /* N m s/rad */
    double u[ARM_NU];    /* held over a period */
} plant;

#define SCALE(LINK, FACTOR)                                                                        \
    (p.m_##LINK *= (FACTOR), p.mx_##LINK *= (FACTOR), p.my_##LINK *= (FACTOR),                     \
     p.mz_##LINK *= (FACTOR), p.Ixx_##LINK *= (FACTOR), p.Ixy_##LINK *= (FACTOR),                  \
     p.Ixz_##LINK *= (FACTOR), p.Iyy_##LINK *= (FACTOR), p.Iyz_##LINK *= (FACTOR),                 \
     p.Izz_##LINK *= (FACTOR))

static void plant_start(plant *self) {
    const double friction[NV] = {0.4, 0.4, 0.3, 0.3, 0.1, 0.1, 0.05};
    arm_parameters p = arm_default_parameters;

    SCALE(panda_link2, 1.05);
    SCALE(panda_link3, 0.95);
    SCALE(panda_link4, 1.05);
    SCALE(panda_link5, 0.95);
    SCALE(panda_link6, 1.05);
    p.m_panda_hand_tcp += 0.5; /* kg, the payload, between the fingertips */
    arm_prepare(&p, self->model);
    for (int i = 0; i < NV; ++i) {
        self->friction[i] = friction[i];
        self->u[i] = 0.0;
    }
}

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;
    double u[ARM_NU];

    (void)t;
    for (int i = 0; i < NV; ++i) {
        u[i] = self->u[i] - self->friction[i] * x[NQ + i];
    }
    return arm_rhs_prepared(self->model, x, u, xdot);
}

/* From waypoint to waypoint along straight lines, with the polynomial of least jerk. */
static void reference(double t, controller_reference *wanted) {
    const int move = t < MOVES * MOVE ? (int)(t / MOVE) : MOVES - 1;
    const double s = fmin(t / MOVE - move, 1.0);
    const double way = s * s * s * (10.0 + s * (6.0 * s - 15.0));
    const double speed = 30.0 * s * s * (1.0 - s) * (1.0 - s) / MOVE;
    const double acceleration = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (MOVE * MOVE);

    for (int i = 0; i < NQ; ++i) {
        const double length = waypoints[move + 1][i] - waypoints[move][i];
        wanted->q[i] = waypoints[move][i] + length * way;
        wanted->v[i] = length * speed;
        wanted->a[i] = length * acceleration;
    }
}

typedef struct {
    plant arm;
    controller law;
    double x[NS];
    unsigned long long seed;
} loop;

static void loop_start(loop *self, controller_law law) {
    plant_start(&self->arm);
    controller_start(&self->law, law, waypoints[0]);
    for (int i = 0; i < NQ; ++i) {
        self->x[i] = waypoints[0][i];
        self->x[NQ + i] = 0.0;
    }
    self->seed = 1;
}

/* One period: measure, control, move. */
static int loop_step(loop *self, double t, const controller_reference *wanted) {
    double q[NQ];
    double v[NV];
    int status = 0;

    for (int i = 0; i < NQ; ++i) { /* encoders of 2e-5 rad, rates with 5 mrad/s of noise */
        q[i] = numerics_quantized(self->x[i], 2e-5);
        v[i] = self->x[NQ + i] + 5e-3 * numerics_normal(&self->seed);
    }
    controller_step(&self->law, wanted, q, v, self->arm.u);
    for (int k = 0; k < SUBSTEPS && status == 0; ++k) {
        const double h = PERIOD / SUBSTEPS;
        status = numerics_rk4(rates, &self->arm, NS, t + k * h, h, self->x);
    }
    return status;
}

static void print_header(void) {
    const char *const laws[LAWS] = {"computed", "pd"};

    printf("t");
    for (int i = 1; i <= NQ; ++i) {
        printf(",wanted%d", i);
    }
    for (int law = 0; law < LAWS; ++law) {
        for (int i = 1; i <= NQ; ++i) {
            printf(",%s_q%d", laws[law], i);
        }
        for (int i = 1; i <= NQ; ++i) {
            printf(",%s_u%d", laws[law], i);
        }
    }
    printf("\n");
}

static void print_row(double t, const controller_reference *wanted, const loop loops[LAWS]) {
    printf("%.3f", t);
    for (int i = 0; i < NQ; ++i) {
        printf(",%.9g", wanted->q[i]);
    }
    for (int law = 0; law < LAWS; ++law) {
        for (int i = 0; i < NQ; ++i) {
            printf(",%.9g", loops[law].x[i]);
        }
        for (int i = 0; i < NQ; ++i) {
            printf(",%.9g", loops[law].arm.u[i]);
        }
    }
    printf("\n");
}

int main(void) {
    const int periods = (int)(MOVES * MOVE / PERIOD + 0.5) + 400;
    loop loops[LAWS];
    double squares[LAWS] = {0.0};
    double largest[LAWS] = {0.0};

    loop_start(&loops[0], COMPUTED_TORQUE);
    loop_start(&loops[1], PD_GRAVITY);
    print_header();
    for (int k = 0; k <= periods; ++k) {
        const double t = k * PERIOD;
        controller_reference wanted;
        reference(t, &wanted);
        for (int law = 0; law < LAWS; ++law) {
            for (int i = 0; i < NQ; ++i) {
                const double error = loops[law].x[i] - wanted.q[i];
                squares[law] += error * error / (NQ * (periods + 1.0));
                largest[law] = fmax(largest[law], fabs(error));
            }
        }
        if (k % LOGGED == 0) {
            print_row(t, &wanted, loops);
        }
        for (int law = 0; law < LAWS; ++law) {
            if (loop_step(&loops[law], t, &wanted) != 0) {
                fputs("the mass matrix is singular\n", stderr);
                return 2;
            }
        }
    }
    fprintf(stderr, "computed torque: RMS %.2f mrad, largest %.2f mrad\n", 1e3 * sqrt(squares[0]),
            1e3 * largest[0]);
    fprintf(stderr, "PD and gravity:  RMS %.2f mrad, largest %.2f mrad\n", 1e3 * sqrt(squares[1]),
            1e3 * largest[1]);
    return sqrt(squares[0]) < GOAL_RMS && largest[0] < GOAL_LARGEST ? 0 : 1;
}
