/* bake_candidates.c - bake_add_view(): the colour that a view has for each texel of a bake, if it may be used.
 *
 * A texel (x, y) of a tile and the pixel of the view that shows the same point of the surface are related by a
 * homography; four functions linear in (x, y) give the pixel (u, v) = (U / w, V / w) and, with W of the tile's raster,
 * the depth w / W. The view shows the texel if the id at that pixel is the surface's: the camera, the plane and the id
 * then leave no other point.
 *
 * Penalties follow [Buehler 2001]: the angle between the rays of the viewpoint and of the source, resolution that the
 * source lacks, and distance from the middle of the picture, where lenses are at their worst. Without a viewpoint the
 * surface's normal takes the place of its ray, and nearer views are preferred. */
#include <math.h>
#include <string.h>

#include "common/base/parallel.h"
#include "common/texture/bake.h"

static const double COARSER = 0.5;  /* penalty, in radians, of a source with half the resolution */
static const double OUTWARDS = 0.1; /* in a corner of the picture */
static const double DISTANCE = 0.5; /* at a distance of the model's size; without a viewpoint */
static const double UNSURE = 1.0;   /* when something may stand in front */
static const double POOR = 100;     /* when the pixel is clipped or too noisy: after all others */

enum { ROWS = 16 };
static const double AROUND = 4; /* texels: the width of the area whose colour is compared with other views' */

struct view_job {
    struct bake *b;
    const struct source_view *view;
    int source;
};

/* What the texels of a tile have in common. */
struct tile_map {
    double pixel[3][3]; /* (x, y, 1) -> U, V, w */
    const struct surface *surface;
    double off;     /* distance of the view's centre from the plane */
    double min_cos; /* of the ray's angle with the normal */
};

static void insert(struct bake *b, size_t list, const struct candidate *c)
{
    struct candidate *in = b->lists[list];
    int count = b->counts[list], at;
    if (count == CANDIDATES && !(c->penalty < in[count - 1].penalty)) return;
    if (count < CANDIDATES) b->counts[list] = (uint8_t)++count;
    for (at = count - 1; at > 0 && c->penalty < in[at - 1].penalty; at--) in[at] = in[at - 1];
    in[at] = *c;
}

/* Penalty of the view for the point p, and the width of a texel in the view's pixels. cosine: of the ray. */
static double penalty_of(double *footprint, const struct bake *b, const struct bake_tile *t, const struct tile_map *m,
                         const struct source_view *v, struct vec3 p, double distance, double cosine, double u, double w)
{
    const struct view *c = &v->camera;
    const double x = (u - c->cx) / c->width, y = (w - c->cy) / c->height;
    const double pixel = distance / (c->fx * cosine); /* length of the pixel on the surface */
    const struct vec3 to_view = vec3_sub(c->center, p);
    double angle, side = t->side;
    if (b->has_centre) {
        const struct vec3 to_centre = vec3_sub(b->centre, p);
        const double away = vec3_length(to_centre);
        const double own_cosine = fabs(vec3_dot(m->surface->normal, to_centre)) / away;
        angle = acos(fmax(-1, fmin(1, vec3_dot(to_view, to_centre) / (distance * away))));
        side = away * t->side / fmax(own_cosine, 0.05);
    } else
        angle = acos(fmin(1, cosine)) + DISTANCE * distance / b->surfaces->size;
    *footprint = side / pixel;
    return angle + COARSER * fmax(0, pixel / side - 1) + OUTWARDS * 2 * (x * x + y * y);
}

static void try_texel(const struct view_job *job, const struct bake_tile *t, const struct tile_map *m, double x,
                      double y, size_t list)
{
    const struct source_view *v = job->view;
    const double w = m->pixel[2][0] * x + m->pixel[2][1] * y + m->pixel[2][2];
    struct vec3 p;
    if (!(w > 0) || !bake_tile_point(&p, t, x, y)) return;
    const double u = (m->pixel[0][0] * x + m->pixel[0][1] * y + m->pixel[0][2]) / w;
    const double r = (m->pixel[1][0] * x + m->pixel[1][1] * y + m->pixel[1][2]) / w;
    if (!(u >= 0 && r >= 0 && u < v->camera.width && r < v->camera.height)) return;
    const size_t at = (size_t)r * (size_t)v->camera.width + (size_t)u;
    if (v->state[at] == SOURCE_NONE || v->id[at] != (uint32_t)m->surface->id) return;
    if (v->state[at] == SOURCE_HIDDEN || v->state[at] == SOURCE_ALLEGED) {
        if (job->b->hidden[list] < UINT8_MAX) job->b->hidden[list]++;
        if (v->state[at] == SOURCE_HIDDEN) job->b->surely[list] = 1;
        return;
    }
    const double distance = vec3_length(vec3_sub(v->camera.center, p)), cosine = m->off / distance;
    if (!(cosine > m->min_cos)) return;
    struct candidate c = {.source = (uint16_t)job->source, .state = v->state[at]};
    double footprint;
    c.penalty =
        (float)(penalty_of(&footprint, job->b, t, m, v, p, distance, cosine, u, r) + (c.state == SOURCE_UNSURE ? UNSURE
                                                                                      : c.state == SOURCE_POOR ? POOR
                                                                                                               : 0));
    if (!source_view_sample(c.rgb, v, u, r, footprint)) return;
    if (!source_view_sample(c.around, v, u, r, fmax(1, footprint) * AROUND)) memcpy(c.around, c.rgb, sizeof c.around);
    insert(job->b, list, &c);
}

static bool map_tile(struct tile_map *m, const struct view_job *job, const struct bake_tile *t)
{
    const struct source_view *v = job->view;
    m->surface = &job->b->surfaces->list[t->surface];
    m->off = vec3_dot(m->surface->normal, v->camera.center) - m->surface->offset;
    m->min_cos = cos(job->b->params->max_slant * M_PI / 180);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            m->pixel[i][k] = 0;
            for (int j = 0; j < 4; j++) m->pixel[i][k] += v->project[i][j] * t->raster.point[j][k];
        }
    return m->off > 0 && source_view_shows(v, m->surface->id);
}

struct tile_job {
    const struct view_job *view;
    const struct bake_tile *tile;
    struct tile_map map;
};

static void add_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct tile_job *job = ctx;
    const struct bake_tile *t = job->tile;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < t->raster.width; x++) {
            const int32_t list = job->view->b->list[t->first + y * (size_t)t->raster.width + (size_t)x];
            if (list >= 0) try_texel(job->view, t, &job->map, x + 0.5, (double)y + 0.5, (size_t)list);
        }
}

void bake_add_view(struct bake *b, const struct source_view *view, int source)
{
    const struct view_job job = {b, view, source};
    for (int i = 0; i < b->tile_count; i++) {
        struct tile_job tile = {.view = &job, .tile = &b->tiles[i]};
        if (map_tile(&tile.map, &job, tile.tile)) parallel_for((size_t)tile.tile->raster.height, ROWS, add_rows, &tile);
    }
}
