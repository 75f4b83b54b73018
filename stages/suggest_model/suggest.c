/* suggest.c - suggests a plan of rooms from oriented points and lines of sight.
 *
 * Faces. For each axis and sign, a histogram of positions is made of the points with that normal. It counts the wall's
 * cells with points, not the points, so that a table's edge with many points is not a wall. Each peak is a face,
 * refined to the mean of the points near it. A face's cell is solid if more points lie on it than lines of sight cross
 * it and end well behind it, and seen through in the opposite case.
 *
 * Rooms. The outermost prominent face on each side that is not only seen through another wall's windows bounds the
 * plan: a box. A box is cut in two by the pair of faces back to back (or the single face) with the largest solid
 * fraction across it, and its parts likewise; boxes that cannot be cut are rooms. The wall's other face is the nearest
 * one that is solid in enough of the same cells: furniture in front of it may hide the rest. Openings are found in
 * openings.c. */
#include "stages/suggest_model/suggest.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "stages/suggest_model/openings.h"

/* As fractions of the ceiling's height: */
static const double MIN_Z = 0.04, MAX_Z = 0.92; /* range of heights in which walls are examined */
static const double MAX_FLOOR_Z = 0.03;         /* of points of the floor */
static const double MAX_HEIGHTS = 50;           /* extent of a plan */
static const double MIN_FACE = 0.12;            /* area of a face, ceiling heights squared */
/* As other fractions: */
static const double MIN_OUTER = 0.25;   /* net area of an outer face, of the best face's */
static const double SEEN_THROUGH = 0.9; /* of a face's lines of sight: it lies beyond another face */
static const double MIN_BACK = 0.15;    /* of a face's solid cells that are solid on the wall's other face too */
static const double MIN_FLOOR = 0.3;    /* of a room's floor cells with points */

struct box {
    double low[2], high[2];
    int walls[4];
};

void suggest_release(struct suggestion *s)
{
    if (!s) return;
    free(s->walls);
    free(s->openings);
    free(s->rooms);
    *s = (struct suggestion){0};
}

/* Finds the bounds of the plan and the ceiling's height as quantiles of the points' coordinates. */
static enum status find_bounds(struct finder *f, double ceiling, struct err *err)
{
    double *v = malloc((f->cloud->count + 1) * sizeof *v);
    if (!v) return err_nomem(err, "coordinates", f->cloud->count * sizeof *v);
    for (int axis = 0; axis < 3; axis++) {
        size_t n = 0;
        for (size_t i = 0; i < f->cloud->count; i++) {
            const struct vec3 p = f->cloud->points[i].position;
            if (axis < 2)
                v[n++] = along(p, axis);
            else if (fabs((double)f->cloud->points[i].normal[2]) < 0.3)
                v[n++] = p.z;
        }
        sort_doubles(v, n);
        if (axis < 2) {
            f->low[axis] = v[n / 500];
            f->high[axis] = v[n - 1 - n / 500];
        } else
            f->height = ceiling > 0 ? ceiling : n ? v[n - 1 - n / 50] : 0;
    }
    free(v);
    if (!(f->height > 0))
        return err_set(
            err, ST_DATA,
            "no points of walls lie above the floor; check the axes and the floor in the pictures in model/axes.");
    const double c = f->params->cell * f->height;
    for (int axis = 0; axis < 2; axis++) {
        f->low[axis] -= c;
        f->high[axis] += c;
        const double cells = (f->high[axis] - f->low[axis]) / c;
        if (cells * f->params->cell > MAX_HEIGHTS)
            return err_set(err, ST_DATA,
                           "the points extend over %.0f times the ceiling's height, wanted at most %.0f, the size of a "
                           "building; check the heights of floor and ceiling in the pictures in model/axes.",
                           cells * f->params->cell, MAX_HEIGHTS);
        f->across[axis] = (int)cells + 1;
    }
    f->up = (int)ceil(1 / f->params->cell);
    return ST_OK;
}

/* The cell of a face with that axis at (s, z), -1 outside. */
static int cell_at(const struct finder *f, int axis, double s, double z)
{
    const double c = f->params->cell * f->height;
    if (z < MIN_Z * f->height || z >= MAX_Z * f->height) return -1;
    const double k = (s - f->low[1 - axis]) / c;
    if (k < 0 || k >= f->across[1 - axis]) return -1;
    return (int)k * f->up + (int)(z / c);
}

/* Finds the faces of an axis and sign: peaks of the number of cells with points, by position. */
static enum status find_faces(struct finder *f, int axis, int sign, struct err *err)
{
    const double step = f->params->window * f->height / 2;
    const int bins = (int)((f->high[axis] - f->low[axis]) / step) + 3, cells = f->across[1 - axis] * f->up;
    unsigned char *seen = calloc((size_t)cells * (size_t)bins, 1);
    int *area = calloc((size_t)bins + 2, sizeof *area);
    if (!seen || !area) err_nomem(err, "cells of walls", (size_t)cells * (size_t)bins);
    for (size_t i = 0; !err->status && i < f->cloud->count; i++) {
        const struct cloud_point *p = &f->cloud->points[i];
        if (!faces_along(f, p, axis, sign)) continue;
        const double bin = (along(p->position, axis) - f->low[axis]) / step;
        const int cell = cell_at(f, axis, along(p->position, 1 - axis), p->position.z);
        if (cell < 0 || bin < 1 || bin >= bins - 1) continue;
        for (int b = (int)bin - 1; b <= (int)bin + 1; b++) /* windows of three bins */
            seen[(size_t)b * (size_t)cells + (size_t)cell] = 1;
    }
    for (int b = 0; !err->status && b < bins; b++)
        for (int c = 0; c < cells; c++) area[b] += seen[(size_t)b * (size_t)cells + (size_t)c];
    const int min_area = (int)(MIN_FACE / (f->params->cell * f->params->cell)), apart = 4;
    for (int b = 1; !err->status && b < bins - 1; b++) {
        bool best = area[b] >= min_area;
        for (int o = -apart; best && o <= apart; o++)
            if (o && b + o >= 0 && b + o < bins && (area[b + o] > area[b] || (o < 0 && area[b + o] == area[b])))
                best = false;
        if (!best) continue;
        if (array_append(&f->faces, (size_t)f->face_count, sizeof *f->faces, "faces of walls", err)) break;
        struct wall_side *face = &f->faces[f->face_count++];
        *face = (struct wall_side){.axis = axis, .sign = sign, .at = f->low[axis] + (b + 0.5) * step};
        for (int round = 0; round < 3; round++) { /* refine to the mean of the points near it */
            double sum = 0;
            size_t n = 0;
            for (size_t i = 0; i < f->cloud->count; i++) {
                const struct cloud_point *p = &f->cloud->points[i];
                const double d = along(p->position, axis) - face->at;
                if (fabs(d) < 2 * step && faces_along(f, p, axis, sign)) sum += d, n++;
            }
            if (n) face->at += sum / (double)n;
        }
    }
    free(area);
    free(seen);
    return err->status;
}

/* Decides which cells of a face are solid and which are seen through, by majority of the lines of sight. */
static enum status count_cells(struct finder *f, struct wall_side *face, struct err *err)
{
    const int cells = f->across[1 - face->axis] * f->up;
    int *votes = calloc((size_t)cells + 1, sizeof *votes);
    face->cells = calloc((size_t)cells + 1, 1);
    if (!votes || !face->cells) {
        free(votes);
        return err_nomem(err, "cells of a wall", (size_t)cells * sizeof *votes);
    }
    for (size_t i = 0; i < f->rays.count; i++) {
        const struct ray *r = &f->rays.rays[i];
        const struct cloud_point *p = &f->cloud->points[r->point];
        double s, z;
        if (fabs(along(p->position, face->axis) - face->at) < 2 * f->params->window * f->height) {
            const int c = cell_at(f, face->axis, along(p->position, 1 - face->axis), p->position.z);
            if (c >= 0 && faces_along(f, p, face->axis, face->sign)) votes[c]++;
        } else if (crosses(f, r, face->axis, face->sign, face->at, &s, &z)) {
            const int c = cell_at(f, face->axis, s, z);
            if (c >= 0) votes[c]--;
        }
    }
    for (int c = 0; c < cells; c++) {
        face->cells[c] = (signed char)((votes[c] > 0) - (votes[c] < 0));
        face->net += face->cells[c];
    }
    free(votes);
    return ST_OK;
}

/* Solid cells minus those seen through, as a fraction of the cells from begin to end. */
static double solid_fraction(const struct finder *f, const struct wall_side *face, double begin, double end)
{
    const double c = f->params->cell * f->height;
    const int other = 1 - face->axis;
    int first = (int)ceil((begin - f->low[other]) / c), last = (int)floor((end - f->low[other]) / c), net = 0;
    if (first < 0) first = 0;
    if (last > f->across[other]) last = f->across[other];
    if (last <= first) return -1;
    for (int k = first; k < last; k++)
        for (int z = 0; z < f->up; z++) net += face->cells[k * f->up + z];
    return net / ((last - first) * (MAX_Z - MIN_Z) / f->params->cell);
}

/* Whether a face is seen only through the windows of a nearer one: it belongs to a yard or to a house opposite. */
static bool is_beyond(const struct finder *f, const struct wall_side *face, const struct wall_side *nearer)
{
    size_t all = 0, through = 0;
    double s, z;
    for (size_t i = 0; i < f->rays.count; i++) {
        const struct cloud_point *p = &f->cloud->points[f->rays.rays[i].point];
        if (fabs(along(p->position, face->axis) - face->at) > 2 * f->params->window * f->height ||
            !faces_along(f, p, face->axis, face->sign))
            continue;
        all++;
        through += crosses(f, &f->rays.rays[i], face->axis, face->sign, nearer->at, &s, &z);
    }
    return (double)through > SEEN_THROUGH * (double)all;
}

static bool is_prominent(const struct wall_side *face, int axis, int sign, int best)
{
    return face->axis == axis && face->sign == sign && face->net > MIN_OUTER * best;
}

/* The outermost prominent face towards the inside that is not beyond another one; NULL: none. */
static const struct wall_side *find_outermost(const struct finder *f, int axis, int sign)
{
    int best = 0;
    for (int i = 0; i < f->face_count; i++)
        if (f->faces[i].axis == axis && f->faces[i].sign == sign && f->faces[i].net > best) best = f->faces[i].net;
    const struct wall_side *found = NULL;
    for (int i = 0; i < f->face_count; i++) {
        const struct wall_side *a = &f->faces[i];
        if (!is_prominent(a, axis, sign, best)) continue;
        bool beyond = found && sign * (found->at - a->at) <= 0;
        for (int k = 0; !beyond && k < f->face_count; k++) {
            const struct wall_side *b = &f->faces[k];
            beyond = is_prominent(b, axis, sign, best) && sign * (b->at - a->at) > 0 && is_beyond(f, a, b);
        }
        if (!beyond) found = a;
    }
    return found;
}

/* *found is set if cameras or enough floor are in the box. */
static enum status is_free(bool *found, const struct finder *f, const struct box *box, struct err *err)
{
    const double c = f->params->cell * f->height;
    for (int v = 0; v < f->view_count; v++) {
        const struct vec3 p = f->views[v].center;
        if (p.x > box->low[0] && p.x < box->high[0] && p.y > box->low[1] && p.y < box->high[1]) *found = true;
    }
    const int w = (int)((box->high[0] - box->low[0]) / c) + 1, h = (int)((box->high[1] - box->low[1]) / c) + 1;
    unsigned char *seen = calloc((size_t)w * (size_t)h, 1);
    int count = 0;
    if (!seen) return err_nomem(err, "a floor's cells", (size_t)w * (size_t)h);
    for (size_t i = 0; i < f->cloud->count; i++) {
        const struct cloud_point *p = &f->cloud->points[i];
        const double x = (p->position.x - box->low[0]) / c, y = (p->position.y - box->low[1]) / c;
        if (fabs(p->position.z) > MAX_FLOOR_Z * f->height || p->normal[2] < 0.9f || x < 0 || y < 0 || x >= w || y >= h)
            continue;
        unsigned char *cell = &seen[(size_t)y * (size_t)w + (size_t)x];
        count += !*cell;
        *cell = 1;
    }
    free(seen);
    if (count > MIN_FLOOR * w * h) *found = true;
    return ST_OK;
}

/* The other face of a wall with the face a; NULL: none. Furniture may hide most of it, and points that fitted
 * badly may lie behind it, so that it is no wall by its own solid fraction. It must be solid in enough cells where the
 * first face is solid too. The thinnest wall is chosen, because what stands in front of a wall is nearer to the
 * room. */
static const struct wall_side *find_back(const struct finder *f, const struct wall_side *a, const struct box *box)
{
    const struct wall_side *found = NULL;
    const double c = f->params->cell * f->height;
    const int other = 1 - a->axis, first = clamp_int((int)((box->low[other] - f->low[other]) / c), 0, f->across[other]),
              last = clamp_int((int)((box->high[other] - f->low[other]) / c), 0, f->across[other]);
    for (int i = 0; i < f->face_count; i++) {
        const struct wall_side *b = &f->faces[i];
        const double thickness = a->sign * (a->at - b->at);
        int both = 0, front = 0;
        if (b->axis != a->axis || b->sign == a->sign || thickness < 2 * f->params->window * f->height ||
            thickness > f->params->max_thickness * f->height)
            continue;
        for (int k = first * f->up; k < last * f->up; k++) {
            front += a->cells[k] > 0;
            both += a->cells[k] > 0 && b->cells[k] > 0;
        }
        if (both * f->params->cell * f->params->cell < MIN_FACE || both < MIN_BACK * front) continue;
        if (!found || thickness < a->sign * (a->at - found->at)) found = b;
    }
    return found;
}

/* The wall with the largest solid fraction that cuts a box: two faces back to back, or else a single face (best[1] is
 * then NULL); best[0] is NULL if there is none. */
static void find_partition(const struct wall_side *best[2], const struct finder *f, const struct box *box)
{
    const double narrow = f->params->min_opening * f->height;
    double best_fraction = f->params->min_wall;
    best[0] = best[1] = NULL;
    for (int i = 0; i < f->face_count; i++)
        for (int k = 0; k < f->face_count; k++) {
            const struct wall_side *a = &f->faces[i], *b = &f->faces[k];
            const int axis = a->axis, other = 1 - axis;
            const double thickness = b->at - a->at;
            if (b->axis != axis || a->sign > 0 || b->sign < 0 || thickness < 2 * f->params->window * f->height ||
                thickness > f->params->max_thickness * f->height || a->at < box->low[axis] + narrow ||
                b->at > box->high[axis] - narrow)
                continue;
            const double pa = solid_fraction(f, a, box->low[other], box->high[other]);
            const double pb = solid_fraction(f, b, box->low[other], box->high[other]);
            if (fmin(pa, pb) > best_fraction) {
                best_fraction = fmin(pa, pb);
                best[0] = a;
                best[1] = b;
            }
        }
    for (int i = 0; !best[1] && i < f->face_count; i++) { /* a wall that was seen from one side */
        const struct wall_side *a = &f->faces[i];
        const double away = (f->params->min_opening + WALL_THICKNESS) * f->height;
        const double fraction = solid_fraction(f, a, box->low[1 - a->axis], box->high[1 - a->axis]);
        if (a->at < box->low[a->axis] + away || a->at > box->high[a->axis] - away || fraction <= best_fraction)
            continue;
        best_fraction = fraction;
        best[0] = a;
    }
    const struct wall_side *front = best[0], *back = front ? find_back(f, front, box) : NULL;
    if (!back) return;
    best[0] = front->sign < 0 ? front : back;
    best[1] = front->sign < 0 ? back : front;
    const struct wall_side *nearer = find_back(f, best[1], box); /* the first may have been furniture too */
    if (nearer) best[0] = nearer;
}

/* Cuts a box in two at its best wall, and its parts likewise; boxes without such a wall become rooms. */
static enum status cut_box(struct suggestion *s, const struct finder *f, const struct box *box, struct err *err)
{
    const struct wall_side *best[2];
    find_partition(best, f, box);
    if (!best[0]) {
        if (array_append(&s->rooms, (size_t)s->room_count, sizeof *s->rooms, "rooms", err)) return err->status;
        struct suggested_room *room = &s->rooms[s->room_count++];
        memcpy(room->walls, box->walls, sizeof room->walls);
        return is_free(&room->free, f, box, err);
    }
    const int axis = best[0]->axis, wall = s->wall_count;
    const int low_side = axis ? 0 : 1, high_side = axis ? 2 : 3; /* south and north, or west and east */
    const double guess = WALL_THICKNESS * f->height;
    const double first = best[1] || best[0]->sign < 0 ? best[0]->at : best[0]->at - guess;
    const double second = best[1] ? best[1]->at : first + guess;
    if (array_append(&s->walls, (size_t)s->wall_count, sizeof *s->walls, "walls", err)) return err->status;
    s->walls[s->wall_count++] = (struct suggested_wall){
        .axis = axis,
        .face = first,
        .thickness = second - first,
        .guessed = !best[1],
        .begin = box->low[1 - axis],
        .end = box->high[1 - axis],
        .sides = {box->walls[axis ? 1 : 0], box->walls[axis ? 3 : 2]},
        .inward = -1,
    };
    struct box low = *box, high = *box;
    low.high[axis] = first;
    low.walls[high_side] = wall;
    high.low[axis] = second;
    high.walls[low_side] = wall;
    return cut_box(s, f, &low, err) ? err->status : cut_box(s, f, &high, err);
}

/* The error where side k of the plan (south, west, north, east) has no wall. */
static enum status no_wall(const struct finder *f, int k, struct err *err)
{
    static const char *const SIDES[] = {"-y", "-x", "+y", "+x"}, *const NORMALS[] = {"+y", "+x", "-y", "-x"};
    const int axis = k % 2 ? 0 : 1, sign = k < 2 ? 1 : -1;
    size_t facing = 0, along_axes = 0;
    for (size_t i = 0; i < f->cloud->count; i++) {
        const struct cloud_point *p = &f->cloud->points[i];
        facing += faces_along(f, p, axis, sign);
        for (int n = 0; n < 4; n++) along_axes += faces_along(f, p, n % 2, n < 2 ? 1 : -1);
    }
    return err_set(
        err, ST_DATA,
        "no wall was found on the %s side of the model's frame. A wall is a plane of points whose normals are within "
        "%g degrees of %s, and which cover at least %g times the square of the ceiling's height (%.3g); of %zu points "
        "%zu have normals along x or y, and %zu of these along %s. Likely causes, the most frequent first: (1) too few "
        "points on the wall: take more photographs of it, or write the script by hand; (2) a wrong lens model, with "
        "fisheye photographs: see the residuals that sfm_import reports; if they are large, set [sfm] camera_model "
        "(EQUISOLID for most fisheye lenses) and run make resfm; (3) wrong axes or heights: look at the pictures in "
        "model/axes, and correct them with axes_fix.txt.",
        SIDES[k], f->params->max_angle, NORMALS[k], MIN_FACE, f->height, f->cloud->count, along_axes, facing,
        NORMALS[k]);
}

enum status suggest_plan(struct suggestion *s, const struct point_cloud *cloud, const struct view *views,
                         int view_count, double ceiling, const struct suggest_params *params, struct err *err)
{
    struct finder f = {.cloud = cloud, .views = views, .view_count = view_count, .params = params};
    const struct wall_side *outer[4];
    *s = (struct suggestion){0};
    if (cloud->count)
        find_bounds(&f, ceiling, err);
    else
        err_set(err, ST_DATA, "there are no points; add photographs that overlap.");
    if (!err->status) rays_find(&f.rays, cloud, views, view_count, err);
    for (int axis = 0; !err->status && axis < 2; axis++)
        for (int sign = -1; !err->status && sign <= 1; sign += 2) find_faces(&f, axis, sign, err);
    for (int i = 0; !err->status && i < f.face_count; i++) count_cells(&f, &f.faces[i], err);
    for (int k = 0; !err->status && k < 4; k++)
        if (!(outer[k] = find_outermost(&f, k % 2 ? 0 : 1, k < 2 ? 1 : -1))) no_wall(&f, k, err);
    if (!err->status && (outer[1]->at >= outer[3]->at || outer[0]->at >= outer[2]->at))
        err_set(err, ST_DATA,
                "the outermost walls do not enclose the points: they face away from each other; check the axes in "
                "the pictures in model/axes, or write the script by hand.");
    if (!err->status) {
        const struct box box = {{outer[1]->at, outer[0]->at}, {outer[3]->at, outer[2]->at}, {0, 1, 2, 3}};
        for (int k = 0; k < 4 && !err->status; k++) {
            array_append(&s->walls, (size_t)s->wall_count, sizeof *s->walls, "walls", err);
            if (!err->status)
                s->walls[s->wall_count++] = (struct suggested_wall){.axis = outer[k]->axis,
                                                                    .face = outer[k]->at,
                                                                    .begin = box.low[1 - outer[k]->axis],
                                                                    .end = box.high[1 - outer[k]->axis],
                                                                    .sides = {-1, -1},
                                                                    .inward = outer[k]->sign};
        }
        s->ceiling = f.height;
        if (!err->status) cut_box(s, &f, &box, err);
    }
    for (int w = 0; !err->status && w < s->wall_count; w++) openings_find(s, &f, w, err);
    for (int i = 0; i < f.face_count; i++) free(f.faces[i].cells);
    free(f.faces);
    ray_list_release(&f.rays);
    if (err->status) suggest_release(s);
    return err->status;
}
