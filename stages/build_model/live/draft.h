/* draft.h - where an edited room takes the colours of a photograph's pixels: a quick draft of what make remodel draws.
 *
 * Model frame and units; pixels are those of the photographs as they are stored. */
#ifndef REMODEL_BUILD_MODEL_DRAFT_H
#define REMODEL_BUILD_MODEL_DRAFT_H

#include "common/texture/texture_map.h"
#include "stages/build_model/building/building.h"

/* What a pixel shows after the edit. */
enum draft_kind {
    DRAFT_PIXEL,  /* what a photograph shows at a pixel */
    DRAFT_COLOUR, /* a surface of one colour: its albedo */
    DRAFT_UNSEEN  /* what no photograph shows */
};

struct draft_pixel {
    enum draft_kind kind;
    int photo;
    double at[3]; /* PIXEL: u, v of the photo; COLOUR: red, green, blue */
};

/* Furniture that the photographs show. */
struct draft_thing {
    char *name; /* owned */
    struct vec3 middle;
    double radius;
    bool is_fixed; /* to the ceiling: places that are cleared leave it */
    bool is_gone;
};

/* Which thing a photograph shows, on a grid of its pixels. */
struct draft_mask {
    int columns, rows;
    unsigned char *things; /* from 1; 0: none; owned */
};

struct draft_solid;

/* {0} is the empty state. */
struct draft {
    struct building before; /* the rooms as they were photographed */
    struct texture_map map;
    struct draft_solid *solids[2]; /* before and after; owned */
    struct draft_thing *things;    /* owned */
    struct draft_mask *masks;      /* one a photo, as far as masks were set; owned */
    int thing_count, mask_count;
    double size; /* of the model, for tolerances */
};

/* Furniture and masks stay when the model changes. radius: of a ball that holds the thing. */
enum status draft_add_thing(struct draft *d, const char *name, struct vec3 middle, double radius, bool is_fixed,
                            struct err *err);
/* The mask of a photo, all 0, for the caller to fill; NULL after a failure. */
unsigned char *draft_mask_of(struct draft *d, int photo, int columns, int rows, struct err *err);

/* Compares a model with the rooms that `before` has. after gets their ids. ST_NOMEM. */
enum status draft_begin(struct draft *d, struct building *after, struct err *err);
bool draft_is_begun(const struct draft *d);
/* What a pixel of a photo shows. Cameras: those of all photos, as many as the placer has. */
struct draft_pixel draft_pixel_of(const struct draft *d, const struct placer *placer, int photo, double u, double v);
/* Where another photo shows what this one shows at u, v, in the rooms as they were photographed. */
bool draft_other_pixel(const struct draft *d, const struct placer *placer, int photo, double u, double v, int other,
                       double at[2]);
/* Forgets the models; furniture and masks stay. */
void draft_end(struct draft *d);
void draft_release(struct draft *d);

#endif
