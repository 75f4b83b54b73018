/* place_judge.c - whether the points in a rectangle show where a wall is.
 *
 * A wall without texture has few points of its own, and these are often wrong; then a plane of something else in the
 * rectangle, or of errors, has the most points. Such a wall lies metres off. What tells it from a real one:
 *   - points on the wall (within the window of positions): at least min_points, in at least MIN_CELLS of the
 *     rectangle's 8 x 8 cells, and MIN_ON_WALL of the weight of all visible points
 *   - the direction, unless the script gives it: of the weight of the points with a horizontal normal, MIN_AGREE has
 *     that of the wall; the mean of these normals is within MAX_TURN of the axis
 *   - the spread: half of the points with the wall's normal are within MAX_SPREAD of its distance from the camera
 *   - what stands before it: at most MAX_BEFORE of the weight is nearer than the wall by NEARER of its distance
 *
 * The limits come from an empty house of blank walls whose layout is known (draft depth, 120 rectangles on its walls
 * over 1 m). Without them 67 are placed: 21 within 10 cm or 5 % of their distance, 46 farther off or in another
 * direction. With them 20 and 6, five of which show a surface that stands before their wall. With its true depth 106 of
 * 107 right ones are kept. Walls with texture are far from all limits: in a simulated room the shares of points on a
 * wall and of its direction are above 0.85. */
#include "stages/build_model/place/place_judge.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "common/math/numbers.h"

enum { SIDE = 8, MIN_CELLS = 5 };
#define MIN_AGREE   0.33
#define MIN_ON_WALL 0.08
#define MAX_BEFORE  0.3
#define NEARER      0.05
#define MAX_SPREAD  0.05
#define MAX_TURN    10.0 /* degrees */

struct evidence {
    double on_wall, before; /* shares of the weight of all visible points */
    double agree;           /* share of the weight of those with a horizontal normal */
    double turn;            /* degrees between their mean normal and the wall's */
    double distance;        /* of the wall from the camera */
    int cells;              /* with points on the wall */
};

static struct evidence weigh(const struct rectangle_wall *f, const struct placer *placer)
{
    const double *n = f->wall->n, near = cos(placer->params->max_angle * DEGREE);
    const struct vec3 center = f->photo->camera.center;
    struct evidence e = {.distance = n[0] * center.x + n[1] * center.y - f->wall->c};
    double all = 0, flat = 0, agree = 0, mean[2] = {0, 0};
    bool filled[SIDE * SIDE] = {false};
    for (size_t i = 0; i < f->count; i++) {
        const struct visible_point *v = &f->visible[i];
        const struct placed_point *q = v->point;
        const double off = q->position[0] * n[0] + q->position[1] * n[1] - f->wall->c, weight = q->weight;
        all += weight;
        if (off > NEARER * e.distance) e.before += weight;
        if (hypot(q->normal[0], q->normal[1]) >= near) flat += weight;
        if (q->normal[0] * n[0] + q->normal[1] * n[1] < near) continue;
        agree += weight;
        for (int k = 0; k < 2; k++) mean[k] += weight * q->normal[k];
        if (fabs(off) > placer->window) continue;
        e.on_wall += weight;
        filled[(int)fmin(SIDE - 1, SIDE * v->v) * SIDE + (int)fmin(SIDE - 1, SIDE * v->u)] = true;
    }
    for (int i = 0; i < SIDE * SIDE; i++) e.cells += filled[i];
    e.on_wall /= fmax(all, 1e-30);
    e.before /= fmax(all, 1e-30);
    e.agree = agree / fmax(flat, 1e-30);
    e.turn = fabs(atan2(mean[1] * n[0] - mean[0] * n[1], mean[0] * n[0] + mean[1] * n[1])) / DEGREE;
    return e;
}

static enum status refuse(const struct rectangle_wall *f, const char *path, int line, struct err *err, const char *fmt,
                          ...) PRINTF_LIKE(5, 6);

static enum status refuse(const struct rectangle_wall *f, const char *path, int line, struct err *err, const char *fmt,
                          ...)
{
    const double *a = f->place->a;
    char text[600];
    va_list args;
    va_start(args, fmt);
    vsnprintf(text, sizeof text, fmt, args);
    va_end(args);
    return err_set(err, ST_DATA,
                   "%s:%d: the rectangle %.9g %.9g %.9g %.9g in %s does not show where the wall is: %s. Draw it where "
                   "the wall has texture, draw it in another photo, or place the wall by its line at the floor (wall "
                   "NAME foot in VIEW X0 Y0 X1 Y1) or by coordinates.",
                   path, line, a[0], a[1], a[2], a[3], f->photo->id, text);
}

enum status place_judge(const struct rectangle_wall *f, const struct placer *placer, const char *path, int line,
                        struct err *err)
{
    const struct evidence e = weigh(f, placer);
    const struct placed_wall *w = f->wall;
    if (w->points < (size_t)placer->params->min_points)
        return refuse(f, path, line, err,
                      "only %zu points lie on the plane that fits best, %.3g from the camera, wanted "
                      "%d or more",
                      w->points, e.distance, placer->params->min_points);
    if (e.cells < MIN_CELLS)
        return refuse(f, path, line, err,
                      "the points on the plane that fits best are in %d of the rectangle's %d parts "
                      "alone, wanted %d or more",
                      e.cells, SIDE * SIDE, MIN_CELLS);
    if (!f->is_given && e.agree < MIN_AGREE)
        return refuse(f, path, line, err,
                      "of the points on upright surfaces only %.0f %% face the direction that the "
                      "wall would have, wanted %.0f or more; the others face elsewhere",
                      100 * e.agree, 100 * MIN_AGREE);
    if (!f->is_given && !f->is_free && e.turn > MAX_TURN)
        return refuse(f, path, line, err,
                      "its points face %.0f degrees off the nearest axis, wanted %.0f or less; add "
                      "the word angled if the wall is not along an axis",
                      e.turn, MAX_TURN);
    if (w->spread > MAX_SPREAD * e.distance)
        return refuse(f, path, line, err,
                      "half of the points that face its way are %.3g or more off the plane that fits "
                      "best, which is %.3g from the camera, wanted %.0f %% of that or less",
                      w->spread, e.distance, 100 * MAX_SPREAD);
    if (e.before > MAX_BEFORE)
        return refuse(f, path, line, err,
                      "%.0f %% of the visible points stand before the plane that fits best, %.3g from "
                      "the camera, wanted %.0f or less",
                      100 * e.before, e.distance, 100 * MAX_BEFORE);
    if (e.on_wall < MIN_ON_WALL)
        return refuse(f, path, line, err,
                      "only %.1f %% of the visible points lie on the plane that fits best, %.3g from "
                      "the camera, wanted %.0f or more",
                      100 * e.on_wall, e.distance, 100 * MIN_ON_WALL);
    return ST_OK;
}
