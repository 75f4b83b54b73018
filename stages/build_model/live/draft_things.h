/* draft_things.h - furniture and objects in the draft of an edit: which of it photographs show, what goes, and what
 * stands elsewhere.
 *
 * Model frame and units; pixels are those of the photographs as they are stored. */
#ifndef REMODEL_BUILD_MODEL_DRAFT_THINGS_H
#define REMODEL_BUILD_MODEL_DRAFT_THINGS_H

#include "common/texture/texture_map.h"
#include "stages/build_model/live/draft_shape.h"
#include "stages/build_model/place/place.h"
#include "stages/build_model/plan/plan.h"

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
    double radius;            /* of a ball that holds it */
    double above;             /* of its middle over what is below it, for moves into a room */
    bool is_fixed;            /* to the ceiling: places that are cleared leave it */
    bool is_gone;             /* from its place */
    struct draft_shape shape; /* as far as it is known: of `corners`, once a draft began */
    float *corners;           /* nine numbers a triangle; owned */
    int triangle_count;
};

/* Which thing a photograph shows, on a grid of its pixels. */
struct draft_mask {
    int columns, rows;
    unsigned char *things; /* from 1; 0: none; owned */
};

/* A thing at a new place, or an object: what was at p stands at turn p + shift. */
struct draft_placed {
    int thing; /* -1: an object */
    struct mat3 turn;
    struct vec3 shift;
    struct draft_shape shape; /* of an object */
    double albedo[3];         /* the same */
};

/* {0} is the empty state; everything is owned. */
struct draft_things {
    struct draft_thing *things;
    struct draft_mask *masks; /* one a photo, as far as masks were set */
    struct draft_placed *placed;
    int thing_count, mask_count, placed_count;
};

/* Furniture and masks stay when the model changes. */
enum status draft_things_add(struct draft_things *d, const char *name, struct vec3 middle, double radius, bool is_fixed,
                             struct err *err);
/* Room for the corners of a thing's triangles, nine numbers each, for the caller to fill; NULL after a failure. */
float *draft_things_corners(struct draft_things *d, int thing, int triangles, struct err *err);
/* The mask of a photo, all 0, for the caller to fill; NULL after a failure. */
unsigned char *draft_things_mask(struct draft_things *d, int photo, int columns, int rows, struct err *err);

/* Takes what an edit does with them. scene: the folder of meshes of objects. ST_NOMEM; ST_DATA: a mesh. */
enum status draft_things_begin(struct draft_things *d, const struct texture_map *map, const struct plan *plan,
                               const char *scene, struct err *err);
/* The middle of the box around what was placed. */
struct vec3 draft_things_middle(const struct draft_things *d, int placed);
/* The thing that a photo shows at a pixel; NULL: none. */
const struct draft_thing *draft_things_at(const struct draft_things *d, int photo, const struct photo_camera *c,
                                          double u, double v);
/* How far a thing that stays is along a ray of a photo that shows it there. */
double draft_things_distance(const struct draft_thing *t, struct vec3 from, struct vec3 ray);
/* What a ray meets of things at new places and of objects, nearer than `most`; false: nothing. */
bool draft_things_meet(const struct draft_things *d, const struct placer *placer, struct vec3 from, struct vec3 ray,
                       double most, struct draft_pixel *pixel);

void draft_things_end(struct draft_things *d); /* forgets the edit; furniture and masks stay */
void draft_things_release(struct draft_things *d);

#endif
