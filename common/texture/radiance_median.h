/* radiance_median.h - the median of radiances, channel by channel: the light on the surfaces that texels show. */
#ifndef REMODEL_RADIANCE_MEDIAN_H
#define REMODEL_RADIANCE_MEDIAN_H

#include <stdint.h>

#include "common/texture/texture_map.h"

enum { RADIANCE_HALVES = 0x7c00 }; /* finite halves of 0 or more */

/* Counts of halves, which are in order as integers: the median is exact. */
struct radiance_median {
    uint32_t (*counts)[RADIANCE_HALVES]; /* [channel]; owned */
    uint64_t total;
};

enum status radiance_median_init(struct radiance_median *r, struct err *err);
void radiance_median_release(struct radiance_median *r);
void radiance_median_add(struct radiance_median *r, const uint16_t halves[3]);
/* The colour of a new surface: its albedo, times the light on a wall of the usual paint. 0 where nothing was added. */
void radiance_median_colour(float colour[3], const struct radiance_median *r, const float albedo[3]);
/* Whether a face of the unedited model shows the light of a rule of colour. */
bool radiance_median_wants(const struct texture_rule *rule, int face);

#endif
