/* Exponentials over times that double, in pairs: in double precision every doubling doubles what a
 * slow motion has lost beside a fast one.
 *
 * The state is of s, of the slots, of the inputs, whose constant parts stay, and of a 1. */
#include "exact_internal.h"

#include <string.h>

/* to = E z, by columns; `to` is another vector */
static void turn(ex_pair (*restrict E)[EX_F], const ex_pair *restrict z, ex_pair *restrict to)
{
    for (int i = 0; i < EX_F; i++)
        to[i] = (ex_pair){0.0, 0.0};
    for (int j = 0; j < EX_F; j++)
        if (z[j].hi != 0.0)
            for (int i = 0; i < EX_F; i++)
                to[i] = ex_plus(to[i], ex_times(E[j][i], z[j]));
}

/* z after a time of at most the unit: start + M h/1 (start + M h/2 (start + ..)) */
static void series(ex_ladder *l, double h, ex_pair *z)
{
    ex_pair start[EX_F], next[EX_F];
    memcpy(start, z, sizeof start);
    for (int k = BG_PAIR_DEGREE; k > 0; k--) {
        const ex_pair share = ex_over(h, k);
        turn(l->M, z, next);
        for (int i = 0; i < EX_F; i++)
            z[i] = ex_plus(start[i], ex_times(next[i], share));
    }
}

/* The rungs up to a level. */
static void climb(ex_ladder *l, int level)
{
    for (; l->rungs <= level; l->rungs++) {
        ex_pair(*const rung)[EX_F] = l->rung[l->rungs];
        for (int j = 0; j < EX_F; j++)
            if (l->rungs) {
                turn(l->rung[l->rungs - 1], l->rung[l->rungs - 1][j], rung[j]);
            } else {
                memset(rung[j], 0, sizeof rung[j]);
                rung[j][j].hi = 1.0;
                series(l, l->unit, rung[j]);
            }
    }
}

void ex_climb(ex_ladder *l, double length, ex_pair *z)
{
    const double units = length / l->unit, whole = floor(units);
    ex_pair next[EX_F];
    if (units > whole)
        series(l, (units - whole) * l->unit, z);
    for (unsigned long long count = (unsigned long long)whole, level = 0; count; count >>= 1, level++) {
        climb(l, (int)level);
        if (count & 1u) {
            turn(l->rung[level], z, next);
            memcpy(z, next, sizeof next);
        }
    }
}

void ex_leap_by(ex_ladder *l, double h, ex_pair *z)
{
    ex_pair next[EX_F];
    if (l->h != h)
        for (int j = 0; j < EX_F; j++) {
            memset(l->leap[j], 0, sizeof l->leap[j]);
            l->leap[j][j].hi = 1.0;
            ex_climb(l, h, l->leap[j]);
        }
    l->h = h;
    turn(l->leap, z, next);
    memcpy(z, next, sizeof next);
}

/* Rates of s by a column of what maps act on; with ports none are told, nor asked for. */
static ex_pair rate_by(const ex_mode *mode, int column, int row)
{
    const int j = EX_K > 0 ? 0 : column;
    return (ex_pair){mode->rate[j][row], mode->rest[j][row]};
}

/* The columns of slots, as in over_slots and generate. */
static void slots(ex_ladder *l, const ex_mode *mode)
{
    const ex_chains *const chains = &l->chains;
    for (int c = 0; c < chains->count; c++) {
        const int first = EX_N + chains->first[c], width = chains->width[c], j = chains->input[c];
        const int by_w = EX_N + j, by_dw = EX_N + EX_W + j;
        const ex_pair re = {chains->rate[c][0], 0.0}, im = {-chains->rate[c][1], 0.0};
        for (int r = 0; r < EX_N; r++) {
            const ex_pair value = rate_by(mode, by_w, r), slope = rate_by(mode, by_dw, r);
            l->M[first][r] = ex_plus(value, ex_times(re, slope));
            if (width == 2)
                l->M[first + 1][r] = ex_times(im, slope);
            if (chains->depth[c] > 1)
                l->M[first + width][r] = slope;
        }
    }
}

void ex_build(ex_ladder *l, const ex_entry *e)
{
    const ex_mode *const mode = e->mode;
    int exponent = 0;
    if (l->known && l->mode == mode && l->chains.count == e->chains.count
        && memcmp(&l->chains, &e->chains, sizeof l->chains) == 0)
        return;
    l->known = 1;
    l->mode = mode;
    l->chains = e->chains;
    l->rungs = 0;
    l->h = -1.0;
    memset(l->M, 0, sizeof l->M);
    for (int r = 0; r < EX_N; r++) {
        for (int j = 0; j < EX_N; j++)
            l->M[j][r] = rate_by(mode, j, r);
        for (int j = 0; j < EX_W; j++)
            l->M[EX_Z + j][r] = rate_by(mode, EX_N + j, r);
        l->M[EX_F - 1][r] = rate_by(mode, EX_L - 1, r);
    }
    slots(l, mode);
    for (int j = EX_N; j < EX_Z; j++)
        for (int i = EX_N; i < EX_Z; i++)
            l->M[j][i].hi = e->M[j][i];
    frexp(e->norm, &exponent);
    l->unit = ldexp(1.0, exponent < 1000 && e->norm > 0.0 ? -2 - exponent : 0);
}
