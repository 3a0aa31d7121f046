/* Signals: from rows of affine maps over (s, w, w', 1) to values at samples. */
#include "batch_internal.h"

#include <string.h>

double batch_over_state(const ex_context *c, const double *reader, double *row)
{
    const ex_inputs *const inputs = c->inputs;
    const ex_chains *const chains = inputs->structures + inputs->chains[c->run.span.segment];
    const double *const by_w = reader + EX_N, *const by_dw = by_w + EX_W;
    double level = reader[EX_L - 1];
    memset(row, 0, sizeof(double) * EX_Z);
    memcpy(row, reader, sizeof(double) * EX_N);
    for (int i = 0; i < chains->count; i++) {
        const int j = chains->input[i], width = chains->width[i];
        double *const slot = row + EX_N + chains->first[i];
        slot[0] += by_w[j] + chains->rate[i][0] * by_dw[j];
        if (width == 2)
            slot[1] -= chains->rate[i][1] * by_dw[j];
        if (chains->depth[i] > 1)
            slot[width] += by_dw[j];
    }
    for (int j = 0; j < EX_W; j++)
        level += by_w[j] * inputs->constant[c->run.span.segment][j];
    return level;
}

void batch_show(const ex_context *c, const batch_room *room, const batch_table *table)
{
    double(*const readers)[EX_L] = batch_readers(room, c->stretch.entry->mode);
    for (int s = 0; s < room->job->signals; s++)
        room->levels[s] = batch_over_state(c, readers[s], table->row[BATCH_OWN + s]);
}

void batch_sample(const batch_room *room, const batch_table *table, const double *z, int at)
{
    for (int s = 0; s < room->job->signals; s++) {
        double sum = room->levels[s];
        for (int j = 0; j < EX_Z; j++)
            sum += table->row[BATCH_OWN + s][j] * z[j];
        room->values[s * room->pitch + at] = sum;
    }
}

void batch_sample_last(ex_context *c, const batch_room *room)
{
    const ex_mode *mode;
    double v[EX_L];
    ex_find(c, c->run.mode, &mode);
    double(*const readers)[EX_L] = batch_readers(room, mode);
    ex_vector(c, c->run.at.t, c->s, v);
    for (int s = 0; s < room->job->signals; s++) {
        double sum = 0.0;
        for (int j = 0; j < EX_L; j++)
            sum += readers[s][j] * v[j];
        room->values[s * room->pitch + room->job->samples - 1] = sum;
    }
}
