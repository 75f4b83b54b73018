/* radiance_median.c - see radiance_median.h.
 *
 * Diffuse light of irradiance E makes a surface of albedo a send out a E / pi. The median radiance of the named faces
 * stands for that of a wall of albedo 0.6, a usual paint, and so gives E. The median is taken channel by channel, so
 * that the colour of the light is kept. */
#include "common/texture/radiance_median.h"

#include <stdlib.h>

#include "common/math/lanes.h"

static const float USUAL_ALBEDO = 0.6f;

enum status radiance_median_init(struct radiance_median *r, struct err *err)
{
    *r = (struct radiance_median){.counts = calloc(3, sizeof *r->counts)};
    return r->counts ? ST_OK : err_nomem(err, "radiances", 3 * sizeof *r->counts);
}

void radiance_median_release(struct radiance_median *r)
{
    free(r->counts);
    *r = (struct radiance_median){0};
}

void radiance_median_add(struct radiance_median *r, const uint16_t halves[3])
{
    for (int c = 0; c < 3; c++) r->counts[c][halves[c]]++;
    r->total++;
}

static float median(const uint32_t *counts, uint64_t total)
{
    uint64_t below = 0;
    int half = 0;
    while (half + 1 < RADIANCE_HALVES && (below += counts[half]) <= (total - 1) / 2) half++;
    return float_from_half((uint16_t)half);
}

void radiance_median_colour(float colour[3], const struct radiance_median *r, const float albedo[3])
{
    for (int c = 0; c < 3; c++) colour[c] = r->total ? albedo[c] / USUAL_ALBEDO * median(r->counts[c], r->total) : 0;
}

bool radiance_median_wants(const struct texture_rule *rule, int face)
{
    for (int i = 0; i < rule->lit_count; i++)
        if (rule->lit[i] == face) return true;
    return !rule->lit_count;
}
