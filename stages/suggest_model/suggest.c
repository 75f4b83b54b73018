/* suggest.c - see suggest.h. */
#include "stages/suggest_model/suggest.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"

/* Parts of the ceiling's height: heights between which walls are looked at, and how far behind a face a line of sight
 * must go on. */
static const double LOWEST = 0.04, HIGHEST = 0.92, BEYOND = 0.06;
static const double LEAST_FACE = 0.12, LEAST_OUTER = 0.25, SEEN_THROUGH = 0.9;
/* parts: of height squared; of the best face's net area; of lines of sight */
static const double FLOOR_NEAR = 0.03, LEAST_FLOOR = 0.3;
static const double MOST_HEIGHTS = 50; /* across a plan */

struct face {
    int axis, sign; /* of its normal */
    double at;
    signed char *cells; /* +1 seen, -1 seen through, 0 not known; across x up */
    int net;
};
struct finder {
    const struct point_cloud *cloud;
    const struct view *views;
    int view_count;
    const struct suggest_params *params;
    struct ray_list rays;
    double height, low[2], high[2]; /* where points are */
    struct face *faces;             /* owned */
    int face_count, across[2], up;  /* cells along x, y (along a face of the other axis) and z */
};
struct box {
    double low[2], high[2];
    int walls[4];
};

void suggestion_release(struct suggestion *s)
{
    if (!s) return;
    free(s->walls);
    free(s->openings);
    free(s->rooms);
    *s = (struct suggestion){0};
}

/* Room for one more at the end of an array; it grows where the count is a power of two. NULL: no memory. */
static void *one_more(void *array, int *count, size_t size, const char *what, struct err *err)
{
    char **items = array;
    if (!(*count & (*count - 1))) {
        const size_t bytes = (*count ? 2 * (size_t)*count : 1) * size;
        char *more = realloc(*items, bytes);
        if (!more) {
            err_nomem(err, what, bytes);
            return NULL;
        }
        *items = more;
    }
    return *items + (size_t)(*count)++ * size;
}

static double along(struct vec3 p, int axis) { return axis ? p.y : p.x; }

static bool looks_along(const struct finder *f, const struct cloud_point *p, int axis, int sign)
{
    return sign * (double)p->normal[axis] >= cos(f->params->max_angle * M_PI / 180);
}

/* The part-quantiles of the points' coordinates: a plan is where nearly all points are. */
static enum status bounds(struct finder *f, double ceiling, struct err *err)
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
        return err_set(err, ST_DATA, "no points of walls lie above the floor; look at the pictures of the axes.");
    const double c = f->params->cell * f->height;
    for (int axis = 0; axis < 2; axis++) {
        f->low[axis] -= c;
        f->high[axis] += c;
        const double cells = (f->high[axis] - f->low[axis]) / c;
        if (cells * f->params->cell > MOST_HEIGHTS)
            return err_set(err, ST_DATA,
                           "the points are spread over %.0f times the ceiling's height, which is no room.",
                           cells * f->params->cell);
        f->across[axis] = (int)cells + 1;
    }
    f->up = (int)ceil(1 / f->params->cell);
    return ST_OK;
}

/* The cell of a face of that axis, -1 outside. */
static int cell_at(const struct finder *f, int axis, double s, double z)
{
    const double c = f->params->cell * f->height;
    if (z < LOWEST * f->height || z >= HIGHEST * f->height) return -1;
    const double k = (s - f->low[1 - axis]) / c;
    if (k < 0 || k >= f->across[1 - axis]) return -1;
    return (int)k * f->up + (int)(z / c);
}

/* Peaks of how many cells have points, by position: a wall has many cells, a table's edge few, however many points. */
static enum status peaks(struct finder *f, int axis, int sign, struct err *err)
{
    const double step = f->params->window * f->height / 2;
    const int bins = (int)((f->high[axis] - f->low[axis]) / step) + 3, cells = f->across[1 - axis] * f->up;
    unsigned char *seen = calloc((size_t)cells * (size_t)bins, 1);
    int *area = calloc((size_t)bins + 2, sizeof *area);
    enum status st = seen && area ? ST_OK : err_nomem(err, "cells of walls", (size_t)cells * (size_t)bins);
    for (size_t i = 0; !st && i < f->cloud->count; i++) {
        const struct cloud_point *p = &f->cloud->points[i];
        if (!looks_along(f, p, axis, sign)) continue;
        const double bin = (along(p->position, axis) - f->low[axis]) / step;
        const int cell = cell_at(f, axis, along(p->position, 1 - axis), p->position.z);
        if (cell < 0 || bin < 1 || bin >= bins - 1) continue;
        for (int b = (int)bin - 1; b <= (int)bin + 1; b++) /* windows of three bins */
            seen[(size_t)b * (size_t)cells + (size_t)cell] = 1;
    }
    for (int b = 0; !st && b < bins; b++)
        for (int c = 0; c < cells; c++) area[b] += seen[(size_t)b * (size_t)cells + (size_t)c];
    const int least = (int)(LEAST_FACE / (f->params->cell * f->params->cell)), apart = 4;
    for (int b = 1; !st && b < bins - 1; b++) {
        bool best = area[b] >= least;
        for (int o = -apart; best && o <= apart; o++)
            if (o && b + o >= 0 && b + o < bins && (area[b + o] > area[b] || (o < 0 && area[b + o] == area[b])))
                best = false;
        if (!best) continue;
        struct face *face = one_more(&f->faces, &f->face_count, sizeof *face, "faces of walls", err);
        if (!face) {
            st = err->status;
            break;
        }
        *face = (struct face){.axis = axis, .sign = sign, .at = f->low[axis] + (b + 0.5) * step};
        for (int round = 0; round < 3; round++) { /* the mean of what gathers there */
            double sum = 0;
            size_t n = 0;
            for (size_t i = 0; i < f->cloud->count; i++) {
                const struct cloud_point *p = &f->cloud->points[i];
                const double d = along(p->position, axis) - face->at;
                if (fabs(d) < 2 * step && looks_along(f, p, axis, sign)) sum += d, n++;
            }
            if (n) face->at += sum / (double)n;
        }
    }
    free(area);
    free(seen);
    return st;
}

/* Where a line of sight crosses a plane from the side that its face looks to, and goes on. */
static bool crosses(const struct finder *f, const struct ray *r, int axis, int sign, double at, double *s, double *z)
{
    const struct vec3 a = f->views[r->view].center, b = f->cloud->points[r->point].position;
    const double from = sign * (along(a, axis) - at), to = sign * (along(b, axis) - at);
    if (from <= 0 || to > -BEYOND * f->height) return false;
    const double t = from / (from - to);
    *s = along(a, 1 - axis) + t * (along(b, 1 - axis) - along(a, 1 - axis));
    *z = a.z + t * (b.z - a.z);
    return true;
}

static enum status look_at_face(struct finder *f, struct face *face, struct err *err)
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
            if (c >= 0 && looks_along(f, p, face->axis, face->sign)) votes[c]++;
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

/* Cells that are seen less those that are seen through, as a part of those from begin to end. */
static double part_seen(const struct finder *f, const struct face *face, double begin, double end)
{
    const double c = f->params->cell * f->height;
    const int other = 1 - face->axis;
    int first = (int)ceil((begin - f->low[other]) / c), last = (int)floor((end - f->low[other]) / c), net = 0;
    if (first < 0) first = 0;
    if (last > f->across[other]) last = f->across[other];
    if (last <= first) return -1;
    for (int k = first; k < last; k++)
        for (int z = 0; z < f->up; z++) net += face->cells[k * f->up + z];
    return net / ((last - first) * (HIGHEST - LOWEST) / f->params->cell);
}

/* What is seen through another wall's windows alone is a yard or a house opposite, no wall of this plan. */
static bool is_beyond(const struct finder *f, const struct face *face, const struct face *nearer)
{
    size_t all = 0, through = 0;
    double s, z;
    for (size_t i = 0; i < f->rays.count; i++) {
        const struct cloud_point *p = &f->cloud->points[f->rays.rays[i].point];
        if (fabs(along(p->position, face->axis) - face->at) > 2 * f->params->window * f->height ||
            !looks_along(f, p, face->axis, face->sign))
            continue;
        all++;
        through += crosses(f, &f->rays.rays[i], face->axis, face->sign, nearer->at, &s, &z);
    }
    return (double)through > SEEN_THROUGH * (double)all;
}

static bool is_candidate(const struct face *face, int axis, int sign, int best)
{
    return face->axis == axis && face->sign == sign && face->net > LEAST_OUTER * best;
}

/* The outermost face that looks inwards, is no less seen than a part of the most seen one, and not through another. */
static const struct face *outermost(const struct finder *f, int axis, int sign)
{
    int best = 0;
    for (int i = 0; i < f->face_count; i++)
        if (f->faces[i].axis == axis && f->faces[i].sign == sign && f->faces[i].net > best) best = f->faces[i].net;
    const struct face *found = NULL;
    for (int i = 0; i < f->face_count; i++) {
        const struct face *a = &f->faces[i];
        if (!is_candidate(a, axis, sign, best)) continue;
        bool beyond = found && sign * (found->at - a->at) <= 0;
        for (int k = 0; !beyond && k < f->face_count; k++) {
            const struct face *b = &f->faces[k];
            beyond = is_candidate(b, axis, sign, best) && sign * (b->at - a->at) > 0 && is_beyond(f, a, b);
        }
        if (!beyond) found = a;
    }
    return found;
}

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
        if (fabs(p->position.z) > FLOOR_NEAR * f->height || p->normal[2] < 0.9f || x < 0 || y < 0 || x >= w || y >= h)
            continue;
        unsigned char *cell = &seen[(size_t)y * (size_t)w + (size_t)x];
        count += !*cell;
        *cell = 1;
    }
    free(seen);
    if (count > LEAST_FLOOR * w * h) *found = true;
    return ST_OK;
}

/* Cuts a box in two at the wall that is most seen from both sides, and its parts likewise. */
static enum status cut(struct suggestion *s, const struct finder *f, const struct box *box, struct err *err)
{
    const struct face *best[2] = {NULL, NULL};
    double most = f->params->least_wall;
    for (int i = 0; i < f->face_count; i++)
        for (int k = 0; k < f->face_count; k++) {
            const struct face *a = &f->faces[i], *b = &f->faces[k];
            const int axis = a->axis, other = 1 - axis;
            const double narrow = f->params->narrowest * f->height, thick = b->at - a->at;
            if (b->axis != axis || a->sign > 0 || b->sign < 0 || thick < 2 * f->params->window * f->height ||
                thick > f->params->thickest * f->height || a->at < box->low[axis] + narrow ||
                b->at > box->high[axis] - narrow)
                continue;
            const double pa = part_seen(f, a, box->low[other], box->high[other]);
            const double pb = part_seen(f, b, box->low[other], box->high[other]);
            if (fmin(pa, pb) > most) {
                most = fmin(pa, pb);
                best[0] = a;
                best[1] = b;
            }
        }
    /* a wall that only one side shows: as thick as walls usually are */
    for (int i = 0; !best[1] && i < f->face_count; i++) {
        const struct face *a = &f->faces[i];
        const double away = (f->params->narrowest + WALL_THICKNESS) * f->height;
        const double part = part_seen(f, a, box->low[1 - a->axis], box->high[1 - a->axis]);
        if (a->at < box->low[a->axis] + away || a->at > box->high[a->axis] - away || part <= most) continue;
        most = part;
        best[0] = a;
    }
    if (!best[0]) {
        struct plan_room *room = one_more(&s->rooms, &s->room_count, sizeof *room, "rooms", err);
        if (!room) return err->status;
        memcpy(room->walls, box->walls, sizeof room->walls);
        return is_free(&room->free, f, box, err);
    }
    const int axis = best[0]->axis, wall = s->wall_count;
    const int low_side = axis ? 0 : 1, high_side = axis ? 2 : 3; /* south and north, or west and east */
    const double guess = WALL_THICKNESS * f->height;
    const double first = best[1] || best[0]->sign < 0 ? best[0]->at : best[0]->at - guess;
    const double second = best[1] ? best[1]->at : first + guess;
    struct plan_wall *w = one_more(&s->walls, &s->wall_count, sizeof *w, "walls", err);
    if (!w) return err->status;
    *w = (struct plan_wall){
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
    return cut(s, f, &low, err) ? err->status : cut(s, f, &high, err);
}

/* ---------------------------------------------------------------------------------------------------------- openings */

struct sheet { /* a wall in fine cells */
    int across, up;
    int *solid, *open; /* points on it, lines of sight through it */
};

static void sheet_release(struct sheet *t)
{
    free(t->solid);
    free(t->open);
}

static enum status sheet_make(struct sheet *t, const struct finder *f, const struct plan_wall *w, struct err *err)
{
    const double c = f->params->window * f->height;
    t->across = (int)((w->end - w->begin) / c) + 1;
    t->up = (int)(1 / f->params->window) + 1;
    const size_t cells = (size_t)t->across * (size_t)t->up;
    t->solid = calloc(cells, sizeof *t->solid);
    t->open = calloc(cells, sizeof *t->open);
    if (!t->solid || !t->open) return err_nomem(err, "a wall's cells", 2 * cells * sizeof *t->open);
    for (int side = 0; side < (w->thickness > 0 ? 2 : 1); side++) {
        const int sign = side ? -w->inward : w->inward;
        const double at = w->face - (side ? w->inward * w->thickness : 0);
        for (size_t i = 0; i < f->rays.count; i++) {
            const struct ray *r = &f->rays.rays[i];
            const struct cloud_point *p = &f->cloud->points[r->point];
            double s, z, unused[2];
            int *count = t->solid;
            const double behind = sign * (at - along(p->position, w->axis));
            const double within = w->thickness > 0 ? w->thickness : WALL_THICKNESS * f->height;
            const bool on = fabs(behind) < 2 * c && looks_along(f, p, w->axis, sign);
            if (on || (behind > c && behind < within - c && !looks_along(f, p, w->axis, sign))) { /* or a reveal */
                s = along(p->position, 1 - w->axis);
                z = p->position.z;
            } else if (crosses(f, r, w->axis, sign, at, &s, &z) &&
                       crosses(f, r, w->axis, sign, at - sign * w->thickness, &unused[0], &unused[1]))
                count = t->open;
            else
                continue;
            const double x = (s - w->begin) / c, y = z / c;
            if (x >= 0 && x < t->across && y >= 0 && y < t->up) count[(size_t)x * (size_t)t->up + (size_t)y]++;
        }
    }
    return ST_OK;
}

/* More open than solid cells, and enough of them to tell: +1; more solid ones: -1. */
static int column_state(const struct sheet *t, int first, int last, int low, int high)
{
    int open = 0, solid = 0;
    for (int x = first; x < last; x++)
        for (int y = low; y < high; y++) {
            const int i = x * t->up + y;
            open += t->open[i] > t->solid[i];
            solid += t->solid[i] > 0 && t->solid[i] >= t->open[i];
        }
    if (10 * (open + solid) < (last - first) * (high - low)) return 0;
    return open > solid ? 1 : -1;
}

/* The next run of open columns (rows of the columns first..last if up) from *begin on; gaps of unknown ones are open. */
static bool next_run(const struct sheet *t, bool up, int first, int last, int *begin, int *end)
{
    const int n = up ? t->up : t->across;
    bool in = false;
    for (int i = *begin; i < n; i++) {
        const int state = up ? column_state(t, first, last, i, i + 1)
                             : column_state(t, i, i + 1, (int)(0.1 * t->up), (int)(0.7 * t->up));
        if (state > 0) {
            if (!in) *begin = i;
            in = true;
            *end = i + 1;
        } else if (in && (state < 0 || i - *end > 3)) {
            /* a single solid column in the open is a leg or a lamp */
            const int after = i + 1 < n ? (up ? column_state(t, first, last, i + 1, i + 2)
                                              : column_state(t, i + 1, i + 2, (int)(0.1 * t->up), (int)(0.7 * t->up)))
                                        : -1;
            if (after <= 0) return true;
        }
    }
    return in;
}

/* Lines of sight tell where an opening is, points of the wall where it ends: each of its sides goes on over cells that
 * nobody saw (sky, dark corners) to where most cells are solid, and stays if no such place comes. */
static void grow(const struct sheet *t, int rect[4])
{
    for (int side = 0; side < 4; side++) { /* begin, foot, end, top */
        const int step = side < 2 ? -1 : 1, limit = side < 2 ? 0 : (side == 2 ? t->across : t->up * 92 / 100);
        const int other = side % 2 ? 0 : 1;
        for (int at = rect[side]; at != limit; at += step) {
            int solid = 0;
            const int line = step < 0 ? at - 1 : at;
            for (int k = rect[other]; k < rect[other + 2]; k++)
                solid += t->solid[side % 2 ? k * t->up + line : line * t->up + k] > 0;
            if (2 * solid < rect[other + 2] - rect[other]) continue;
            rect[side] = at;
            break;
        }
    }
}

static enum status openings_of(struct suggestion *s, const struct finder *f, int wall, struct err *err)
{
    const struct plan_wall *w = &s->walls[wall];
    const double c = f->params->window * f->height, narrow = f->params->narrowest * f->height;
    struct sheet t = {0};
    int begin = 0, end = 0;
    enum status st = sheet_make(&t, f, w, err);
    while (!st && next_run(&t, false, 0, 0, &begin, &end)) {
        int low = 0, high = 0, best[2] = {0, 0};
        if ((end - begin) * c >= narrow)
            for (; next_run(&t, true, begin, end, &low, &high); low = high + 1)
                if (high - low > best[1] - best[0]) best[0] = low, best[1] = high;
        if ((best[1] - best[0]) * c >= narrow) {
            int rect[4] = {begin, best[0], end, best[1]};
            grow(&t, rect);
            const bool window = rect[1] * c > 0.15 * f->height;
            struct plan_opening *o = one_more(&s->openings, &s->opening_count, sizeof *o, "openings", err);
            if (!o) {
                st = err->status;
                break;
            }
            *o = (struct plan_opening){
                wall, w->begin + rect[0] * c, w->begin + rect[2] * c, window ? rect[1] * c : 0, rect[3] * c, window};
            if (rect[2] > end) end = rect[2];
        }
        begin = end + 1;
    }
    sheet_release(&t);
    return st;
}

enum status suggest_plan(struct suggestion *s, const struct point_cloud *cloud, const struct view *views,
                         int view_count, double ceiling, const struct suggest_params *params, struct err *err)
{
    static const char *const SIDES[] = {"-y", "-x", "+y", "+x"};
    struct finder f = {.cloud = cloud, .views = views, .view_count = view_count, .params = params};
    const struct face *outer[4];
    *s = (struct suggestion){0};
    enum status st = cloud->count ? bounds(&f, ceiling, err) : err_set(err, ST_DATA, "there are no points.");
    if (!st) st = rays_find(&f.rays, cloud, views, view_count, err);
    for (int axis = 0; !st && axis < 2; axis++)
        for (int sign = -1; !st && sign <= 1; sign += 2) st = peaks(&f, axis, sign, err);
    for (int i = 0; !st && i < f.face_count; i++) st = look_at_face(&f, &f.faces[i], err);
    for (int k = 0; !st && k < 4; k++)
        if (!(outer[k] = outermost(&f, k % 2 ? 0 : 1, k < 2 ? 1 : -1)))
            st = err_set(err, ST_DATA,
                         "no wall is seen on the side of %s of the model's frame; write the script by hand.", SIDES[k]);
    if (!st && (outer[1]->at >= outer[3]->at || outer[0]->at >= outer[2]->at))
        st = err_set(err, ST_DATA, "no four walls stand around the points; write the script by hand.");
    if (!st) {
        const struct box box = {{outer[1]->at, outer[0]->at}, {outer[3]->at, outer[2]->at}, {0, 1, 2, 3}};
        for (int k = 0; k < 4 && !st; k++) {
            struct plan_wall *w = one_more(&s->walls, &s->wall_count, sizeof *w, "walls", err);
            if (!w)
                st = err->status;
            else
                *w = (struct plan_wall){.axis = outer[k]->axis,
                                        .face = outer[k]->at,
                                        .begin = box.low[1 - outer[k]->axis],
                                        .end = box.high[1 - outer[k]->axis],
                                        .sides = {-1, -1},
                                        .inward = outer[k]->sign};
        }
        s->ceiling = f.height;
        if (!st) st = cut(s, &f, &box, err);
    }
    for (int w = 0; !st && w < s->wall_count; w++) st = openings_of(s, &f, w, err);
    for (int i = 0; i < f.face_count; i++) free(f.faces[i].cells);
    free(f.faces);
    ray_list_release(&f.rays);
    if (st) suggestion_release(s);
    return st;
}
