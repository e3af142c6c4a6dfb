/* The arm in closed loop: its tool answers a step in the open, then is led against a wall; prints
 * its motion as CSV.
 *
 * The arm that is simulated has links that are not those of the URDF, and joints with friction.
 */
#include <math.h>
#include <stdio.h>

#include "../numerics.h"
#include "controller.h"

#define PERIOD       1e-3    /* s, of the controller */
#define SUBSTEPS     4       /* of the simulation in each */
#define LOGGED       10      /* periods from one line of the log to the next */
#define TIME         5.0     /* s */
#define STEP_TIME    0.1     /* s */
#define LEAD_TIME    1.5     /* s */
#define LEAD_ENDS    3.5     /* s */
#define LEAD         0.08    /* m, along x */
#define GAP          0.05    /* m, from the tool to the wall: it is led 0.03 m beyond */
#define WALL         20000.0 /* N/m */
#define WALL_DAMPING 100.0   /* N s/m */
#define MASS         6.0     /* kg, N/m, N s/m: the impedance that is wanted */
#define STIFFNESS    600.0
#define DAMPING      84.0
#define GOAL_FREE    3e-3 /* m, from the response that is wanted */
#define GOAL_FORCE   0.03 /* of the force that is wanted, at the end */
#define GOAL_PEAK    25.0 /* N */
#define GOAL_TURN    0.01 /* rad */

enum { NQ = ARM_NQ, NV = ARM_NV, NS = ARM_NS };

static const double start[NQ] = {0.0, -0.3, 0.0, -2.2, 0.0, 2.0, 0.8};
static const double step[3] = {0.0, 0.05, -0.03}; /* m */

typedef struct {
    arm_parameters p;
    double model[ARM_NK];
    double friction[NV]; /* N m s/rad */
    double wall;         /* m, its place on the x axis */
    double u[ARM_NU];    /* held over a period */
} plant;

/* What the wall exerts on the tool along x; it does not pull. */
static double push(const plant *self, const double q[NQ], const double v[NV]) {
    double place[3];
    double rotation[9];
    double velocity[6];
    double inside;

    arm_frame_panda_hand_tcp_pose(&self->p, q, place, rotation);
    arm_frame_panda_hand_tcp_velocity(&self->p, q, v, velocity);
    inside = place[0] - self->wall;
    return inside > 0.0 ? -fmax(0.0, WALL * inside + WALL_DAMPING * velocity[0]) : 0.0;
}

static int rates(const void *of, double t, const double x[], double xdot[]) {
    const plant *self = of;
    const double force = push(self, x, &x[NQ]);
    double J[6 * NV];
    double u[ARM_NU];

    (void)t;
    arm_frame_panda_hand_tcp_jacobian(&self->p, x, J);
    for (int i = 0; i < NV; ++i) {
        u[i] = self->u[i] - self->friction[i] * x[NQ + i] + J[i] * force;
    }
    return arm_rhs_prepared(self->model, x, u, xdot);
}

#define SCALE(LINK, FACTOR)                                                                        \
    (self->p.m_##LINK *= (FACTOR), self->p.mx_##LINK *= (FACTOR), self->p.my_##LINK *= (FACTOR),   \
     self->p.mz_##LINK *= (FACTOR), self->p.Ixx_##LINK *= (FACTOR),                                \
     self->p.Ixy_##LINK *= (FACTOR), self->p.Ixz_##LINK *= (FACTOR),                               \
     self->p.Iyy_##LINK *= (FACTOR), self->p.Iyz_##LINK *= (FACTOR),                               \
     self->p.Izz_##LINK *= (FACTOR))

static void plant_start(plant *self) {
    self->p = arm_default_parameters;
    SCALE(panda_link4, 1.01);
    SCALE(panda_link5, 0.99);
    SCALE(panda_link6, 1.02);
    arm_prepare(&self->p, self->model);
    for (int i = 0; i < NV; ++i) {
        self->friction[i] = 0.1;
        self->u[i] = 0.0;
    }
}

static void reference(double t, const double origin[3], controller_reference *wanted) {
    const double length = LEAD_ENDS - LEAD_TIME;
    const double s = fmax(0.0, fmin((t - LEAD_TIME) / length, 1.0));

    for (int i = 0; i < 3; ++i) {
        wanted->place[i] = origin[i] + (t < STEP_TIME ? 0.0 : step[i]);
        wanted->velocity[i] = 0.0;
        wanted->acceleration[i] = 0.0;
    }
    wanted->place[0] += LEAD * s * s * s * (10.0 + s * (6.0 * s - 15.0));
    wanted->velocity[0] = LEAD * 30.0 * s * s * (1.0 - s) * (1.0 - s) / length;
    wanted->acceleration[0] = LEAD * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (length * length);
}

/* What part of a step the wanted impedance has made after the time t. */
static double response(double t) {
    const double decay = DAMPING / (2.0 * MASS);
    const double rate = sqrt(STIFFNESS / MASS - decay * decay);

    return t < 0.0 ? 0.0 : 1.0 - exp(-decay * t) * (cos(rate * t) + decay / rate * sin(rate * t));
}

/* The angle by which the tool is turned away. */
static double turned(const controller *law, const double rotation[9]) {
    double trace = 0.0;

    for (int i = 0; i < 9; ++i) {
        trace += law->turned[i] * rotation[i];
    }
    return acos(fmin(0.5 * (trace - 1.0), 1.0));
}

int main(void) {
    const int periods = (int)(TIME / PERIOD + 0.5);
    const double ends = STIFFNESS * WALL / (STIFFNESS + WALL) * (LEAD - GAP);
    plant arm;
    controller law;
    unsigned long long seed = 1;
    double x[NS] = {0.0};
    double origin[3];
    double rotation[9];
    double free = 0.0;
    double peak = 0.0;
    double force = 0.0;
    double turn = 0.0;
    int status = 0;

    plant_start(&arm);
    for (int i = 0; i < NQ; ++i) {
        x[i] = start[i];
    }
    arm_frame_panda_hand_tcp_pose(&arm.p, x, origin, rotation);
    arm.wall = origin[0] + GAP;
    controller_start(&law, start);
    printf("t,wanted_x,wanted_y,wanted_z,x,y,z,response_y,force,turn,u1,u2,u3,u4,u5,u6,u7\n");
    for (int k = 0; k <= periods && status == 0; ++k) {
        const double t = k * PERIOD;
        controller_reference wanted;
        double place[3];
        double felt[3];
        double q[NQ];
        double v[NV];

        reference(t, origin, &wanted);
        arm_frame_panda_hand_tcp_pose(&arm.p, x, place, rotation);
        for (int i = 0; i < 3;
             ++i) { /* in the open: until the tool is led to the wall, across it always */
            const double off = place[i] - origin[i] - step[i] * response(t - STEP_TIME);
            free = t < LEAD_TIME || i > 0 ? fmax(free, fabs(off)) : free;
            felt[i] = (i == 0 ? push(&arm, x, &x[NQ]) : 0.0) + 0.2 * numerics_normal(&seed);
        }
        peak = fmax(peak, -push(&arm, x, &x[NQ]));
        force += t > TIME - 0.5 ? -push(&arm, x, &x[NQ]) * PERIOD / 0.5 : 0.0;
        turn = fmax(turn, turned(&law, rotation));
        for (int i = 0; i < NQ;
             ++i) { /* encoders of 2e-5 rad, rates with 2 mrad/s of noise, forces with 0.2 N */
            q[i] = numerics_quantized(x[i], 2e-5);
            v[i] = x[NQ + i] + 2e-3 * numerics_normal(&seed);
        }
        status = controller_step(&law, &wanted, q, v, felt, arm.u);
        if (k % LOGGED == 0) {
            printf("%.3f,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g,%.9g", t, wanted.place[0],
                   wanted.place[1], wanted.place[2], place[0], place[1], place[2],
                   origin[1] + step[1] * response(t - STEP_TIME), -push(&arm, x, &x[NQ]),
                   turned(&law, rotation));
            for (int i = 0; i < NV; ++i) {
                printf(",%.9g", arm.u[i]);
            }
            printf("\n");
        }
        for (int i = 0; i < SUBSTEPS && status == 0; ++i) {
            const double h = PERIOD / SUBSTEPS;
            status = numerics_rk4(rates, &arm, NS, t + i * h, h, x);
        }
    }
    if (status != 0) {
        fprintf(stderr, "stopped with status %d\n", status);
        return 2;
    }
    fprintf(stderr, "in the open within %.2f mm of the response; turned by %.1f mrad at most\n",
            1e3 * free, 1e3 * turn);
    fprintf(stderr, "at the wall %.2f N, wanted %.2f N; %.2f N at most\n", force, ends, peak);
    return free < GOAL_FREE && turn < GOAL_TURN && fabs(force / ends - 1.0) < GOAL_FORCE &&
                   peak < GOAL_PEAK
               ? 0
               : 1;
}
