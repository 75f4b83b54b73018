/* tour_graph.c - the graph of a tour; see tour_graph.h.
 *
 * [Colburn 2014, 4.7.1] joins two viewpoints if the segment between their centres does not meet the model, with the
 * weight 1 + d + (2/pi) theta / d. Here the segment also keeps a clearance from the model (model_clearance.h). And
 * theta / d, which has no limit for two photographs from one place, is theta / max(d, 2/pi). */
#include "stages/plan_tour/tour_graph.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/base/sort.h"
#include "common/capture/photo_camera.h"
#include "common/light/model_clearance.h"

enum { RAYS = 128 };

void tour_graph_release(struct tour_graph *g)
{
    free(g->nodes);
    free(g->weights);
    *g = (struct tour_graph){0};
}

double tour_weight(double d, double theta)
{
    const double k = 2 / M_PI;
    return 1 + d + k * theta / fmax(d, k);
}

static struct vec3 photo_axis(const struct view *view, const struct lens *lens)
{
    /* the photo's axis in the view, then in the world */
    const struct vec3 in_view = mat3_apply(mat3_from_quat(lens->view_from_photo), vec3_make(0, 0, 1));
    return vec3_normalize(mat3_apply(mat3_transpose(view->cam_from_world), in_view));
}

/* Median distance to the model over directions spread over the sphere. */
static double openness(const struct model_rays *model, struct vec3 from)
{
    double lengths[RAYS];
    int count = 0;
    for (int i = 0; i < RAYS; i++) {
        const double z = 1 - (2 * i + 1.0) / RAYS, a = i * M_PI * (3 - sqrt(5)), r = sqrt(1 - z * z);
        struct ray_hit hit;
        if (ray_scene_hit(&model->rays, from, vec3_make(r * cos(a), r * sin(a), z), &hit)) lengths[count++] = hit.t;
    }
    if (!count) return 0;
    sort_doubles(lengths, (size_t)count);
    return lengths[count / 2];
}

static enum status find_nodes(struct tour_graph *g, const struct camera_set *set, const struct lens_list *lenses,
                              const struct model_axes *axes, const struct model_rays *model, double clearance,
                              struct err *err)
{
    int usable = 0;
    g->nodes = calloc((size_t)set->view_count + 1, sizeof *g->nodes);
    if (!g->nodes) return err_nomem(err, "viewpoints", (size_t)set->view_count * sizeof *g->nodes);
    for (int i = 0; i < set->view_count; i++) {
        const struct lens *lens = photo_lens_of_view(set, lenses, i);
        if (!lens) return err_set(err, ST_DATA, "lenses.txt has no line of view %s.", set->views[i].name);
        if (g->count && !strcmp(g->nodes[g->count - 1].photo, lens->photo)) continue;
        const struct view view = model_from_world_view(axes, &set->views[i]);
        struct tour_node *n = &g->nodes[g->count++];
        *n = (struct tour_node){.photo = lens->photo, .centre = view.center, .axis = photo_axis(&view, lens)};
        n->usable = model_rays_way_is_free(model, n->centre, n->centre, clearance);
        n->open = n->usable ? openness(model, n->centre) : 0;
        usable += n->usable;
        if (!n->usable)
            log_warn(
                "viewpoint %s is left out of the tour: it is inside the model, or nearer to it than the clearance of "
                "%.3g",
                n->photo, clearance);
    }
    if (usable) return ST_OK;
    return err_set(err, ST_DATA,
                   "none of the %d viewpoints is outside of the model's walls by %.3g; lower [plan_tour] clearance, or "
                   "check the model.",
                   g->count, clearance);
}

static double distance(const struct tour_graph *g, int i, int k)
{
    return vec3_length(vec3_sub(g->nodes[i].centre, g->nodes[k].centre));
}

static const double ONE_PLACE = 1e-3; /* of the distance of the nodes that are farthest apart */

/* The median distance to the nearest node at another place; 1 if there is none. Photos cut from one panorama have one
 * place, but for rounding. */
static double median_spacing(const struct tour_graph *g)
{
    double *nearest = malloc(((size_t)g->count + 1) * sizeof *nearest), middle = 1, farthest = 0;
    int count = 0;
    for (int i = 0; i < g->count; i++)
        for (int k = 0; k < i; k++) farthest = fmax(farthest, distance(g, i, k));
    for (int i = 0; nearest && i < g->count; i++) {
        double least = INFINITY;
        for (int k = 0; k < g->count; k++)
            if (distance(g, i, k) > ONE_PLACE * farthest) least = fmin(least, distance(g, i, k));
        if (isfinite(least)) nearest[count++] = least;
    }
    if (count) {
        sort_doubles(nearest, (size_t)count);
        middle = nearest[count / 2];
    }
    free(nearest);
    return middle;
}

enum status tour_graph_make(struct tour_graph *g, const struct camera_set *set, const struct lens_list *lenses,
                            const struct model_axes *axes, const struct model_rays *model,
                            const struct tour_params *params, struct err *err)
{
    *g = (struct tour_graph){0};
    if (find_nodes(g, set, lenses, axes, model, params->clearance, err)) return err->status;
    const size_t n = (size_t)g->count;
    g->unit = axes->metric ? 1 : median_spacing(g);
    g->weights = malloc((n * n + 1) * sizeof *g->weights);
    if (!g->weights) return err_nomem(err, "ways", n * n * sizeof *g->weights);
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k <= i; k++) {
            const struct tour_node *a = &g->nodes[i], *b = &g->nodes[k];
            double w = i == k ? 0 : INFINITY;
            if (i != k && a->usable && b->usable &&
                model_rays_way_is_free(model, a->centre, b->centre, params->clearance)) {
                const double theta = atan2(vec3_length(vec3_cross(a->axis, b->axis)), vec3_dot(a->axis, b->axis));
                w = tour_weight(distance(g, (int)i, (int)k) / g->unit, theta);
            }
            g->weights[i * n + k] = g->weights[k * n + i] = (float)w;
        }
    return ST_OK;
}

enum status tour_shortest(double *costs, int *before, const struct tour_graph *g, int from, struct err *err)
{
    const size_t n = (size_t)g->count;
    bool *done = calloc(n + 1, sizeof *done);
    if (!done) return err_nomem(err, "ways", n);
    for (int i = 0; i < g->count; i++) {
        costs[i] = i == from ? 0 : INFINITY;
        before[i] = -1;
    }
    for (;;) {
        int next = -1;
        for (int i = 0; i < g->count; i++)
            if (!done[i] && isfinite(costs[i]) && (next < 0 || costs[i] < costs[next])) next = i;
        if (next < 0) break;
        done[next] = true;
        for (int i = 0; i < g->count; i++) {
            const double cost = costs[next] + (double)g->weights[(size_t)next * n + (size_t)i];
            if (cost >= costs[i]) continue;
            costs[i] = cost;
            before[i] = next;
        }
    }
    free(done);
    return ST_OK;
}
