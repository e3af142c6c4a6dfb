/*
 * A function that CasADi has written, as a library for the harness; NAME is its name.
 *
 * What comes first is input by input, densely; results stay where CasADi puts them, packed by its sparsity.
 */
#include <stdlib.h>

typedef long long number;

#define JOINED(a, b) a##b
#define OF(name, part) JOINED(name, part)

int NAME(const double **in, double **out, number *iw, double *w, int memory);
int OF(NAME, _work)(number *in, number *out, number *iw, number *w);
number OF(NAME, _n_in)(void);
number OF(NAME, _n_out)(void);
const number *OF(NAME, _sparsity_in)(number k);
const number *OF(NAME, _sparsity_out)(number k);

struct function {
    const double **in;
    double **out, *w;
    number *iw, *sizes, inputs, outputs;
};

void *setup(const char *options)
{
    struct function *self = calloc(1, sizeof *self);
    number in, out, iw, w;
    (void)options;
    OF(NAME, _work)(&in, &out, &iw, &w);
    self->inputs = OF(NAME, _n_in)();
    self->outputs = OF(NAME, _n_out)();
    self->in = calloc((size_t)in + 1, sizeof *self->in);
    self->out = calloc((size_t)out + 1, sizeof *self->out);
    self->iw = calloc((size_t)iw + 1, sizeof *self->iw);
    self->w = calloc((size_t)w + 1, sizeof *self->w);
    self->sizes = calloc((size_t)self->inputs, sizeof *self->sizes);
    for (number k = 0; k < self->inputs; ++k) {
        self->sizes[k] = OF(NAME, _sparsity_in)(k)[0];
    }
    for (number k = 0; k < self->outputs; ++k) {
        const number *pattern = OF(NAME, _sparsity_out)(k);
        self->out[k] = calloc((size_t)(pattern[0] * pattern[1]), sizeof(double));
    }
    return self;
}

void call(void *function, const double *x, double *y)
{
    struct function *self = function;
    (void)y;
    for (number k = 0; k < self->inputs; ++k) {
        self->in[k] = x;
        x += self->sizes[k];
    }
    NAME(self->in, self->out, self->iw, self->w, 0);
}

/* The results of the last call, made dense; of a square matrix only a triangle may be there. */
void fetch(void *function, double *y)
{
    struct function *self = function;
    for (number k = 0; k < self->outputs; ++k) {
        const number *pattern = OF(NAME, _sparsity_out)(k);
        const number rows = pattern[0], columns = pattern[1];
        const int dense = pattern[2] == 1; /* then no columns follow */
        const double *value = self->out[k];
        for (number j = 0; j < columns; ++j) {
            const number first = dense ? 0 : pattern[2 + j];
            const number last = dense ? rows : pattern[3 + j];
            for (number at = first; at < last; ++at) {
                const number i = dense ? at : pattern[3 + columns + at];
                y[i * columns + j] = *value;
                if (columns == rows) {
                    y[j * columns + i] = *value;
                }
                ++value;
            }
        }
        y += rows * columns;
    }
}
