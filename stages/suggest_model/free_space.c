/* free_space.c - free space from lines of sight.
 *
 * Each line of sight passes through cells of the plan, at one of eight levels of height. It ends a little before its
 * point, by more where that is far away, because depth is noisy. A level is free where two lines or more pass: one may
 * lead to a stray point. A line of sight ends where it leaves through a window, so
 * that the yard does not become a room. */
#include "stages/suggest_model/free_space.h"

#include <math.h>
#include <stdlib.h>

static const double EDGE = 0.02, SHORTEN = 0.02; /* of the ceiling's height */
static const double NOISE = 0.02;                /* of a point's distance: by which its line of sight ends before it */
static const double SILL = 0.25;                 /* of the ceiling's height: below windows */
static const double LOW = 0.04, HIGH = 0.96;     /* range of heights, of the ceiling's */
enum { MIN_COUNT = 2 };

void free_space_release(struct free_space *f)
{
    if (!f) return;
    free(f->counts);
    *f = (struct free_space){0};
}

/* Whether a column of a face is solid near the floor and near the ceiling, so that what is open is a window. */
static bool has_sill(const struct face_list *list, const struct wall_face *face, int column)
{
    int state = 0;
    for (int z = 0; z < SILL * list->up; z++) state += face->cells[column * list->up + z];
    return state > 0 && face->lintel[column] > 0;
}

/* The part of a line of sight, 0 .. 1, until it leaves through a window. */
static double part_inside(const struct face_list *list, const struct sights *sights, const struct ray *r)
{
    const struct vec3 a = sights->views[r->view].center, b = sights->points.cloud.points[r->point].position;
    double part = 1;
    for (int i = 0; i < list->count; i++) {
        const struct wall_face *face = &list->faces[i];
        const double from = line_across(&face->line, a.x, a.y), to = line_across(&face->line, b.x, b.y);
        double s, z;
        if (from / (from - to) >= part || !sight_crosses(sights, r, &face->line, list->height, &s, &z)) continue;
        const int column = (int)floor((s - face->first) / list->cell);
        if (column >= 0 && column < face->columns && has_sill(list, face, column)) part = from / (from - to);
    }
    return part;
}

static void add_ray(struct free_space *f, struct vec3 a, struct vec3 b, double height, double part)
{
    const double length = vec3_length(vec3_sub(b, a));
    const double kept = fmin(part, 1 - NOISE - SHORTEN * height / fmax(length, 1e-12));
    const double flat = hypot(b.x - a.x, b.y - a.y);
    const int steps = (int)(kept * flat / (0.5 * f->edge));
    unsigned char *last = NULL;
    for (int i = 0; i <= steps; i++) {
        const double t = kept * (i + 0.5) / (steps + 1);
        const double x = (a.x + t * (b.x - a.x) - f->low[0]) / f->edge;
        const double y = (a.y + t * (b.y - a.y) - f->low[1]) / f->edge;
        const double z = ((a.z + t * (b.z - a.z)) / height - LOW) / (HIGH - LOW) * FREE_LEVELS;
        if (!(x >= 0 && y >= 0 && z >= 0 && x < f->size[0] && y < f->size[1] && z < FREE_LEVELS)) continue;
        unsigned char *cell = &f->counts[((size_t)y * (size_t)f->size[0] + (size_t)x) * FREE_LEVELS + (size_t)z];
        if (cell != last && *cell < 255) (*cell)++;
        last = cell;
    }
}

enum status free_space_find(struct free_space *f, const struct face_list *list, const struct sights *sights,
                            struct err *err)
{
    *f = (struct free_space){.low = {list->low[0], list->low[1]}, .edge = EDGE * list->height};
    for (int k = 0; k < 2; k++) f->size[k] = (int)((list->high[k] - list->low[k]) / f->edge) + 1;
    const size_t count = (size_t)f->size[0] * (size_t)f->size[1] * FREE_LEVELS;
    f->counts = calloc(count, 1);
    if (!f->counts) return err_nomem(err, "free space", count);
    for (size_t i = 0; i < sights->rays.count; i++) {
        const struct ray *r = &sights->rays.rays[i];
        add_ray(f, sights->views[r->view].center, sights->points.cloud.points[r->point].position, list->height,
                part_inside(list, sights, r));
    }
    return ST_OK;
}

double free_space_at(const struct free_space *f, double x, double y)
{
    const double u = (x - f->low[0]) / f->edge, v = (y - f->low[1]) / f->edge;
    int free_levels = 0;
    if (!(u >= 0 && v >= 0 && u < f->size[0] && v < f->size[1])) return 0;
    const unsigned char *counts = &f->counts[((size_t)v * (size_t)f->size[0] + (size_t)u) * FREE_LEVELS];
    for (int k = 0; k < FREE_LEVELS; k++) free_levels += counts[k] >= MIN_COUNT;
    return (double)free_levels / FREE_LEVELS;
}
