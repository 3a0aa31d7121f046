/* Rows over the state, and what they are one to eight steps later: as many products as lanes. */
#include "batch_internal.h"

#include <string.h>

enum { HALF = BATCH_STRIDE / 2 };

batch_table batch_table_of(const batch_room *room, const ex_context *c)
{
    const int rows = BATCH_OWN + room->job->signals;
    const int size = BATCH_POWERS * EX_Z * EX_Z + rows * EX_Z * (1 + BATCH_STRIDE);
    double *const at = room->tables + (c->stretch.entry - c->entries) * size;
    double *const row = at + rows * EX_Z * BATCH_STRIDE;
    return (batch_table){(double(*)[EX_Z][EX_Z])(row + rows * EX_Z), (double(*)[EX_Z])row,
                         (batch_lanes(*)[EX_Z])at};
}

/* A row from one state to the next, then twice as many with each power. Lanes that are not known
 * yet are carried along: so vectors have one length. */
static void spread(const double *row, double (*power)[EX_Z][EX_Z], batch_lanes *lane)
{
    memset(lane, 0, sizeof(batch_lanes) * EX_Z);
    for (int j = 0; j < EX_Z; j++)
        for (int l = 0; l < EX_Z; l++)
            lane[j][0] += row[l] * power[0][j][l];
    for (int known = 1, i = 0; known < BATCH_STRIDE; known *= 2, i++)
        for (int j = 0; j < EX_Z; j++) {
            double sum[HALF] = {0};
            for (int l = 0; l < EX_Z; l++)
                for (int r = 0; r < HALF; r++)
                    sum[r] += lane[l][r] * power[i][j][l];
            memcpy(lane[j] + known, sum, sizeof sum);
        }
}

/* Triggers, and a third of their change in a step. */
static void own_rows(const ex_entry *e, double (*row)[EX_Z])
{
    for (int i = 0; i < EX_T; i++)
        for (int j = 0; j < EX_Z; j++) {
            double change = 0.0;
            for (int l = 0; l < EX_Z; l++)
                change += e->trigger[l][i] * e->M[j][l];
            row[i][j] = e->trigger[j][i];
            row[EX_T + i][j] = e->cap[i] ? 0.0 : e->step / 3.0 * change;
        }
}

void batch_prepare(ex_context *c, const batch_room *room, const batch_table *table, double h)
{
    ex_entry *const e = c->stretch.entry;
    ex_divide(c, e, h, table->power[0]);
    for (int i = 1; i < BATCH_POWERS; i++)
        ex_multiply(table->power[i - 1], table->power[i - 1], table->power[i]);
    own_rows(e, table->row);
    for (int i = 0; i < BATCH_OWN + room->job->signals; i++)
        if (i < EX_T || i >= BATCH_OWN || !e->cap[i - EX_T])
            spread(table->row[i], table->power, table->lane[i]);
    if (EX_K)
        ex_bound(c, e, table->power[0]);
}
