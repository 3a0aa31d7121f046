/* Runs the model with constant inputs and prints its states and outputs as CSV:
 *     ./model END STEP [name=value ...]      names of parameters, initial states, inputs
 * and `band=value`, the dead band of every friction port. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "model_runtime.h"

static int find(int count, const char *const *names, const char *text, size_t length)
{
    for (int i = 0; i < count; i++)
        if (strlen(names[i]) == length && strncmp(names[i], text, length) == 0)
            return i;
    return -1;
}

/* One name=value of the command line; 0 if nothing has that name. */
static int assign(const char *text, double *parameters, double *states, double *inputs,
                  double *band)
{
    const char *const equals = strchr(text, '=');
    char *end = NULL;
    const size_t length = equals ? (size_t)(equals - text) : 0;
    const double value = equals ? strtod(equals + 1, &end) : 0.0;
    int at;
    if (!equals || end == equals + 1 || *end != '\0')
        return 0;
    if ((at = find(BG_PARAMETERS, bg_parameter_names, text, length)) >= 0)
        parameters[at] = value;
    else if ((at = find(BG_STATES + BG_LAW_STATES, bg_state_names, text, length)) >= 0)
        states[at] = value;
    else if ((at = find(BG_EXTERNAL, bg_input_names, text, length)) >= 0)
        for (int k = 0; k < 3; k++)
            inputs[k * BG_EXTERNAL + at] = value;
    else if (length == 4 && strncmp(text, "band", 4) == 0)
        *band = value;
    else
        return 0;
    return 1;
}

static void print_row(double t, const bg_snapshot *shot)
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
    printf("\n");
}

static void print_head(void)
{
    printf("t");
    for (int i = 0; i < BG_STATES + BG_LAW_STATES; i++)
        printf(",%s", bg_state_names[i]);
    for (int i = 0; i < BG_OUTPUTS; i++)
        printf(",%s", bg_output_names[i]);
    printf("\n");
}

static int failed(int status)
{
    if (status != BG_OK)
        fprintf(stderr, "%s: %s\n", bg_model_name, bg_model_message(status));
    return status != BG_OK;
}

/* Rows at t = 0, step, 2 step, ... */
static int run(bg_model *m, double end, double step, double *s, const double *w)
{
    static bg_snapshot shot;
    for (long k = 0; k * step <= end * (1 + 1e-12); k++) {
        const double t = k * step;
        if (failed(bg_model_settle(m, t, step, s, w)))
            return 1;
        if (failed(bg_model_evaluate(m, t, s, w, NULL, m->mode, &shot)))
            return 1;
        print_row(t, &shot);
        if (failed(bg_model_advance(m, t, step, s, w)))
            return 1;
    }
    return 0;
}

int main(int count, char **words)
{
    static bg_model model;
    static double parameters[BG_ROOM(BG_PARAMETERS)], states[BG_SIZE], s[BG_SIZE];
    static double inputs[3 * BG_ROOM(BG_EXTERNAL)];
    double band = 1e-6;
    const double end = count > 1 ? strtod(words[1], NULL) : 0.0;
    const double step = count > 2 ? strtod(words[2], NULL) : 0.0;
    bg_model_parameters(parameters);
    for (int i = 3; i < count; i++)
        if (!assign(words[i], parameters, states, inputs, &band)) {
            fprintf(stderr, "%s: nothing is called as in %s\n", bg_model_name, words[i]);
            return 1;
        }
    if (!(end > 0) || !(step > 0)) {
        fprintf(stderr, "usage: %s END STEP [name=value ...]\n", bg_model_name);
        return 1;
    }
    if (failed(bg_model_init(&model, parameters)))
        return 1;
    for (int i = 0; i < BG_FRICTION; i++)
        model.band[i] = band;
    if (failed(bg_model_vector(&model, 0.0, states, inputs, s)))
        return 1;
    print_head();
    return run(&model, end, step, s, inputs);
}
