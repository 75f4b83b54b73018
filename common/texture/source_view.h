/* source_view.h - a view as a source of texels: its colours, and at each pixel which surface of the model it shows and
 * whether it may be used. */
#ifndef REMODEL_SOURCE_VIEW_H
#define REMODEL_SOURCE_VIEW_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/camera_set.h"
#include "common/texture/texture_params.h"
#include "common/texture/view_ids.h"

enum { SOURCE_LEVELS = 4 }; /* full, half, quarter, eighth size */

/* What a pixel is good for. */
enum source_state {
    SOURCE_NONE,    /* outside the photo, near a jump */
    SOURCE_ALLEGED, /* something stands in front, by this view alone: all views together know of no thing there */
    SOURCE_HIDDEN,  /* something stands in front */
    SOURCE_POOR,    /* clipped or too noisy: only if nothing better shows the place, such as a lamp */
    SOURCE_UNSURE,  /* something may stand in front: other views decide */
    SOURCE_LIKELY,  /* nothing stands in front, by a depth that is not sure: other views may outvote it */
    SOURCE_CLEAN,
};

struct source_level {
    int width, height;
    float *rgba; /* 4 a pixel, premultiplied; alpha: share of usable pixels; owned */
};

struct source_view {
    struct view camera;   /* in the model's frame */
    double project[3][4]; /* model frame -> (u, v, 1) times the depth, in model units */
    uint32_t *id;         /* per pixel: face id, 0: none; owned */
    uint8_t *state;       /* per pixel: enum source_state; owned */
    uint8_t *own;         /* the same for the viewpoint's own texels: clipped and noisy pixels count; owned */
    uint8_t *shows;       /* per face id below `ids`: 1 if a usable pixel shows it; owned */
    uint32_t ids;
    struct source_level levels[SOURCE_LEVELS]; /* levels[0]: the view's own pixels, usable or not, with its alpha */
    int level_count;
    uint64_t bytes; /* read from disk */
};

/* The folders of a view's files. */
struct source_files {
    const char *views, *ids;
    const char *things; /* may be NULL: no things are known */
};

/* Reads VIEWS/VIEW.exr, IDS/VIEW.exr and THINGS/masks/VIEW.exr. camera: in the model's frame. ids, if not NULL, gets
 * the rest of the second file (without id, which v has), in scene units; the caller releases it. v is overwritten; the
 * caller releases it in each case. ST_DATA: a missing channel, sizes that differ. */
enum status source_view_read(struct source_view *v, struct view_ids *ids, const struct source_files *files,
                             const struct view *camera, const struct texture_params *params, struct provenance *prov,
                             struct err *err);
/* Whether a usable pixel shows a face. */
static inline bool source_view_shows(const struct source_view *v, int id)
{
    return (uint32_t)id < v->ids && v->shows[id];
}
void source_view_release(struct source_view *v);

/* The colour at (x, y) of level 0, averaged over about `footprint` of its pixels (1 or below: bilinear there). Only
 * usable pixels count, but for level 0, where all pixels of the photo do. False: there is none. */
bool source_view_sample(float rgb[3], const struct source_view *v, double x, double y, double footprint);

#endif
