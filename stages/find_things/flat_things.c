/* flat_things.c - rugs, pictures and what else lies flat on a face; see flat_things.h.
 *
 * No depth tells a rug from the floor. A user draws its outline in one photo; the rays of the corners meet the model.
 * In the volume it is a surface a fraction of a voxel before the face, so that it is cleared, moved, drawn and lit like
 * any other thing. */
#include "stages/find_things/flat_things.h"

#include <math.h>
#include <stdlib.h>

#define UPRIGHT  0.7   /* |z| of the normal of a floor or a ceiling, at least */
#define BEFORE   0.25  /* voxels: of the surface before the face */
#define PER_BAND 2.5   /* voxels of a band of distances */
#define GRADE    0.6f  /* of a pixel of clutter, from trace_ids */
#define NEARER   0.08f /* relative: noise of the depth of a blank rug is less */

/* The point of the face of the first corner that a mark shows. */
static enum status find_corner(struct vec3 *corner, struct flat_outline *face, bool first, const struct thing_mark *m,
                               const char *name, const struct model_axes *axes, const struct model_rays *model,
                               double slack, struct err *err)
{
    const struct vec3 from = model_from_world_point(axes, m->origin),
                      along = model_from_world_direction(axes, m->direction);
    struct ray_hit hit;
    if (!ray_scene_hit(&model->rays, from, along, &hit))
        return err_set(err, ST_DATA, "things.txt:%d: the corner %.6g %.6g of %s in %s shows no face of the model.",
                       m->line, m->u, m->v, name, m->view);
    if (first) *face = (struct flat_outline){.normal = hit.normal, .offset = vec3_dot(hit.normal, hit.point)};
    const double off = flat_outline_height(face, hit.point);
    if (fabs(off) > slack)
        return err_set(err, ST_DATA,
                       "things.txt:%d: the corner %.6g %.6g of %s in %s is not on the face of the first corner, but "
                       "%.2g off it. Draw the outline on one face.",
                       m->line, m->u, m->v, name, m->view, fabs(off));
    const double t = -flat_outline_height(face, from) / vec3_dot(face->normal, along);
    *corner = vec3_add(from, vec3_scale(along, t));
    return ST_OK;
}

static enum status place(struct flat_thing *f, const struct thing_marks *marks, int name, const struct model_axes *axes,
                         const struct model_rays *model, double slack, struct err *err)
{
    struct vec3 *corners = malloc((size_t)marks->mark_count * sizeof *corners);
    struct flat_outline face = {0};
    int count = 0;
    *f = (struct flat_thing){.name = name};
    if (!corners) return err_nomem(err, "an outline", (size_t)marks->mark_count * sizeof *corners);
    for (int k = 0; !err->status && k < marks->mark_count; k++)
        if (marks->marks[k].name == name &&
            !find_corner(&corners[count], &face, !count, &marks->marks[k], marks->names[name], axes, model, slack, err))
            count++;
    if (!err->status) flat_outline_init(&f->outline, face.normal, face.offset, count, err);
    for (int i = 0; !err->status && i < count; i++) flat_outline_put(&f->outline, i, corners[i]);
    free(corners);
    if (!err->status && flat_outline_area(&f->outline) < slack * slack)
        err_set(err, ST_DATA, "things.txt:%d: the outline of %s holds no area.", marks->lines[name],
                marks->names[name]);
    return err->status;
}

enum status flat_things_place(struct flat_things *f, const struct thing_marks *marks, const struct model_axes *axes,
                              const struct model_rays *model, double slack, struct err *err)
{
    *f = (struct flat_things){.list = calloc((size_t)marks->name_count + 1, sizeof *f->list)};
    if (!f->list) return err_nomem(err, "outlines", (size_t)marks->name_count * sizeof *f->list);
    for (int n = 0; !err->status && n < marks->name_count; n++)
        if (marks->flat[n]) place(&f->list[f->count++], marks, n, axes, model, slack, err);
    if (err->status) flat_things_release(f);
    return err->status;
}

void flat_things_release(struct flat_things *f)
{
    for (int i = 0; i < f->count; i++) flat_outline_release(&f->list[i].outline);
    free(f->list);
    *f = (struct flat_things){0};
}

static void grow(double low[3], double high[3], struct vec3 p)
{
    const double at[3] = {p.x, p.y, p.z};
    for (int k = 0; k < 3; k++) {
        low[k] = fmin(low[k], at[k]);
        high[k] = fmax(high[k], at[k]);
    }
}

/* The box around a thing that is `thick` thick. */
static void find_box(double low[3], double high[3], const struct flat_outline *o, double thick)
{
    for (int k = 0; k < 3; k++) low[k] = INFINITY, high[k] = -INFINITY;
    for (int i = 0; i < o->count; i++) {
        const struct vec3 p = flat_outline_corner(o, i);
        grow(low, high, p);
        grow(low, high, vec3_add(p, vec3_scale(o->normal, thick)));
    }
}

static void fill(const struct flat_thing *f, struct thing_volume *v)
{
    const struct voxel_grid *g = &v->grid;
    const double origin[3] = {g->origin.x, g->origin.y, g->origin.z};
    double low[3], high[3];
    int first[3], last[3];
    find_box(low, high, &f->outline, 0);
    for (int k = 0; k < 3; k++) {
        first[k] = (int)fmax(0, floor((low[k] - origin[k]) / g->voxel) - 2);
        last[k] = (int)fmin(g->size[k] - 1, ceil((high[k] - origin[k]) / g->voxel) + 2);
    }
    for (int z = first[2]; z <= last[2]; z++)
        for (int y = first[1]; y <= last[1]; y++)
            for (int x = first[0]; x <= last[0]; x++) {
                const size_t at = ((size_t)z * (size_t)g->size[1] + (size_t)y) * (size_t)g->size[0] + (size_t)x;
                const struct vec3 p = thing_voxel_centre(g, (int64_t)at);
                const double above = flat_outline_height(&f->outline, p) / g->voxel;
                if (above <= -1 || above > 2 || (v->id[at] && v->distance[at] <= 0) ||
                    !flat_outline_holds(&f->outline, p))
                    continue;
                v->id[at] = f->id;
                v->distance[at] = (float)fmin(1, (above - BEFORE) / PER_BAND);
            }
}

void flat_things_fill(const struct flat_things *f, struct thing_volume *v)
{
    for (int i = 0; i < f->count; i++) fill(&f->list[i], v);
}

enum status flat_thing_measure(struct thing *t, const struct flat_thing *f, const struct thing_volume *v,
                               struct err *err)
{
    const double up = f->outline.normal.z;
    double low[3], high[3];
    find_box(low, high, &f->outline, v->grid.voxel);
    t->low = vec3_make(low[0], low[1], low[2]);
    t->high = vec3_make(high[0], high[1], high[2]);
    t->support = up > UPRIGHT ? THING_ON_FLOOR : up < -UPRIGHT ? THING_ON_CEILING : THING_ON_WALL;
    for (size_t i = 0; i < voxel_count(&v->grid); i++) t->voxels += v->id[i] == f->id;
    return flat_outline_copy(&t->outline, &f->outline, err);
}

void flat_things_see(struct thing_mask *mask, const struct flat_things *f, const struct view *camera,
                     const struct view_ids *ids, const float *depth, double slack, double scale)
{
    for (int y = 0; y < camera->height && f->count; y++)
        for (int x = 0; x < camera->width; x++) {
            const size_t i = (size_t)y * (size_t)camera->width + (size_t)x;
            if (!(ids->z[i] > 0) || mask->shows[i] || ids->clutter[i] > GRADE) continue;
            if (depth[i] > 0 && depth[i] < ids->z[i] * (1 - NEARER)) continue;
            const struct vec3 p = view_unproject(camera, x + 0.5, y + 0.5, scale * (double)ids->z[i]);
            for (int k = 0; k < f->count; k++)
                if (fabs(flat_outline_height(&f->list[k].outline, p)) <= slack &&
                    flat_outline_holds(&f->list[k].outline, p)) {
                    mask->shows[i] = f->list[k].id;
                    if (!mask->meets[i]) mask->meets[i] = f->list[k].id;
                }
        }
}
