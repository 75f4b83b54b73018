/* place.c - walls from rectangles on photographs [Colburn 2014, 4.4.2].
 *
 * The points visible in the rectangle vote, by confidence, for the one of the four directions along the axes that is
 * within max_angle of their normals. Along the winner n the positions n . p of the points with that normal are sorted;
 * the wall is the densest window of positions, refined to the weighted mean of its content (mean shift, 8 rounds).
 *
 * Hidden points are removed first: points that face away from the camera, and points behind others. The rectangle is
 * cut into cells; in each of them points farther than 1.08 times the cell's front are hidden. The front is where the
 * nearest 5 % of the solid angle of the cell's points end. Their number would not do: a far wall has as many points per
 * area as a near one, hence many more in one cell.
 *
 * Beyond the source: rectangles that do not show where the wall is are refused (place_judge.c), and angled walls. The
 * normal of an angled wall is the mean normal about the fullest 5 degree bin, then three rounds of a total least
 * squares fit of the wall's line in plan to the points near it. */
#include "stages/build_model/place/place.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/math/numbers.h"
#include "stages/build_model/place/place_judge.h"
#include "stages/build_model/place/place_memory.h"

enum { MAX_CELLS = 24, MIN_IN_CELL = 55 }; /* along each side; mean effective number of points in a cell */
#define BEHIND         1.08                /* times the front's distance: points beyond are hidden */
#define FRONT_FRACTION 0.05                /* of the solid angle of a cell's points, outliers, is before its front */

void place_release(struct placer *placer)
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

static enum status add_photos(struct placer *placer, const struct placer_views *views, const struct model_axes *axes,
                              struct err *err)
{
    for (int i = 0; i < views->lenses->count; i++) {
        const struct lens *lens = &views->lenses->lenses[i];
        struct photo_camera camera;
        bool known = camera_set_find(views->set, lens->view) < 0;
        for (int k = 0; k < placer->photo_count; k++) known |= !strcmp(placer->photos[k].id, lens->photo);
        if (known) continue;
        if (photo_camera_find(&camera, lens->view, views->set, views->lenses, "lenses.txt", 0, err)) return err->status;
        placer->photos[placer->photo_count++] = (struct placer_photo){lens->photo, model_camera(&camera, axes)};
    }
    return ST_OK;
}

enum status place_init(struct placer *placer, const struct placer_views views[2], const struct model_axes *axes,
                       const struct point_cloud *points, const struct model_params *params, struct err *err)
{
    const size_t count = points ? points->count : 0;
    size_t photos = 1;
    *placer = (struct placer){.params = params, .count = count};
    for (int k = 0; k < 2; k++) {
        placer->lenses[k] = views[k].lenses;
        photos += (size_t)views[k].lenses->count;
    }
    placer->photos = calloc(photos, sizeof *placer->photos);
    placer->points = calloc(count + 1, sizeof *placer->points);
    if (!placer->photos || !placer->points) err_nomem(err, "the points of a model", count * sizeof *placer->points);
    for (int k = 0; !err->status && k < 2; k++) add_photos(placer, &views[k], axes, err);
    if (err->status) {
        place_release(placer);
        return err->status;
    }
    for (size_t i = 0; i < count; i++) {
        const struct cloud_point *p = &points->points[i];
        const struct vec3 at = model_from_world_point(axes, p->position);
        const struct vec3 n = model_from_world_direction(axes, vec3_make(p->normal[0], p->normal[1], p->normal[2]));
        placer->points[i] = (struct placed_point){
            {(float)at.x, (float)at.y, (float)at.z}, {(float)n.x, (float)n.y, (float)n.z}, p->confidence};
    }
    placer->window = params->window * (axes->ceiling > 0 ? axes->ceiling : 2.5);
    return ST_OK;
}

static const char *known_photo(const void *ctx, int i)
{
    const struct placer *placer = ctx;
    const struct lens_list *lenses = placer->lenses[0];
    if (i >= 2 * lenses->count) {
        i -= 2 * lenses->count;
        lenses = placer->lenses[1];
    }
    if (i >= 2 * lenses->count) return NULL;
    return i % 2 ? lenses->lenses[i / 2].view : lenses->lenses[i / 2].photo;
}

enum status place_find_photo(const struct placer_photo **found, const struct placer *placer, const char *view,
                             const char *path, int line, struct err *err)
{
    const char *photo = view;
    char quoted[SCAN_QUOTED];
    for (int k = 0; k < 2; k++) {
        const int at = lens_list_find(placer->lenses[k], view);
        if (at >= 0) photo = placer->lenses[k]->lenses[at].photo;
    }
    for (int i = 0; i < placer->photo_count; i++)
        if (!strcmp(placer->photos[i].id, photo)) {
            *found = &placer->photos[i];
            return ST_OK;
        }
    const char *near = scan_nearest(view, known_photo, placer);
    scan_quote(quoted, view);
    if (near)
        return err_set(err, ST_DATA, "%s:%d: found %s, wanted a photo's id or a view's name; did you mean %s?", path,
                       line, quoted, near);
    return err_set(err, ST_DATA, "%s:%d: found %s, wanted a photo's id or a view's name from lenses.txt.", path, line,
                   quoted);
}

static enum status check_pixels(const struct placer_photo *c, const struct script_place *p, const char *path, int line,
                                struct err *err)
{
    if (p->a[0] >= 0 && p->a[1] >= 0 && p->a[2] <= c->camera.lens.width && p->a[3] <= c->camera.lens.height)
        return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: the rectangle %.9g %.9g %.9g %.9g is not inside the photo %s, which has %d x %d pixels.",
                   path, line, p->a[0], p->a[1], p->a[2], p->a[3], c->id, c->camera.lens.width, c->camera.lens.height);
}

bool place_pixel_ray(struct vec3 *ray, const struct placer_photo *c, double x, double y)
{
    struct vec3 r;
    if (!camera_unproject(&c->camera.lens, x, y, &r)) return false;
    *ray = mat3_apply(mat3_transpose(c->camera.cam_from_world), r);
    return true;
}

enum status place_no_ray(const struct placer_photo *c, double x, double y, const char *path, int line, struct err *err)
{
    return err_set(err, ST_DATA, "%s:%d: the lens of %s has no ray at pixel %.9g %.9g; choose another pixel.", path,
                   line, c->id, x, y);
}

/* The intersection of a pixel's ray with the plane n p = d, from the side of n. */
static enum status meet_plane(struct vec3 *at, const struct placer_photo *c, double x, double y, struct vec3 n,
                              double d, const char *path, int line, struct err *err)
{
    struct vec3 ray = {0, 0, 0};
    if (!place_pixel_ray(&ray, c, x, y)) return place_no_ray(c, x, y, path, line, err);
    const double down = -vec3_dot(n, ray), height = vec3_dot(n, c->camera.center) - d;
    if (!(height > 0 && down > PLACE_MIN_COSINE))
        return err_set(
            err, ST_DATA,
            "%s:%d: the ray through pixel %.9g %.9g of %s does not hit the plane: it %s; choose another photo.", path,
            line, x, y, c->id,
            height > 0 ? "is parallel to the plane, or nearly so, or leads away" : "starts behind it");
    *at = vec3_add(c->camera.center, vec3_scale(ray, height / down));
    return ST_OK;
}

enum status place_corners(struct vec3 corners[2], const struct placer *placer, const struct script_place *place,
                          struct vec3 n, double d, const char *path, int line, struct err *err)
{
    const struct placer_photo *c;
    if (place_find_photo(&c, placer, place->view, path, line, err) || check_pixels(c, place, path, line, err) ||
        meet_plane(&corners[0], c, place->a[0], place->a[1], n, d, path, line, err) ||
        meet_plane(&corners[1], c, place->a[2], place->a[3], n, d, path, line, err))
        return err->status;
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------- visible points */

static int compare_visible(const void *a, const void *b)
{
    const struct visible_point *x = a, *y = b;
    if (x->cell != y->cell) return x->cell - y->cell;
    if (x->distance != y->distance) return x->distance < y->distance ? -1 : 1;
    return x->point < y->point ? -1 : x->point > y->point;
}

/* Cosine of a cone about the rectangle; points outside it need not be projected. -1: all directions. */
static double bounding_cone(const struct placer_photo *c, const struct script_place *p, struct vec3 *axis)
{
    double min_cos = 1;
    if (!camera_unproject(&c->camera.lens, 0.5 * (p->a[0] + p->a[2]), 0.5 * (p->a[1] + p->a[3]), axis)) return -1;
    for (int i = 0; i < 9; i++) {
        struct vec3 ray = {0, 0, 0};
        if (i == 4) continue;
        if (!camera_unproject(&c->camera.lens, p->a[0] + (p->a[2] - p->a[0]) * (i % 3) / 2,
                              p->a[1] + (p->a[3] - p->a[1]) * (i / 3) / 2, &ray))
            return -1;
        min_cos = fmin(min_cos, vec3_dot(ray, *axis));
    }
    return cos(fmin(acos(fmax(-1, min_cos)) * 1.1 + 0.01, 3.14));
}

/* The distance of the nearest surface of a cell, whose points are in the order of their distance. */
static double front_of(const struct visible_point *cell, size_t count)
{
    double all = 0, before = 0;
    size_t i = 0;
    for (size_t k = 0; k < count; k++) all += cell[k].angle;
    for (; i + 1 < count && (before += cell[i].angle) <= FRONT_FRACTION * all; i++) continue;
    return cell[i].distance;
}

/* So many points of equal solid angle would be as many [Kish 1965]: where a near wall covers most of a rectangle, the
 * points behind it hardly count. */
static double effective_count(const struct visible_point *p, size_t count)
{
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        sum += p[i].angle;
        squares += (double)p[i].angle * p[i].angle;
    }
    return squares > 0 ? sum * sum / squares : 0;
}

/* The points that are visible in the rectangle; the caller frees them, also after a failure. */
static enum status find_visible(struct visible_point **visible, size_t *count, const struct placer *placer,
                                const struct placer_photo *c, const struct script_place *p, struct err *err)
{
    struct vec3 axis;
    const double cone = bounding_cone(c, p, &axis);
    const struct mat3 turn = c->camera.cam_from_world;
    *visible = NULL;
    *count = 0;
    for (size_t i = 0; i < placer->count; i++) {
        const struct placed_point *q = &placer->points[i];
        const struct vec3 at = vec3_make(q->position[0], q->position[1], q->position[2]);
        const struct vec3 to = vec3_sub(at, c->camera.center);
        const double before = -(to.x * q->normal[0] + to.y * q->normal[1] + to.z * q->normal[2]);
        if (!(before > 0)) continue;
        const struct vec3 cam = mat3_apply(turn, to);
        const double distance = vec3_length(cam);
        double u, v;
        if (vec3_dot(cam, axis) < cone * distance || !camera_project(&c->camera.lens, cam, &u, &v)) continue;
        if (!(u >= p->a[0] && u < p->a[2] && v >= p->a[1] && v < p->a[3])) continue;
        if (array_append(visible, *count, sizeof **visible, "points of a rectangle", err)) return err->status;
        (*visible)[(*count)++] = (struct visible_point){q,
                                                        distance,
                                                        (float)(before / (distance * distance * distance)),
                                                        (float)((u - p->a[0]) / (p->a[2] - p->a[0])),
                                                        (float)((v - p->a[1]) / (p->a[3] - p->a[1])),
                                                        0};
    }
    /* fewer points make larger cells, so that a cell that sees through a sparse wall has points of the wall, too */
    const int cells = (int)fmax(1, fmin(MAX_CELLS, sqrt(effective_count(*visible, *count) / MIN_IN_CELL)));
    for (size_t i = 0; i < *count; i++) {
        const int x = (int)((*visible)[i].u * (float)cells), y = (int)((*visible)[i].v * (float)cells);
        (*visible)[i].cell = (y < cells ? y : cells - 1) * cells + (x < cells ? x : cells - 1);
    }
    if (*count) qsort(*visible, *count, sizeof **visible, compare_visible);
    size_t kept = 0;
    for (size_t from = 0, end; from < *count; from = end) {
        for (end = from; end < *count && (*visible)[end].cell == (*visible)[from].cell;) end++;
        const double front = front_of(*visible + from, end - from);
        for (size_t i = from; i < end; i++)
            if ((*visible)[i].distance <= front * BEHIND) (*visible)[kept++] = (*visible)[i];
    }
    *count = kept;
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ a wall's position */

struct position {
    double at, weight;
};

static int compare_positions(const void *a, const void *b)
{
    const struct position *x = a, *y = b;
    if (x->at != y->at) return x->at < y->at ? -1 : 1;
    return (x->weight > y->weight) - (x->weight < y->weight);
}

/* The mode of sorted positions: the middle of the window with the greatest weight, refined by mean shift. */
static double mode(const struct position *p, size_t count, double window)
{
    double sum = 0, max_sum = -1, at = 0;
    for (size_t i = 0, from = 0; i < count; i++) {
        sum += p[i].weight;
        while (p[i].at - p[from].at > window) sum -= p[from++].weight;
        if (sum > max_sum) {
            max_sum = sum;
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
        "%s:%d: the rectangle %.9g %.9g %.9g %.9g in %s contains %zu visible points%s, wanted %d or more; draw it "
        "larger or in another photo, or place the wall by its line at the floor (wall NAME foot in VIEW X0 Y0 X1 Y1) "
        "or "
        "by coordinates.",
        path, line, p->a[0], p->a[1], p->a[2], p->a[3], c->id, found, what, wanted);
}

/* Of a direction, the side towards which more normals point. False: none do. */
static bool vote_side(double n[2], const struct visible_point *visible, size_t count, double max_angle,
                      const double along[2])
{
    const double near = cos(max_angle * DEGREE);
    double sides[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = visible[i].point;
        const double toward = q->normal[0] * along[1] - q->normal[1] * along[0];
        if (fabs(toward) >= near) sides[toward < 0] += q->weight;
    }
    const double sign = sides[1] > sides[0] ? -1 : 1;
    n[0] = sign * along[1];
    n[1] = -sign * along[0];
    return sides[0] + sides[1] > 0;
}

/* The horizontal direction for which most normals vote: along an axis or, for an angled wall, the mean normal about the
 * fullest bin of 5 degrees. False: there are no horizontal normals. */
static bool vote(double n[2], const struct visible_point *visible, size_t count, double max_angle, bool angled)
{
    enum { BINS = 72 };
    const double min_horizontal = cos(max_angle * DEGREE);
    double bins[BINS] = {0}, axes[4] = {0};
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = visible[i].point;
        const double flat = hypot(q->normal[0], q->normal[1]);
        if (flat < min_horizontal) continue;
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
        const struct placed_point *q = visible[i].point;
        const double turn = atan2(q->normal[1], q->normal[0]);
        if (hypot(q->normal[0], q->normal[1]) < min_horizontal ||
            fabs(remainder(turn - middle, 360 * DEGREE)) > 10 * DEGREE)
            continue;
        for (int k = 0; k < 2; k++) sum[k] += q->weight * q->normal[k];
    }
    const double length = hypot(sum[0], sum[1]);
    for (int k = 0; k < 2; k++) n[k] = sum[k] / length;
    return length > 0;
}

/* Positions along n of the points whose normals are within max_angle of it, sorted. */
static size_t gather(struct position *p, const struct visible_point *visible, size_t count, const double n[2],
                     double max_angle)
{
    const double near = cos(max_angle * DEGREE);
    size_t used = 0;
    for (size_t i = 0; i < count; i++) {
        const struct placed_point *q = visible[i].point;
        if (q->normal[0] * n[0] + q->normal[1] * n[1] >= near)
            p[used++] = (struct position){q->position[0] * n[0] + q->position[1] * n[1], q->weight};
    }
    if (used) qsort(p, used, sizeof *p, compare_positions);
    return used;
}

/* Turns n to the line in plan that fits the points within `window` of it best, by total least squares. */
static void fit_line(double n[2], double c, const struct visible_point *visible, size_t count, double max_angle,
                     double window)
{
    const double near = cos(max_angle * DEGREE);
    double weight = 0, mean[2] = {0, 0}, xx = 0, xy = 0, yy = 0;
    for (int pass = 0; pass < 2; pass++) {
        for (size_t i = 0; i < count; i++) {
            const struct placed_point *q = visible[i].point;
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

static enum status locate_wall(struct placed_wall *wall, const struct placer *placer, const struct placer_photo *c,
                               const struct script_place *place, const struct place_direction *wanted, const char *path,
                               int line, const struct visible_point *visible, size_t count, struct position *p,
                               struct err *err)
{
    const struct model_params *params = placer->params;
    const double *const normal = wanted->normal;
    const bool angled = wanted->is_free;
    if (count < (size_t)params->min_points) return too_few(c, place, path, line, count, params->min_points, "", err);
    if (normal)
        memcpy(wall->n, normal, sizeof wall->n);
    else if (wanted->along ? !vote_side(wall->n, visible, count, params->max_angle, wanted->along)
                           : !vote(wall->n, visible, count, params->max_angle, angled))
        return too_few(c, place, path, line, 0, params->min_points, " with the normal of a wall", err);
    size_t used = gather(p, visible, count, wall->n, params->max_angle);
    if (used < (size_t)params->min_points)
        return too_few(c, place, path, line, used, params->min_points, " with the wall's normal", err);
    wall->c = mode(p, used, placer->window);
    for (int round = 0; angled && !normal && round < 3;
         round++) { /* a wider window at first, while the direction is rough */
        fit_line(wall->n, wall->c, visible, count, params->max_angle, placer->window * (round ? 2 : 8));
        used = gather(p, visible, count, wall->n, params->max_angle);
        if (used < (size_t)params->min_points)
            return too_few(c, place, path, line, used, params->min_points, " with the wall's normal", err);
        wall->c = mode(p, used, placer->window);
    }
    size_t near = 0;
    for (size_t i = 0; i < used; i++) near += fabs(p[i].at - wall->c) <= placer->window;
    for (size_t i = 0; i < used; i++) p[i].at = fabs(p[i].at - wall->c);
    qsort(p, used, sizeof *p, compare_positions);
    wall->spread = p[used / 2].at;
    wall->points = near;
    const struct rectangle_wall found = {wall, c, place, visible, count, normal || wanted->along, angled};
    return place_judge(&found, placer, path, line, err);
}

enum status place_wall(struct placed_wall *wall, const struct placer *placer, const struct script_place *place,
                       const struct place_direction *wanted, const char *path, int line, struct err *err)
{
    const struct placer_photo *c;
    struct visible_point *visible = NULL;
    size_t count = 0;
    *wall = (struct placed_wall){0};
    if (place_find_photo(&c, placer, place->view, path, line, err) || check_pixels(c, place, path, line, err))
        return err->status;
    if (!placer->count)
        return err_set(
            err, ST_DATA,
            "%s:%d: a wall by a rectangle needs the scene's points; give --points, or the wall's coordinates.", path,
            line);
    const struct placed_wall *known = place_memory_find(placer->memory, place, wanted);
    if (known) {
        *wall = *known;
        return ST_OK;
    }
    struct position *p = NULL;
    if (!find_visible(&visible, &count, placer, c, place, err) && !(p = calloc(count + 1, sizeof *p)))
        err_nomem(err, "points of a rectangle", count * sizeof *p);
    if (!err->status) locate_wall(wall, placer, c, place, wanted, path, line, visible, count, p, err);
    const double middle = 0.5 * (place->a[1] + place->a[3]);
    for (int i = 0; i < 2 && !err->status; i++) {
        struct vec3 at;
        if (meet_plane(&at, c, place->a[2 * i], middle, vec3_make(wall->n[0], wall->n[1], 0), wall->c, path, line, err))
            break;
        wall->ends[i][0] = at.x;
        wall->ends[i][1] = at.y;
    }
    if (!err->status) place_memory_add(placer->memory, place, wanted, wall);
    free(p);
    free(visible);
    return err->status;
}
