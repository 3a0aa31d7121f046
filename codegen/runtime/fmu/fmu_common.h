/* An instance of a functional mock-up unit over a generated model, for FMI 2 and 3 alike. What can fail
 * gives a text that says why, or NULL. */
#ifndef FMU_COMMON_H
#define FMU_COMMON_H

#include "fmu_config.h"
#include "model_internal.h"
#include "model_located.h"

enum {
    FMU_STATES = BG_STATES + BG_LAW_STATES,
    FMU_INDICATORS = 2 * BG_FRICTION + FMU_SWITCHES,
    FMU_MOVED = BG_DRIVEN && !BG_VARYING /* inputs drive dependent storages: s differs from x */
};

typedef const char *fmu_error;

enum fmu_kind {
    FMU_TIME, FMU_PARAMETER, FMU_TABLE, FMU_AXIS, FMU_TABLE_VALUE, FMU_INTERNAL_STEP, FMU_INPUT, FMU_SLOPE, FMU_STATE, FMU_VECTOR, FMU_RATE,
    FMU_READING, FMU_GIVEN, FMU_SOURCE, FMU_INDICATOR, FMU_MODE, FMU_SWITCH, FMU_SLIDES
};

enum fmu_phase { FMU_MADE, FMU_INITIALIZING, FMU_EVENT, FMU_CONTINUOUS, FMU_STEPPING, FMU_ENDED };

typedef struct {
    int kind, index;
} fmu_variable;

/* Where delays have read last: the time, the states, their rates and what the importer gave; whether
 * what follows may not go on smoothly. */
typedef struct {
    double time, s[BG_SIZE], rate[BG_SIZE], given[BG_ROOM(BG_EXTERNAL)];
    int turned;
} fmu_read;

/* All that a run depends on: what is saved and restored. Plain numbers. `began`: when it did; `step`:
 * of fixed internal steps, 0 where events are located; `tolerance`: relative, 0 where none is told;
 * `seen`: as of the model. `named`: start values that are kept as they are. `rest`, `margin`: how far a
 * slip or what holds or keeps a port may go beyond its bound before it counts as an event. `ticked`:
 * up to when tasks have set what they set. */
typedef struct {
    double time, began, ticked, step, tolerance, seen[BG_SIZE];
    double parameters[BG_ROOM(BG_PARAMETERS)], start[BG_ROOM(FMU_STATES)], s[BG_SIZE];
    double given[BG_ROOM(BG_EXTERNAL)], slopes[BG_ROOM(BG_EXTERNAL)];
    bg_peaks peaks;
    double rest[BG_ROOM(BG_FRICTION)], margin[BG_ROOM(BG_FRICTION)];
    double switch_peak[BG_ROOM(FMU_SWITCHES)], switch_rest[BG_ROOM(FMU_SWITCHES)];
    int side[BG_ROOM(FMU_SWITCHES)], mode[BG_ROOM(BG_FRICTION)];
    bg_span span; /* of the sources inside */
    fmu_read read; /* in model exchange */
    int named[BG_ROOM(FMU_STATES)], phase, decided, exchange, stepped;
    bg_fastest fastest;
} fmu_memory;

/* The same with the values of all tables, one after the other, and with what delays have read. */
typedef struct {
    fmu_memory at;
    double tables[BG_ROOM(BG_TABLE_VALUES)];
    bg_memory memory;
} fmu_saved;

typedef struct fmu_instance {
    fmu_memory at;
    int stale, changed, frozen; /* values, parameters; frozen: the mode is not to be decided */
    int retabled[BG_ROOM(BG_TABLES)]; /* tables with new values */
    bg_model model;
    bg_own_tables own;
    bg_located located; /* its view is the instance's */
    double w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)], point[BG_SIZE];
    double switches[BG_ROOM(FMU_SWITCHES)], steps[3 * BG_ROOM(BG_EXTERNAL)];
    double completed[BG_ROOM(FMU_STATES)]; /* what states gained at the start that were not set */
    int warned;                            /* what fixed steps told of that were taken */
    char text[256];                        /* of a failure, or of these, that has numbers */
} fmu_instance;

/* What is generated: the variables by value reference, sources, start values and which of them are
 * kept, how ports are before a run, switching expressions, those of time alone. */
extern const fmu_variable fmu_variables[];
extern const bg_signals fmu_signals; /* sources inside the unit .. */
extern const int fmu_inside[];       /* .. and whether an external input is one */
extern const double fmu_starts[], fmu_inputs[];
extern const int fmu_named[], fmu_first[];
void fmu_switch_values(const bg_values *v, double *out);
void fmu_timed_values(const bg_values *v, double *out);
int fmu_resolved(const bg_values *v, double t, double h); /* known sources do little in h */

/* fmu_common.c: what a status of the model means, and of a table that was left which; everything at
 * the time and states of the instance in its mode. */
fmu_error fmu_message(fmu_instance *f, int status);
fmu_error fmu_look(fmu_instance *f);
void fmu_reset(fmu_instance *f, int exchange);
fmu_error fmu_apply(fmu_instance *f);
fmu_error fmu_tunable(const fmu_instance *f); /* whether parameters may be set now */
fmu_error fmu_refresh(fmu_instance *f);
fmu_error fmu_get(fmu_instance *f, unsigned reference, double *value);
fmu_error fmu_set(fmu_instance *f, unsigned reference, double value);
fmu_error fmu_set_states(fmu_instance *f, const double *states, size_t count);
void fmu_set_time(fmu_instance *f, double time);
void fmu_restore(fmu_instance *f, const fmu_memory *from);

/* fmu_calls.c: one mode after the other; values of several variables; a saved state. What is not
 * allowed in the instance's phase gives a text. `fmu_completed`: what is to be told of a start that
 * was completed, or NULL; `fmu_warning`: of fixed steps in the last communication step, which were
 * taken. `fmu_enter`: FMU_EVENT or FMU_CONTINUOUS. */
fmu_error fmu_begin(fmu_instance *f, double start);
fmu_error fmu_finish(fmu_instance *f);
const char *fmu_completed(fmu_instance *f);
const char *fmu_warning(const fmu_instance *f);
fmu_error fmu_enter(fmu_instance *f, int phase);
fmu_error fmu_update(fmu_instance *f, int *states_changed);
fmu_error fmu_completed_step(fmu_instance *f);
fmu_error fmu_step(fmu_instance *f, double time, double step);
void fmu_end(fmu_instance *f);
fmu_error fmu_get_all(fmu_instance *f, const unsigned *references, size_t count, double *values,
                      size_t room);
fmu_error fmu_set_all(fmu_instance *f, const unsigned *references, size_t count,
                      const double *values, size_t given);
fmu_error fmu_get_modes(fmu_instance *f, const unsigned *references, size_t count, int *values);
fmu_error fmu_get_states(fmu_instance *f, double *states, size_t count);
fmu_error fmu_get_rates(fmu_instance *f, double *rates, size_t count);
fmu_error fmu_get_indicators(fmu_instance *f, double *indicators, size_t count);
void fmu_get_nominals(double *nominals, size_t count);
fmu_error fmu_copy(void *to, const void *from, size_t size);

/* fmu_tables.c: how many values a variable has, and several have together; those of tables and axes;
 * what is between new ones. A state with the values of tables, saved and gone back to. */
size_t fmu_size(unsigned reference);
size_t fmu_sizes(const unsigned *references, size_t count);
void fmu_get_table(const fmu_instance *f, unsigned reference, double *values);
fmu_error fmu_set_table(fmu_instance *f, unsigned reference, const double *values);
fmu_error fmu_fit_tables(fmu_instance *f);
fmu_error fmu_save(const fmu_instance *f, fmu_saved *to);
void fmu_load(fmu_instance *f, const fmu_saved *from);

/* Whether a variable is a table's: its values, one of them, or an axis. */
static inline int fmu_is_table(int kind)
{
    return kind == FMU_TABLE || kind == FMU_AXIS || kind == FMU_TABLE_VALUE;
}

/* fmu_tasks.c: which tasks are due at the instance's time, and whether any is: they are so once. What
 * those set. The next instant of a task, or infinity; where a run from a time to the end ends: at an
 * instant that is a rounding off the end. */
int fmu_due(fmu_instance *f, int *due);
fmu_error fmu_set_by_tasks(fmu_instance *f, const int *due);
double fmu_next_tick(const fmu_instance *f);
double fmu_run_end(double from, double end);

/* fmu_sources.c: external inputs at a time in a span; breakpoints that are passed; the next one, or
 * the next instant of a task. The time of the next event: of one of these, or of a look. That after t: where known sources have done
 * enough to be looked at, or an expression of time alone changes its sign. */
void fmu_externals(const fmu_instance *f, const bg_span *span, double t, double *w, double *dw);
void fmu_pass(fmu_instance *f, double t);
int fmu_next_break(const fmu_instance *f, double *time);
int fmu_next_event(const fmu_instance *f, double *time);
int fmu_next_look(const fmu_instance *f, double t, double *time);
double fmu_resolution(const fmu_instance *f, double t, double longest);

/* fmu_modes.c: the mode at an instant, and the vector after an impact there; what counts as zero of
 * what keeps switches, once everything in their mode is known. */
fmu_error fmu_decide(fmu_instance *f);
void fmu_note_stays(fmu_instance *f);

/* fmu_events.c */
void fmu_indicators_of(fmu_instance *f, const bg_snapshot *now, double *values);
fmu_error fmu_indicators(fmu_instance *f, double *values);
fmu_error fmu_initialize(fmu_instance *f);
fmu_error fmu_event(fmu_instance *f, int *states_changed);

/* fmu_late.c, of models with delays: these begin at a start; what they read in model exchange up to the
 * instance's time, as its states came there; and that it goes on from there. */
void fmu_begin_late(fmu_instance *f);
fmu_error fmu_read_late(fmu_instance *f);
fmu_error fmu_go_on_late(fmu_instance *f, int turned);

/* fmu_step.c: a communication step; what went wrong at t. fmu_fixed.c, fmu_locate.c: from t to the end
 * in fixed internal steps, or as a run with events located. */
fmu_error fmu_advance(fmu_instance *f, double t, double h);
fmu_error fmu_fixed(fmu_instance *f, double t, double end);
fmu_error fmu_locate(fmu_instance *f, double t, double end);

/* fmu_derive.c */
fmu_error fmu_derive(fmu_instance *f, const unsigned *unknowns, size_t rows, const unsigned *knowns,
                     size_t columns, const double *seed, double *result);

#endif
