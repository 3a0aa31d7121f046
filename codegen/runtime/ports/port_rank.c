/* Ranks of what holds a set of ports, exact: elimination of rows [D over what answers, F, D] in
 * residues modulo a prime, as codegen/standalone/ranks.py does. */
#include <string.h>

#include "model_internal.h"

typedef unsigned long long residue;

enum { ANSWERS = K + BG_COUPLED, WIDTH = BG_RANKED };

/* The higher half of a product. */
static residue higher(residue a, residue b)
{
    const residue low = 0xffffffffu, a0 = a & low, a1 = a >> 32, b0 = b & low, b1 = b >> 32;
    const residue middle = a1 * b0 + (a0 * b0 >> 32), other = a0 * b1 + (middle & low);
    return a1 * b1 + (middle >> 32) + (other >> 32);
}

/* a b / 2^64 modulo the prime (Montgomery 1985). */
static residue residue_product(residue a, residue b)
{
    const residue low = a * b, part = low * bg_prime_inverse;
    const residue sum = higher(a, b) + higher(part, bg_prime) + (low != 0);
    return sum >= bg_prime ? sum - bg_prime : sum;
}

/* Makes row[at] zero by a row that is not zero there; both are scaled alike, so no rank changes. */
static void cancel(residue *row, const residue *pivot, int at)
{
    const residue factor = row[at], own = pivot[at];
    if (factor == 0)
        return;
    for (int j = 0; j < WIDTH; j++) {
        if (row[j] == 0 && pivot[j] == 0)
            continue;
        const residue kept = residue_product(row[j], own), less = residue_product(factor, pivot[j]);
        row[j] = kept >= less ? kept - less : kept + bg_prime - less;
    }
}

/* Of the rows `which` those independent in the columns from `begin` to `end`, by their places among
 * these; where, in order; and the others. How many are independent. */
static int eliminate_rows(residue *rows, int count, const int *which, int begin, int end,
                     int *independent, int *columns, int *others)
{
    int found = 0, left = 0, leading[PORTS];
    for (int k = 0; k < count; k++) {
        residue *const row = rows + which[k] * WIDTH;
        int at = begin;
        for (int b = 0; b < found; b++)
            cancel(row, rows + which[independent[b]] * WIDTH, leading[b]);
        for (; at < end && row[at] == 0; at++)
            ;
        if (at == end) {
            others[left++] = k;
            continue;
        }
        independent[found] = k;
        leading[found] = at;
        int place = found++;
        for (; place > 0 && columns[place - 1] > at - begin; place--)
            columns[place] = columns[place - 1];
        columns[place] = at - begin;
    }
    return found;
}

/* The laws that the set's efforts move, in order. */
static int moved_laws(int count, const int *ports, int *laws)
{
    int moved[BG_ROOM(BG_COUPLED)] = {0}, found = 0;
    for (int c = 0; c < count; c++)
        for (int k = bg_moved_begins[ports[c]]; k < bg_moved_begins[ports[c] + 1]; k++)
            moved[bg_moved[k]] = 1;
    for (int l = 0; l < BG_COUPLED; l++)
        if (moved[l])
            laws[found++] = l;
    return found;
}

/* The rows of the set. */
static void write_rows(const bg_structure *s, int count, const int *ports, residue *rows)
{
    memset(rows, 0, sizeof *rows * (size_t)(count * WIDTH));
    for (int c = 0; c < count; c++) {
        residue *const row = rows + c * WIDTH, *const inputs = row + ANSWERS + N;
        for (int k = bg_slip_begins[ports[c]]; k < bg_slip_begins[ports[c] + 1]; k++)
            row[ANSWERS + bg_slip_places[k]] = bg_slip_residues[k];
        for (int a = 0; a < count; a++)
            row[a] = inputs[bg_friction_inputs[ports[a]]];
        for (int l = 0; l < s->moved; l++)
            row[count + l] = inputs[bg_coupled.inputs[s->moved_laws[l]]];
    }
}

void bg_rank(bg_model *m, int count, const int *ports, bg_structure *s)
{
    residue *const rows = m->work.residues;
    int every[PORTS], null[PORTS] = {0}, left[PORTS];
    for (int c = 0; c < count; c++)
        every[c] = c;
    s->moved = moved_laws(count, ports, s->moved_laws);
    write_rows(s, count, ports, rows);
    s->direct =
        eliminate_rows(rows, count, every, 0, ANSWERS, s->direct_rows, s->direct_columns, null);
    s->null = count - s->direct;
    memcpy(s->null_rows, null, sizeof null);
    s->kept = eliminate_rows(rows, s->null, null, ANSWERS, ANSWERS + N, s->kept_rows,
                             s->kept_columns, left);
    s->ruled = 0;
    for (int r = 0; r < s->null - s->kept; r++)
        for (int j = 0; j < M; j++)
            s->ruled |= rows[null[left[r]] * WIDTH + ANSWERS + N + j] != 0;
}
