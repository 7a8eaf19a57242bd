/* A small FMI 2.0 importer, for every platform: it loads a library, follows the commands on standard input and prints
 * what it reads, bit by bit.
 *
 *     host LIBRARY GUID
 *
 * A number is the 16 hexadecimal digits of its bits, since C libraries differ in how they read and write decimal ones.
 *
 *     setInteger REFERENCE VALUE       before the first step
 *     setReal REFERENCE NUMBER
 *     setSlope REFERENCE NUMBER        of a real input
 *     start TIME                       initialisation
 *     doStep TIME STEP
 *     getReal REFERENCE                prints the number
 *     getInteger REFERENCE             prints the value
 *     save FILE                        the state, as bytes
 *     restore FILE
 *
 * It ends with 1 and a message at the first call that does not answer fmi2OK. */
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#define RESOURCES "file:///C:/an%20FMU/resources"
static void *load(const char *file) { return (void *)LoadLibraryA(file); }
static void *find(void *library, const char *name) { return (void *)GetProcAddress((HMODULE)library, name); }
#else
#include <dlfcn.h>
#define RESOURCES "file:///an%20FMU/resources"
static void *load(const char *file) { return dlopen(file, RTLD_NOW | RTLD_LOCAL); }
static void *find(void *library, const char *name) { return dlsym(library, name); }
#endif

typedef void *Component;
typedef unsigned Reference;
typedef struct {
    void (*logger)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void (*finished)(void *, int);
    void *environment;
} Callbacks;

static void fail(const char *what) {
    fprintf(stderr, "%s\n", what);
    exit(1);
}

static void *required(void *found, const char *what) {
    if (!found) fail(what);
    return found;
}

static void check(int status, const char *call) {
    if (status != 0) fail(call);
}

static void print_log(void *environment, const char *instance, int status, const char *category, const char *message,
                      ...) {
    (void)environment;
    va_list arguments;
    va_start(arguments, message);
    fprintf(stderr, "%d %s %s: ", status, instance, category);
    vfprintf(stderr, message, arguments);
    fputc('\n', stderr);
    va_end(arguments);
}

static double number(void) {
    unsigned long long bits;
    double value;
    if (scanf("%16llx", &bits) != 1) fail("a number is missing");
    memcpy(&value, &bits, sizeof value);
    return value;
}

static Reference reference(void) {
    Reference found;
    if (scanf("%u", &found) != 1) fail("a reference is missing");
    return found;
}

static FILE *file(const char *mode) {
    char name[1024];
    if (scanf(" %1023[^\r\n]", name) != 1) fail("a file is missing");
    return required(fopen(name, mode), name);
}

/* Declares a pointer to a function of the library, under its name without `fmi2`. */
#define FUNCTION(result, name, ...) \
    result (*name)(__VA_ARGS__) = (result(*)(__VA_ARGS__))required(find(library, "fmi2" #name), "no fmi2" #name)

int main(int count, char **arguments) {
    if (count != 3) fail("host LIBRARY GUID");
    void *library = required(load(arguments[1]), "the library does not load");
    FUNCTION(Component, Instantiate, const char *, int, const char *, const char *, const Callbacks *, int, int);
    FUNCTION(int, SetupExperiment, Component, int, double, double, int, double);
    FUNCTION(int, EnterInitializationMode, Component);
    FUNCTION(int, ExitInitializationMode, Component);
    FUNCTION(int, SetReal, Component, const Reference *, size_t, const double *);
    FUNCTION(int, SetRealInputDerivatives, Component, const Reference *, size_t, const int *, const double *);
    FUNCTION(int, SetInteger, Component, const Reference *, size_t, const int *);
    FUNCTION(int, GetReal, Component, const Reference *, size_t, double *);
    FUNCTION(int, GetInteger, Component, const Reference *, size_t, int *);
    FUNCTION(int, DoStep, Component, double, double, int);
    FUNCTION(int, GetFMUstate, Component, void **);
    FUNCTION(int, SetFMUstate, Component, void *);
    FUNCTION(int, FreeFMUstate, Component, void **);
    FUNCTION(int, SerializedFMUstateSize, Component, void *, size_t *);
    FUNCTION(int, SerializeFMUstate, Component, void *, char *, size_t);
    FUNCTION(int, DeSerializeFMUstate, Component, const char *, size_t, void **);
    FUNCTION(int, Terminate, Component);
    FUNCTION(void, FreeInstance, Component);

    const Callbacks callbacks = {print_log, calloc, free, NULL, NULL};
    Component fmu = required(Instantiate("host", 1, arguments[2], RESOURCES, &callbacks, 0, 1), "no instance");
    char command[32];
    while (scanf("%31s", command) == 1) {
        if (strcmp(command, "setReal") == 0) {
            Reference variable = reference();
            double value = number();
            check(SetReal(fmu, &variable, 1, &value), command);
        } else if (strcmp(command, "setSlope") == 0) {
            Reference variable = reference();
            const int order = 1;
            double slope = number();
            check(SetRealInputDerivatives(fmu, &variable, 1, &order, &slope), command);
        } else if (strcmp(command, "setInteger") == 0) {
            Reference variable = reference();
            int value = (int)reference();
            check(SetInteger(fmu, &variable, 1, &value), command);
        } else if (strcmp(command, "start") == 0) {
            check(SetupExperiment(fmu, 0, 0, number(), 0, 0), command);
            check(EnterInitializationMode(fmu), command);
            check(ExitInitializationMode(fmu), command);
        } else if (strcmp(command, "doStep") == 0) {
            double time = number(), step = number();
            check(DoStep(fmu, time, step, 0), command);
        } else if (strcmp(command, "getReal") == 0) {
            Reference variable = reference();
            double value;
            unsigned long long bits;
            check(GetReal(fmu, &variable, 1, &value), command);
            memcpy(&bits, &value, sizeof bits);
            printf("%u %016llx\n", variable, bits);
        } else if (strcmp(command, "getInteger") == 0) {
            Reference variable = reference();
            int value;
            check(GetInteger(fmu, &variable, 1, &value), command);
            printf("%u %d\n", variable, value);
        } else if (strcmp(command, "save") == 0) {
            void *state = NULL;
            size_t size;
            check(GetFMUstate(fmu, &state), command);
            check(SerializedFMUstateSize(fmu, state, &size), command);
            char *bytes = required(malloc(size), "no memory");
            check(SerializeFMUstate(fmu, state, bytes, size), command);
            FILE *out = file("wb");
            if (fwrite(bytes, 1, size, out) != size || fclose(out) != 0) fail("the state is not written");
            free(bytes);
            check(FreeFMUstate(fmu, &state), command);
        } else if (strcmp(command, "restore") == 0) {
            static char bytes[1 << 20];
            void *state = NULL;
            FILE *in = file("rb");
            size_t size = fread(bytes, 1, sizeof bytes, in);
            fclose(in);
            check(DeSerializeFMUstate(fmu, bytes, size, &state), command);
            check(SetFMUstate(fmu, state), command);
            check(FreeFMUstate(fmu, &state), command);
        } else {
            fail(command);
        }
    }
    check(Terminate(fmu), "terminate");
    FreeInstance(fmu);
    return 0;
}
