/* thing_surface.c - a thing's surface from its volume of signed distances; see thing_surface.h.
 *
 * A ray meets the surface where the distance falls through 0, between two places that views have seen [Curless 1996].
 * The place P takes its colour from the views that see it: those whose nearest surface is at P, weighted as in
 * unstructured lumigraph rendering [Buehler 2001] by the angle between their ray and the camera's. A view that sees
 * past P, to the floor, but shows the thing there counts where none sees P: a leg is thinner than its segments. If P is
 * hidden from all of them, those count that show clutter at its pixel, unless it is another thing; it is near P. From
 * behind the surface no view counts: the back of a bookcase that nobody saw is not drawn.
 *
 * What lies flat is not met in voxels, whose steps would show at its rim, but in the plane of its outline. A pixel at
 * the rim is covered by the share of rays through it that meet the outline. */
#include "stages/render_model/thing_surface.h"

#include <math.h>

#include "common/base/parallel.h"

#define STEP        0.5   /* voxels */
#define TOLERANCE   0.02  /* of the depth, beside the size of a voxel: a view's surface this near to P is P's */
#define VOXELS      2.0   /* the same in voxels */
#define BLUR        0.08  /* radians */
#define MIN_COVER   0.3f  /* of a view's pixel by clutter, whose colour is used */
#define BEHIND      0.25  /* sine of the angle by which a view may be behind a surface, whose normal is not sure */
#define PAST        0.03  /* weight of a view that sees past P, relative to one that sees P */
#define ELSEWHERE   1e-3  /* the same of a view from which P is hidden */
#define FLAT_BEHIND 0.01f /* the same of what lies flat, in a plane that is known */
#define MAX_BEHIND  0.05f /* of the depth: what the shell may be in front of the surface without hiding it */

enum { RIM_RAYS = 4 }; /* across a pixel, and down */

struct surface_job {
    struct clutter_layer *layer;
    const float *shell;
    const struct clutter_scene *scene;
    const struct clutter_choice *choice;
    const struct view *camera;
    const struct thing_shape *thing;
    const struct thing_volume *volume; /* of the thing */
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

/* Whether a ray of the model's frame meets the surface; *t: where, of its direction. */
static bool meet(double *t, const struct surface_job *job, struct vec3 from, struct vec3 way)
{
    double begin = 0, end = INFINITY;
    const struct vec3 low = job->thing->points->low, high = job->thing->points->high;
    cut(&begin, &end, from.x, way.x, low.x, high.x);
    cut(&begin, &end, from.y, way.y, low.y, high.y);
    cut(&begin, &end, from.z, way.z, low.z, high.z);
    const double step = STEP * job->volume->grid.voxel / vec3_length(way);
    float last = THING_UNSEEN;
    for (double s = begin; s <= end; s += step) {
        const float d = thing_volume_distance(job->volume, job->thing->id, vec3_add(from, vec3_scale(way, s)));
        if (d <= 0 && last > 0 && last < THING_UNSEEN) {
            *t = s - step * (double)(d / (d - last));
            return true;
        }
        last = d;
    }
    return false;
}

/* Whether a view may see the side of the surface whose normal this is: from behind no view tells its colour. */
static bool may_see(const struct surface_job *job, const struct view *view, struct vec3 p, struct vec3 normal)
{
    const struct model_axes *axes = &job->scene->axes;
    const struct vec3 to = vec3_sub(model_from_world_point(axes, view->center), model_from_world_point(axes, p));
    return vec3_dot(normal, to) > -BEHIND * vec3_length(to) || !(vec3_length(normal) > 0);
}

/* Adds the colour that a view has at P, if it shows clutter there. */
static void add_colour(double sum[4], const struct surface_job *job, int k, struct vec3 p, struct vec3 normal)
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
    const double penalty = clutter_penalty(p, job->camera->center, view->center);
    const double weight = sees / pow(BLUR * BLUR + penalty * penalty, 2);
    for (int i = 0; i < 3; i++) sum[i] += weight * (double)(c[i] / c[3]);
    sum[3] += weight;
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
    const float share = flat ? meet_flat(&t, job, flat, from, x, y) : (float)meet(&t, job, from, way);
    if (!(share > 0)) return;
    const float z = (float)(t * axes->scale), shell = job->shell[at]; /* t: depth in scene units */
    if (shell > 0 && z > shell * (1 + (flat ? FLAT_BEHIND : MAX_BEHIND))) return;
    const struct vec3 p = view_unproject(job->camera, x + 0.5, y + 0.5, t);
    const struct vec3 normal =
        flat ? flat->normal : thing_volume_normal(job->volume, job->thing->id, vec3_add(from, vec3_scale(way, t)));
    for (int k = 0; k < job->choice->count; k++) add_colour(sum, job, k, p, normal);
    if (!(sum[3] > 0)) return;
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

void thing_surface_draw(struct thing_rows *rows, struct clutter_layer *layer, const float *shell,
                        const struct clutter_scene *scene, const struct clutter_choice *choice,
                        const struct view *camera, const struct thing_shape *thing)
{
    struct surface_job job = {layer, shell, scene, choice, camera, thing, thing->volume, 0};
    *rows = (struct thing_rows){0, 0};
    if (thing->points->low.x > thing->points->high.x) return;
    find_rows(&rows->first, &rows->last, &job);
    job.first = rows->first;
    if (rows->last > rows->first) parallel_for(rows->last - rows->first, 4, draw_rows, &job);
}
