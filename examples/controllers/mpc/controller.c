#include "controller.h"

#include <math.h>

#include "../numerics.h"

#define PERIOD      0.02 /* s, of the plan: it looks HORIZON of them ahead */
#define MOST        8.0  /* N, of the motor */
#define RAIL        0.5  /* m, from the middle to where the rail is to be kept free */
#define MOST_SPREAD 6.0  /* N, of what is tried about the plan */
#define PERSISTENCE 0.85 /* of that from one period to the next */
#define TEMPERATURE 3.0  /* how much worse a plan may be than the best and still count */

enum { SLIDE = 0, SWING = 1 };

/* What a moment costs: the pole away from upright, the cart away from the middle, motion, force. */
static double price(const double q[NQ], const double v[NV], double u) {
    const double off = fabs(q[SLIDE]) - RAIL;

    return 10.0 * (1.0 + cos(q[SWING])) + 8.0 * q[SLIDE] * q[SLIDE] + 0.2 * v[SWING] * v[SWING] +
           0.5 * v[SLIDE] * v[SLIDE] + 0.01 * u * u + (off > 0.0 ? 1000.0 * off : 0.0);
}

void controller_start(controller *self, unsigned long long seed) {
    cart_pole_prepare(&cart_pole_default_parameters, self->model);
    self->seed = seed;
    for (int k = 0; k < HORIZON; ++k) {
        self->plan[k] = 0.0;
    }
}

/* Plans near the present one; the first is the present one itself. */
static void try(controller *self) {
    for (int s = 0; s < SAMPLES; ++s) {
        const double part = s / (SAMPLES - 1.0);
        const double spread = MOST_SPREAD * part * part;
        double aside = 0.0;
        for (int k = 0; k < HORIZON; ++k) {
            const double fresh = spread * numerics_normal(&self->seed);
            aside = k == 0 ? fresh
                           : PERSISTENCE * aside + sqrt(1.0 - PERSISTENCE * PERSISTENCE) * fresh;
            self->tried[s * HORIZON + k] = numerics_clipped(self->plan[k] + aside, MOST);
        }
    }
}

/* All of them at once over one period of the plan: M v' + h = (u, 0) for all, then each by itself.
 */
static void advance(controller *self, int k) {
    cart_pole_equations_prepared_batch(SAMPLES, self->model, self->q, self->v, self->M, self->h);
    for (int s = 0; s < SAMPLES; ++s) {
        const double u = self->tried[s * HORIZON + k];
        const double *const M = &self->M[s * NV * NV];
        const double *const h = &self->h[s * NV];
        double *const q = &self->q[s * NQ];
        double *const v = &self->v[s * NV];
        const double determinant = M[0] * M[3] - M[1] * M[2];

        v[SLIDE] += PERIOD * (M[3] * (u - h[SLIDE]) + M[1] * h[SWING]) / determinant;
        v[SWING] += PERIOD * (-M[0] * h[SWING] - M[2] * (u - h[SLIDE])) / determinant;
        q[SLIDE] += PERIOD * v[SLIDE];
        q[SWING] += PERIOD * v[SWING];
        self->cost[s] += price(q, v, u);
    }
}

/* The mean of what was tried, the cheaper the more. */
static void decide(controller *self) {
    double least = self->cost[0];
    double total = 0.0;

    for (int s = 1; s < SAMPLES; ++s) {
        least = fmin(least, self->cost[s]);
    }
    for (int k = 0; k < HORIZON; ++k) {
        self->plan[k] = 0.0;
    }
    for (int s = 0; s < SAMPLES; ++s) {
        const double weight = exp((least - self->cost[s]) / TEMPERATURE);
        total += weight;
        for (int k = 0; k < HORIZON; ++k) {
            self->plan[k] += weight * self->tried[s * HORIZON + k];
        }
    }
    for (int k = 0; k < HORIZON; ++k) {
        self->plan[k] /= total;
    }
}

double controller_step(controller *self, const double q[NQ], const double v[NV]) {
    double now;

    for (int s = 0; s < SAMPLES; ++s) {
        self->cost[s] = 0.0;
        for (int i = 0; i < NQ; ++i) {
            self->q[s * NQ + i] = q[i];
            self->v[s * NV + i] = v[i];
        }
    }
    try(self);
    for (int k = 0; k < HORIZON; ++k) {
        advance(self, k);
    }
    decide(self);
    now = self->plan[0];
    for (int k = 0; k + 1 < HORIZON; ++k) { /* the next period starts with the next force */
        self->plan[k] = self->plan[k + 1];
    }
    return now;
}
