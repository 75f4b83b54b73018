/* work_estimate.c - what the pieces of a stage's work will cost, and the line that says so to scripts. */
#include "common/base/work_estimate.h"

#include <assert.h>
#include <math.h>

void work_estimate_add(struct work_estimate *w, double seconds, double mib, double bytes)
{
    assert(seconds >= 0 && mib >= 0 && bytes >= 0 && isfinite(seconds + mib + bytes));
    w->items++;
    w->seconds += seconds;
    w->bytes += bytes;
    w->mib = fmax(w->mib, mib);
    w->longest = fmax(w->longest, seconds);
}

void work_estimate_print(FILE *to, const struct work_estimate *w)
{
    fprintf(to, "estimate %d %.3f %.0f %.0f %.3f\n", w->items, ceil(w->seconds * 1000) / 1000, ceil(w->mib),
            ceil(w->bytes), ceil(w->longest * 1000) / 1000);
}
