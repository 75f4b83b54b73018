/* place.c - see place.h.
 *
 * A wall by a rectangle (thesis 4.4.2): of the points that the rectangle shows, those whose normals are near one of the
 * four canonical directions vote for it; along the winner the densest window of positions is the wall, refined to
 * the weighted mean of what lies in it. What the camera cannot see is left out first: points that turn away from it,
 * and points behind others (the rectangle is cut into cells, in each of which what is farther than the front by a
 * part of its distance is hidden). */
#include "stages/build_model/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"

enum { CELLS = 24, IN_CELL = 60 }; /* each way at most; points in a cell, about, at least */
#define DEGREE     (3.14159265358979323846 / 180)
#define BEHIND     1.08 /* of the front's distance: farther is hidden */
#define FRONT_PART 0.05 /* of a cell's points are before its front: stray ones */
#define GRAZING    0.02 /* least cosine at which a ray meets a plane at a place */

void placer_release(struct placer *placer)
{
    if (!placer) return;
    free(placer->photos);
    free(placer->points);
    *placer = (struct placer){0};
}

static struct photo_camera model_camera(const struct photo_camera *world, const struct model_axes *axes)
{
    struct photo_camera c = *world;
    c.cam_from_world = mat3_multiply(world->cam_from_world, mat3_transpose(mat3_from_quat(axes->rotation)));
    c.center = model_from_world_point(axes, world->center);
    c.translation = vec3_scale(mat3_apply(c.cam_from_world, c.center), -1);
    return c;
}

enum status placer_init(struct placer *placer, const struct camera_set *set, const struct lens_list *lenses,
                        const struct model_axes *axes, const struct point_cloud *points,
                        const struct model_params *params, struct err *err)
{
    const size_t count = points ? points->count : 0;
    *placer = (struct placer){.lenses = lenses, .params = params, .count = count};
    placer->photos = calloc((size_t)lenses->count + 1, sizeof *placer->photos);
    placer->points = calloc(count + 1, sizeof *placer->points);
    if (!placer->photos || !placer->points) {
        placer_release(placer);
        return err_nomem(err, "the points of a model", count * sizeof *placer->points);
    }
    for (int i = 0; i < lenses->count; i++) {
        const struct lens *lens = &lenses->lenses[i];
        struct photo_camera camera;
        bool known = camera_set_find(set, lens->view) < 0;
        for (int k = 0; k < placer->photo_count; k++) known |= !strcmp(placer->photos[k].id, lens->photo);
        if (known) continue;
        if (photo_camera_find(&camera, lens->view, set, lenses, "lenses.txt", 0, err)) {
            placer_release(placer);
            return err->status;
        }
        placer->photos[placer->photo_count++] = (struct placer_photo){lens->photo, model_camera(&camera, axes)};
    }
    for (size_t i = 0; i < count; i++) {
        const struct cloud_point *p = &points->points[i];
        const struct vec3 at = model_from_world_point(axes, p->position);
        const struct vec3 n = model_from_world_direction(axes, vec3_make(p->normal[0], p->normal[1], p->normal[2]));
        placer->points[i] = (struct placed_point){
            {(float)at.x, (float)at.y, (float)at.z}, {(float)n.x, (float)n.y, (float)n.z}, p->confidence};
    }
    placer->step = params->window * (axes->ceiling > 0 ? axes->ceiling : 2.5);
    return ST_OK;
}

static const char *known_photo(const void *ctx, int i)
{
    const struct lens_list *lenses = ctx;
    if (i >= 2 * lenses->count) return NULL;
    return i % 2 ? lenses->lenses[i / 2].view : lenses->lenses[i / 2].photo;
}

/* By a photo's id or a view's name. */
static enum status find_photo(const struct placer_photo **found, const struct placer *placer, const char *view,
                              const char *path, int line, struct err *err)
{
    const char *photo = view;
    const int at = lens_list_find(placer->lenses, view);
    char shown[SCAN_SHOWN];
    if (at >= 0) photo = placer->lenses->lenses[at].photo;
    for (int i = 0; i < placer->photo_count; i++)
        if (!strcmp(placer->photos[i].id, photo)) {
            *found = &placer->photos[i];
            return ST_OK;
        }
    const char *near = scan_nearest(view, known_photo, placer->lenses);
    scan_show(shown, view);
    if (near)
        return err_set(err, ST_DATA, "%s:%d: found %s, wanted a photo's id or a view's name; did you mean %s?", path,
                       line, shown, near);
    return err_set(err, ST_DATA, "%s:%d: found %s, wanted a photo's id or a view's name, as lenses.txt has them.", path,
                   line, shown);
}

static enum status check_pixels(const struct placer_photo *c, const struct script_place *p, const char *path, int line,
                                struct err *err)
{
    if (p->a[0] >= 0 && p->a[1] >= 0 && p->a[2] <= c->camera.lens.width && p->a[3] <= c->camera.lens.height)
        return ST_OK;
    return err_set(
        err, ST_DATA,
        "%s:%d: the rectangle %.9g %.9g %.9g %.9g is not inside the photo %s, which has %d x %d pixels as it is "
        "stored.",
        path, line, p->a[0], p->a[1], p->a[2], p->a[3], c->id, c->camera.lens.width, c->camera.lens.height);
}

/* The ray through a pixel, in the model. */
static enum status pixel_ray(struct vec3 *ray, const struct placer_photo *c, double x, double y, const char *path,
                             int line, struct err *err)
{
    struct vec3 r;
    if (!camera_unproject(&c->camera.lens, x, y, &r))
        return err_set(err, ST_DATA, "%s:%d: the lens of %s has no ray at pixel %.9g %.9g; choose another place.", path,
                       line, c->id, x, y);
    *ray = mat3_apply(mat3_transpose(c->camera.cam_from_world), r);
    return ST_OK;
}

static enum status meet_plane(struct vec3 *at, const struct placer_photo *c, double x, double y, struct vec3 n,
                              double d, const char *path, int line, struct err *err)
{
    struct vec3 ray = {0, 0, 0};
    if (pixel_ray(&ray, c, x, y, path, line, err)) return err->status;
    const double down = -vec3_dot(n, ray), height = vec3_dot(n, c->camera.center) - d;
    if (!(height > 0 && down > GRAZING))
        return err_set(err, ST_DATA,
                       "%s:%d: what pixel %.9g %.9g of %s shows does not lie on it: the ray %s; choose another photo.",
                       path, line, x, y, c->id,
                       height > 0 ? "passes it, or meets it at too low an angle" : "starts behind it");
    *at = vec3_add(c->camera.center, vec3_scale(ray, height / down));
    return ST_OK;
}

enum status place_corners(struct vec3 corners[2], const struct placer *placer, const struct script_place *place, struct vec3 n,
                          double d, const char *path, int line, struct err *err)
{
    const struct placer_photo *c;
    if (find_photo(&c, placer, place->view, path, line, err) || check_pixels(c, place, path, line, err) ||
        meet_plane(&corners[0], c, place->a[0], place->a[1], n, d, path, line, err) ||
        meet_plane(&corners[1], c, place->a[2], place->a[3], n, d, path, line, err))
        return err->status;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------- what a rectangle shows */

struct shown_point {
    const struct placed_point *point;
    double distance;
    float u, v; /* in the rectangle, 0 .. 1 */
    int cell;
};

static int compare_shown(const void *a, const void *b)
{
    const struct shown_point *x = a, *y = b;
    if (x->cell != y->cell) return x->cell - y->cell;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    return x->point < y->point ? -1 : x->point > y->point;
}

/* A cone about the rectangle, that a point outside of does not need the lens for. */
static double cone(const struct placer_photo *c, const struct script_place *p, struct vec3 *axis)
{
    double least = 1;
    if (!camera_unproject(&c->camera.lens, 0.5 * (p->a[0] + p->a[2]), 0.5 * (p->a[1] + p->a[3]), axis)) return -1;
    for (int i = 0; i < 9; i++) {
        struct vec3 ray = {0, 0, 0};
        if (i == 4) continue;
        if (!camera_unproject(&c->camera.lens, p->a[0] + (p->a[2] - p->a[0]) * (i % 3) / 2,
                              p->a[1] + (p->a[3] - p->a[1]) * (i / 3) / 2, &ray))
            return -1;
        least = fmin(least, vec3_dot(ray, *axis));
    }
    return cos(fmin(acos(fmax(-1, least)) * 1.1 + 0.01, 3.14));
}

/* shown: those that the camera sees in the rectangle. */
static enum status show_points(struct shown_point **shown, size_t *count, const struct placer *placer,
                               const struct placer_photo *c, const struct script_place *p, struct err *err)
{
    struct vec3 axis;
    const double wide = cone(c, p, &axis);
    const struct mat3 turn = c->camera.cam_from_world;
    size_t room = 0;
    *shown = NULL;
    *count = 0;
    for (size_t i = 0; i < placer->count; i++) {
        const struct placed_point *q = &placer->points[i];
        const struct vec3 at = vec3_make(q->position[0], q->position[1], q->position[2]);
        const struct vec3 to = vec3_sub(at, c->camera.center);
        if (!(to.x * q->normal[0] + to.y * q->normal[1] + to.z * q->normal[2] < 0)) continue;
        const struct vec3 cam = mat3_apply(turn, to);
        const double distance = vec3_length(cam);
        double u, v;
        if (vec3_dot(cam, axis) < wide * distance || !camera_project(&c->camera.lens, cam, &u, &v)) continue;
        if (!(u >= p->a[0] && u < p->a[2] && v >= p->a[1] && v < p->a[3])) continue;
        if (*count == room) {
            room = room ? 2 * room : 1024;
            struct shown_point *more = realloc(*shown, room * sizeof *more);
            if (!more) return err_nomem(err, "points of a rectangle", room * sizeof *more);
            *shown = more;
        }
        (*shown)[(*count)++] = (struct shown_point){q, distance, (float)((u - p->a[0]) / (p->a[2] - p->a[0])),
                                                    (float)((v - p->a[1]) / (p->a[3] - p->a[1])), 0};
    }
    /* where points are few cells are larger, so that a cell with points behind a sparse wall has some of the wall
     * too */
    const int cells = (int)fmax(1, fmin(CELLS, sqrt((double)*count / IN_CELL)));
    for (size_t i = 0; i < *count; i++) {
        const int x = (int)((*shown)[i].u * (float)cells), y = (int)((*shown)[i].v * (float)cells);
        (*shown)[i].cell = (y < cells ? y : cells - 1) * cells + (x < cells ? x : cells - 1);
    }
    if (*count) qsort(*shown, *count, sizeof **shown, compare_shown);
    size_t kept = 0;
    for (size_t from = 0, end; from < *count; from = end) {
        for (end = from; end < *count && (*shown)[end].cell == (*shown)[from].cell;) end++;
        const double front = (*shown)[from + (size_t)(FRONT_PART * (double)(end - from))].distance;
        for (size_t i = from; i < end; i++)
            if ((*shown)[i].distance <= front * BEHIND) (*shown)[kept++] = (*shown)[i];
    }
    *count = kept;
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------- where a wall is */

struct position {
    double at, weight;
};

static int compare_positions(const void *a, const void *b)
{
    const struct position *x = a, *y = b;
    if (x->at != y->at) return x->at < y->at ? -1 : 1;
    return (x->weight > y->weight) - (x->weight < y->weight);
}

/* Positions sorted: the middle of the heaviest window, then the mean of what lies in the window about it. */
static double mode(const struct position *p, size_t count, double window)
{
    double sum = 0, most = -1, at = 0;
    for (size_t i = 0, from = 0; i < count; i++) {
        sum += p[i].weight;
        while (p[i].at - p[from].at > window) sum -= p[from++].weight;
        if (sum > most) {
            most = sum;
            at = 0.5 * (p[i].at + p[from].at);
        }
    }
    for (int round = 0; round < 8; round++) {
        double weight = 0, moment = 0;
        for (size_t i = 0; i < count; i++)
            if (fabs(p[i].at - at) <= window) {
                weight += p[i].weight;
                moment += p[i].weight * p[i].at;
            }
        if (!(weight > 0)) break;
        at = moment / weight;
    }
    return at;
}

static enum status too_few(const struct placer_photo *c, const struct script_place *p, const char *path, int line,
                           size_t found, int wanted, const char *what, struct err *err)
{
    return err_set(
        err, ST_DATA,
        "%s:%d: the rectangle %.9g %.9g %.9g %.9g of %s shows %zu points%s, wanted %d or more; draw it larger, "
        "or in another photo, or give the wall by coordinates.",
        path, line, p->a[0], p->a[1], p->a[2], p->a[3], c->id, found, what, wanted);
}

/* The direction that most normals have, horizontal: the canonical one, or, for an angled wall, the mean about the
 * fullest five degrees. False: none has a horizontal normal. */
static bool vote(double n[2], const struct shown_point *shown, size_t count, double max_angle, bool angled)
{
    enum { BINS = 72 };
    const double upright = cos(max_angle * DEGREE);
    double bins[BINS] = {0}, axes[4] = {0};
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = shown[i].point;
        const double flat = hypot(q->normal[0], q->normal[1]);
        if (flat < upright) continue;
        const double turn = atan2(q->normal[1], q->normal[0]);
        const int axis = ((int)floor(turn / (90 * DEGREE) + 0.5) + 4) % 4;
        if (fabs(remainder(turn - axis * 90 * DEGREE, 360 * DEGREE)) <= max_angle * DEGREE) axes[axis] += q->weight;
        bins[((int)floor(turn / (360 * DEGREE) * BINS) + BINS) % BINS] += q->weight;
    }
    if (!angled) {
        static const double directions[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
        int best = 0;
        for (int i = 1; i < 4; i++)
            if (axes[i] > axes[best]) best = i;
        memcpy(n, directions[best], sizeof directions[best]);
        return axes[best] > 0;
    }
    int best = 0;
    for (int i = 1; i < BINS; i++)
        if (bins[i] > bins[best]) best = i;
    if (!(bins[best] > 0)) return false;
    const double middle = (best + 0.5) * 360 * DEGREE / BINS;
    double sum[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = shown[i].point;
        const double turn = atan2(q->normal[1], q->normal[0]);
        if (hypot(q->normal[0], q->normal[1]) < upright || fabs(remainder(turn - middle, 360 * DEGREE)) > 10 * DEGREE)
            continue;
        for (int k = 0; k < 2; k++) sum[k] += q->weight * q->normal[k];
    }
    const double length = hypot(sum[0], sum[1]);
    for (int k = 0; k < 2; k++) n[k] = sum[k] / length;
    return length > 0;
}

/* Positions along n of the points whose normals are within max_angle of it, sorted. */
static size_t gather(struct position *p, const struct shown_point *shown, size_t count, const double n[2],
                     double max_angle)
{
    const double near = cos(max_angle * DEGREE);
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = shown[i].point;
        if (q->normal[0] * n[0] + q->normal[1] * n[1] >= near)
            p[used++] = (struct position){q->position[0] * n[0] + q->position[1] * n[1], q->weight};
    }
    if (used) qsort(p, used, sizeof *p, compare_positions);
    return used;
}

/* Turns n to the line that fits the points within `window` of it best (plan, total least squares). */
static void fit_line(double n[2], double c, const struct shown_point *shown, size_t count, double max_angle,
                     double window)
{
    const double near = cos(max_angle * DEGREE);
    double weight = 0, mean[2] = {0, 0}, xx = 0, xy = 0, yy = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < count; i++) {
            const struct placed_point *q = shown[i].point;
            const double x = q->position[0], y = q->position[1];
            if (q->normal[0] * n[0] + q->normal[1] * n[1] < near || fabs(x * n[0] + y * n[1] - c) > window) continue;
            if (pass == 0) {
                weight += q->weight;
                mean[0] += q->weight * x;
                mean[1] += q->weight * y;
            } else {
                xx += q->weight * (x - mean[0]) * (x - mean[0]);
                xy += q->weight * (x - mean[0]) * (y - mean[1]);
                yy += q->weight * (y - mean[1]) * (y - mean[1]);
            }
        }
        if (!(weight > 0)) return;
        if (pass == 0) mean[0] /= weight, mean[1] /= weight;
    }
    const double along = 0.5 * atan2(2 * xy, xx - yy);
    double fitted[2] = {-sin(along), cos(along)};
    if (fitted[0] * n[0] + fitted[1] * n[1] < 0) fitted[0] = -fitted[0], fitted[1] = -fitted[1];
    if (fitted[0] * n[0] + fitted[1] * n[1] > cos(10 * DEGREE)) memcpy(n, fitted, sizeof fitted);
}

static enum status locate(struct placed_wall *wall, const struct placer *placer, const struct placer_photo *c,
                          const struct script_place *place, const double normal[2], bool angled, const char *path, int line,
                          const struct shown_point *shown, size_t count, struct position *p, struct err *err)
{
    const struct model_params *params = placer->params;
    if (count < (size_t)params->least_points)
        return too_few(c, place, path, line, count, params->least_points, "", err);
    if (normal)
        memcpy(wall->n, normal, sizeof wall->n);
    else if (!vote(wall->n, shown, count, params->max_angle, angled))
        return too_few(c, place, path, line, 0, params->least_points, " with the normal of a wall", err);
    size_t used = gather(p, shown, count, wall->n, params->max_angle);
    if (used < (size_t)params->least_points)
        return too_few(c, place, path, line, used, params->least_points, " with the wall's normal", err);
    wall->c = mode(p, used, placer->step);
    for (int round = 0; angled && !normal && round < 3; round++) { /* wider at first: the direction is only near */
        fit_line(wall->n, wall->c, shown, count, params->max_angle, placer->step * (round ? 2 : 8));
        used = gather(p, shown, count, wall->n, params->max_angle);
        if (used < (size_t)params->least_points)
            return too_few(c, place, path, line, used, params->least_points, " with the wall's normal", err);
        wall->c = mode(p, used, placer->step);
    }
    size_t near = 0;
    for (size_t i = 0; i < used; i++) near += fabs(p[i].at - wall->c) <= placer->step;
    for (size_t i = 0; i < used; i++) p[i].at = fabs(p[i].at - wall->c);
    qsort(p, used, sizeof *p, compare_positions);
    wall->spread = p[used / 2].at;
    wall->points = near;
    return ST_OK;
}

enum status place_wall(struct placed_wall *wall, const struct placer *placer, const struct script_place *place,
                       const double normal[2], bool angled, const char *path, int line, struct err *err)
{
    const struct placer_photo *c;
    struct shown_point *shown = NULL;
    size_t count = 0;
    *wall = (struct placed_wall){0};
    if (find_photo(&c, placer, place->view, path, line, err) || check_pixels(c, place, path, line, err))
        return err->status;
    if (!placer->count)
        return err_set(
            err, ST_DATA,
            "%s:%d: a wall by a rectangle needs the scene's points; make them, or give the wall by coordinates.", path,
            line);
    enum status st = show_points(&shown, &count, placer, c, place, err);
    struct position *p = st ? NULL : calloc(count + 1, sizeof *p);
    if (!st)
        st = p ? locate(wall, placer, c, place, normal, angled, path, line, shown, count, p, err)
               : err_nomem(err, "points of a rectangle", count * sizeof *p);
    const double middle = 0.5 * (place->a[1] + place->a[3]);
    for (int i = 0; i < 2 && !st; i++) {
        struct vec3 at;
        st =
            meet_plane(&at, c, place->a[2 * i], middle, vec3_make(wall->n[0], wall->n[1], 0), wall->c, path, line, err);
        if (st) break;
        wall->ends[i][0] = at.x;
        wall->ends[i][1] = at.y;
    }
    free(p);
    free(shown);
    return st;
}
