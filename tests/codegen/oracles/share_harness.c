/* What tests call: how ports share a load along any directions. */
#include <string.h>

#include "model_internal.h"

int harness_share(int free, int count, const double *share, const double *caps, double *efforts)
{
    static bg_hold held;
    held.share_count = free;
    held.count = count;
    memcpy(held.ways, share, sizeof(double) * (size_t)(free * count));
    return bg_fair_share(&held, caps, efforts);
}
