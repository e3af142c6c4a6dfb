/*
 * MuJoCo's stages of smooth dynamics, as a library for the harness.
 *
 * setup takes "FUNCTION fixed|floating ROBOT.urdf". Timed are, after kinematics, comPos and comVel:
 *   equations         makeM and rne without accelerations: M sparse, as MuJoCo keeps it
 *   inverse_dynamics  rne with accelerations
 *   forward_dynamics  makeM, factorM, rne without accelerations, solveM
 * and neither contacts, constraints, actuators nor sensors.
 */
#include <mujoco/mujoco.h>

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

struct robot {
    mjModel *model;
    mjData *data;
    mjtNum *result, *force;
    int unknown; /* efforts at the front that nothing drives */
    char function;
};

void *setup(const char *options)
{
    char function[32], base[32], urdf[4096], error[1000] = "";
    struct robot *self = calloc(1, sizeof *self);
    if (sscanf(options, "%31s %31s %4095s", function, base, urdf) != 3) {
        return NULL;
    }
    self->model = mj_loadXML(urdf, NULL, error, sizeof error);
    if (!self->model) {
        fprintf(stderr, "%s\n", error);
        return NULL;
    }
    self->data = mj_makeData(self->model);
    self->result = calloc((size_t)self->model->nv, sizeof(mjtNum));
    self->force = calloc((size_t)self->model->nv, sizeof(mjtNum));
    self->unknown = strcmp(base, "floating") == 0 ? 6 : 0;
    self->function = function[0];
    return self;
}

/* Names of the joints in order, one a line. */
void names(const void *robot, char *text)
{
    const struct robot *self = robot;
    for (int k = 0; k < self->model->njnt; ++k) {
        text += sprintf(text, "%s\n", mj_id2name(self->model, mjOBJ_JOINT, k));
    }
}

void call(void *robot, const double *x, double *y)
{
    struct robot *self = robot;
    const mjModel *m = self->model;
    mjData *d = self->data;
    const double *rest = x + m->nq + m->nv;
    (void)y;
    memcpy(d->qpos, x, (size_t)m->nq * sizeof *x);
    memcpy(d->qvel, x + m->nq, (size_t)m->nv * sizeof *x);
    mj_kinematics(m, d);
    mj_comPos(m, d);
    if (self->function != 'i') {
        mj_makeM(m, d);
    } else {
        memcpy(d->qacc, rest, (size_t)m->nv * sizeof *x);
    }
    if (self->function == 'f') {
        mj_factorM(m, d);
    }
    mj_comVel(m, d);
    mj_rne(m, d, self->function == 'i', self->result);
    if (self->function == 'f') {
        for (int k = 0; k < m->nv; ++k) {
            const double tau = k < self->unknown ? 0.0 : rest[k - self->unknown];
            self->force[k] = tau - self->result[k];
        }
        mj_solveM(m, d, self->result, self->force, 1);
    }
}

/* The results of the last call; M made dense here, outside of what is timed. */
void fetch(void *robot, double *y)
{
    struct robot *self = robot;
    const size_t nv = (size_t)self->model->nv;
    if (self->function == 'e') {
        mj_fullM(self->model, self->data, y);
        y += nv * nv;
    }
    memcpy(y, self->result, nv * sizeof *y);
}
