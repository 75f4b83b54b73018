/* search_walls.c - walls from the labels of cells.
 *
 * Walls between rooms. Two faces that look away from each other bound a strip. Where the strip is outside and both of
 * its sides are inside, it is a wall; its thickness is the distance of the faces. Where the strip itself is inside for
 * the width of a door, and something solid lies above, it is a doorway of that wall. Thin strips are examined first.
 * What remains between the ends of such walls, no larger than a wall is thick, is their core.
 *
 * Outer walls. The other borders between inside and outside, along one line without a gap, are a wall that was seen
 * from one side. It is found if enough of it was seen, or if it is so short that its neighbours imply it; less is
 * enough where no camera stands behind it. The rest are doubts: what was seen ends there, and nobody knows whether a
 * wall does. A wall that passes behind the end of a wall
 * between rooms is one wall.
 *
 * Lastly, long parts of faces that are on no wall are doubts, too: a wall that was seen from afar, through a door.
 *
 * Confidence is the fraction of the wall's length that was seen, times how well the points agree: the fraction of
 * those around the face that lie on it, of which three quarters are as good as all, as furniture stands at walls. */
#include <math.h>
#include <stdlib.h>

#include "common/base/array.h"
#include "stages/suggest_model/plan_search.h"

/* As fractions of the ceiling's height: */
static const double MAX_DOOR = 0.7, MIN_BETWEEN = 0.12; /* width of a doorway, length of a wall between rooms */
static const double SIDE = 0.03;                        /* distance of the places beside a strip */
static const double STEP = 0.01;                        /* along strips and faces */
static const double MIN_THICKNESS = 0.015;
static const double SHORT = 0.3;       /* length of an outer wall that its neighbours may imply */
static const double MIN_FACE = 0.5;    /* length of a part of a face that is a doubt */
static const double SAME = 0.06;       /* distance of a face from a wall that explains it */
static const double MIN_STRETCH = 0.5; /* length of a part of a wall that nothing shows, to be mentioned */
/* As other fractions: */
static const double MIN_SOLID = 0.8;  /* of a column of a face */
static const double MIN_LINTEL = 0.3; /* of the width of a doorway: what is solid above, minus what is not */
static const double FLAT = 0.75;      /* of the points around a face */
static const double GUESSED = 0.8;    /* times the confidence of a wall whose other face is assumed */

static double flatness(const struct plan_search *p, int line)
{
    return line < p->faces->count ? fmin(1, (double)p->faces->faces[line].flat / FLAT) : 0;
}

static enum status add_wall(struct suggestion *s, const struct suggested_wall *w, struct err *err)
{
    if (array_append(&s->walls, (size_t)s->wall_count, sizeof *s->walls, "walls", err)) return err->status;
    s->walls[s->wall_count++] = *w;
    return ST_OK;
}

static enum status add_doubt(struct suggestion *s, enum doubt_kind kind, const struct wall_line *l, double begin,
                             double end, int wall, double seen, struct err *err)
{
    if (array_append(&s->doubts, (size_t)s->doubt_count, sizeof *s->doubts, "doubts", err)) return err->status;
    struct suggested_doubt *d = &s->doubts[s->doubt_count++];
    *d = (struct suggested_doubt){.kind = kind, .wall = wall, .covered = seen};
    line_point(l, begin, 0, d->a);
    line_point(l, end, 0, d->b);
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------- between rooms */

struct strip {
    int front, back; /* lines */
    double thickness;
};

static int compare_strips(const void *a, const void *b)
{
    const struct strip *x = a, *y = b;
    if (x->thickness != y->thickness) return x->thickness < y->thickness ? -1 : 1;
    if (x->front != y->front) return x->front < y->front ? -1 : 1;
    return (x->back > y->back) - (x->back < y->back);
}

static enum status find_strips(struct strip **strips, int *count, const struct plan_search *p, struct err *err)
{
    const double h = p->faces->height;
    for (int i = 0; i < p->faces->count; i++)
        for (int k = i + 1; k < p->border; k++) {
            const double thickness = p->lines[i].at + p->lines[k].at;
            if ((k >= p->faces->count && p->front_of[k] != i) || line_cosine(&p->lines[i], &p->lines[k]) > -0.998 ||
                thickness < MIN_THICKNESS * h || thickness > p->params->max_thickness * h)
                continue;
            if (array_append(strips, (size_t)*count, sizeof **strips, "walls between rooms", err)) return err->status;
            (*strips)[(*count)++] = (struct strip){i, k, thickness};
        }
    if (*count) qsort(*strips, (size_t)*count, sizeof **strips, compare_strips);
    return ST_OK;
}

/* Whether both sides of a strip are inside. */
static bool is_inside(const struct plan_search *p, const struct strip *strip, double s)
{
    const double side = SIDE * p->faces->height, across[2] = {side, -strip->thickness - side};
    for (int k = 0; k < 2; k++) {
        double at[2];
        line_point(&p->lines[strip->front], s, across[k], at);
        if (search_label_at(p, at[0], at[1]) != CELL_INSIDE) return false;
    }
    return true;
}

enum { NOT_WALL, WALL, SOLID, DOORWAY }; /* solid: by its faces, though the strip is inside there */

/* What the strip is at a place along its front line. */
static int strip_state(const struct plan_search *p, const struct strip *strip, double s)
{
    const struct wall_line *l = &p->lines[strip->front];
    double at[2];
    line_point(l, s, -0.5 * strip->thickness, at);
    const int label = search_label_at(p, at[0], at[1]);
    if (!is_inside(p, strip, s)) return NOT_WALL;
    if (label != CELL_INSIDE) return label == CELL_OUTSIDE ? WALL : NOT_WALL;
    const double front = search_solid(p, strip->front, s, s), back = search_solid(p, strip->back, -s, -s);
    return fmax(front, back) > MIN_SOLID ? SOLID : DOORWAY;
}

/* The lintel above a stretch of a strip, on its better face. */
static double lintel(const struct plan_search *p, const struct strip *strip, double begin, double end)
{
    double best = face_lintel(p->faces, &p->faces->faces[strip->front], begin, end);
    if (strip->back < p->faces->count) /* S of the other face runs backwards */
        best = fmax(best, face_lintel(p->faces, &p->faces->faces[strip->back], -end, -begin));
    return best;
}

/* Makes the strip's cells from begin to end the body of a wall. */
static void make_body(struct plan_search *p, const struct strip *strip, double begin, double end, int wall)
{
    const struct wall_line *l = &p->lines[strip->front];
    for (int c = 0; c < p->cells.cell_count; c++) {
        const double *m = p->cells.cells[c].middle;
        const double across = line_across(l, m[0], m[1]), s = line_along(l, m[0], m[1]);
        if (across > 0 || across < -strip->thickness || s < begin || s > end || p->labels[c] > CELL_INSIDE) continue;
        p->labels[c] = CELL_BODY;
        p->bodies[c] = wall;
    }
}

static enum status add_between(struct suggestion *s, struct plan_search *p, const struct strip *strip, double begin,
                               double end, struct err *err)
{
    const bool guessed = strip->back >= p->faces->count;
    const double front = search_solid(p, strip->front, begin, end), back = search_solid(p, strip->back, -end, -begin);
    struct suggested_wall w = {.line = p->lines[strip->front],
                               .angled = p->faces->faces[strip->front].angled,
                               .begin = begin,
                               .end = end,
                               .seen = {begin, end},
                               .thickness = strip->thickness,
                               .between = true,
                               .guessed = guessed,
                               .covered = guessed ? front : 0.5 * (front + back),
                               .others = {-1, -1}};
    w.confidence = guessed ? GUESSED * front * flatness(p, strip->front)
                           : 0.5 * (front * flatness(p, strip->front) + back * flatness(p, strip->back));
    if (fmax(front, back) < p->params->min_wall) return ST_OK;
    make_body(p, strip, begin, end, s->wall_count);
    return add_wall(s, &w, err);
}

/* The walls in one strip: runs of wall, and of doorways with a lintel. */
static enum status walk_strip(struct suggestion *s, struct plan_search *p, const struct strip *strip, struct err *err)
{
    const struct wall_face *front = &p->faces->faces[strip->front];
    const double step = STEP * p->faces->height, h = p->faces->height;
    const int count = (int)(front->columns * p->faces->cell / step);
    int begin = -1, wall = 0, end = 0; /* of the run; samples of it that are wall */
    for (int i = 0, next; i <= count && !err->status; i = next) {
        const int state = i < count ? strip_state(p, strip, front->first + (i + 0.5) * step) : NOT_WALL;
        for (next = i + 1; next < count; next++)
            if (strip_state(p, strip, front->first + (next + 0.5) * step) != state) break;
        const double from = front->first + i * step, to = front->first + next * step;
        if (state == WALL || state == SOLID ||
            (state == DOORWAY && to - from <= MAX_DOOR * h && lintel(p, strip, from, to) > MIN_LINTEL)) {
            if (begin < 0 && state == DOORWAY && is_inside(p, strip, from - step)) continue;
            if (begin < 0) begin = i;
            if (state != DOORWAY || !is_inside(p, strip, to + step)) end = next;
            wall += state == WALL ? next - i : 0;
            continue;
        }
        if (begin >= 0 && i < count && (next - i) * step < SIDE * h) continue; /* a gap by noise */
        if (begin >= 0 && wall * step >= MIN_BETWEEN * h)
            add_between(s, p, strip, front->first + begin * step, front->first + end * step, err);
        begin = -1;
        wall = 0;
    }
    return err->status;
}

/* Small parts of the outside that touch nothing but insides and walls between rooms become cores. */
static enum status find_cores(struct plan_search *p, struct err *err)
{
    int *stack = malloc((size_t)p->cells.edge_count * sizeof *stack);
    unsigned char *seen = calloc((size_t)p->cells.cell_count, 1);
    const double most = 1.5 * pow(p->params->max_thickness * p->faces->height, 2);
    if (!stack || !seen) err_nomem(err, "cells of a plan", (size_t)p->cells.edge_count * sizeof *stack);
    for (int c = 0; c < p->cells.cell_count && !err->status; c++) {
        if (p->labels[c] != CELL_OUTSIDE || seen[c]) continue;
        bool open = false;
        double area = 0;
        int count = 0, done = 0;
        stack[count++] = c;
        seen[c] = 1;
        while (done < count) {
            const struct plan_cell *cell = &p->cells.cells[stack[done++]];
            int e = cell->first;
            area += cell->area;
            do {
                const int twin = p->cells.edges[e].twin, other = twin < 0 ? -1 : p->cells.edges[twin].cell;
                open |= other < 0;
                if (other >= 0 && p->labels[other] == CELL_OUTSIDE && !seen[other]) {
                    seen[other] = 1;
                    stack[count++] = other;
                }
                e = p->cells.edges[e].next;
            } while (e != cell->first);
        }
        for (int k = 0; !open && area <= most && k < count; k++) p->labels[stack[k]] = CELL_CORE;
    }
    free(seen);
    free(stack);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------ outer walls */

struct border { /* an edge between inside and outside */
    int line, edge;
    bool front; /* the inside is in front of the line */
    double begin, end;
};

static int compare_borders(const void *a, const void *b)
{
    const struct border *x = a, *y = b;
    if (x->line != y->line) return x->line < y->line ? -1 : 1;
    if (x->front != y->front) return x->front ? -1 : 1;
    if (x->begin != y->begin) return x->begin < y->begin ? -1 : 1;
    return (x->edge > y->edge) - (x->edge < y->edge);
}

static enum status find_borders(struct border **borders, int *count, const struct plan_search *p, struct err *err)
{
    for (int e = 0; e < p->cells.edge_count; e++) {
        const struct cell_edge *edge = &p->cells.edges[e];
        double span[2];
        if (p->labels[edge->cell] != CELL_INSIDE ||
            (edge->twin >= 0 && p->labels[p->cells.edges[edge->twin].cell] != CELL_OUTSIDE))
            continue;
        if (array_append(borders, (size_t)*count, sizeof **borders, "borders of rooms", err)) return err->status;
        search_edge_span(p, e, span);
        (*borders)[(*count)++] = (struct border){edge->line, e, search_is_front(p, e), span[0], span[1]};
    }
    if (*count) qsort(*borders, (size_t)*count, sizeof **borders, compare_borders);
    return ST_OK;
}

/* Whether a wall between rooms ends in the gap between two borders of a line. */
static bool is_behind_wall(const struct plan_search *p, const struct border *a, const struct border *b)
{
    const double gap = b->begin - a->end, side = (a->front ? 1 : -1) * SIDE * p->faces->height;
    double at[2];
    if (gap > p->params->max_thickness * p->faces->height) return false;
    line_point(&p->lines[a->line], a->end + 0.5 * gap, side, at);
    return search_label_at(p, at[0], at[1]) == CELL_BODY;
}

/* The wall of the borders first to last, which are one run. */
static struct suggested_wall wall_of_run(const struct plan_search *p, const struct border *first,
                                         const struct border *last)
{
    const struct wall_line *l = &p->lines[first->line];
    struct suggested_wall w = {.line = *l, .begin = first->begin, .end = last->end, .others = {-1, -1}};
    const int face = p->front_of[first->line] >= 0 ? p->front_of[first->line] : first->line;
    const double step = p->faces->cell;
    double length = 0;
    w.angled = face < p->faces->count && p->faces->faces[face].angled;
    w.seen[0] = w.end;
    w.seen[1] = w.begin;
    if (!first->front) {
        w.line = (struct wall_line){{-l->n[0], -l->n[1]}, -l->at};
        w.begin = -last->end;
        w.end = -first->begin;
        return w;
    }
    for (const struct border *b = first; b <= last; b++) {
        w.covered += (b->end - b->begin) * search_solid(p, b->line, b->begin, b->end);
        length += b->end - b->begin;
    }
    for (double at = w.begin; at < w.end; at += step) {
        if (search_solid(p, first->line, at, at + step) <= 0) continue;
        w.seen[0] = fmin(w.seen[0], at);
        w.seen[1] = fmin(w.end, at + step);
    }
    w.covered = length > 0 ? w.covered / length : 0;
    w.confidence = w.covered * flatness(p, first->line);
    return w;
}

/* Mentions the long stretches of a wall that nothing shows. */
static enum status add_stretches(struct suggestion *s, const struct plan_search *p, int wall, int line, struct err *err)
{
    const struct suggested_wall *w = &s->walls[wall];
    const double step = p->faces->cell, h = p->faces->height;
    double from = w->begin;
    for (double at = w->begin; at < w->end + step && !err->status; at += step) {
        const bool ends = at >= w->end;
        if (!ends && search_solid(p, line, at, at + step) <= 0) continue;
        const double to = fmin(at, w->end);
        if (to - from >= MIN_STRETCH * h) add_doubt(s, DOUBT_STRETCH, &w->line, from, to, wall, 0, err);
        from = at + step;
    }
    return err->status;
}

/* How many views were taken from behind a wall. */
static int views_behind(const struct plan_search *p, const struct suggested_wall *w)
{
    int count = 0;
    for (int i = 0; i < p->sights->view_count; i++) {
        const struct vec3 c = p->sights->views[i].center;
        const double along = line_along(&w->line, c.x, c.y);
        count += line_across(&w->line, c.x, c.y) < 0 && along > w->begin && along < w->end;
    }
    return count;
}

/* The least fraction of a wall that must have been seen: less if no camera stands behind it. */
static double least_seen(const struct plan_search *p, const struct suggested_wall *w)
{
    return views_behind(p, w) ? p->params->min_wall : fmin(p->params->min_wall, p->params->weak_wall);
}

static enum status add_outer_walls(struct suggestion *s, struct plan_search *p, struct err *err)
{
    struct border *borders = NULL;
    int count = 0;
    const double eps = 1e-4 * p->faces->height;
    find_borders(&borders, &count, p, err);
    for (int i = 0, end; i < count && !err->status; i = end) {
        for (end = i + 1; end < count; end++) {
            const struct border *a = &borders[end - 1], *b = &borders[end];
            if (a->line != b->line || a->front != b->front || (b->begin - a->end > eps && !is_behind_wall(p, a, b)))
                break;
        }
        const struct suggested_wall w = wall_of_run(p, &borders[i], &borders[end - 1]);
        const bool is_short = w.end - w.begin < SHORT * p->faces->height;
        if (borders[i].line >= p->border || (w.covered < least_seen(p, &w) && !is_short)) {
            if (!add_doubt(s, DOUBT_BORDER, &w.line, w.begin, w.end, -1, w.covered, err))
                s->doubts[s->doubt_count - 1].views_beyond = views_behind(p, &w);
            continue;
        }
        for (int k = i; k < end; k++) {
            p->edge_walls[borders[k].edge] = s->wall_count;
            p->edge_sides[borders[k].edge] = 0;
        }
        if (!add_wall(s, &w, err) && borders[i].front) add_stretches(s, p, s->wall_count - 1, borders[i].line, err);
    }
    free(borders);
    return err->status;
}

/* The edges of inside cells at the bodies of walls between rooms. */
static void mark_bodies(const struct suggestion *s, struct plan_search *p)
{
    for (int e = 0; e < p->cells.edge_count; e++) {
        const struct cell_edge *edge = &p->cells.edges[e];
        if (p->labels[edge->cell] != CELL_INSIDE || edge->twin < 0) continue;
        const int body = p->bodies[p->cells.edges[edge->twin].cell];
        if (body < 0) continue;
        const struct suggested_wall *w = &s->walls[body];
        const double *a = edge->a, *b = cell_edge_end(&p->cells, e), m[2] = {0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])};
        const double across = line_across(&w->line, m[0], m[1]);
        const double ds = line_along(&w->line, b[0], b[1]) - line_along(&w->line, a[0], a[1]);
        const bool along = fabs(ds) > 0.7 * hypot(b[0] - a[0], b[1] - a[1]);
        p->edge_walls[e] = body;
        p->edge_sides[e] = !along ? 2 : across > -0.5 * w->thickness ? 0 : 1;
    }
}

/* ------------------------------------------------------------------------------------------------------------ rest */

/* Whether a wall explains a face at a place. */
static bool is_explained(const struct suggestion *s, const struct wall_line *l, const double at[2], double h)
{
    for (int i = 0; i < s->wall_count; i++) {
        const struct suggested_wall *w = &s->walls[i];
        const double along = line_along(&w->line, at[0], at[1]), across = line_across(&w->line, at[0], at[1]);
        if (fabs(line_cosine(l, &w->line)) < 0.9 || along < w->begin - SAME * h || along > w->end + SAME * h) continue;
        if (across < SAME * h && across > -w->thickness - SAME * h) return true;
    }
    return false;
}

static enum status add_unexplained(struct suggestion *s, const struct plan_search *p, struct err *err)
{
    const struct face_list *list = p->faces;
    for (int i = 0; i < list->count && !err->status; i++) {
        const struct wall_face *f = &list->faces[i];
        int begin = -1, end = -1;
        for (int k = 0; k <= f->columns && !err->status; k++) {
            double at[2];
            line_point(&f->line, f->first + (k + 0.5) * list->cell, 0, at);
            if (k < f->columns && f->solid[k] >= 0.5f && !is_explained(s, &f->line, at, list->height)) {
                if (begin < 0) begin = k;
                end = k + 1;
            } else if (begin >= 0 && (k == f->columns || k - end > 2)) {
                const double from = f->first + begin * list->cell, to = f->first + end * list->cell;
                if (to - from >= MIN_FACE * list->height)
                    add_doubt(s, DOUBT_FACE, &f->line, from, to, -1, face_solid(list, f, from, to), err);
                begin = -1;
            }
        }
    }
    return err->status;
}

enum status search_walls(struct suggestion *s, struct plan_search *p, struct err *err)
{
    struct strip *strips = NULL;
    int count = 0;
    find_strips(&strips, &count, p, err);
    for (int i = 0; i < count && !err->status; i++) walk_strip(s, p, &strips[i], err);
    free(strips);
    if (err->status || find_cores(p, err) || add_outer_walls(s, p, err)) return err->status;
    mark_bodies(s, p);
    return add_unexplained(s, p, err);
}
