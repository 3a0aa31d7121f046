/* An instant in its parts: a mode with its impacts, what that sets states to, the mode after that,
 * and so on. As codegen/instants/parts.py. */
#include <math.h>
#include <string.h>

#include "port_choosing.h"

void bg_take_first(const bg_switch *kinds, int ports, const int *before, int *mode)
{
    for (int i = 0; i < ports; i++) {
        const int turns_on = mode[i] != before[i] && kinds[i].on == (mode[i] == 0);
        for (int k = 0; k < i && kinds[i].machine && turns_on; k++)
            if (kinds[k].machine == kinds[i].machine && mode[k] != before[k]
                && kinds[k].on == (mode[k] == 0))
                mode[i] = before[i];
    }
}

int bg_find_fired(const bg_reset *resets, int count, const bg_switch *kinds, const int *before,
                  const int *mode, const bg_set *hit, int begins, int *fired)
{
    int any = 0;
    for (int r = 0; r < count; r++) {
        const bg_reset *const one = resets + r;
        const int i = one->port;
        fired[r] = 0;
        if (i < 0 || (begins && !kinds[i].machine))
            continue;
        const int comes = mode[i] == one->sign && before[i] != one->sign;
        const int off = kinds[i].on == (one->sign != 0);
        fired[r] = comes || (bg_has(hit, i) && off);
        any |= fired[r];
    }
    return any;
}

int bg_set_states(const bg_reset *resets, int count, const int *fired, const double *values,
                  double *s)
{
    for (int r = 0; r < count; r++)
        for (int q = 0; q <= r && fired[r]; q++) {
            if (!isfinite(values[r]))
                return BG_NOT_FINITE;
            if (fired[q] && resets[q].place == resets[r].place && values[q] != values[r])
                return BG_SET_TWICE;
        }
    for (int r = 0; r < count; r++)
        if (fired[r])
            s[resets[r].place] = values[r];
    return BG_OK;
}

/* Sets what these resets set; a status where that is set twice, or contradicts what is held. */
static int reset(const bg_sight *c, const bg_instant *at, const int *mode, const int *fired)
{
    double values[BG_MOST_RESETS];
    int held[BG_MOST_PORTS] = {0}, any = 0;
    bg_blow blow = {0};
    int status = c->become(c->self, at, mode, values);
    if (status)
        return status;
    status = bg_set_states(c->reset, c->resets, fired, values, at->s);
    if (status)
        return status;
    for (int i = 0; i < c->ports; i++) {
        held[i] = c->kinds[i].kind == BG_RUBS || c->kinds[i].side ? 1 : mode[i];
        any |= held[i] == 0;
    }
    memcpy(c->struck, at->s, sizeof(double) * (size_t)c->size);
    if (any)
        status = c->strike(c->self, at, held, NULL, c->struck, &blow);
    return status ? status : blow.struck ? BG_SET_HELD : BG_OK;
}

int bg_set_by_tasks(const bg_sight *c, const bg_instant *at, const int *mode, const int *due)
{
    int fired[BG_MOST_RESETS] = {0};
    for (int r = 0; r < c->resets; r++)
        fired[r] = c->reset[r].port < 0 && due[-1 - c->reset[r].port];
    return reset(c, at, mode, fired);
}

int bg_choose(const bg_sight *c, const bg_instant *at, int *mode)
{
    bg_instant now = *at;
    int fired[BG_MOST_RESETS];
    int status = bg_choose_mode(c, &now, mode);
    if (!c->resets || !at->log)
        return status;
    for (int k = 0; k < BG_RENEWALS && status == BG_OK; k++) {
        const bg_log *const log = at->log;
        const bg_set hit = bg_hits(log, c->ports, c->kinds, mode);
        bg_take_first(c->kinds, c->ports, log->before, mode);
        if (!bg_find_fired(c->reset, c->resets, c->kinds, log->before, mode, &hit, log->begins,
                           fired))
            return BG_OK;
        if (bg_note(at->log, at->t, c->ports, c->kinds, mode))
            return BG_EVENTS;
        status = reset(c, &now, mode, fired);
        memset(now.touched, 0, sizeof now.touched);
        if (status == BG_OK)
            status = bg_choose_mode(c, &now, mode);
    }
    return status ? status : BG_SET_ENDLESSLY;
}
