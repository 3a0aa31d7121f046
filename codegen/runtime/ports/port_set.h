/* Sets of the ports that are held or let go. */
#ifndef BG_PORT_SET_H
#define BG_PORT_SET_H

#include "config.h"

enum { BG_MOST_PORTS = BG_PORTS, BG_WORD = 64, BG_SET_WORDS = (BG_PORTS + BG_WORD - 1) / BG_WORD };

typedef struct {
    unsigned long long bits[BG_SET_WORDS];
} bg_set;

static inline int bg_has(const bg_set *set, int port)
{
    return (int)(set->bits[port / BG_WORD] >> port % BG_WORD & 1u);
}

static inline void bg_add(bg_set *set, int port)
{
    set->bits[port / BG_WORD] |= 1ull << port % BG_WORD;
}

static inline int bg_is_empty(const bg_set *set)
{
    unsigned long long any = 0;
    for (int k = 0; k < BG_SET_WORDS; k++)
        any |= set->bits[k];
    return any == 0;
}

static inline int bg_is_same(const bg_set *one, const bg_set *other)
{
    unsigned long long differ = 0;
    for (int k = 0; k < BG_SET_WORDS; k++)
        differ |= one->bits[k] ^ other->bits[k];
    return differ == 0;
}

/* Those in one of the two. */
static inline bg_set bg_turned(bg_set set, const bg_set *others)
{
    for (int k = 0; k < BG_SET_WORDS; k++)
        set.bits[k] ^= others->bits[k];
    return set;
}

static inline bg_set bg_only(int port)
{
    bg_set one = {{0}};
    bg_add(&one, port);
    return one;
}

/* The first port of a set that is not empty. */
static inline int bg_first_of(const bg_set *set)
{
    int port = 0;
    for (; port < BG_PORTS - 1 && !bg_has(set, port); port++)
        ;
    return port;
}

/* The ports that are held in a mode. */
static inline bg_set bg_held_in(int ports, const int *mode)
{
    bg_set held = {{0}};
    for (int i = 0; i < ports; i++)
        if (mode[i] == 0)
            bg_add(&held, i);
    return held;
}

#endif
