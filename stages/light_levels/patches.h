/* patches.h - the surfaces of a textured model as patches, between which light is passed.
 *
 * A face is cut into cells of one size; the part of a cell on the face is a patch. Triangles of furniture and of
 * objects that are near each other and face one way make a patch. Everything is in the model's frame and units. */
#ifndef REMODEL_LEVELS_PATCHES_H
#define REMODEL_LEVELS_PATCHES_H

#include "common/gather/model_field.h"

enum { PATCH_ORIGINS = 4 };

struct light_patch {
    struct gather_point origins[PATCH_ORIGINS]; /* places on it, from which rays go */
    int origin_count;
    double area;
    int face;                 /* of the mesh; -1: of a further surface */
    int owner;                /* of a further surface: the caller's number; -1: of a face */
    struct rgb radiance;      /* mean of its texels */
    double photographed;      /* the share of its texels that photographs show */
    int sample, sample_count; /* its places in patches.samples; of a face only */
};

/* A face's cells: a point p of it has the coordinates (u . p, v . p). */
struct patch_cells {
    struct vec3 u, v;
    double low[2], step[2];
    int columns, rows;
    int *patch; /* of each cell, the nearest one where the cell has none; owned; NULL: the face has no patches */
};

/* {0} is the empty state; everything but the field is owned. */
struct light_patches {
    const struct model_field *field;
    struct patch_cells *cells; /* of each face */
    int (*of_surface)[2];      /* of each further triangle: of its front, its back; -1: none */
    struct light_patch *list;
    struct vec3 *samples;                  /* places spread over the patches of faces, at which they have a texture */
    int count, sample_count, face_patches; /* the patches of faces come first */
    double side;                           /* of a cell, about */
};

/* What the caller knows of further triangle k: whose it is (0 or more), and whether its back is seen. */
struct patch_owner {
    int owner;
    bool two_sided;
};
typedef struct patch_owner patch_owner_fn(const void *ctx, int triangle);

/* Cuts the surfaces of a field into about `wanted` patches; faces that look outdoors have none. owner may be NULL if
 * the field has no further surfaces. The caller releases p in each case. ST_NOMEM. */
enum status patches_make(struct light_patches *p, const struct model_field *field, int wanted, patch_owner_fn *owner,
                         const void *ctx, struct err *err);
void patches_release(struct light_patches *p);

/* The patch that a ray met; -1: none. */
int patches_hit(const struct light_patches *p, const struct ray_hit *hit);
/* The patch of a face at a point of it; -1: none. */
int patches_at(const struct light_patches *p, int face, struct vec3 at);

#endif
