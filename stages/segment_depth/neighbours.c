/* neighbours.c - see neighbours.h. */
#include "stages/segment_depth/neighbours.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

#include "common/base/sort.h"

#define LEAST_SHARED  8   /* points that two views must share before the points choose */
#define LARGEST_ERROR 2.0 /* px, of a point that is believed */
#define DEGREE        (M_PI / 180)

static int compare_points(const void *a, const void *b)
{
    const struct sfm_point *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

enum status seen_points_find(struct seen_points *seen, const struct camera_set *set, int view_idx, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    const struct sfm_model *m = &set->model;
    *seen = (struct seen_points){0};
    if (view_idx >= m->image_count) return ST_OK;
    const struct sfm_image *image = &m->images[view_idx];
    seen->points = malloc(((size_t)image->observation_count + 1) * sizeof *seen->points);
    if (!seen->points) return err_nomem(err, "the points of a view", (size_t)image->observation_count * 32);
    for (int i = 0; i < image->observation_count && m->point_count > 0; i++) {
        const struct sfm_observation *o = &image->observations[i];
        struct sfm_point key = {.id = o->point_id};
        const struct sfm_point *p = bsearch(&key, m->points, (size_t)m->point_count, sizeof *m->points, compare_points);
        double u, v, z;
        if (!p || !((z = view_project(view, p->position, &u, &v)) > 0)) continue;
        if (!(hypot(u - o->u, v - o->v) <= LARGEST_ERROR)) continue;
        seen->points[seen->count++] = (struct seen_point){(int)(p - m->points), u, v, 1 / z};
    }
    return ST_OK;
}

void seen_points_release(struct seen_points *seen)
{
    if (!seen) return;
    free(seen->points);
    *seen = (struct seen_points){0};
}

static double angle_at(struct vec3 point, struct vec3 a, struct vec3 b)
{
    struct vec3 to_a = vec3_sub(a, point), to_b = vec3_sub(b, point);
    return atan2(vec3_length(vec3_cross(to_a, to_b)), vec3_dot(to_a, to_b)) / DEGREE;
}

static double angle_weight(double degrees)
{
    if (degrees < 5) return pow(degrees / 5, 1.5);
    return degrees <= 20 ? 1 : exp(-pow((degrees - 20) / 12, 2));
}

#define GRID    12  /* tiles that a view is cut into, each way */
#define COVERED 4.0 /* what a point seen by a view that is chosen already takes from its tile */
#define FRAMED  0.5 /* weight of a tile whose points only other views saw: they may be hidden here */

/* A point that tells which views see a tile: the view's own, and where it has none in a tile, all that project there. */
struct witness {
    const struct sfm_point *point;
    double inverse_z;
    int tile;
    bool seen;
};

struct witnesses {
    struct witness *list;
    int count, of_tile[GRID * GRID];
};

static int tile_of(const struct view *view, double u, double v)
{
    const double x = fmin(fmax(u / view->width, 0), 0.999), y = fmin(fmax(v / view->height, 0), 0.999);
    return (int)(y * GRID) * GRID + (int)(x * GRID);
}

static bool track_has(const struct sfm_point *p, int image_idx)
{
    for (int k = 0; k < p->track_count; k++)
        if (p->track[k].image_idx == image_idx) return true;
    return false;
}

static enum status find_witnesses(struct witnesses *w, const struct camera_set *set, int view_idx,
                                  const struct seen_points *seen, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    const struct sfm_model *m = &set->model;
    int own[GRID * GRID] = {0};
    *w = (struct witnesses){0};
    w->list = malloc(((size_t)seen->count + (size_t)m->point_count + 1) * sizeof *w->list);
    if (!w->list) return err_nomem(err, "points in the frame", (size_t)m->point_count * sizeof *w->list);
    for (int i = 0; i < seen->count; i++) {
        const struct seen_point *p = &seen->points[i];
        const int tile = tile_of(view, p->u, p->v);
        own[tile]++;
        w->list[w->count++] = (struct witness){&m->points[p->point_idx], p->inverse_z, tile, true};
    }
    for (int i = 0; i < m->point_count; i++) {
        double u, v, z = view_project(view, m->points[i].position, &u, &v);
        if (!(z > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height)) continue;
        const int tile = tile_of(view, u, v);
        if (!own[tile]) w->list[w->count++] = (struct witness){&m->points[i], 1 / z, tile, false};
    }
    for (int i = 0; i < w->count; i++) w->of_tile[w->list[i].tile]++;
    return ST_OK;
}

/* Score of every view given those chosen already; shared[] counts the points in common. The points of a tile together count as
 * one, so that a wall with few is worth as much as a shelf with many; and the less, the more of the views chosen already see the tile. */
static void score_views(double *score, int *shared, const struct camera_set *set, int view_idx,
                        const struct witnesses *witnesses, const int *chosen, int chosen_count)
{
    const struct view *view = &set->views[view_idx];
    int covered[GRID * GRID] = {0};
    for (int j = 0; j < set->view_count; j++) score[j] = shared[j] = 0;
    for (int i = 0; i < witnesses->count; i++)
        for (int c = 0; c < chosen_count; c++)
            covered[witnesses->list[i].tile] += track_has(witnesses->list[i].point, chosen[c]);
    for (int i = 0; i < witnesses->count; i++) {
        const struct witness *at = &witnesses->list[i];
        const struct sfm_point *p = at->point;
        const double share = (at->seen ? 1 : FRAMED) / (witnesses->of_tile[at->tile] + COVERED * covered[at->tile]);
        for (int k = 0; k < p->track_count; k++) {
            int j = p->track[k].image_idx;
            if (j == view_idx || j >= set->view_count) continue;
            const struct view *other = &set->views[j];
            double u, v, z = view_project(other, p->position, &u, &v);
            if (!(z > 0)) continue;
            double scale = other->fx / z / (view->fx * at->inverse_z);
            double w =
                share * angle_weight(angle_at(p->position, view->center, other->center)) * fmin(scale, 1 / scale);
            for (int c = 0; c < chosen_count; c++)
                w *= fmin(1, 0.2 + angle_at(p->position, set->views[chosen[c]].center, other->center) / 5);
            score[j] += w;
            shared[j]++;
        }
    }
}

/* Without points: near ones looking the same way, at some distance. */
static void score_poses(double *score, const struct camera_set *set, int view_idx)
{
    const struct view *view = &set->views[view_idx];
    double farthest = 0;
    for (int j = 0; j < set->view_count; j++)
        farthest = fmax(farthest, vec3_length(vec3_sub(set->views[j].center, view->center)));
    for (int j = 0; j < set->view_count; j++) {
        const struct view *other = &set->views[j];
        double distance = vec3_length(vec3_sub(other->center, view->center)), cosine = 0;
        for (int k = 0; k < 3; k++) cosine += view->cam_from_world.m[2][k] * other->cam_from_world.m[2][k];
        bool usable = distance > 1e-6 * farthest && cosine > 0.7;
        score[j] = usable ? cosine / (0.05 * farthest + distance) : 0;
    }
}

static int best_view(const double *score, const int *shared, int count, int view_idx, const int *chosen,
                     int chosen_count)
{
    int best = -1;
    for (int j = 0; j < count; j++) {
        bool taken = j == view_idx || (shared && shared[j] < LEAST_SHARED);
        for (int c = 0; c < chosen_count; c++) taken = taken || chosen[c] == j;
        if (!taken && score[j] > 1e-9 && (best < 0 || score[j] > score[best])) best = j;
    }
    return best;
}

enum status neighbours_choose(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set, int view_idx,
                              const struct seen_points *seen, int most, struct err *err)
{
    double *score = malloc((size_t)set->view_count * sizeof *score);
    struct witnesses witnesses = {0};
    int *shared = malloc((size_t)set->view_count * sizeof *shared), best = 0;
    enum status st = ST_OK;
    *count = 0;
    if (!score || !shared) {
        st = err_nomem(err, "scores of views", (size_t)set->view_count * 12);
        goto done;
    }
    double first_score = 0;
    if ((st = find_witnesses(&witnesses, set, view_idx, seen, err))) goto done;
    while (*count < most && *count < MAX_NEIGHBOURS && best >= 0) {
        score_views(score, shared, set, view_idx, &witnesses, neighbours, *count);
        best = best_view(score, shared, set->view_count, view_idx, neighbours, *count);
        if (*count == 0 && best >= 0) first_score = score[best];
        /* a view that adds next to nothing costs as much time as a good one */
        if (best >= 0 && score[best] >= 0.02 * first_score)
            neighbours[(*count)++] = best;
        else
            best = -1;
    }
    if (*count == 0) {
        score_poses(score, set, view_idx);
        while (*count < most && *count < MAX_NEIGHBOURS &&
               (best = best_view(score, NULL, set->view_count, view_idx, neighbours, *count)) >= 0)
            neighbours[(*count)++] = best;
    }
    if (*count == 0)
        st = err_set(err, ST_DATA,
                     "view %s has no neighbour to match with: among the %d other view(s) none looks at the same scene "
                     "from another place. Depth needs at least two views taken from different points; add photos "
                     "beside this one or leave it out (EXCLUDE).",
                     set->views[view_idx].name, set->view_count - 1);
done:
    free(score);
    free(shared);
    free(witnesses.list);
    return st;
}

/* Inverse depths of all points of the scene that lie in the view's frame, seen by it or not: what it sees without having
 * matched it is mostly no nearer and no farther than what other views matched there. *inverse is malloc'ed. */
static enum status framed_points(double **inverse, int *count, const struct camera_set *set, const struct view *view,
                                 struct err *err)
{
    const struct sfm_model *m = &set->model;
    *count = 0;
    *inverse = malloc(((size_t)m->point_count + 1) * sizeof **inverse);
    if (!*inverse) return err_nomem(err, "depths of points", (size_t)m->point_count * sizeof **inverse);
    for (int i = 0; i < m->point_count; i++) {
        double u, v, z = view_project(view, m->points[i].position, &u, &v);
        if (z > 0 && u >= 0 && v >= 0 && u <= view->width && v <= view->height) (*inverse)[(*count)++] = 1 / z;
    }
    sort_doubles(*inverse, (size_t)*count);
    return ST_OK;
}

enum status depth_range(double *least, double *most, bool *guessed, const struct camera_set *set, int view_idx,
                        const int *neighbours, int count, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    double *inverse = NULL;
    int points = 0;
    if (framed_points(&inverse, &points, set, view, err)) return err->status;
    if (points >= LEAST_SHARED) {
        const int stray = (points + 80) / 100; /* at either end; one in 20 points may be false */
        double low = inverse[stray], high = inverse[points - 1 - stray];
        const double margin = 0.15 * (high - low) + 0.03 * high;
        *least = fmax(low - margin, 0.3 * low);
        *most = high + 2 * margin; /* near ground has few points: it is blurred, or hidden from most views */
    }
    free(inverse);
    *guessed = points < LEAST_SHARED;
    if (!*guessed) return ST_OK;
    double baseline = 0;
    for (int k = 0; k < count; k++)
        baseline = fmax(baseline, vec3_length(vec3_sub(set->views[neighbours[k]].center, view->center)));
    *most = fmax(0.25 * view->width, 2) / (view->fx * baseline);
    *least = *most / 500;
    return ST_OK;
}
