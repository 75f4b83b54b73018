/* hole_fill.h - hole filling from the far side [Colburn 2014, 3.6.1], and beyond the photos from all sides.
 *
 * Hole pixels have alpha 0. Holes narrower than `diameter` are filled from their neighbourhood, wider ones by a
 * pull-push pyramid; both prefer the farthest known depths, except where the frame overhangs the photos. See
 * hole_fill.c. */
#ifndef REMODEL_HOLE_FILL_H
#define REMODEL_HOLE_FILL_H

#include <stddef.h>
#include <stdint.h>

#include "common/capture/camera_set.h"
#include "common/layers/rendered_frame.h"
#include "common/layers/soft_z.h"

/* What a frame is rendered from. The views and the camera must outlive its use. */
struct hole_photos {
    const struct view *views;
    int count;                 /* 0: unknown, so every hole counts as a disocclusion */
    const struct view *camera; /* of the frame */
};

/* Sets overhang[p], width * height, to 1 at the pixels of overhanging holes: those with most of their pixels beyond
 * every photo, by the definition in hole_fill.c; to 0 elsewhere. photos may be NULL: unknown. ST_NOMEM. */
enum status hole_find_overhang(uint8_t *overhang, const struct rendered_frame *frame, const struct hole_photos *photos,
                               struct err *err);

/* Fills rgba and z of the holes and sets unfilled_fraction. sigma: relative uncertainty of the depths, which sets the
 * width of the reversed soft z. photos may be NULL: unknown. Diameter 0 fills nothing. Same bits for any number of
 * threads. */
enum status hole_fill(struct rendered_frame *frame, const struct hole_photos *photos, const struct soft_z *soft,
                      float sigma, int diameter, struct err *err);

/* The two steps of narrow holes, for callers that fill wide holes by another method.
 *
 * Lists all hole pixels: first the *count pixels of narrow holes (no diameter x diameter square of hole pixels contains
 * them), then the others, *empty in all, each part in picture order. The caller frees *list. */
enum status hole_narrow_pixels(uint32_t **list, size_t *count, size_t *empty, const struct rendered_frame *frame,
                               int diameter, struct err *err);
/* Fills the listed pixels from known pixels up to `diameter` away; those marked in `overhang` from all sides. */
enum status hole_fill_pixels(struct rendered_frame *frame, const uint32_t *list, size_t count, const uint8_t *overhang,
                             const struct soft_z *soft, float sigma, int diameter, struct err *err);

#endif
