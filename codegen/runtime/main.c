/* Runs the model and prints its states, outputs and switches (1 on, 0 off) as CSV:
 *     ./model END SAMPLE [name=value ...]    names of parameters, initial states, inputs, and of
 *                                            what storages hold at the start
 * A table has as many values as points, name=value,value,...; over two axes row by row of x.
 * A row every SAMPLE seconds, by fixed steps of SAMPLE or, with `step=H`, of a part of it that is
 * about H; `band=B` is the dead band of every friction port. With the word `located` steps are
 * adaptive and events located; they are told on the error stream, with the impulses of impacts. An
 * input named is constant; others are as in scenario.h. States that follow what switches hold at
 * the start are told there, too. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model_left.h"
#include "model_located.h"
#include "scenario.h"
#include "tuning.h"

enum { STATES = BG_STATES + BG_LAW_STATES, EVENTS = 4096 };

/* What the command line asks for. */
typedef struct {
    double end, sample, step, band;
    int located;
    double parameters[BG_ROOM(BG_PARAMETERS)], states[BG_ROOM(STATES)];
    int named[BG_ROOM(STATES)], given[BG_SIZE], told[BG_ROOM(BG_HOLDINGS)];
    double held[BG_ROOM(BG_HOLDINGS)];
    bg_term terms[SCENARIO_TERMS];
    double coefficients[SCENARIO_COEFFICIENTS][2], values[BG_ROOM(BG_TABLE_VALUES)];
    bg_own_tables tables;
} command;

static int find(int count, const char *const *names, const char *text, size_t length)
{
    for (int i = 0; i < count; i++)
        if (strlen(names[i]) == length && strncmp(names[i], text, length) == 0)
            return i;
    return -1;
}

/* Holds an input at a value: the first term of each is a constant, the others lose theirs. */
static void hold_input(command *asked, int input, double value)
{
    asked->coefficients[input][0] = value;
    for (int k = 0; k < SCENARIO_TERMS; k++)
        if (asked->terms[k].input == input && asked->terms[k].first != input)
            asked->terms[k].count = 0;
}

/* Values for a table, one for each of its points; -1 where they are none. */
static int fill_table(command *asked, int table, const char *text)
{
    const bg_table *const of = asked->tables.tables + table;
    const int count = of->counts[0] * of->counts[1];
    char *end = NULL;
    int read = 0;
    for (; read < count; read++, text = end + 1) {
        asked->values[read] = strtod(text, &end);
        if (end == text || *end != (read + 1 < count ? ',' : '\0'))
            break;
    }
    if (read == count && bg_tables_set(&asked->tables, table, asked->values) == BG_OK)
        return 1;
    fprintf(stderr, "%s: table %s: give %d finite numbers\n", bg_model_name, bg_lookup_names[table],
            count);
    return -1;
}

/* One name=value of the command line; 0 if nothing has that name, -1 if what is wrong is told. */
static int assign(command *asked, const char *text)
{
    const char *const equals = strchr(text, '=');
    char *end = NULL;
    const size_t length = equals ? (size_t)(equals - text) : 0;
    const double value = equals ? strtod(equals + 1, &end) : 0.0;
    int at;
    if (!equals)
        return asked->located = strcmp(text, "located") == 0;
    if ((at = find(BG_TABLES, bg_lookup_names, text, length)) >= 0)
        return fill_table(asked, at, equals + 1);
    if (end == equals + 1 || *end != '\0')
        return 0;
    if ((at = find(BG_PARAMETERS, bg_parameter_names, text, length)) >= 0)
        asked->parameters[at] = value;
    else if ((at = find(STATES, bg_state_names, text, length)) >= 0)
        asked->given[at] = 1, asked->states[at] = value;
    else if ((at = find(BG_HOLDINGS, bg_held_names, text, length)) >= 0)
        asked->told[at] = 1, asked->held[at] = value;
    else if ((at = find(BG_EXTERNAL, bg_input_names, text, length)) >= 0
             && !(at >= BG_DELAYED_FROM && at < BG_DELAYED_FROM + BG_DELAYS))
        hold_input(asked, at, value);
    else if (length == 4 && strncmp(text, "band", 4) == 0)
        asked->band = value;
    else if (length == 4 && strncmp(text, "step", 4) == 0 && value > 0)
        asked->step = value;
    else
        return 0;
    return 1;
}

/* States from what storages hold at the start; 0 if one does not tell any, which is told. */
static int begin_held(bg_model *m, command *asked)
{
    const int wrong = bg_model_held(m, asked->told, asked->held, asked->given, asked->states);
    if (wrong)
        fprintf(stderr, "%s: %s does not tell a state: give all that its field holds, or the other "
                "states, and nothing twice\n", bg_model_name, bg_held_names[wrong - 1]);
    for (int i = 0; i < STATES; i++)
        asked->named[i] |= asked->given[i];
    return !wrong;
}

static void print_row(double t, const int *mode, const bg_snapshot *shot)
{
    double outputs[BG_ROOM(BG_OUTPUTS)] = {0};
    bg_model_outputs(shot, outputs);
    printf("%.17g", t);
    for (int i = 0; i < BG_STATES; i++)
        printf(",%.17g", shot->x[i]);
    for (int i = 0; i < BG_LAW_STATES; i++)
        printf(",%.17g", shot->z[i]);
    for (int i = 0; i < BG_OUTPUTS; i++)
        printf(",%.17g", outputs[i]);
    for (int i = 0; i < BG_FRICTION; i++)
        if (bg_model_switched(i, mode[i]) >= 0)
            printf(",%d", bg_model_switched(i, mode[i]));
    printf("\n");
}

static void print_head(void)
{
    printf("t");
    for (int i = 0; i < STATES; i++)
        printf(",%s", bg_state_names[i]);
    for (int i = 0; i < BG_OUTPUTS; i++)
        printf(",%s", bg_output_names[i]);
    for (int i = 0; i < BG_FRICTION; i++)
        if (bg_model_switched(i, 0) >= 0)
            printf(",%s", bg_friction_names[i]);
    printf("\n");
}

/* Whether a call failed, which is told; of a table that was left, and of a stop that begins beyond
 * its bound, which one. */
static int failed(const bg_model *m, int status)
{
    char text[256];
    if (status == BG_OK)
        return 0;
    if (bg_left_text(m, status, text, sizeof text)) {
        fprintf(stderr, "%s: %s\n", bg_model_name, text);
        return 1;
    }
    if (status == BG_BEYOND)
        fprintf(stderr, "%s: stop %s: ", bg_model_name, bg_friction_names[m->where]);
    else
        fprintf(stderr, "%s: ", bg_model_name);
    fprintf(stderr, "%s\n", bg_model_message(status));
    return 1;
}

/* Told of a step that was taken nevertheless, once of each kind; whether it was not taken. */
static int refused(const bg_model *m, int status, int *told)
{
    if (!bg_is_taken(status))
        return failed(m, status);
    if (status != BG_OK && *told != status)
        (void)failed(m, status);
    *told = status != BG_OK ? status : *told;
    return 0;
}

/* Inputs at t and just after. */
static void inputs_at(const bg_signals *signals, double t, double *w, double *dw)
{
    const bg_span span = bg_signals_span(signals, bg_reached(t));
    bg_signals_at(signals, &span, t, w, dw);
}

/* Rows by fixed steps, `parts` from each to the next. */
static int run_stepped(bg_model *m, const command *asked, const bg_signals *signals, double *s)
{
    static bg_snapshot shot;
    static double w[3 * BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)];
    const long parts = (long)fmax(1.0, floor(asked->sample / asked->step + 0.5));
    const double h = asked->sample / (double)parts;
    int told = BG_OK;
    for (long k = 0; (double)k * h <= asked->end * (1 + BG_TOGETHER); k++) {
        const double t = (double)(k / parts) * asked->sample + (double)(k % parts) * h;
        for (int i = 2; i >= 0; i--)
            inputs_at(signals, t + 0.5 * i * h, w + i * BG_EXTERNAL, dw);
        if (refused(m, bg_model_settle(m, t, h, s, w), &told))
            return 1;
        if (k % parts == 0) {
            bg_model_recall(m, t, w, dw);
            if (failed(m, bg_model_evaluate(m, t, s, w, dw, m->mode, &shot)))
                return 1;
            print_row(t, m->mode, &shot);
        }
        const int status = bg_model_advance(m, t, h, s, w);
        if (status == BG_UNSTABLE)
            fprintf(stderr, "%s: at t = %.9g step=%.6g; the longest stable one is %.4g\n",
                    bg_model_name, t, h, m->fastest.step);
        if (refused(m, status, &told))
            return 1;
    }
    return 0;
}

static void print_sample(void *to, int sample, const double *w, const int *mode,
                         const bg_snapshot *shot)
{
    (void)w;
    print_row(((const double *)to)[sample], mode, shot);
}

/* Tells of states at a start that was completed, from what each gained. */
static void tell_completed(const command *asked, const double *gained)
{
    int told = 0;
    for (int i = 0; i < STATES; i++)
        if (gained[i] != 0.0)
            fprintf(stderr, "%s %s = %.9g", told++ ? "," : "states that were not named follow what "
                    "switches hold:", bg_state_names[i], asked->states[i] + gained[i]);
    if (told)
        fprintf(stderr, "\n");
}

/* Rows by adaptive steps. The samples are the only memory that is asked for. */
static int run_located(bg_model *m, const command *asked, const bg_signals *signals)
{
    static const char *const kinds[] = {"stick", "slip", "cross", "on", "off", "hit",
                                        "touch", "apart", "slide", "leave"};
    static bg_located run;
    static bg_event events[EVENTS];
    static double gained[BG_ROOM(STATES)];
    const int count = (int)floor(asked->end / asked->sample * (1 + BG_TOGETHER)) + 1;
    double *const times = calloc((size_t)count, sizeof *times);
    bg_request request = {times, asked->states, count, BG_AUTO, BG_RTOL, BG_ATOL,
                          times, print_sample, events, EVENTS, 0, 0.0, NULL,
                          m->mode, asked->named, gained, 0, 0};
    if (!times)
        return 1;
    for (int k = 0; k < count; k++)
        times[k] = k * asked->sample;
    const int status = bg_model_run(&run, m, signals, &request);
    tell_completed(asked, gained);
    for (int k = 0; k < request.count; k++)
        fprintf(stderr, "%.17g,%s,%s,%.17g\n", events[k].time, bg_friction_names[events[k].port],
                kinds[events[k].kind], events[k].impulse);
    free(times);
    return failed(m, status);
}

/* The command, read; 0 if it cannot be. */
static int read_command(int count, char **words, command *asked)
{
    asked->end = count > 1 ? strtod(words[1], NULL) : 0.0;
    asked->sample = count > 2 ? strtod(words[2], NULL) : 0.0;
    asked->band = BG_BAND;
    bg_model_parameters(asked->parameters);
    bg_tables_init(&asked->tables);
    memcpy(asked->states, scenario_states, sizeof asked->states);
    memcpy(asked->named, scenario_named, sizeof asked->named);
    memcpy(asked->terms, scenario_terms, sizeof asked->terms);
    memcpy(asked->coefficients, scenario_coefficients, sizeof asked->coefficients);
    for (int i = 3; i < count; i++) {
        const int done = assign(asked, words[i]);
        if (done == 0)
            fprintf(stderr, "%s: nothing is called as in %s\n", bg_model_name, words[i]);
        if (done <= 0)
            return 0;
    }
    if (!(asked->end > 0) || !(asked->sample > 0))
        fprintf(stderr, "usage: %s END SAMPLE [located] [name=value ...]\n", bg_model_name);
    if (!(asked->step > 0))
        asked->step = asked->sample;
    return asked->end > 0 && asked->sample > 0;
}

int main(int count, char **words)
{
    static bg_model model;
    static command asked;
    static double s[BG_SIZE], w[BG_ROOM(BG_EXTERNAL)], dw[BG_ROOM(BG_EXTERNAL)], gained[BG_SIZE];
    if (!read_command(count, words, &asked))
        return 1;
    const bg_signals signals = {
        SCENARIO_SEGMENTS, scenario_breaks, scenario_begins, asked.terms,
        (const double(*)[2])asked.coefficients, scenario_fastest,
        SCENARIO_WAVES, scenario_wave, scenario_parts, SCENARIO_DUTIES,
    };
    if (failed(&model, bg_model_init_with(&model, asked.parameters, &asked.tables)))
        return 1;
    if (!begin_held(&model, &asked))
        return 1;
    for (int i = 0; i < BG_FRICTION; i++)
        model.band[i] = asked.band;
    inputs_at(&signals, 0.0, w, dw);
    if (failed(&model, bg_model_vector(&model, 0.0, asked.states, w, s)))
        return 1;
    for (int i = 0; i < STATES; i++)
        gained[i] = -s[i];
    if (!asked.located
        && failed(&model, bg_model_complete(&model, 0.0, w, asked.named, s)))
        return 1;
    for (int i = 0; i < STATES; i++)
        gained[i] += s[i];
    tell_completed(&asked, gained);
    print_head();
    return asked.located ? run_located(&model, &asked, &signals)
                         : run_stepped(&model, &asked, &signals, s);
}
