/* thing_surface.c - a thing's surface from its volume of signed distances; see thing_surface.h.
 *
 * A ray meets the surface where the distance falls through 0, between two places that views have seen [Curless 1996].
 * The place P takes its colour from the views that see it: those whose nearest surface is at P, weighted as in
 * unstructured lumigraph rendering [Buehler 2001] by the angle between their ray and the camera's. A view that sees
 * past P, to the floor, but shows the thing there counts where none sees P: a leg is thinner than its segments. If P is
 * hidden from all of them, P takes the mean colour of the places around it, at its height, that some view sees; without
 * any, those views count that look past P, or show clutter at its pixel, unless it is another thing. From behind the
 * surface no view counts.
 *
 * What no view looks into ends where the hull does (thing_hull.c): the side of a bookcase at a wall.
 *
 * What lies flat is not met in voxels, whose steps would show at its rim, but in the plane of its outline. A pixel at
 * the rim is covered by the share of rays through it that meet the outline. */
#include "stages/render_model/thing_surface.h"

#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "stages/render_model/thing_hull.h"

#define STEP        0.5   /* voxels */
#define TOLERANCE   0.02  /* of the depth, beside the size of a voxel: a view's surface this near to P is P's */
#define VOXELS      2.0   /* the same in voxels */
#define BLUR        0.08  /* radians */
#define MIN_COVER   0.3f  /* of a view's pixel by clutter, whose colour is used */
#define HULL_NEARER 6.0   /* steps: by which the hull is met before the surface where it counts */
#define BEHIND      0.25  /* sine of the angle by which a view may be behind a surface, whose normal is not sure */
#define PAST        0.03  /* weight of a view that sees past P, relative to one that sees P */
#define ELSEWHERE   1e-3  /* the same of a view from which P is hidden */
#define FLAT_BEHIND 0.01f /* the same of what lies flat, in a plane that is known */
#define MAX_BEHIND  0.05f /* of the depth: what the shell may be in front of the surface without hiding it */
#define THROUGH     2.5   /* the same in voxels: what stands behind a wall does not show through it */
#define ON_SURFACE  0.4f  /* bands: a place this near to the surface is on it */
#define BORROW_BLUR 4.0   /* voxels: places as near as that count alike */

enum { HULL_STEPS = 2 };     /* within the hull, which tell that a ray meets it */
enum { RIM_RAYS = 4 };       /* across a pixel, and down */
enum { BORROW_SLICES = 16 }; /* voxels above and below a place that no view sees, at most */

struct seen_place {
    struct vec3 at; /* model frame */
    float rgb[3];
};

struct seen_places {
    struct seen_place *list; /* by height; owned */
    int *first;              /* of each slice of voxels, and their number; owned */
    int count;
};

struct surface_job {
    struct clutter_layer *layer;
    const float *shell;
    const struct clutter_scene *scene;
    const struct clutter_choice *choice;
    const struct view *camera;
    const struct thing_shape *thing;
    const struct thing_volume *volume; /* of the thing */
    const struct seen_places *seen;    /* of the thing */
    const struct thing_hull *hull;     /* the same */
    size_t first;                      /* row */
};

/* Cuts [*from, *to] to the part of a ray's coordinate between low and high. */
static void cut(double *from, double *to, double at, double way, double low, double high)
{
    const double a = (low - at) / way, b = (high - at) / way;
    if (way == 0 && (at < low || at > high)) *to = -INFINITY;
    if (way == 0) return;
    *from = fmax(*from, fmin(a, b));
    *to = fmin(*to, fmax(a, b));
}

struct ray_piece { /* of a ray of the model's frame, in the thing's box */
    struct vec3 from, way;
    double begin, end, step; /* of its direction */
};

static struct ray_piece piece_of(const struct surface_job *job, struct vec3 from, struct vec3 way)
{
    struct ray_piece r = {from, way, 0, INFINITY, STEP * job->volume->grid.voxel / vec3_length(way)};
    const struct vec3 low = job->thing->points->low, high = job->thing->points->high;
    cut(&r.begin, &r.end, from.x, way.x, low.x, high.x);
    cut(&r.begin, &r.end, from.y, way.y, low.y, high.y);
    cut(&r.begin, &r.end, from.z, way.z, low.z, high.z);
    return r;
}

/* Whether a ray meets the surface; *t: where, of its direction. */
static bool meet(double *t, const struct surface_job *job, const struct ray_piece *r)
{
    float last = THING_UNSEEN;
    for (double s = r->begin; s <= r->end; s += r->step) {
        const float d = thing_volume_distance(job->volume, job->thing->id, vec3_add(r->from, vec3_scale(r->way, s)));
        if (d <= 0 && last > 0 && last < THING_UNSEEN) {
            *t = s - r->step * (double)(d / (d - last));
            return true;
        }
        last = d;
    }
    return false;
}

/* The same for the hull. */
static bool meet_hull(double *t, const struct surface_job *job, const struct ray_piece *r)
{
    int steps = 0;
    for (double s = r->begin; s <= r->end; s += r->step) {
        steps = thing_hull_at(job->hull, vec3_add(r->from, vec3_scale(r->way, s))) ? steps + 1 : 0;
        *t = s - HULL_STEPS * r->step;
        if (steps > HULL_STEPS) return true;
    }
    return false;
}

/* The nearer of both, but the hull, which is as coarse as voxels, only where it is clearly nearer. */
static bool meet_either(double *t, const struct surface_job *job, struct vec3 from, struct vec3 way)
{
    const struct ray_piece r = piece_of(job, from, way);
    double hull;
    const bool met = meet(t, job, &r), shut = meet_hull(&hull, job, &r);
    if (!shut || (met && hull > *t - HULL_NEARER * r.step)) return met;
    *t = hull;
    return true;
}

/* Whether a view may see the side of the surface whose normal this is: from behind no view tells its colour. */
static bool may_see(const struct surface_job *job, const struct view *view, struct vec3 p, struct vec3 normal)
{
    const struct model_axes *axes = &job->scene->axes;
    const struct vec3 to = vec3_sub(model_from_world_point(axes, view->center), model_from_world_point(axes, p));
    return vec3_dot(normal, to) > -BEHIND * vec3_length(to) || !(vec3_length(normal) > 0);
}

/* Adds the colour that a view has at P, if it shows clutter there, and sees P by at least `least`. */
static void add_colour(double sum[4], const struct surface_job *job, int k, struct vec3 p, struct vec3 normal,
                       double least)
{
    const struct view *view = &job->scene->set->views[job->choice->view[k]];
    const struct clutter_view *source = &job->scene->sources[job->choice->view[k]].view;
    double u, v;
    const double z = view_project(view, p, &u, &v);
    if (!(z > 0) || !(u >= 1 && v >= 1 && u < view->width - 1 && v < view->height - 1)) return;
    if (!may_see(job, view, p, normal)) return;
    const struct clutter_sight *sight = &source->sight[(size_t)v * (size_t)view->width + (size_t)u];
    const float nearest = sight->nearest;
    float c[4];
    clutter_view_sample(c, source, u, v);
    if (!(c[3] > MIN_COVER)) return;
    const double voxel = job->volume->grid.voxel / job->scene->axes.scale;
    const double beyond = nearest > 0 ? 1 / (double)nearest - z : -INFINITY, slack = TOLERANCE * z + VOXELS * voxel;
    const bool other = sight->thing ? sight->thing != job->thing->id : source->knows_things && beyond < -slack;
    if (other) return;
    const double sees = beyond < -slack ? ELSEWHERE : beyond > slack ? PAST : 1;
    if (sees < least) return;
    const double penalty = clutter_penalty(p, job->camera->center, view->center);
    const double weight = sees / pow(BLUR * BLUR + penalty * penalty, 2);
    for (int i = 0; i < 3; i++) sum[i] += weight * (double)(c[i] / c[3]);
    sum[3] += weight;
}

static bool add_colours(double sum[4], const struct surface_job *job, struct vec3 p, struct vec3 normal, double least)
{
    for (int k = 0; k < job->choice->count; k++) add_colour(sum, job, k, p, normal, least);
    return sum[3] > 0;
}

/* Lists the places of the surface that views see, by height. */
static enum status list_seen(struct seen_places *seen, const struct surface_job *job, struct err *err)
{
    const struct thing_volume *v = job->volume;
    const struct voxel_grid *g = &v->grid;
    const int64_t slice = (int64_t)g->size[0] * g->size[1];
    const struct vec3 low = job->thing->points->low, high = job->thing->points->high;
    seen->first = calloc((size_t)g->size[2] + 1, sizeof *seen->first);
    if (!seen->first) return err_nomem(err, "places of a thing", (size_t)g->size[2] * sizeof *seen->first);
    const struct vec3 from = vec3_scale(vec3_sub(low, g->origin), 1 / g->voxel),
                      to = vec3_scale(vec3_sub(high, g->origin), 1 / g->voxel);
    for (int z = 0; z < g->size[2]; z++) {
        seen->first[z] = seen->count;
        if (z < (int)floor(from.z) || z > (int)ceil(to.z)) continue;
        for (int y = (int)fmax(0, floor(from.y)); y < g->size[1] && y <= (int)ceil(to.y); y++)
            for (int x = (int)fmax(0, floor(from.x)); x < g->size[0] && x <= (int)ceil(to.x); x++) {
                const int64_t at = z * slice + (int64_t)y * g->size[0] + x;
                double sum[4] = {0};
                if (v->id[at] != job->thing->id || !(fabsf(v->distance[at]) < ON_SURFACE)) continue;
                const struct vec3 centre = thing_voxel_centre(g, at);
                const struct vec3 normal = thing_volume_normal(v, job->thing->id, centre);
                if (!add_colours(sum, job, world_from_model_point(&job->scene->axes, centre), normal, 1)) continue;
                if (array_append(&seen->list, (size_t)seen->count, sizeof *seen->list, "places of a thing", err))
                    return err->status;
                seen->list[seen->count++] = (struct seen_place){
                    centre, {(float)(sum[0] / sum[3]), (float)(sum[1] / sum[3]), (float)(sum[2] / sum[3])}};
            }
    }
    seen->first[g->size[2]] = seen->count;
    return ST_OK;
}

/* Adds the colours of the seen places within so many slices of voxels of P, by their distance from it in plan. */
static void add_seen(double sum[4], const struct surface_job *job, struct vec3 p, int slices)
{
    const struct voxel_grid *g = &job->volume->grid;
    const int at = (int)floor((p.z - g->origin.z) / g->voxel);
    const int from = at > slices ? at - slices : 0, to = at + slices + 1 < g->size[2] ? at + slices + 1 : g->size[2];
    const double blur = BORROW_BLUR * g->voxel;
    for (int i = from < to ? job->seen->first[from] : 0; from < to && i < job->seen->first[to]; i++) {
        const struct seen_place *s = &job->seen->list[i];
        const double x = s->at.x - p.x, y = s->at.y - p.y, away = x * x + y * y + blur * blur;
        const double weight = blur * blur * blur * blur / (away * away);
        for (int c = 0; c < 3; c++) sum[c] += weight * (double)s->rgb[c];
        sum[3] += weight;
    }
}

/* The mean colour of the places around P that a view sees, at about its height: furniture is made of boards and sides,
 * whose colours change with the height more than along it. p: in the model's frame. */
static bool borrow_colour(double sum[4], const struct surface_job *job, struct vec3 p)
{
    for (int slices = 1; slices <= BORROW_SLICES && !(sum[3] > 0); slices *= 2) add_seen(sum, job, p, slices);
    return sum[3] > 0;
}

/* The direction of the ray through a place of the picture, model frame, for a depth of one scene unit. */
static struct vec3 ray_way(const struct surface_job *job, double x, double y)
{
    const struct model_axes *axes = &job->scene->axes;
    return vec3_sub(model_from_world_point(axes, view_unproject(job->camera, x, y, 1)),
                    model_from_world_point(axes, job->camera->center));
}

/* The share of a pixel that an outline covers; *t: where the ray of its centre meets the plane. */
static float meet_flat(double *t, const struct surface_job *job, const struct flat_outline *o, struct vec3 from, int x,
                       int y)
{
    int met = 0;
    *t = 0;
    for (int k = 0; k < RIM_RAYS * RIM_RAYS; k++)
        met += flat_outline_meets(
            NULL, o, from, ray_way(job, x + (k % RIM_RAYS + 0.5) / RIM_RAYS, y + (k / RIM_RAYS + 0.5) / RIM_RAYS));
    flat_outline_meets(t, o, from, ray_way(job, x + 0.5, y + 0.5));
    return *t > 0 ? (float)met / (RIM_RAYS * RIM_RAYS) : 0;
}

static void draw_pixel(const struct surface_job *job, int x, int y)
{
    const size_t at = (size_t)y * (size_t)job->camera->width + (size_t)x;
    const struct model_axes *axes = &job->scene->axes;
    float *to = job->layer->rgba + 4 * at;
    const struct flat_outline *flat = job->thing->outline->count ? job->thing->outline : NULL;
    double t, sum[4] = {0};
    if (to[3] >= 1) return;
    const struct vec3 from = model_from_world_point(axes, job->camera->center), way = ray_way(job, x + 0.5, y + 0.5);
    const float share = flat ? meet_flat(&t, job, flat, from, x, y) : (float)meet_either(&t, job, from, way);
    if (!(share > 0)) return;
    const float z = (float)(t * axes->scale), shell = job->shell[at]; /* t: depth in scene units */
    const float behind = fminf(shell * (flat ? FLAT_BEHIND : MAX_BEHIND), (float)(THROUGH * job->volume->grid.voxel));
    if (shell > 0 && z > shell + behind) return;
    const struct vec3 p = view_unproject(job->camera, x + 0.5, y + 0.5, t);
    const struct vec3 normal =
        flat ? flat->normal : thing_volume_normal(job->volume, job->thing->id, vec3_add(from, vec3_scale(way, t)));
    if (!add_colours(sum, job, p, normal, 1) &&
        (flat || !borrow_colour(sum, job, vec3_add(from, vec3_scale(way, t)))) && !add_colours(sum, job, p, normal, 0))
        return;
    const float left = (1 - to[3]) * share;
    for (int i = 0; i < 3; i++) to[i] += left * (float)(sum[i] / sum[3]);
    if (to[3] < 0.5f) job->layer->z[at] = (float)t;
    to[3] = share < 1 ? to[3] + left : 1;
}

static void draw_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct surface_job *job = ctx;
    (void)thread;
    for (size_t y = begin; y < end; y++)
        for (int x = 0; x < job->camera->width; x++) draw_pixel(job, x, (int)(job->first + y));
}

/* The rows of the picture that the box may cover. */
static void find_rows(size_t *first, size_t *last, const struct surface_job *job)
{
    const struct vec3 low = job->thing->points->low, high = job->thing->points->high;
    double top = INFINITY, below = -INFINITY;
    for (int k = 0; k < 8; k++) {
        double u, v;
        const struct vec3 corner = vec3_make(k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z);
        if (!(view_project(job->camera, world_from_model_point(&job->scene->axes, corner), &u, &v) > 0)) {
            top = 0, below = job->camera->height; /* behind the camera: it may be anywhere */
            break;
        }
        top = fmin(top, v), below = fmax(below, v);
    }
    *first = (size_t)fmin(fmax(0, floor(top)), job->camera->height);
    *last = (size_t)fmin(fmax(0, ceil(below)), job->camera->height);
}

enum status thing_surface_draw(struct thing_rows *rows, struct clutter_layer *layer, const float *shell,
                               const struct clutter_scene *scene, const struct clutter_choice *choice,
                               const struct view *camera, const struct thing_shape *thing, struct err *err)
{
    struct seen_places seen = {0};
    struct thing_hull hull = {0};
    struct surface_job job = {layer, shell, scene, choice, camera, thing, thing->volume, &seen, &hull, 0};
    *rows = (struct thing_rows){0, 0};
    if (thing->points->low.x > thing->points->high.x) return ST_OK;
    find_rows(&rows->first, &rows->last, &job);
    job.first = rows->first;
    if (rows->last > rows->first && !list_seen(&seen, &job, err) && !thing_hull_find(&hull, scene, choice, thing, err))
        parallel_for(rows->last - rows->first, 4, draw_rows, &job);
    thing_hull_release(&hull);
    free(seen.list);
    free(seen.first);
    return err->status;
}
