/* Unlike fmin and fmax instructions, not calls. */
#ifndef BG_RUN_EXTREMES_H
#define BG_RUN_EXTREMES_H

static inline double bg_lesser(double a, double b)
{
    return a < b ? a : b;
}

static inline double bg_greater(double a, double b)
{
    return a > b ? a : b;
}

#endif
