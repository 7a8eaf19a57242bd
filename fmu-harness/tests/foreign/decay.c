/* A foreign FMU in few words: dx/dt = u - k*x by its exact solution, u straight over each step, turns of an angle, and one of
 * each type. */
#include <math.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

typedef void (*Logger)(void *, const char *, int, const char *, const char *, ...);
typedef struct {
    Logger logger;
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;
typedef struct {
    const Callbacks *callbacks;
    double x, u, slope, k, angle;
    int steps, fast, law;
} Decay;

enum { OK, WARNING, DISCARD, ERROR };

static int complain(Decay *d, const char *words) {
    d->callbacks->logger(d->callbacks->environment, "decay", ERROR, "logStatusError", words);
    return ERROR;
}

const char *fmi2GetVersion(void) { return "2.0"; }
const char *fmi2GetTypesPlatform(void) { return "default"; }

void *fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
                      const Callbacks *callbacks, int visible, int logging) {
    if (strcmp(guid, "{decay}") != 0) {
        callbacks->logger(callbacks->environment, name, ERROR, "logStatusError", "the GUID is not {decay}");
        return NULL;
    }
    if (type != 1 || strncmp(resources, "file:///", 8) != 0) return NULL;
    Decay *d = callbacks->allocate(1, sizeof *d);
    d->callbacks = callbacks;
    d->x = d->k = 1;
    d->law = 1;
    return d;
}
void fmi2FreeInstance(void *c) {
    Decay *d = c;
    if (d) d->callbacks->release(d);
}
int fmi2SetupExperiment(void *c, int has_tolerance, double tolerance, double start, int has_stop, double stop) { return OK; }
int fmi2EnterInitializationMode(void *c) { return OK; }
int fmi2ExitInitializationMode(void *c) {
    Decay *d = c;
    return d->k > 0 ? OK : complain(d, "k must be positive");
}
int fmi2Terminate(void *c) { return OK; }

static double *real(Decay *d, unsigned reference) {
    switch (reference) {
    case 0: return &d->x;
    case 1: return &d->u;
    case 2: return &d->k;
    case 3: return &d->angle;
    default: return NULL;
    }
}
int fmi2GetReal(void *c, const unsigned *vr, size_t n, double *values) {
    for (size_t i = 0; i < n; i++) {
        if (!real(c, vr[i])) return complain(c, "no such real");
        values[i] = *real(c, vr[i]);
    }
    return OK;
}
int fmi2SetReal(void *c, const unsigned *vr, size_t n, const double *values) {
    for (size_t i = 0; i < n; i++) {
        if (!real(c, vr[i])) return complain(c, "no such real");
        *real(c, vr[i]) = values[i];
    }
    return OK;
}
int fmi2SetRealInputDerivatives(void *c, const unsigned *vr, size_t n, const int *order, const double *values) {
    for (size_t i = 0; i < n; i++) {
        if (vr[i] != 1 || order[i] != 1) return complain(c, "no such slope");
        ((Decay *)c)->slope = values[i];
    }
    return OK;
}
int fmi2GetInteger(void *c, const unsigned *vr, size_t n, int *values) {
    for (size_t i = 0; i < n; i++) values[i] = vr[i] == 0 ? ((Decay *)c)->steps : ((Decay *)c)->law;
    return OK;
}
int fmi2SetInteger(void *c, const unsigned *vr, size_t n, const int *values) {
    for (size_t i = 0; i < n; i++) ((Decay *)c)->law = values[i];
    return OK;
}
int fmi2GetBoolean(void *c, const unsigned *vr, size_t n, int *values) {
    for (size_t i = 0; i < n; i++) values[i] = ((Decay *)c)->x > 0.5;
    return OK;
}
int fmi2SetBoolean(void *c, const unsigned *vr, size_t n, const int *values) { return OK; }
int fmi2SetString(void *c, const unsigned *vr, size_t n, const char *const *values) {
    return strcmp(values[0], "decay") == 0 ? OK : complain(c, "the name is decay");
}
int fmi2DoStep(void *c, double time, double step, int never_back) {
    Decay *d = c;
    if (time > 1e3) return complain(d, "too late");
    double slope = d->law == 2 ? 0 : d->slope / d->k, level = d->law == 2 ? 0 : (d->u - slope) / d->k;
    d->x = level + slope * step + (d->x - level) * exp(-d->k * step);
    d->u += d->slope * step;
    d->angle += 10 * step;
    d->steps += 1;
    return OK;
}
