/* wall_faces.c - faces of walls from oriented points and lines of sight.
 *
 * Directions. Walls run along the two axes of the model, and along further directions where the normals of the points
 * off the axes concentrate: local maxima of the histogram of their headings, by number of thinned points, so that it
 * counts area.
 *
 * Lines. Points with a direction's normals vote for lines across it. A wall is cut into columns and rows of cells; the
 * votes of a cell add up to at most one per place, so that a line's votes measure its area: a table's edge with many
 * points is no wall. A cell with few points, compared with the others, counts less: stray points are everywhere. Peaks
 * of the votes, smoothed by a few centimetres, are faces, refined to the mean of the points near them; that of another
 * direction is turned, too, to fit its points by least squares.
 *
 * Columns. A cell is solid if more points lie in it than lines of sight cross it and end well behind it, and seen
 * through in the opposite case. A wall reaches up to the ceiling, furniture rarely does: so a column whose upper cells
 * are solid is wall, whatever is open below, and one whose upper cells are seen through is none. Where those are
 * unknown, the others decide by majority, with less weight where few are known.
 *
 * The votes are those of a Hough transform on each direction, as in [Cabral 2014]; what they count differs. */
#include "stages/suggest_model/wall_faces.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"

/* As fractions of the ceiling's height: */
static const double MIN_Z = 0.04, MAX_Z = 0.92;  /* range of heights in which walls are examined */
static const double LINTEL_Z = 0.78;             /* above most doors, windows and furniture */
static const double MIN_FACE = 0.08;             /* area of a face, ceiling heights squared */
static const double BIN = 0.005, SPREAD = 0.012; /* of positions; standard deviation of the smoothing */
static const double NEAR = 0.03;                 /* distance of points that belong to a face; of equal faces */
static const double AROUND = 0.12;               /* distance of points that may belong to a face */
static const double MAX_HIDDEN = 0.5;            /* width of a stretch that furniture hides */
/* As other fractions: */
static const float HIDDEN = 0.5f;       /* weight of a hidden column between parts of a wall */
static const double MIN_DENSITY = 0.2;  /* number of points in a cell, of the median of cells with points */
static const double MAX_SLOPE = 0.5;    /* of a wall's normal: its z */
static const double LINTEL_ONLY = 0.7;  /* weight of a column of which only the upper cells are solid */
static const double ENOUGH_KNOWN = 0.3; /* of a column's cells */
enum { LINTEL_CELLS = 2 };
enum { HEADINGS = 360, OFF_AXIS = 9, HEADING_SPREAD = 3, MAX_ANGLED = 12 }; /* degrees; number of directions */
static const double ANGLED_NORMALS = 12;                                    /* degrees */

struct vote {
    int cell;
    double at, weight, density;
};
struct votes {
    struct vote *list;
    size_t count, capacity;
};

void face_list_release(struct face_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->faces[i].cells);
        free(list->faces[i].solid);
        free(list->faces[i].open);
        free(list->faces[i].lintel);
    }
    free(list->faces);
    list->faces = NULL;
    list->count = 0;
}

static bool is_of_wall(const struct face_list *list, const struct cloud_point *p)
{
    return fabs((double)p->normal[2]) < MAX_SLOPE && p->position.z >= MIN_Z * list->height &&
           p->position.z < MAX_Z * list->height && p->position.x > list->low[0] && p->position.x < list->high[0] &&
           p->position.y > list->low[1] && p->position.y < list->high[1];
}

/* S of the bounds' corners: least and most. */
static void extent(const struct face_list *list, const struct wall_line *l, double range[2])
{
    range[0] = HUGE_VAL;
    range[1] = -HUGE_VAL;
    for (int k = 0; k < 4; k++) {
        const double s = line_along(l, k & 1 ? list->high[0] : list->low[0], k & 2 ? list->high[1] : list->low[1]);
        range[0] = fmin(range[0], s);
        range[1] = fmax(range[1], s);
    }
}

/* ------------------------------------------------------------------------------------------------------- directions */

static int compare_votes(const void *a, const void *b)
{
    const struct vote *x = a, *y = b;
    if (x->cell != y->cell) return x->cell < y->cell ? -1 : 1;
    return (x->at > y->at) - (x->at < y->at);
}

/* The headings in degrees, off the axes, of which there are many normals. */
static int find_headings(double headings[MAX_ANGLED], const struct face_list *list, const struct sights *sights)
{
    double count[HEADINGS] = {0}, smooth[HEADINGS] = {0};
    int found = 0;
    const double edge = sights->points.cloud.cell / list->height, least = MIN_FACE / (edge * edge);
    for (size_t i = 0; i < sights->points.cloud.count; i++) {
        const struct cloud_point *p = &sights->points.cloud.points[i];
        if (!is_of_wall(list, p)) continue;
        const double heading = atan2((double)p->normal[1], (double)p->normal[0]) / DEGREE;
        count[((int)floor(heading + 0.5) + HEADINGS) % HEADINGS]++;
    }
    for (int h = 0; h < HEADINGS; h++)
        for (int d = -HEADING_SPREAD; d <= HEADING_SPREAD; d++)
            smooth[h] += count[(h + d + HEADINGS) % HEADINGS] * (HEADING_SPREAD + 1 - abs(d)) / (HEADING_SPREAD + 1);
    for (int h = 0; h < HEADINGS && found < MAX_ANGLED; h++) {
        const int off = abs((h + 45) % 90 - 45);
        bool peak = off >= OFF_AXIS && smooth[h] >= least;
        for (int d = -OFF_AXIS; peak && d <= OFF_AXIS; d++) {
            const double other = smooth[(h + d + HEADINGS) % HEADINGS];
            peak = d < 0 ? smooth[h] > other : smooth[h] >= other;
        }
        if (peak) headings[found++] = h;
    }
    return found;
}

/* ------------------------------------------------------------------------------------------------------------ lines */

/* The votes of the points that face along a direction, sorted by cell and place, with the weight around each. */
static enum status gather_votes(struct votes *v, const struct face_list *list, const struct sights *sights,
                                const struct wall_line *l, double min_cosine, struct err *err)
{
    double range[2];
    extent(list, l, range);
    for (size_t i = 0; i < sights->points.cloud.count; i++) {
        const struct cloud_point *p = &sights->points.cloud.points[i];
        if (!is_of_wall(list, p) || !sight_faces(p, l, min_cosine)) continue;
        if (array_reserve(&v->list, &v->capacity, v->count + 1, sizeof *v->list, "votes for walls", err))
            return err->status;
        const int column = (int)((line_along(l, p->position.x, p->position.y) - range[0]) / list->cell);
        v->list[v->count++] =
            (struct vote){column * list->up + (int)(p->position.z / list->cell),
                          line_across(l, p->position.x, p->position.y), (double)sights->points.weight[i] + 1e-3, 0};
    }
    if (v->count) qsort(v->list, v->count, sizeof *v->list, compare_votes);
    double sum = 0;
    for (size_t i = 0, first = 0, end = 0; i < v->count; i++) {
        const struct vote *a = &v->list[i];
        if (i == 0 || a->cell != v->list[i - 1].cell) sum = 0, first = end = i;
        while (end < v->count && v->list[end].cell == a->cell && v->list[end].at <= a->at + NEAR * list->height)
            sum += v->list[end++].weight;
        while (v->list[first].at < a->at - NEAR * list->height) sum -= v->list[first++].weight;
        v->list[i].density = sum;
    }
    return ST_OK;
}

static enum status count_votes(double *area, int bins, double from, double step, const struct votes *v, struct err *err)
{
    double *densities = malloc((v->count + 1) * sizeof *densities);
    double *exact = calloc((size_t)bins, sizeof *exact);
    const int reach = (int)ceil(3 * SPREAD / BIN);
    if (!densities || !exact) {
        free(densities);
        free(exact);
        return err_nomem(err, "votes for walls", v->count * sizeof *densities);
    }
    for (size_t i = 0; i < v->count; i++) densities[i] = v->list[i].density;
    const double least = v->count ? MIN_DENSITY * sort_median(densities, v->count) : 0;
    for (size_t i = 0; i < v->count; i++)
        exact[clamp_int((int)((v->list[i].at - from) / step), 0, bins - 1)] +=
            v->list[i].weight / fmax(v->list[i].density, least);
    for (int b = 0; b < bins; b++)
        for (int o = -reach; o <= reach; o++)
            if (b + o >= 0 && b + o < bins) area[b] += exact[b + o] * exp(-0.5 * pow(o * BIN / SPREAD, 2));
    free(densities);
    free(exact);
    return ST_OK;
}

/* Refines a face to its points: its position, and if it is angled its direction. */
static void refine_line(struct wall_face *face, const struct votes *v, const struct face_list *list,
                        const struct sights *sights, double min_cosine)
{
    struct wall_line *l = &face->line;
    for (int round = 0; round < 3; round++) {
        double sum = 0, ms = 0, mx = 0, ss = 0, sx = 0;
        for (size_t i = 0; !face->angled && i < v->count; i++) {
            const double d = v->list[i].at - l->at;
            if (fabs(d) > NEAR * list->height) continue;
            const double w = v->list[i].weight / v->list[i].density;
            sum += w;
            mx += w * d;
        }
        for (int pass = 0; face->angled && pass < 2; pass++)
            for (size_t i = 0; i < sights->points.cloud.count; i++) {
                const struct cloud_point *p = &sights->points.cloud.points[i];
                const double d = line_across(l, p->position.x, p->position.y);
                if (fabs(d) > 1.5 * NEAR * list->height || !is_of_wall(list, p) || !sight_faces(p, l, min_cosine))
                    continue;
                const double s = line_along(l, p->position.x, p->position.y);
                if (pass == 0) {
                    sum++;
                    ms += s;
                    mx += d;
                } else {
                    ss += (s - ms / sum) * (s - ms / sum);
                    sx += (s - ms / sum) * (d - mx / sum);
                }
            }
        if (!(sum > 0)) return;
        if (face->angled && ss > 0) { /* d = mean + slope (s - mean s) */
            double p[2];
            const double slope = sx / ss, c = 1 / hypot(1, slope);
            line_point(l, ms / sum, mx / sum, p);
            const double n[2] = {c * (l->n[0] + slope * l->n[1]), c * (l->n[1] - slope * l->n[0])};
            *l = (struct wall_line){{n[0], n[1]}, n[0] * p[0] + n[1] * p[1]};
        } else
            l->at += mx / sum;
    }
}

/* Adds the faces across one direction. */
static enum status find_lines(struct face_list *list, const struct sights *sights, const double n[2], bool angled,
                              double min_cosine, struct err *err)
{
    const struct wall_line origin = {{n[0], n[1]}, 0}, turned = {{n[1], -n[0]}, 0};
    double range[2]; /* of positions along n */
    extent(list, &turned, range);
    const double step = BIN * list->height;
    const int bins = (int)((range[1] - range[0]) / step) + 1, apart = (int)(NEAR / BIN);
    double *area = calloc((size_t)bins, sizeof *area);
    struct votes votes = {0};
    if (!area) err_nomem(err, "positions of walls", (size_t)bins * sizeof *area);
    if (!err->status && !gather_votes(&votes, list, sights, &origin, min_cosine, err))
        count_votes(area, bins, range[0], step, &votes, err);
    const double unit = list->cell * list->cell / (list->height * list->height);
    for (int b = 0; !err->status && b < bins; b++) {
        bool best = area[b] * unit >= MIN_FACE;
        for (int o = -apart; best && o <= apart; o++)
            if (o && b + o >= 0 && b + o < bins && (area[b + o] > area[b] || (o < 0 && area[b + o] == area[b])))
                best = false;
        if (!best) continue;
        if (array_append(&list->faces, (size_t)list->count, sizeof *list->faces, "faces of walls", err)) break;
        struct wall_face *face = &list->faces[list->count++];
        *face = (struct wall_face){
            .line = {{n[0], n[1]}, range[0] + (b + 0.5) * step}, .angled = angled, .area = area[b] * unit};
        refine_line(face, &votes, list, sights, min_cosine);
    }
    free(votes.list);
    free(area);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- columns */

struct column_job {
    struct face_list *list;
    const struct sights *sights;
    double min_cosine;
    int *failed; /* of each face: no memory */
};

static int cell_at(const struct face_list *list, const struct wall_face *face, double s, double z)
{
    if (z < MIN_Z * list->height || z >= MAX_Z * list->height) return -1;
    const double k = (s - face->first) / list->cell;
    return k < 0 || k >= face->columns ? -1 : (int)k * list->up + (int)(z / list->cell);
}

static void count_cells(int *votes, const struct column_job *job, struct wall_face *face)
{
    const struct face_list *list = job->list;
    const struct sights *sights = job->sights;
    double on = 0, around = 0, s, z;
    for (size_t i = 0; i < sights->rays.count; i++) {
        const struct ray *r = &sights->rays.rays[i];
        const struct cloud_point *p = &sights->points.cloud.points[r->point];
        const double d = line_across(&face->line, p->position.x, p->position.y);
        if (fabs(d) < AROUND * list->height) {
            const int c = cell_at(list, face, line_along(&face->line, p->position.x, p->position.y), p->position.z);
            if (c < 0 || !sight_faces(p, &face->line, job->min_cosine)) continue;
            around++;
            if (fabs(d) >= NEAR * list->height) continue;
            on++;
            votes[c]++;
        } else if (sight_crosses(sights, r, &face->line, list->height, &s, &z)) {
            const int c = cell_at(list, face, s, z);
            if (c >= 0) votes[c]--;
        }
    }
    face->flat = (float)(around > 0 ? on / around : 0);
}

static void weigh_columns(const struct face_list *list, struct wall_face *face)
{
    const int low = (int)ceil(MIN_Z * list->height / list->cell), high = (int)(MAX_Z * list->height / list->cell);
    const int lintel = (int)(LINTEL_Z * list->height / list->cell);
    for (int k = 0; k < face->columns; k++) {
        int solid = 0, open = 0, above = 0, known_above = 0;
        for (int z = high - 1; z >= low; z--) { /* downwards: the uppermost known cells are the lintel */
            const int8_t state = face->cells[k * list->up + z];
            solid += state > 0;
            open += state < 0;
            if (z >= lintel && state && known_above++ < LINTEL_CELLS) above += state;
        }
        const double known = (double)(solid + open) / (high - low);
        face->open[k] = (float)(solid + open ? (double)open / (solid + open) : 0);
        face->lintel[k] = (signed char)((above > 0) - (above < 0));
        if (above > 0)
            face->solid[k] = (float)(solid >= open ? 1 : LINTEL_ONLY);
        else if (above == 0 && solid > open)
            face->solid[k] = (float)((double)(solid - open) / (solid + open) * fmin(1, known / ENOUGH_KNOWN));
    }
}

/* A short stretch that nobody saw, between parts of a wall: furniture hides it, and it is probably wall. */
static void fill_hidden(const struct face_list *list, struct wall_face *face)
{
    const int most = (int)(MAX_HIDDEN * list->height / list->cell);
    for (int k = 1, end; k < face->columns; k = end) {
        for (end = k; end < face->columns && !(face->solid[end] > 0) && !(face->open[end] > 0);) end++;
        if (end > k && end < face->columns && end - k <= most && face->solid[k - 1] > HIDDEN &&
            face->solid[end] > HIDDEN)
            for (int i = k; i < end; i++) face->solid[i] = HIDDEN;
        if (end == k) end++;
    }
}

static void examine_faces(void *ctx, size_t begin, size_t end, int thread)
{
    const struct column_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct wall_face *face = &job->list->faces[i];
        double range[2];
        extent(job->list, &face->line, range);
        face->first = range[0];
        face->columns = (int)((range[1] - range[0]) / job->list->cell) + 1;
        const size_t columns = (size_t)face->columns, cells = columns * (size_t)job->list->up;
        int *votes = calloc(cells, sizeof *votes);
        face->cells = calloc(cells, 1);
        face->solid = calloc(columns, sizeof *face->solid);
        face->open = calloc(columns, sizeof *face->open);
        face->lintel = calloc(columns, 1);
        if (!votes || !face->cells || !face->solid || !face->open || !face->lintel)
            job->failed[i] = 1;
        else {
            count_cells(votes, job, face);
            for (size_t c = 0; c < cells; c++) face->cells[c] = (signed char)((votes[c] > 0) - (votes[c] < 0));
            weigh_columns(job->list, face);
            fill_hidden(job->list, face);
        }
        free(votes);
    }
}

static enum status find_columns(struct face_list *list, const struct sights *sights, double min_cosine, struct err *err)
{
    struct column_job job = {list, sights, min_cosine, calloc((size_t)list->count + 1, sizeof *job.failed)};
    if (!job.failed) return err_nomem(err, "faces of walls", (size_t)list->count * sizeof *job.failed);
    parallel_for((size_t)list->count, 1, examine_faces, &job);
    for (int i = 0; i < list->count && !err->status; i++)
        if (job.failed[i]) err_nomem(err, "cells of a wall", (size_t)list->faces[i].columns * (size_t)list->up);
    free(job.failed);
    return err->status;
}

/* Removes angled faces that turned out to run along an axis, or are equal to one before them. */
static void remove_equal(struct face_list *list)
{
    int kept = 0;
    for (int i = 0; i < list->count; i++) {
        const struct wall_face *a = &list->faces[i];
        bool equal = false;
        for (int k = 0; k < kept && a->angled && !equal; k++) {
            const struct wall_face *b = &list->faces[k];
            if (line_cosine(&a->line, &b->line) < cos(OFF_AXIS * DEGREE)) continue;
            equal = !b->angled || fabs(a->line.at - b->line.at) < NEAR * list->height;
        }
        if (!equal) list->faces[kept++] = list->faces[i];
    }
    list->count = kept;
}

enum status faces_find(struct face_list *list, const struct sights *sights, const struct suggest_params *params,
                       struct err *err)
{
    const double min_cosine = cos(params->max_angle * DEGREE);
    double headings[MAX_ANGLED];
    for (int k = 0; k < 4 && !err->status; k++) {
        static const double NORMALS[4][2] = {{0, 1}, {1, 0}, {0, -1}, {-1, 0}};
        find_lines(list, sights, NORMALS[k], false, min_cosine, err);
    }
    const int angled = err->status ? 0 : find_headings(headings, list, sights);
    for (int k = 0; k < angled && !err->status; k++) {
        const double n[2] = {cos(headings[k] * DEGREE), sin(headings[k] * DEGREE)};
        find_lines(list, sights, n, true, cos(fmin(ANGLED_NORMALS, params->max_angle) * DEGREE), err);
    }
    remove_equal(list);
    if (!err->status) find_columns(list, sights, min_cosine, err);
    if (err->status) face_list_release(list);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------ means */

/* The columns whose middles lie from begin to end; at least the one in the middle. */
static bool columns_of(const struct face_list *list, const struct wall_face *face, double begin, double end, int *first,
                       int *last)
{
    *first = clamp_int((int)ceil((begin - face->first) / list->cell - 0.5), 0, face->columns);
    *last = clamp_int((int)ceil((end - face->first) / list->cell - 0.5), 0, face->columns);
    if (*last > *first) return true;
    *first = (int)floor((0.5 * (begin + end) - face->first) / list->cell);
    *last = *first + 1;
    return *first >= 0 && *last <= face->columns;
}

double face_solid(const struct face_list *list, const struct wall_face *face, double begin, double end)
{
    int first, last;
    double sum = 0;
    if (!columns_of(list, face, begin, end, &first, &last)) return 0;
    for (int k = first; k < last; k++) sum += (double)face->solid[k];
    return sum / (last - first);
}

double face_open(const struct face_list *list, const struct wall_face *face, double begin, double end)
{
    int first, last;
    double sum = 0;
    if (!columns_of(list, face, begin, end, &first, &last)) return 0;
    for (int k = first; k < last; k++) sum += (double)face->open[k];
    return sum / (last - first);
}

double face_lintel(const struct face_list *list, const struct wall_face *face, double begin, double end)
{
    int first, last;
    double sum = 0;
    if (!columns_of(list, face, begin, end, &first, &last)) return 0;
    for (int k = first; k < last; k++) sum += face->lintel[k];
    return sum / (last - first);
}
