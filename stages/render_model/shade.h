/* shade.h - colours of the pixels that show faces, from the texels of atlases.
 *
 * A picture is shaded in passes. In each pass a face has one step; pixels that it gives no colour keep MADE_NOTHING and
 * wait for the face's step of the next pass. */
#ifndef REMODEL_RENDER_SHADE_H
#define REMODEL_RENDER_SHADE_H

#include <stdatomic.h>

#include "common/texture/model_picture.h"
#include "common/texture/outdoors.h"
#include "stages/render_model/page_cache.h"
#include "stages/render_model/visible.h"
#include "stages/render_model/visible_lanes.h"

/* A tile of an atlas as a face's pixels see it: pixel (x, y) is at (X / W, Y / W) of the tile, (0, 0) its upper left
 * corner, where W > 0. */
struct shade_tile {
    struct linear x, y, w;
    int width, height, stride; /* texels; stride: with the frame */
    const uint16_t *texels;    /* the upper left one of the frame; 4 halves each */
    const uint8_t *made;
    bool own; /* its texels are the picture's pixels, but for a shift: preferred */
};

/* (A d + (A c + b) / z) of a row (A | b), as a function of the pixel: row (p, 1) / z of the point p that it shows. */
struct linear shade_linear(const double row[4], const struct linear *inverse_z, const struct view *camera);
/* The place of a tile in a picture. place: takes a point of the picture's frame to the frame of the atlas (3 x 4),
 * NULL: they are one. inverse_z: of the face in the picture. The texels are not set. */
void shade_tile_place(struct shade_tile *s, const struct atlas_tile *t, const double place[3][4],
                      const struct linear *inverse_z, const struct view *camera);
/* Whether no pixel with x0 <= x <= x1 and y0 <= y <= y1 looks into the tile. */
bool shade_tile_misses(const struct shade_tile *s, int x0, int y0, int x1, int y1);

enum shade_kind {
    SHADE_NOTHING, /* the face has no more steps */
    SHADE_TILES,   /* texels of a, b or both, blended */
    SHADE_EDGE,    /* the nearest texel of a */
    SHADE_COLOUR,
    SHADE_OUTDOORS,
};

struct shade_step {
    enum shade_kind kind;
    int a, a_count, b, b_count; /* SHADE_TILES, SHADE_EDGE: places in `tiles` */
    float colour[3];            /* SHADE_COLOUR */
    bool limited;
    struct linear limits[4]; /* of `limited`: all are >= 0 where the step counts */
};

struct shade_pass {
    const struct visible *seen;
    const struct view *camera;
    const struct outdoors *outdoors;
    const struct shade_step *steps; /* of each face, [0] where there is none: indices are those of `seen` */
    const struct shade_tile *tiles;
    bool first;                  /* sets z and id of all pixels, and MADE_NOTHING, before */
    const uint32_t *ids;         /* of faces: [1 + faces], [0] is 0 */
    float t;                     /* share of b where both a and b have a texel */
    int max_tiles;               /* of a step */
    _Atomic unsigned char *open; /* [1 + faces]: set to 1 for those with pixels that have no colour yet */
    unsigned char *done;         /* of each tile of `seen`: no pixel of it is left to be shaded */
    struct model_picture *out;
};

/* Sets `open` of the faces that are seen. */
void shade_mark_seen(struct shade_pass *pass);
/* Same bits for any number of threads. */
enum status shade_pixels(const struct shade_pass *pass, struct err *err);

#endif
