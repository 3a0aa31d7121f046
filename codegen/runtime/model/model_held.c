/* States at which storages hold what a start tells. */
#include <math.h>

#include "model_internal.h"

/* The states that laws give, from what is held at their places; 1 + the first that is none. */
static int by_laws(bg_model *m, const int *told, const double *held, int *named, double *states)
{
    for (int h = 0; h < BG_HOLDINGS; h++)
        if (told[h] && bg_held_by_law[h])
            m->now.x[bg_held_states[bg_held_begins[h]]] = held[h];
    bg_held_values(&m->now, m->work.holding);
    for (int h = 0; h < BG_HOLDINGS; h++) {
        const int at = bg_held_begins[h], place = bg_held_states[at];
        if (!told[h] || !bg_held_by_law[h])
            continue;
        if (named[place] || !isfinite(m->work.holding[at]))
            return h + 1;
        named[place] = 1, states[place] = m->work.holding[at];
    }
    return 0;
}

/* Columns for the states that the others leave open; how many, or less than 0 where one of the
 * others leaves none, -1 - that. */
static int open_states(const double *values, const int *told, const int *named, int *column)
{
    int count = 0;
    for (int i = 0; i < BG_SIZE; i++)
        column[i] = -1;
    for (int h = 0; h < BG_HOLDINGS; h++) {
        int own = 0;
        for (int e = bg_held_begins[h]; told[h] && e < bg_held_begins[h + 1]; e++) {
            const int place = bg_held_states[e];
            if (bg_held_by_law[h] || values[e] == 0 || named[place])
                continue;
            own++;
            if (column[place] < 0)
                column[place] = count++;
        }
        if (told[h] && !bg_held_by_law[h] && !own)
            return -1 - h;
    }
    return count;
}

/* The row of one of them over `count` columns, its largest entry 1, and its right side. */
static void held_row(int held, double value, const bg_model *m, const int *column, int count,
                   const double *states, double *row, double *right)
{
    double largest = 0.0;
    for (int c = 0; c < count; c++)
        row[c] = 0.0;
    *right = value;
    for (int e = bg_held_begins[held]; e < bg_held_begins[held + 1]; e++) {
        const int place = bg_held_states[e];
        if (column[place] < 0)
            *right -= m->work.holding[e] * states[place];
        else
            row[column[place]] = m->work.holding[e];
    }
    for (int c = 0; c < count; c++)
        largest = fmax(largest, fabs(row[c]));
    for (int c = 0; c < count; c++)
        row[c] /= largest;
    *right /= largest;
}

int bg_model_held(bg_model *m, const int *told, const double *held, int *named, double *states)
{
    double *const a = m->work.implicit, *const right = m->work.next;
    int column[BG_SIZE], rows = 0, last = 0;
    const int wrong = by_laws(m, told, held, named, states);
    if (wrong)
        return wrong;
    const int count = open_states(m->work.holding, told, named, column);
    if (count < 0)
        return -count;
    for (int h = 0; h < BG_HOLDINGS; h++)
        if (told[h] && !bg_held_by_law[h])
            rows++, last = h;
    if (rows != count)
        return last + 1;
    for (int h = 0, r = 0; h < BG_HOLDINGS; h++)
        if (told[h] && !bg_held_by_law[h]) {
            held_row(h, held[h], m, column, count, states, a + r * count, right + r);
            r++;
        }
    if (!bg_factor(count, a, m->work.implicit_pivots))
        return last + 1;
    bg_solve(count, a, m->work.implicit_pivots, 1, right);
    for (int i = 0; i < BG_SIZE; i++)
        if (column[i] >= 0)
            named[i] = 1, states[i] = right[column[i]];
    return 0;
}
