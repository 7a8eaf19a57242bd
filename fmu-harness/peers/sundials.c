/* A scene's equations in SUNDIALS, with root finding on the event functions and a restart after each event.
 *
 *   sundials METHOD SCENE SPAN POINTS TOLERANCE...
 *
 * One line of JSON for each tolerance: CPU time and work of a run over SPAN seconds, and the positions at POINTS
 * equidistant instants from a run of its own. The weights are those of the scene's error norm: absolute ones, tolerance
 * times equations_scales, of which SUNDIALS, too, takes the root mean square. */
#include "equations.h"
#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>
#include <time.h>

enum { GUARDS = 8, FEWEST_RUNS = 3, MOST_RUNS = 200, MOST_EVENTS = 1000000 };
static const double ENOUGH = 0.2; /* [s] Repeated until the runs have taken so long together. */
static const long MOST_STEPS = 100000000;
static const int MOST_FAILURES = 50; /* in one step: an impact may shorten it a lot */

typedef struct {
    SUNContext context;
    system_of_equations *equations;
    size_t positions, states;
    int guards;
    int order; /* of an explicit Runge-Kutta method; 0: CVODE */
    int family; /* CV_ADAMS or CV_BDF */
    double tolerance;
    void *memory;
    N_Vector y, weights;
    SUNMatrix matrix;
    SUNLinearSolver linear;
    SUNNonlinearSolver iteration;
    long evaluations, events;
} run;

static double cpu_time(void) {
    struct timespec now;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

static int rates(realtype t, N_Vector y, N_Vector ydot, void *data) {
    run *r = data;
    r->evaluations++;
    equations_rates(r->equations, t, NV_DATA_S(y), NV_DATA_S(ydot));
    return 0;
}

static int guards(realtype t, N_Vector y, realtype *values, void *data) {
    run *r = data;
    equations_event_functions(r->equations, t, NV_DATA_S(y), values);
    return 0;
}

/* Memory and settings of the method; 0 if all went well. */
static int set_up(run *r) {
    int falling[GUARDS], failed = 0;
    for (int i = 0; i < GUARDS; i++) falling[i] = -1;
    double longest = equations_longest_step(r->equations);
    equations_start(r->equations, NV_DATA_S(r->y));
    equations_scales(r->equations, NV_DATA_S(r->weights));
    N_VScale(r->tolerance, r->weights, r->weights);
    if (r->order) {
        r->memory = ERKStepCreate(rates, 0.0, r->y, r->context);
        failed |= ERKStepSetUserData(r->memory, r);
        failed |= ERKStepSetOrder(r->memory, r->order);
        failed |= ERKStepSVtolerances(r->memory, 0.0, r->weights);
        failed |= ERKStepSetMaxStep(r->memory, longest);
        failed |= ERKStepSetMaxNumSteps(r->memory, MOST_STEPS);
        failed |= ERKStepSetMaxErrTestFails(r->memory, MOST_FAILURES);
        failed |= ERKStepRootInit(r->memory, r->guards, guards);
        if (r->guards) failed |= ERKStepSetRootDirection(r->memory, falling);
        return failed | ERKStepSetNoInactiveRootWarn(r->memory);
    }
    r->memory = CVodeCreate(r->family, r->context);
    failed |= CVodeInit(r->memory, rates, 0.0, r->y);
    failed |= CVodeSetUserData(r->memory, r);
    failed |= CVodeSVtolerances(r->memory, 0.0, r->weights);
    failed |= CVodeSetMaxStep(r->memory, longest);
    failed |= CVodeSetMaxNumSteps(r->memory, MOST_STEPS);
    failed |= CVodeSetMaxErrTestFails(r->memory, MOST_FAILURES);
    failed |= CVodeRootInit(r->memory, r->guards, guards);
    if (r->guards) failed |= CVodeSetRootDirection(r->memory, falling);
    failed |= CVodeSetNoInactiveRootWarn(r->memory);
    if (r->family == CV_ADAMS) {
        r->iteration = SUNNonlinSol_FixedPoint(r->y, 0, r->context);
        return failed | CVodeSetNonlinearSolver(r->memory, r->iteration);
    }
    r->matrix = SUNDenseMatrix((sunindextype)r->states, (sunindextype)r->states, r->context);
    r->linear = SUNLinSol_Dense(r->y, r->matrix, r->context);
    return failed | CVodeSetLinearSolver(r->memory, r->linear, r->matrix);
}

static void tear_down(run *r) {
    if (r->order) ERKStepFree(&r->memory);
    else CVodeFree(&r->memory);
    if (r->linear) SUNLinSolFree(r->linear);
    if (r->matrix) SUNMatDestroy(r->matrix);
    if (r->iteration) SUNNonlinSolFree(r->iteration);
    r->linear = NULL;
    r->matrix = NULL;
    r->iteration = NULL;
}

/* From where it is to `end`, event by event; 0 if all went well. */
static int advance(run *r, double end) {
    int crossed[GUARDS] = {0};
    for (int event = 0; event < MOST_EVENTS; event++) {
        double t;
        int flag = r->order ? ERKStepEvolve(r->memory, end, r->y, &t, ARK_NORMAL)
                            : CVode(r->memory, end, r->y, &t, CV_NORMAL);
        if (flag < 0) return flag;
        if (flag != (r->order ? ARK_ROOT_RETURN : CV_ROOT_RETURN)) return 0;
        r->events++;
        flag = r->order ? ERKStepGetRootInfo(r->memory, crossed) : CVodeGetRootInfo(r->memory, crossed);
        equations_cross(r->equations, t, NV_DATA_S(r->y), crossed);
        flag |= r->order ? ERKStepReInit(r->memory, rates, t, r->y) : CVodeReInit(r->memory, t, r->y);
        if (flag) return flag;
    }
    return -1;
}

/* One run. With `positions` they are written at every point, else nothing is asked for before the end. */
static int march(run *r, double span, int points, double *positions, double *seconds) {
    r->evaluations = r->events = 0;
    int failed = set_up(r);
    double start = cpu_time();
    for (int point = positions ? 1 : points; point <= points && !failed; point++) {
        failed = advance(r, span * point / points);
        if (positions) memcpy(positions + (size_t)(point - 1) * r->positions, NV_DATA_S(r->y), r->positions * sizeof(double));
    }
    *seconds = cpu_time() - start;
    tear_down(r);
    return failed;
}

static void report(run *r, double span, int points, double *positions) {
    double seconds, least = 1e300, total = 0.0;
    int failed = march(r, span, points, positions, &seconds);
    for (int i = 0; i < MOST_RUNS && !failed && (i < FEWEST_RUNS || total < ENOUGH); i++) {
        failed = march(r, span, points, NULL, &seconds);
        least = seconds < least ? seconds : least;
        total += seconds;
    }
    printf("{\"tolerance\": %.17g, ", r->tolerance);
    if (failed) {
        printf("\"note\": \"gave up with code %d\"}\n", failed);
    } else {
        printf("\"seconds\": %.9g, \"evaluations\": %ld, \"events\": %ld, \"positions\": [", least, r->evaluations, r->events);
        for (size_t i = 0; i < (size_t)points * r->positions; i++) printf("%s%.17g", i ? ", " : "", positions[i]);
        printf("]}\n");
    }
    fflush(stdout);
}

int main(int count, char **words) {
    if (count < 6) {
        fprintf(stderr, "usage: %s METHOD SCENE SPAN POINTS TOLERANCE...\n", words[0]);
        return 2;
    }
    run r = {.family = strcmp(words[1], "bdf") ? CV_ADAMS : CV_BDF};
    if (sscanf(words[1], "erk%d", &r.order) != 1) r.order = 0;
    double span = atof(words[3]);
    int points = atoi(words[4]);
    r.equations = equations_open(words[2]);
    if (!r.equations || points < 1 || SUNContext_Create(NULL, &r.context)) return 1;
    r.positions = equations_positions(r.equations);
    r.states = equations_states(r.equations);
    r.guards = (int)equations_guards(r.equations);
    r.y = N_VNew_Serial((sunindextype)r.states, r.context);
    r.weights = N_VNew_Serial((sunindextype)r.states, r.context);
    double *positions = malloc((size_t)points * r.positions * sizeof(double));
    if (!positions || r.guards > GUARDS) return 1;
    for (int i = 5; i < count; i++) {
        r.tolerance = atof(words[i]);
        report(&r, span, points, positions);
    }
    free(positions);
    N_VDestroy(r.y);
    N_VDestroy(r.weights);
    equations_close(r.equations);
    SUNContext_Free(&r.context);
    return 0;
}
