/* view_cluster.c - the cluster of views that sees one thing.
 *
 * A film moves between the views of one subject, near the centre of all cameras. Where photographs look all round,
 * as in a room, that centre faces whatever wall is there. So a film is made from a cluster of views instead.
 *
 * Whether a scene looks all round. The mean of the views' unit viewing directions has the length R, the mean
 * resultant length of directional statistics [Mardia 2000]: 1 for parallel views, sin(a) / a for views spread evenly
 * over a fan of 2a in a plane, 0 all round. Below min_agreement, by default 1/2 (a fan of 217 degrees), no direction
 * is the scene's.
 *
 * Clusters. Each view is the seed of one: the views that look about the same way and see the same sparse points,
 *
 *   angle(axis_v, axis_seed) <= max_angle,   shared >= min_shared min(points_v, points_seed)
 *
 * where points_v counts the sparse points seen in v, and shared those seen in both. Co-visibility of sparse points
 * is the usual measure of which views show one thing [Simon 2007]; the angle leaves out views from behind, which
 * share points but not surfaces.
 *
 * Scores. A film of a cluster is centred on its most central view c (central_views.h), so the cluster is judged by
 * what c shows. A point that c sees has the weight of [Goesele 2007] for parallax, min((a / full_angle)^2, 1), where
 * a is the largest angle at the point between the ray of c and that of another member that sees it. The picture of c
 * is divided into GRID x GRID cells. A cell weighs as much as its best point and has the median of its points'
 * depths:
 *
 *   coverage = sum of w / GRID^2,   variety = sum of w |ln z - median of ln z| / sum of w
 *
 * Blank walls have no sparse points, so coverage measures texture and parallax at once, over the area of the
 * picture: one poster does not make a wall a subject. A wall that is textured has no variety. The best product of
 * both wins, the first in order of the seed's name among equals.
 *
 * What differs from the sources: [Simon 2007] clusters all views by their points, to summarize a collection; here
 * one cluster is wanted, so clusters may overlap, and their score is that of a film, not of a summary. */
#include "stages/choose_views/view_cluster.h"

#include <stdlib.h>
#include <string.h>

#include "common/capture/central_views.h"
#include "common/math/weighted.h"

#define PARAM_STRUCT struct cluster_params
const struct param cluster_param_table[] = {CLUSTER_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { GRID = 8 };
#define DEGREES (M_PI / 180)

struct sighting { /* a point that the central view sees with parallax */
    int cell;
    double depth; /* ln z */
    double weight;
};

struct cluster_search {
    const struct camera_set *set;
    const struct cluster_params *params;
    size_t *first;             /* view_count + 1: the range of each view's points in `seen` */
    int *seen;                 /* indices of points */
    int *shared;               /* of each view: points that it and the seed see */
    bool *member;              /* of the seed's cluster */
    struct view *members;      /* their copies, for central_views() */
    int *order, *member_idx;   /* room for central_views(); the members' indices */
    struct sighting *sighting; /* one per point */
};

static struct vec3 axis_of(const struct view *v) { return mat3_row(v->cam_from_world, 2); }

double views_agreement(const struct camera_set *set)
{
    struct vec3 sum = {0};
    for (int i = 0; i < set->view_count; i++) sum = vec3_add(sum, axis_of(&set->views[i]));
    return set->view_count ? vec3_length(sum) / set->view_count : 0;
}

/* ------------------------------------------------------------------------------------------------------- the search */

static void search_release(struct cluster_search *s)
{
    free(s->first);
    free(s->seen);
    free(s->shared);
    free(s->member);
    free(s->members);
    free(s->order);
    free(s->member_idx);
    free(s->sighting);
}

/* Whether an earlier item of the point's track is of the same view. */
static bool is_repeated(const struct sfm_point *p, int item)
{
    for (int k = 0; k < item; k++)
        if (p->track[k].image_idx == p->track[item].image_idx) return true;
    return false;
}

/* Lists the points that each view sees, in order. */
static void list_points(struct cluster_search *s)
{
    const struct sfm_model *m = &s->set->model;
    for (int pass = 0; pass < 2; pass++) {
        for (int i = 0; i < m->point_count; i++)
            for (int k = 0; k < m->points[i].track_count; k++) {
                const int view = m->points[i].track[k].image_idx;
                if (is_repeated(&m->points[i], k)) continue;
                if (pass)
                    s->seen[s->first[view]++] = i;
                else
                    s->first[view + 1]++;
            }
        if (!pass)
            for (int v = 0; v < s->set->view_count; v++) s->first[v + 1] += s->first[v];
    }
    memmove(s->first + 1, s->first, (size_t)s->set->view_count * sizeof *s->first);
    s->first[0] = 0;
}

static enum status search_init(struct cluster_search *s, const struct camera_set *set,
                               const struct cluster_params *params, struct err *err)
{
    const size_t views = (size_t)set->view_count + 1, points = (size_t)set->model.point_count + 1;
    size_t tracks = 1;
    for (int i = 0; i < set->model.point_count; i++) tracks += (size_t)set->model.points[i].track_count;
    *s = (struct cluster_search){.set = set, .params = params};
    s->first = calloc(views, sizeof *s->first);
    s->seen = malloc(tracks * sizeof *s->seen);
    s->shared = malloc(views * sizeof *s->shared);
    s->member = malloc(views * sizeof *s->member);
    s->members = malloc(views * sizeof *s->members);
    s->order = malloc(views * sizeof *s->order);
    s->member_idx = malloc(views * sizeof *s->member_idx);
    s->sighting = malloc(points * sizeof *s->sighting);
    if (!s->first || !s->seen || !s->shared || !s->member || !s->members || !s->order || !s->member_idx || !s->sighting)
        return err_nomem(err, "clusters of views", tracks * sizeof *s->seen + points * sizeof *s->sighting);
    list_points(s);
    return ST_OK;
}

static size_t points_of(const struct cluster_search *s, int view) { return s->first[view + 1] - s->first[view]; }

/* ---------------------------------------------------------------------------------------------------------- members */

/* Marks the members of the seed's cluster; c gets their number and the central one. */
static enum status find_members(struct view_cluster *c, struct cluster_search *s, struct err *err)
{
    const struct camera_set *set = s->set;
    const double min_cosine = cos(s->params->max_angle * DEGREES);
    memset(s->shared, 0, (size_t)set->view_count * sizeof *s->shared);
    for (size_t i = s->first[c->seed]; i < s->first[c->seed + 1]; i++) {
        const struct sfm_point *p = &set->model.points[s->seen[i]];
        for (int k = 0; k < p->track_count; k++)
            if (!is_repeated(p, k)) s->shared[p->track[k].image_idx]++;
    }
    c->count = 0;
    for (int v = 0; v < set->view_count; v++) {
        const size_t fewer = points_of(s, v) < points_of(s, c->seed) ? points_of(s, v) : points_of(s, c->seed);
        const bool same_way = vec3_dot(axis_of(&set->views[v]), axis_of(&set->views[c->seed])) >= min_cosine;
        const bool sees = s->shared[v] > 0 && s->shared[v] >= s->params->min_shared * (double)fewer;
        s->member[v] = v == c->seed || (same_way && sees);
        if (!s->member[v]) continue;
        s->member_idx[c->count] = v;
        s->members[c->count++] = set->views[v];
    }
    const struct camera_set members = {.views = s->members, .view_count = c->count};
    if (central_views(s->order, &members, err)) return err->status;
    c->central = s->member_idx[s->order[0]];
    return ST_OK;
}

/* ----------------------------------------------------------------------------------------------------------- scores */

/* The largest angle at the point, in degrees, between the central view's ray and another member's. */
static double parallax_of(const struct cluster_search *s, const struct sfm_point *p, int central)
{
    const struct vec3 ray = vec3_normalize(vec3_sub(p->position, s->set->views[central].center));
    double largest = 0;
    for (int k = 0; k < p->track_count; k++) {
        const int v = p->track[k].image_idx;
        if (!s->member[v] || v == central) continue;
        const struct vec3 other = vec3_normalize(vec3_sub(p->position, s->set->views[v].center));
        largest = fmax(largest, atan2(vec3_length(vec3_cross(ray, other)), vec3_dot(ray, other)));
    }
    return largest / DEGREES;
}

/* Lists the points that the central view sees with parallax; returns their number. */
static size_t list_sightings(struct cluster_search *s, int central)
{
    const struct view *c = &s->set->views[central];
    size_t count = 0;
    for (size_t i = s->first[central]; i < s->first[central + 1]; i++) {
        const struct sfm_point *p = &s->set->model.points[s->seen[i]];
        double x, y;
        const double z = view_project(c, p->position, &x, &y);
        if (!(z > 0) || !(x >= 0 && x < c->width && y >= 0 && y < c->height)) continue;
        const double weight = fmin(1, pow(parallax_of(s, p, central) / s->params->full_angle, 2));
        const int cell = (int)(y * GRID / c->height) * GRID + (int)(x * GRID / c->width);
        if (weight > 0) s->sighting[count++] = (struct sighting){cell, log(z), weight};
    }
    return count;
}

static int compare_sightings(const void *a, const void *b)
{
    const struct sighting *p = a, *q = b;
    if (p->cell != q->cell) return p->cell - q->cell;
    return (p->depth > q->depth) - (p->depth < q->depth);
}

/* One entry per cell that has points: median depth, largest weight. Returns their number. */
static size_t make_cells(struct weighted cells[GRID * GRID], struct sighting *list, size_t count)
{
    size_t made = 0;
    qsort(list, count, sizeof *list, compare_sightings);
    for (size_t begin = 0, end; begin < count; begin = end) {
        double weight = 0;
        for (end = begin; end < count && list[end].cell == list[begin].cell; end++)
            weight = fmax(weight, list[end].weight);
        cells[made++] = (struct weighted){list[(begin + end) / 2].depth, weight};
    }
    return made;
}

static void measure(struct view_cluster *c, struct cluster_search *s)
{
    struct weighted cells[GRID * GRID];
    const size_t count = make_cells(cells, s->sighting, list_sightings(s, c->central));
    const double middle = weighted_percentile(cells, count, 0.5);
    double sum = 0, apart = 0;
    for (size_t i = 0; i < count; i++) {
        sum += cells[i].weight;
        apart += cells[i].weight * fabs(cells[i].value - middle);
    }
    c->coverage = sum / (GRID * GRID);
    c->variety = sum > 0 ? apart / sum : 0;
}

static double score_of(const struct view_cluster *c) { return c->coverage * c->variety; }

enum status view_cluster_find(struct view_cluster *best, const struct camera_set *set, int seed, const int *wanted,
                              int wanted_count, const struct cluster_params *params, struct err *err)
{
    struct cluster_search s;
    *best = (struct view_cluster){0};
    bool *member = malloc((size_t)set->view_count + 1);
    search_init(&s, set, params, err);
    if (!err->status && !member) err_nomem(err, "views", (size_t)set->view_count);
    for (int i = seed < 0 ? 0 : seed; !err->status && i < (seed < 0 ? set->view_count : seed + 1); i++) {
        struct view_cluster c = {.seed = i};
        bool has_wanted = true;
        find_members(&c, &s, err);
        for (int k = 0; !err->status && k < wanted_count; k++) has_wanted = has_wanted && s.member[wanted[k]];
        if (err->status || !has_wanted) continue;
        measure(&c, &s);
        if (!(score_of(&c) > score_of(best))) continue;
        memcpy(member, s.member, (size_t)set->view_count);
        *best = c;
    }
    if (!err->status && score_of(best) > 0) {
        best->member = member;
    } else {
        *best = (struct view_cluster){0};
        free(member);
    }
    search_release(&s);
    return err->status;
}

void view_cluster_release(struct view_cluster *c)
{
    free(c->member);
    *c = (struct view_cluster){0};
}
