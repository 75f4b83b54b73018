/* thing_overlap.c - whether a thing would occupy the same space as another one; see thing_overlap.h.
 *
 * Boxes around things would refuse too much: a chair fits below a table, and a stool in the corner of a sofa. So voxels
 * are compared. A voxel is inside of a thing if it is behind the surfaces that the views show, or below them where no
 * view looks through. Surfaces are off by about a voxel, and single voxels may be wrong, so a few shared voxels do not
 * count, and neither does an overlap of up to two voxels.
 *
 * The depth of an overlap is the length of the shortest way out: the thing is shifted by half a voxel at a time, in
 * eight directions and upwards, until it is free. For two boxes that is their smallest overlap along an axis. */
#include "common/relight/thing_overlap.h"

#include <math.h>
#include <stdlib.h>

#define STEP    0.5 /* voxels, of a shift */
#define ALLOWED 2.0 /* the same: what outlines may overlap */

enum { WAYS = 9, FEW = 8 }; /* FEW: voxels that are within both by errors of depth */

struct solid {
    struct vec3 *at; /* centres of the voxels inside of a thing, at its new place; owned */
    size_t count;
};

static bool is_inside(const struct thing_volume *v, int64_t at, uint32_t id)
{
    return at >= 0 && v->id[at] == id && v->distance[at] <= 0;
}

static enum status list_solid(struct solid *s, const struct thing_volume *v, const struct placed_thing *a,
                              struct err *err)
{
    const int64_t voxels = (int64_t)voxel_count(&v->grid);
    size_t count = 0;
    for (int64_t i = 0; i < voxels; i++) count += is_inside(v, i, a->id);
    *s = (struct solid){malloc((count + 1) * sizeof *s->at), 0};
    if (!s->at) return err_nomem(err, "the inside of a thing", count * sizeof *s->at);
    for (int64_t i = 0; i < voxels; i++)
        if (is_inside(v, i, a->id)) s->at[s->count++] = placed_thing_place(a, thing_voxel_centre(&v->grid, i));
    return ST_OK;
}

/* Whether a thing that is shifted is in the other one. */
static bool overlaps(const struct solid *s, struct vec3 shift, const struct thing_volume *v,
                     const struct placed_thing *b, uint32_t other)
{
    int both = 0;
    for (size_t i = 0; i < s->count && both <= FEW; i++) {
        const struct vec3 p = vec3_add(s->at[i], shift), was = b ? placed_thing_origin(b, p) : p;
        both += is_inside(v, thing_voxel_at(&v->grid, was), other);
    }
    return both > FEW;
}

enum status thing_overlap_depth(double *depth, const struct thing_volume *v, const struct placed_thing *a,
                                const struct placed_thing *b, uint32_t other, struct err *err)
{
    const double voxel = v->grid.voxel, half = sqrt(0.5);
    const struct vec3 ways[WAYS] = {{0, 0, 1},       {1, 0, 0},        {-1, 0, 0},       {0, 1, 0},        {0, -1, 0},
                                    {half, half, 0}, {half, -half, 0}, {-half, half, 0}, {-half, -half, 0}};
    struct solid s = {0};
    *depth = 0;
    if (list_solid(&s, v, a, err)) return err->status;
    bool free_way = !overlaps(&s, vec3_make(0, 0, 0), v, b, other);
    for (int step = 1; !free_way; step++) {
        *depth = STEP * voxel * step;
        for (int k = 0; k < WAYS && !free_way; k++) free_way = !overlaps(&s, vec3_scale(ways[k], *depth), v, b, other);
    }
    if (*depth <= ALLOWED * voxel) *depth = 0;
    free(s.at);
    return ST_OK;
}
