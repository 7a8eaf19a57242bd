/* The equations of motion of a scene. All arrays are as long as equations_states says, those of event
 * functions as long as equations_guards says. See src/lib.rs. */
#include <stddef.h>
#include <stdint.h>

typedef struct system_of_equations system_of_equations;

system_of_equations *equations_open(const char *scene_file);
void equations_close(system_of_equations *);
size_t equations_positions(const system_of_equations *);
size_t equations_states(const system_of_equations *);
size_t equations_guards(const system_of_equations *);
double equations_longest_step(const system_of_equations *);
void equations_start(system_of_equations *, double *y);
void equations_scales(const system_of_equations *, double *scales);
void equations_rates(const system_of_equations *, double t, const double *y, double *rates);
void equations_event_functions(const system_of_equations *, double t, const double *y, double *guards);
void equations_cross(system_of_equations *, double t, double *y, const int32_t *crossed);
double equations_parameter(const char *scene_file, const char *name);
