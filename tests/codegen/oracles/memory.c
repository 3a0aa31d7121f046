/* Runs a generated model in rooms of exactly its size that nothing has set, for a checker of memory:
 * event-located runs by every method with 1, 2 and 9 samples, and fixed steps. Prints every number. */
#include <stdio.h>
#include <stdlib.h>

#include "located_rows.h"
#include "scenario.h"

static int shown(const char *what, int status, long count, const double *values)
{
    double sum = 0.0;
    printf("%s %s", what, bg_model_message(status));
    for (long i = 0; status == BG_OK && i < count; i++) {
        sum += values[i] * values[i];
        printf(" %.17g", values[i]);
    }
    printf(sum >= 0 ? "\n" : " no number\n");
    return status == BG_OK && sum >= 0 ? 0 : 1;
}

static int located(const bg_signals *signals, double end, int samples, int method)
{
    static const char *const names[] = {"auto", "DOP853", "Radau"};
    bg_located *const run = malloc(sizeof *run);
    bg_model *const model = malloc(sizeof *model);
    double *const times = malloc(sizeof(double) * (size_t)samples);
    double *const rows = malloc(sizeof(double) * (size_t)(samples * BG_ROW_WIDTH + 1));
    double *const p = malloc(sizeof(double) * (BG_PARAMETERS + 1));
    bg_event *const events = malloc(sizeof(bg_event) * 256);
    bg_request asked = {
        .times = times, .states = scenario_states, .samples = samples, .method = method,
        .rtol = 1e-10, .atol = 1e-11, .events = events, .capacity = 256,
    };
    for (int k = 0; k < samples; k++)
        times[k] = samples > 1 ? end * k / (samples - 1) : 0.0;
    bg_rows into = {.table = rows, .room = samples};
    bg_model_parameters(p);
    const int status = bg_rows_run(run, model, p, signals, &asked, &into);
    int bad = shown(names[method], status, (long)samples * BG_ROW_WIDTH, rows);
    for (int k = 0; k < asked.count; k++)
        printf("%.17g %d %d\n", events[k].time, events[k].port, events[k].kind);
    free(run), free(model), free(times), free(rows), free(p), free(events);
    return bad;
}

static int stepped(const bg_signals *signals, double h)
{
    bg_model *const model = malloc(sizeof *model);
    double *const s = malloc(sizeof(double) * BG_SIZE);
    double *const w = malloc(sizeof(double) * (3 * BG_EXTERNAL + 1));
    double *const dw = malloc(sizeof(double) * (BG_EXTERNAL + 1));
    double *const outputs = malloc(sizeof(double) * (BG_OUTPUTS + 1));
    double *const map = malloc(sizeof(double) * BG_MAP_ROWS * BG_MAP_COLUMNS);
    bg_snapshot *const shot = malloc(sizeof *shot);
    int status = bg_model_init(model, NULL), bad = 0;
    bg_span span = bg_signals_span(signals, bg_reached(0.0));
    bg_signals_at(signals, &span, 0.0, w, dw);
    if (status == BG_OK)
        status = bg_model_vector(model, 0.0, scenario_states, w, s);
    for (int k = 0; k < 5 && status == BG_OK; k++) {
        for (int i = 2; i >= 0; i--) {
            const double t = (k + 0.5 * i) * h;
            span = bg_signals_span(signals, bg_reached(t));
            bg_signals_at(signals, &span, t, w + i * BG_EXTERNAL, dw);
        }
        status = bg_model_step(model, k * h, h, s, w);
        if (status == BG_OK)
            status = bg_model_evaluate(model, k * h, s, w, k ? dw : NULL, model->mode, shot);
        bg_model_outputs(shot, outputs);
        bad |= shown("s", status, BG_SIZE, s) | shown("y", status, BG_OUTPUTS, outputs)
             | shown("rate", status, BG_SIZE, shot->rate) | shown("caps", status, BG_FRICTION, shot->caps);
    }
    if (BG_AFFINE && status == BG_OK)
        bad |= shown("map", bg_model_affine_map(model, model->mode, map),
                     (long)BG_MAP_ROWS * BG_MAP_COLUMNS, map);
    free(model), free(s), free(w), free(dw), free(outputs), free(map), free(shot);
    return bad || status != BG_OK;
}

int main(int count, char **words)
{
    static const int samples[] = {1, 2, 9};
    const bg_signals signals = {SCENARIO_SEGMENTS, scenario_breaks, scenario_begins, scenario_terms,
                                scenario_coefficients, scenario_fastest, SCENARIO_WAVES,
                                scenario_wave, scenario_parts, SCENARIO_DUTIES};
    const double end = count > 1 ? strtod(words[1], NULL) : 1.0;
    int bad = stepped(&signals, 1e-5);
    for (int method = BG_AUTO; method <= BG_RADAU; method++)
        for (int k = 0; k < 3; k++)
            bad |= located(&signals, end, samples[k], method);
    return bad;
}
