/* Exponentials over times that double, in pairs: in double precision every doubling doubles what a
 * slow motion has lost beside a fast one.
 *
 * The state is of s, of the slots, of the inputs, whose constant parts stay, and of a 1. */
#include "bg_internal.h"

#include <string.h>

enum {
    BG_TERMS = 21 /* of the series; over times of |M| h <= 1/4 what is left out is below 1e-32 */
};

/* to = E z, by columns; `to` is another vector */
static void turn(bg_pair (*restrict E)[BG_F], const bg_pair *restrict z, bg_pair *restrict to)
{
    for (int i = 0; i < BG_F; i++)
        to[i] = (bg_pair){0.0, 0.0};
    for (int j = 0; j < BG_F; j++)
        if (z[j].hi != 0.0)
            for (int i = 0; i < BG_F; i++)
                to[i] = bg_plus(to[i], bg_times(E[j][i], z[j]));
}

/* z after a time of at most the unit: start + M h/1 (start + M h/2 (start + ..)) */
static void series(bg_ladder *l, double h, bg_pair *z)
{
    bg_pair start[BG_F], next[BG_F];
    memcpy(start, z, sizeof start);
    for (int k = BG_TERMS; k > 0; k--) {
        const bg_pair share = bg_over(h, k);
        turn(l->M, z, next);
        for (int i = 0; i < BG_F; i++)
            z[i] = bg_plus(start[i], bg_times(next[i], share));
    }
}

/* The rungs up to a level. */
static void climb(bg_ladder *l, int level)
{
    for (; l->rungs <= level; l->rungs++) {
        bg_pair(*const rung)[BG_F] = l->rung[l->rungs];
        for (int j = 0; j < BG_F; j++)
            if (l->rungs) {
                turn(l->rung[l->rungs - 1], l->rung[l->rungs - 1][j], rung[j]);
            } else {
                memset(rung[j], 0, sizeof rung[j]);
                rung[j][j].hi = 1.0;
                series(l, l->unit, rung[j]);
            }
    }
}

void bg_climb(bg_ladder *l, double length, bg_pair *z)
{
    const double units = length / l->unit, whole = floor(units);
    bg_pair next[BG_F];
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

void bg_leap_by(bg_ladder *l, double h, bg_pair *z)
{
    bg_pair next[BG_F];
    if (l->h != h)
        for (int j = 0; j < BG_F; j++) {
            memset(l->leap[j], 0, sizeof l->leap[j]);
            l->leap[j][j].hi = 1.0;
            bg_climb(l, h, l->leap[j]);
        }
    l->h = h;
    turn(l->leap, z, next);
    memcpy(z, next, sizeof next);
}

/* The columns of slots, as in over_slots and generate. */
static void slots(bg_ladder *l, const bg_mode *mode)
{
    const bg_chains *const chains = &l->chains;
    for (int c = 0; c < chains->count; c++) {
        const int first = BG_N + chains->first[c], width = chains->width[c], j = chains->input[c];
        const int by_w = BG_N + j, by_dw = BG_N + BG_W + j;
        const bg_pair re = {chains->rate[c][0], 0.0}, im = {-chains->rate[c][1], 0.0};
        for (int r = 0; r < BG_N; r++) {
            const bg_pair value = {mode->rate[by_w][r], mode->rest[by_w][r]};
            const bg_pair slope = {mode->rate[by_dw][r], mode->rest[by_dw][r]};
            l->M[first][r] = bg_plus(value, bg_times(re, slope));
            if (width == 2)
                l->M[first + 1][r] = bg_times(im, slope);
            if (chains->depth[c] > 1)
                l->M[first + width][r] = slope;
        }
    }
}

void bg_build(bg_ladder *l, const bg_entry *e)
{
    const bg_mode *const mode = e->mode;
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
    for (int r = 0; r < BG_N; r++) {
        for (int j = 0; j < BG_N; j++)
            l->M[j][r] = (bg_pair){mode->rate[j][r], mode->rest[j][r]};
        for (int j = 0; j < BG_W; j++)
            l->M[BG_Z + j][r] = (bg_pair){mode->rate[BG_N + j][r], mode->rest[BG_N + j][r]};
        l->M[BG_F - 1][r] = (bg_pair){mode->rate[BG_L - 1][r], mode->rest[BG_L - 1][r]};
    }
    slots(l, mode);
    for (int j = BG_N; j < BG_Z; j++)
        for (int i = BG_N; i < BG_Z; i++)
            l->M[j][i].hi = e->M[j][i];
    frexp(e->norm, &exponent);
    l->unit = ldexp(1.0, exponent < 1000 && e->norm > 0.0 ? -2 - exponent : 0);
}
