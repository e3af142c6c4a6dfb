/*
 * Times libraries against one another, calls one so often that its instructions can be counted, and tells
 * what a process costs.
 *
 *     harness time ROUNDS MILLISECONDS STATES.bin LIBRARY OPTIONS NX NY [STATES.bin LIBRARY ...]
 *     harness count CALLS STATES.bin LIBRARY OPTIONS NX NY
 *     harness spend COMMAND...
 *
 * A library has setup (optional) and call. STATES.bin holds inputs of NX doubles each, which the calls go
 * through in turn. Timing takes the libraries one after the other in every round, so that what disturbs
 * the machine disturbs all; printed is a line for each library, of nanoseconds per call in every round:
 * CPU time of this thread. After what a command prints comes a line with its CPU seconds and peak MiB: it
 * is started from here because a process is charged for the memory of the one that starts it.
 */
#define _DEFAULT_SOURCE
#include <dlfcn.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

enum { MOST = 32 };

struct library {
    void (*call)(void *self, const double *x, double *y);
    void *self;
    double *x, *y;
    size_t nx;
    long states, calls;
};

static void fail(const char *what, const char *which)
{
    fprintf(stderr, "harness: %s %s\n", what, which);
    exit(1);
}

static double seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static struct library opened(char **words)
{
    struct library found = {0};
    void *handle = dlopen(words[1], RTLD_NOW | RTLD_LOCAL);
    if (!handle) {
        fail("cannot load", dlerror());
    }
    void *(*setup)(const char *);
    *(void **)&setup = dlsym(handle, "setup");
    *(void **)&found.call = dlsym(handle, "call");
    found.self = setup ? setup(words[2]) : NULL;
    if (!found.call || (setup && !found.self)) {
        fail("cannot set up", words[1]);
    }
    found.nx = strtoul(words[3], NULL, 10);
    found.y = calloc(strtoul(words[4], NULL, 10) + 1, sizeof(double));
    FILE *file = fopen(words[0], "rb");
    if (!file || fseek(file, 0, SEEK_END)) {
        fail("cannot read", words[0]);
    }
    const size_t size = (size_t)ftell(file);
    rewind(file);
    found.states = (long)(size / sizeof(double) / found.nx);
    found.x = malloc(size);
    if (found.states < 1 || fread(found.x, 1, size, file) != size) {
        fail("cannot read", words[0]);
    }
    fclose(file);
    return found;
}

static void repeat(const struct library *library, long calls)
{
    for (long k = 0; k < calls; ++k) {
        library->call(library->self, library->x + (size_t)(k % library->states) * library->nx, library->y);
    }
}

static void calibrate(struct library *library, double wanted)
{
    library->calls = library->states;
    for (;;) {
        const double start = seconds();
        repeat(library, library->calls);
        const double spent = seconds() - start;
        if (spent > 0.5 * wanted) {
            break;
        }
        library->calls *= 2;
    }
}

static int spend(char **command)
{
    const pid_t child = fork();
    if (child == 0) {
        execvp(command[0], command);
        _exit(127);
    }
    int status;
    struct rusage usage;
    if (child < 0 || wait4(child, &status, 0, &usage) != child || status != 0) {
        fail("failed:", command[0]);
    }
    const double user = (double)usage.ru_utime.tv_sec + 1e-6 * (double)usage.ru_utime.tv_usec;
    const double system = (double)usage.ru_stime.tv_sec + 1e-6 * (double)usage.ru_stime.tv_usec;
    printf("%.6f %.3f\n", user + system, (double)usage.ru_maxrss / 1024);
    return 0;
}

int main(int count, char **words)
{
    static struct library libraries[MOST];
    if (count > 2 && strcmp(words[1], "spend") == 0) {
        return spend(words + 2);
    }
    if (count == 8 && strcmp(words[1], "count") == 0) {
        const struct library library = opened(words + 3);
        repeat(&library, strtol(words[2], NULL, 10));
        return 0;
    }
    const int n = (count - 4) / 5;
    if (count < 9 || n > MOST || (count - 4) % 5 != 0) {
        fail("does not understand", "this call");
    }
    const int rounds = atoi(words[2]);
    double *spent = calloc((size_t)n * (size_t)rounds, sizeof *spent);
    for (int k = 0; k < n; ++k) {
        libraries[k] = opened(words + 4 + 5 * k);
        calibrate(&libraries[k], 1e-3 * atof(words[3]));
    }
    for (int round = 0; round < rounds; ++round) {
        for (int k = 0; k < n; ++k) {
            const double start = seconds();
            repeat(&libraries[k], libraries[k].calls);
            spent[k * rounds + round] = 1e9 * (seconds() - start) / (double)libraries[k].calls;
        }
    }
    for (int k = 0; k < n; ++k) {
        for (int round = 0; round < rounds; ++round) {
            printf("%.2f%c", spent[k * rounds + round], round + 1 < rounds ? ' ' : '\n');
        }
    }
    return 0;
}
