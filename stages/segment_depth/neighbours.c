/* neighbours.c - choice of the views that a view is matched with, and of the depth range.
 *
 * Neighbours are chosen greedily [Goesele 2007]. A candidate's score is a sum over the points that both views observed
 * of the product of
 *   frustum_angle_weight() of the angle: 1 from 5 to 20 degrees, little near 0 and above 45
 *   scale          the ratio of the two pixels' footprints at the point, at most 1
 *   min(1, 0.2 + angle / 5 degrees) for the angle to each neighbour chosen already: it should add a direction
 *
 * What differs from the source: the view is divided into GRID x GRID tiles of equal weight, however many points they
 * have, so that a bare wall counts as much as a full shelf; a tile's weight falls with the number of chosen neighbours
 * that see it. In a tile without observed points, points of other views that project there count by UNSEEN_WEIGHT,
 * since they may be occluded.
 *
 * Where points are few they do not decide alone: as long as there are tiles that fewer than ENOUGH of the chosen views
 * show, as far as cameras tell (frustum_overlap.h), views are added that show the most of them. If the scene has no
 * points, distance and viewing direction decide. */
#include "stages/segment_depth/neighbours.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "stages/segment_depth/frustum_overlap.h"

#define MIN_SHARED             8   /* points that two views must share to be neighbours by points */
#define MAX_REPROJECTION_ERROR 2.0 /* px, of an observation that is used */

static int compare_points(const void *a, const void *b)
{
    const struct sfm_point *p = a, *q = b;
    return (p->id > q->id) - (p->id < q->id);
}

enum status neighbours_find_points(struct observed_points *seen, const struct camera_set *set, int view_idx,
                                   struct err *err)
{
    const struct view *view = &set->views[view_idx];
    const struct sfm_model *m = &set->model;
    *seen = (struct observed_points){0};
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
        if (!(hypot(u - o->u, v - o->v) <= MAX_REPROJECTION_ERROR)) continue;
        seen->points[seen->count++] = (struct observed_point){(int)(p - m->points), u, v, 1 / z};
    }
    return ST_OK;
}

void neighbours_release_points(struct observed_points *seen)
{
    if (!seen) return;
    free(seen->points);
    *seen = (struct observed_points){0};
}

static double angle_at(struct vec3 point, struct vec3 a, struct vec3 b)
{
    struct vec3 to_a = vec3_sub(a, point), to_b = vec3_sub(b, point);
    return atan2(vec3_length(vec3_cross(to_a, to_b)), vec3_dot(to_a, to_b)) / DEGREE;
}

#define WIDE_ANGLE 12.0 /* degrees beyond 20 at which a point counts 1 / e */

#define GRID 12 /* tiles of a view in each direction */
/* Each view of a point that is chosen already counts as so many further points of the tile. */
#define COVERED_WEIGHT 4.0
#define UNSEEN_WEIGHT  0.5 /* of a tile whose points only other views observed */

/* A point that represents a tile: one that the view observed; in tiles without, any that projects there. */
struct tile_point {
    const struct sfm_point *point;
    double inverse_z;
    int tile;
    bool seen;
};

struct tile_points {
    struct tile_point *list;
    int count, of_tile[GRID * GRID];
};

static int tile_of(const struct view *view, double u, double v)
{
    const double x = clamp(u / view->width, 0, 0.999), y = clamp(v / view->height, 0, 0.999);
    return (int)(y * GRID) * GRID + (int)(x * GRID);
}

static bool track_has(const struct sfm_point *p, int image_idx)
{
    for (int k = 0; k < p->track_count; k++)
        if (p->track[k].image_idx == image_idx) return true;
    return false;
}

static enum status find_tile_points(struct tile_points *w, const struct camera_set *set, int view_idx,
                                    const struct observed_points *seen, struct err *err)
{
    const struct view *view = &set->views[view_idx];
    const struct sfm_model *m = &set->model;
    int own[GRID * GRID] = {0};
    *w = (struct tile_points){0};
    w->list = malloc(((size_t)seen->count + (size_t)m->point_count + 1) * sizeof *w->list);
    if (!w->list) return err_nomem(err, "points in the frame", (size_t)m->point_count * sizeof *w->list);
    for (int i = 0; i < seen->count; i++) {
        const struct observed_point *p = &seen->points[i];
        const int tile = tile_of(view, p->u, p->v);
        own[tile]++;
        w->list[w->count++] = (struct tile_point){&m->points[p->point_idx], p->inverse_z, tile, true};
    }
    for (int i = 0; i < m->point_count; i++) {
        double u, v, z = view_project(view, m->points[i].position, &u, &v);
        if (!(z > 0) || !(u >= 0 && v >= 0 && u < view->width && v < view->height)) continue;
        const int tile = tile_of(view, u, v);
        if (!own[tile]) w->list[w->count++] = (struct tile_point){&m->points[i], 1 / z, tile, false};
    }
    for (int i = 0; i < w->count; i++) w->of_tile[w->list[i].tile]++;
    return ST_OK;
}

/* Scores every view, given the neighbours chosen so far; shared[]: number of points in common. */
static void score_views(double *score, int *shared, const struct camera_set *set, int view_idx,
                        const struct tile_points *points, const int *chosen, int chosen_count)
{
    const struct view *view = &set->views[view_idx];
    int covered[GRID * GRID] = {0};
    for (int j = 0; j < set->view_count; j++) score[j] = shared[j] = 0;
    for (int i = 0; i < points->count; i++)
        for (int c = 0; c < chosen_count; c++)
            covered[points->list[i].tile] += track_has(points->list[i].point, chosen[c]);
    for (int i = 0; i < points->count; i++) {
        const struct tile_point *at = &points->list[i];
        const struct sfm_point *p = at->point;
        const double share =
            (at->seen ? 1 : UNSEEN_WEIGHT) / (points->of_tile[at->tile] + COVERED_WEIGHT * covered[at->tile]);
        for (int k = 0; k < p->track_count; k++) {
            int j = p->track[k].image_idx;
            if (j == view_idx || j >= set->view_count) continue;
            const struct view *other = &set->views[j];
            double u, v, z = view_project(other, p->position, &u, &v);
            if (!(z > 0)) continue;
            double scale = other->fx / z / (view->fx * at->inverse_z);
            double w = share * frustum_angle_weight(angle_at(p->position, view->center, other->center), WIDE_ANGLE) *
                       fmin(scale, 1 / scale);
            for (int c = 0; c < chosen_count; c++)
                w *= fmin(1, 0.2 + angle_at(p->position, set->views[chosen[c]].center, other->center) / 5);
            score[j] += w;
            shared[j]++;
        }
    }
}

/* Scores without points: nearby views in the same direction, but not at the same position. */
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
        bool taken = j == view_idx || (shared && shared[j] < MIN_SHARED);
        for (int c = 0; c < chosen_count; c++) taken = taken || chosen[c] == j;
        if (!taken && score[j] > 1e-9 && (best < 0 || score[j] > score[best])) best = j;
    }
    return best;
}

#define ENOUGH    3.0  /* views that show a tile well */
#define WELL      0.25 /* frustum_overlap() of a view that shows a tile */
#define MIN_ADDED 4.0  /* tiles that a further view must show, of those that too few show */

static bool is_chosen(int view, const int *chosen, int count)
{
    for (int c = 0; c < count; c++)
        if (chosen[c] == view) return true;
    return false;
}

/* Adds views to those chosen by points until all tiles are shown by enough, as far as cameras tell. */
static void add_by_frusta(int *neighbours, int *count, int max_count, const struct camera_set *set, int view_idx,
                          const struct observed_points *seen)
{
    enum { TILES = FRUSTUM_TILES * FRUSTUM_TILES };
    const struct view *view = &set->views[view_idx];
    struct frustum_tiles tiles;
    double shown[TILES], views[TILES] = {0};
    if (!frustum_tiles_make(&tiles, set, view_idx, seen)) return;
    for (int c = 0; c < *count; c++) {
        frustum_overlap(shown, &tiles, view, &set->views[neighbours[c]]);
        for (int k = 0; k < TILES; k++) views[k] += shown[k] >= WELL;
    }
    for (int best = 0; best >= 0 && *count < max_count && *count < MAX_NEIGHBOURS;) {
        double most = MIN_ADDED, best_shown[TILES];
        best = -1;
        for (int j = 0; j < set->view_count; j++) {
            double gain = 0;
            if (j == view_idx || is_chosen(j, neighbours, *count)) continue;
            if (!(frustum_overlap(shown, &tiles, view, &set->views[j]) > most)) continue;
            for (int k = 0; k < TILES; k++)
                if (views[k] < (shown[k] >= WELL ? ENOUGH : ENOUGH - 1)) gain += shown[k] / (1 + views[k]);
            if (!(gain > most)) continue;
            most = gain;
            best = j;
            memcpy(best_shown, shown, sizeof shown);
        }
        if (best < 0) break;
        for (int k = 0; k < TILES; k++) views[k] += best_shown[k] >= WELL;
        neighbours[(*count)++] = best;
    }
}

enum status neighbours_choose(int neighbours[MAX_NEIGHBOURS], int *count, const struct camera_set *set, int view_idx,
                              const struct observed_points *seen, int max_count, struct err *err)
{
    double *score = malloc((size_t)set->view_count * sizeof *score);
    struct tile_points points = {0};
    int *shared = malloc((size_t)set->view_count * sizeof *shared), best = 0;
    *count = 0;
    if (!score || !shared) {
        err_nomem(err, "scores of views", (size_t)set->view_count * 12);
        goto done;
    }
    double first_score = 0;
    if (find_tile_points(&points, set, view_idx, seen, err)) goto done;
    while (*count < max_count && *count < MAX_NEIGHBOURS && best >= 0) {
        score_views(score, shared, set, view_idx, &points, neighbours, *count);
        best = best_view(score, shared, set->view_count, view_idx, neighbours, *count);
        if (*count == 0 && best >= 0) first_score = score[best];
        /* a view that adds almost nothing takes as much time as a good one */
        if (best >= 0 && score[best] >= 0.02 * first_score)
            neighbours[(*count)++] = best;
        else
            best = -1;
    }
    if (max_count > MAX_NEIGHBOURS) max_count = MAX_NEIGHBOURS;
    add_by_frusta(neighbours, count, max_count, set, view_idx, seen);
    if (*count == 0) {
        score_poses(score, set, view_idx);
        while (*count < max_count && *count < MAX_NEIGHBOURS &&
               (best = best_view(score, NULL, set->view_count, view_idx, neighbours, *count)) >= 0)
            neighbours[(*count)++] = best;
    }
    if (*count == 0)
        err_set(err, ST_DATA,
                "view %s has no neighbour to match with: none of the %d other view(s) shows the same scene from "
                "another position. Depth needs at least two views taken from different positions; add photos "
                "taken beside this one, or leave it out (EXCLUDE).",
                set->views[view_idx].name, set->view_count - 1);
done:
    free(score);
    free(shared);
    free(points.list);
    return err->status;
}

#define SAME_SIDE 45.0 /* degrees between the rays of two views to a point that both may see */

/* Whether a view that does not observe a point may see it: a view that does looks at it from the same side. What only
 * views from elsewhere observe may lie behind a wall, or in another room. Of points that no view observes, as some
 * given models have them, nothing is known. */
static bool may_see(const struct camera_set *set, const struct view *view, const struct sfm_point *p)
{
    if (!p->track_count) return true;
    for (int k = 0; k < p->track_count; k++) {
        const int j = p->track[k].image_idx;
        if (j >= set->view_count) continue;
        if (angle_at(p->position, view->center, set->views[j].center) < SAME_SIDE) return true;
    }
    return false;
}

/* Sorted inverse depths of all points that project into the view and that it may see, observed by it or not: surfaces
 * that only other views matched lie at similar depths. *inverse is malloc'ed. */
static enum status framed_points(double **inverse, int *count, const struct camera_set *set, const struct view *view,
                                 struct err *err)
{
    const struct sfm_model *m = &set->model;
    *count = 0;
    *inverse = malloc(((size_t)m->point_count + 1) * sizeof **inverse);
    if (!*inverse) return err_nomem(err, "depths of points", (size_t)m->point_count * sizeof **inverse);
    for (int i = 0; i < m->point_count; i++) {
        double u, v, z = view_project(view, m->points[i].position, &u, &v);
        if (!(z > 0) || !(u >= 0 && v >= 0 && u <= view->width && v <= view->height)) continue;
        if (may_see(set, view, &m->points[i])) (*inverse)[(*count)++] = 1 / z;
    }
    sort_doubles(*inverse, (size_t)*count);
    return ST_OK;
}

#define FEW_POINTS 30.0 /* with so many the margins of the depth range are half as wide again */

enum status neighbours_depth_range(double *min_inverse_z, double *max_inverse_z, bool *guessed,
                                   const struct camera_set *set, int view_idx, const int *neighbours, int count,
                                   struct err *err)
{
    const struct view *view = &set->views[view_idx];
    double *inverse = NULL;
    int points = 0;
    if (framed_points(&inverse, &points, set, view, err)) return err->status;
    if (points >= MIN_SHARED) {
        const int stray = (points + 80) / 100; /* outliers at either end */
        double low = inverse[stray], high = inverse[points - 1 - stray];
        /* few points miss the ends of the range */
        const double margin = (0.15 * (high - low) + 0.03 * high) * (1 + FEW_POINTS / (FEW_POINTS + points));
        *min_inverse_z = fmax(low - margin, 0.3 * low);
        *max_inverse_z =
            high + 2 * margin; /* the near ground has few points: it is blurred, or occluded in most views */
    }
    free(inverse);
    *guessed = points < MIN_SHARED;
    if (!*guessed) return ST_OK;
    double baseline = 0;
    for (int k = 0; k < count; k++)
        baseline = fmax(baseline, vec3_length(vec3_sub(set->views[neighbours[k]].center, view->center)));
    *max_inverse_z = fmax(0.25 * view->width, 2) / (view->fx * baseline);
    *min_inverse_z = *max_inverse_z / 500;
    return ST_OK;
}
