/* wall_raster.c - pictures and depth of all views, fused on a wall's plane.
 *
 * A cell's centre is projected into each view in front of the wall. The depth there lies before the plane (something
 * hides the cell: the view says nothing), on it, or behind it (the view looks through the cell). A vote weighs the
 * confidence of its segment plus a little, because depth that was inherited from neighbours is still the best guess
 * where nothing matched, for example in a bright sky.
 *
 * A mirror is as deep as a window. But the mirror images of the points in it are points of the room, whereas those of
 * a yard are nowhere: each point behind the plane is reflected in the plane and looked up in the scene's points. */
#include "stages/suggest_model/wall_raster.h"

#include <math.h>
#include <stdlib.h>

#include "common/image/luminance.h"
#include "common/math/numbers.h"

static const double OFF = 0.03;           /* distance from the plane, of the height, at which depth is not on it */
static const double MIN_LUMINANCE = 1e-4; /* added before the logarithm */

enum status raster_occupancy_make(struct occupancy *o, const struct point_cloud *cloud, const double low[3],
                                  const double high[3], double edge, struct err *err)
{
    size_t count = 1;
    *o = (struct occupancy){.edge = edge};
    for (int k = 0; k < 3; k++) {
        o->low[k] = low[k];
        o->size[k] = (int)((high[k] - low[k]) / edge) + 1;
        count *= (size_t)o->size[k];
    }
    o->cells = calloc(count, 1);
    if (!o->cells) return err_nomem(err, "cells of a scene", count);
    for (size_t i = 0; i < cloud->count; i++) {
        const double p[3] = {cloud->points[i].position.x, cloud->points[i].position.y, cloud->points[i].position.z};
        size_t at = 0;
        bool inside = true;
        for (int k = 0; k < 3; k++) {
            const double x = (p[k] - low[k]) / edge;
            inside = inside && x >= 0 && x < o->size[k];
            if (inside) at = at * (size_t)o->size[k] + (size_t)x;
        }
        if (inside) o->cells[at] = 1;
    }
    return ST_OK;
}

void raster_occupancy_release(struct occupancy *o)
{
    if (!o) return;
    free(o->cells);
    *o = (struct occupancy){0};
}

static bool is_occupied(const struct occupancy *o, struct vec3 v)
{
    const double p[3] = {v.x, v.y, v.z};
    size_t at = 0;
    if (!o->cells) return false;
    for (int k = 0; k < 3; k++) {
        const double x = (p[k] - o->low[k]) / o->edge;
        if (!(x >= 0 && x < o->size[k])) return false;
        at = at * (size_t)o->size[k] + (size_t)x;
    }
    return o->cells[at];
}

enum status wall_raster_init(struct wall_raster *r, const struct wall_line *line, double begin, double end,
                             double height, double cell, struct err *err)
{
    *r = (struct wall_raster){.line = *line, .begin = begin, .cell = cell, .height = height};
    r->across = (int)((end - begin) / cell) + 1;
    r->up = (int)(height / cell) + 1;
    const size_t count = (size_t)r->across * (size_t)r->up;
    r->cells = calloc(count, sizeof *r->cells);
    return r->cells ? ST_OK : err_nomem(err, "a wall's cells", count * sizeof *r->cells);
}

void wall_raster_release(struct wall_raster *r)
{
    if (!r) return;
    free(r->cells);
    *r = (struct wall_raster){0};
}

/* Adds what a view shows at its position (u, v), where it sees the cell. */
static void add_sample(struct wall_cell *cell, const struct wall_raster *r, const struct view *view, double u, double v,
                       const struct image *picture, const struct layered_depth *depth, double scale,
                       const struct occupancy *scene)
{
    const size_t at = (size_t)(int)v * (size_t)view->width + (size_t)(int)u;
    const uint32_t id = depth->interior.id[at];
    const double z = scale * (double)depth->interior.z[at];
    const float *rgba = picture->data + 4 * at;
    if (!id || !(z > 0) || rgba[3] < 0.5f) return;
    struct vec3 p = view_unproject(view, u, v, z);
    const double behind = -line_across(&r->line, p.x, p.y);
    if (behind < -OFF * r->height) return;
    const double weight = depth->segments[id - 1].confidence + RASTER_MIN_WEIGHT;
    if (behind <= OFF * r->height)
        cell->on += weight;
    else {
        cell->beyond += weight;
        p.x += 2 * behind * r->line.n[0];
        p.y += 2 * behind * r->line.n[1];
        if (is_occupied(scene, p)) cell->mirrored += weight;
    }
    cell->brightness += log(MIN_LUMINANCE + fmax(luminance_precise(rgba), 0));
    cell->samples++;
}

void wall_raster_add(struct wall_raster *r, const struct view *view, const struct image *picture,
                     const struct layered_depth *depth, double scale, const struct occupancy *scene)
{
    if (line_across(&r->line, view->center.x, view->center.y) <= 0) return;
    for (int x = 0; x < r->across; x++)
        for (int y = 0; y < r->up; y++) {
            double at[2], u, v;
            line_point(&r->line, r->begin + (x + 0.5) * r->cell, 0, at);
            const struct vec3 p = vec3_make(at[0], at[1], (y + 0.5) * r->cell);
            if (view_project(view, p, &u, &v) <= 0) continue;
            if (!(u >= 0 && v >= 0 && u < view->width && v < view->height)) continue;
            add_sample(wall_raster_at(r, x, y), r, view, u, v, picture, depth, scale, scene);
        }
}
