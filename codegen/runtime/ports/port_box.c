/* Block principal pivoting with Murty's single changes where that does not help (J. J. Judice,
 * F. M. Pires, A block principal pivoting algorithm for large-scale strictly monotone linear
 * complementarity problems, Computers Oper. Res. 21, 1994), in a bounded number of turns. */
#include <math.h>
#include <string.h>

#include "model_internal.h"
#include "port_box.h"

enum {
    BOX_PATIENCE = 3, /* turns of all that contradict which need not better anything */
    BOX_TURNS = 4 * BG_PORTS + 8
};

/* Where a port goes from its way: itself if nothing contradicts that. */
static int box_way(const bg_boxed *b, int i)
{
    const int way = b->way[i];
    if (way == 0 && b->given[i] > b->most[i] + b->extra[i] + b->slack[i])
        return 1;
    if (way == 0 && b->given[i] < b->least[i] - b->extra[i] - b->slack[i])
        return -1;
    if (way == 0 || b->least[i] == b->most[i] || !(way * b->slip[i] < -b->near[i] - b->shared[i]))
        return way;
    return b->reversed[i] ? -way : 0;
}

int bg_box_broken(int ports, const bg_boxed *b)
{
    int count = 0;
    for (int i = 0; i < ports; i++)
        count += box_way(b, i) != b->way[i] || (b->way[i] == 0 && b->slip[i] != 0.0);
    return count;
}

/* What ports give and receive in their ways, from what they give and receive at first. */
static void box_look(int ports, bg_boxed *b, const double *given, const double *slip,
                 const double *yields, double *system)
{
    double right[BG_PORTS];
    int held[BG_PORTS] = {0}, pivots[BG_PORTS], count = 0;
    for (int i = 0; i < ports; i++) {
        const double bound = b->way[i] > 0 ? b->most[i] : b->least[i];
        b->given[i] = b->way[i] ? bound : given[i];
        if (b->way[i] == 0)
            held[count++] = i;
    }
    for (int r = 0; r < count; r++) {
        const double *const row = yields + held[r] * ports;
        right[r] = slip[held[r]];
        for (int j = 0; j < ports; j++)
            right[r] -= row[j] * (b->given[j] - given[j]);
        for (int c = 0; c < count; c++)
            system[r * count + c] = row[held[c]];
    }
    if (count > 0 && bg_factor(count, system, pivots)) {
        bg_solve(count, system, pivots, 1, right);
        for (int r = 0; r < count; r++)
            b->given[held[r]] += right[r];
    }
    for (int i = 0; i < ports; i++) {
        double sum = 0.0, terms = 0.0;
        for (int j = 0; j < ports; j++) {
            const double term = yields[i * ports + j] * (b->given[j] - given[j]);
            sum += term;
            terms += fabs(term);
        }
        b->slip[i] = b->way[i] ? slip[i] - sum : 0.0;
        b->shared[i] = BG_LOOSE * terms;
    }
}

/* Ports that let go with a slip give less from then on; 0 where none does. */
static int lets_slip(int ports, bg_boxed *b)
{
    int any = 0;
    for (int i = 0; i < ports; i++) {
        const int goes = b->way[i] && fabs(b->slip[i]) > b->near[i] + b->shared[i];
        if (!goes || !(b->slips[i] < b->most[i]))
            continue;
        b->extra[i] += b->most[i] - b->slips[i];
        b->most[i] = b->slips[i];
        b->least[i] = -b->slips[i];
        any = 1;
    }
    return any;
}

int bg_box_solve(int ports, bg_boxed *b, const double *yields, double *system)
{
    double given[BG_PORTS], slip[BG_PORTS];
    int best[BG_PORTS] = {0}, fewest = ports + 1, patience = BOX_PATIENCE;
    memcpy(given, b->given, sizeof given);
    memcpy(slip, b->slip, sizeof slip);
    for (int turn = 0; turn < BOX_TURNS; turn++) {
        int changed = 0, last = -1, way[BG_PORTS];
        box_look(ports, b, given, slip, yields, system);
        for (int i = 0; i < ports; i++) {
            way[i] = box_way(b, i);
            changed += way[i] != b->way[i];
            last = way[i] != b->way[i] ? i : last;
        }
        if (changed == 0 && !lets_slip(ports, b))
            return BG_OK;
        if (changed > 0 && changed < fewest) {
            fewest = changed;
            memcpy(best, b->way, sizeof best);
            patience = BOX_PATIENCE;
        } else {
            patience -= changed > 0;
        }
        if (changed > 0 && patience > 0)
            memcpy(b->way, way, sizeof way);
        else if (changed > 0)
            b->way[last] = way[last];
    }
    memcpy(b->way, best, sizeof best);
    box_look(ports, b, given, slip, yields, system);
    return BG_PIVOTS;
}
