/* Signals: from rows of affine maps over (s, w, w', 1) to values at samples. */
#include "batch_internal.h"

#include <string.h>

static const double (*readers_of(const bg_context *c, const batch_room *room))[BG_L]
{
    const int place = room->place[bg_number(c->mode)];
    return (const double(*)[BG_L])batch_readers(room, place);
}

double batch_over_state(const bg_context *c, const double *reader, double *row)
{
    const bg_inputs *const inputs = c->inputs;
    const bg_chains *const chains = inputs->structures + inputs->chains[c->segment];
    const double *const by_w = reader + BG_N, *const by_dw = by_w + BG_W;
    double level = reader[BG_L - 1];
    memset(row, 0, sizeof(double) * BG_Z);
    memcpy(row, reader, sizeof(double) * BG_N);
    for (int i = 0; i < chains->count; i++) {
        const int j = chains->input[i], width = chains->width[i];
        double *const slot = row + BG_N + chains->first[i];
        slot[0] += by_w[j] + chains->rate[i][0] * by_dw[j];
        if (width == 2)
            slot[1] -= chains->rate[i][1] * by_dw[j];
        if (chains->depth[i] > 1)
            slot[width] += by_dw[j];
    }
    for (int j = 0; j < BG_W; j++)
        level += by_w[j] * inputs->constant[c->segment][j];
    return level;
}

void batch_show(const bg_context *c, const batch_room *room, const batch_table *table)
{
    const double(*const readers)[BG_L] = readers_of(c, room);
    for (int s = 0; s < room->job->signals; s++)
        room->levels[s] = batch_over_state(c, readers[s], table->row[BATCH_OWN + s]);
}

void batch_sample(const batch_room *room, const batch_table *table, const double *z, int at)
{
    for (int s = 0; s < room->job->signals; s++) {
        double sum = room->levels[s];
        for (int j = 0; j < BG_Z; j++)
            sum += table->row[BATCH_OWN + s][j] * z[j];
        room->values[s * room->pitch + at] = sum;
    }
}

void batch_sample_last(bg_context *c, const batch_room *room)
{
    const double(*const readers)[BG_L] = readers_of(c, room);
    double v[BG_L];
    bg_vector(c, c->t, c->s, v);
    for (int s = 0; s < room->job->signals; s++) {
        double sum = 0.0;
        for (int j = 0; j < BG_L; j++)
            sum += readers[s][j] * v[j];
        room->values[s * room->pitch + room->job->samples - 1] = sum;
    }
}
