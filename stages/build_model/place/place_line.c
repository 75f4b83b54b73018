/* place_line.c - walls from lines in photographs.
 *
 * A pixel on the line between wall and floor has the floor's height z. With the camera's centre C and the pixel's ray r
 * its place is C + r (z - C_z) / r_z. Errors: p is computed again for a pixel half a pixel to either side; the
 * differences are the columns of J = dp/d(x, y), and clicks of standard error s give p the covariance s^2 J J'.
 *
 * The line of a wall through two places p_i with covariances S_i. Along a given direction with the normal n only its
 * position c is unknown; its estimate is the mean of n p_i weighted by 1 / (n' S_i n), so the nearer end counts for
 * more. An end is the most probable place on the line: p_i + S_i n (c - n p_i) / (n' S_i n), which moves the corner
 * along its ray rather than along the wall.
 *
 * Two places turn about each other by the angle of sqrt(n' S_0 n + n' S_1 n) / |p_1 - p_0|. A direction is in doubt
 * beyond three times that and max_turn, for the errors of axes and lenses; in any case beyond 30 degrees, where the
 * other axis is nearly as near. */
#include "stages/build_model/place/place_line.h"

#include <math.h>
#include <string.h>

#include "common/math/numbers.h"
#include "stages/build_model/place/place_pixels.h"

#define HALF         0.5  /* px, the step of derivatives */
#define CONFIDENT    3.0  /* standard errors */
#define LARGEST      30.0 /* degrees, the limit of any turn */
#define MIN_DISTANCE 1e-6

static bool meet_level(double p[2], const struct placer_photo *c, double x, double y, double z)
{
    struct vec3 ray;
    if (!place_pixel_ray(&ray, c, x, y)) return false;
    const double height = z - c->camera.center.z, along = ray.z * height;
    if (!(along > 0) || fabs(ray.z) <= PLACE_MIN_COSINE) return false;
    p[0] = c->camera.center.x + ray.x * height / ray.z;
    p[1] = c->camera.center.y + ray.y * height / ray.z;
    return true;
}

/* The change of p by a pixel in x (or y). */
static void derivative(double d[2], const struct placer_photo *c, const struct placed_corner *at, bool in_y, double z)
{
    const double dx = in_y ? 0 : HALF, dy = in_y ? HALF : 0;
    double p[2][2], step = 2 * HALF;
    for (int k = 0; k < 2; k++) {
        const double side = k ? 1 : -1;
        if (meet_level(p[k], c, at->x + side * dx, at->y + side * dy, z)) continue;
        memcpy(p[k], at->p, sizeof at->p);
        step = HALF;
    }
    for (int k = 0; k < 2; k++) d[k] = (p[1][k] - p[0][k]) / step;
}

enum status place_corner(struct placed_corner *corner, const struct placer *placer, const struct script_corner *pixel,
                         double z, enum place_level level, const char *path, int line, struct err *err)
{
    const struct placer_photo *c;
    const bool top = level == PLACE_ON_CEILING;
    struct vec3 ray;
    double d[2][2];
    *corner = (struct placed_corner){.view = pixel->view, .x = pixel->x, .y = pixel->y};
    if (place_find_photo(&c, placer, pixel->view, path, line, err)) return err->status;
    if (!(pixel->x >= 0 && pixel->y >= 0 && pixel->x <= c->camera.lens.width && pixel->y <= c->camera.lens.height))
        return err_set(err, ST_DATA,
                       "%s:%d: the pixel %.9g %.9g is outside the picture of %s, which has %d x %d pixels; give pixels "
                       "of the photo as it is stored.",
                       path, line, pixel->x, pixel->y, pixel->view, c->camera.lens.width, c->camera.lens.height);
    if (!place_pixel_ray(&ray, c, pixel->x, pixel->y)) return place_no_ray(c, pixel->x, pixel->y, path, line, err);
    if (!((z > c->camera.center.z) == top))
        return err_set(err, ST_DATA, "%s:%d: the camera of %s is at height %.3g, %s at %.3g; choose another photo.",
                       path, line, pixel->view, c->camera.center.z,
                       top ? "not below the ceiling" : "not above the floor", z);
    if (!meet_level(corner->p, c, pixel->x, pixel->y, z))
        return err_set(
            err, ST_DATA,
            "%s:%d: at the pixel %.9g %.9g of %s there can be no %s: it is at the horizon or %s it; choose pixels on "
            "the line where the wall meets the %s.",
            path, line, pixel->x, pixel->y, pixel->view, top ? "ceiling" : "floor", top ? "below" : "above",
            top ? "ceiling" : "floor");
    corner->camera[0] = c->camera.center.x;
    corner->camera[1] = c->camera.center.y;
    for (int k = 0; k < 2; k++) derivative(d[k], c, corner, k, z);
    const double square = placer->params->click * placer->params->click;
    corner->xx = square * (d[0][0] * d[0][0] + d[1][0] * d[1][0]);
    corner->xy = square * (d[0][0] * d[0][1] + d[1][0] * d[1][1]);
    corner->yy = square * (d[0][1] * d[0][1] + d[1][1] * d[1][1]);
    return ST_OK;
}

/* The variance of n p. */
static double variance_along(const struct placed_corner *c, const double n[2])
{
    return c->xx * n[0] * n[0] + 2 * c->xy * n[0] * n[1] + c->yy * n[1] * n[1];
}

static void nearest_axis(double d[2], const double straight[2])
{
    const int axis = fabs(straight[1]) > fabs(straight[0]);
    d[axis] = 1;
    d[!axis] = 0;
}

enum status place_line(struct placed_line *line, const struct placer *placer, const struct placed_corner *start,
                       const struct placed_corner *end, const double along[2], bool is_free, const char *path,
                       int number, struct err *err)
{
    const struct placed_corner *corners[2] = {start, end};
    const double by[2] = {end->p[0] - start->p[0], end->p[1] - start->p[1]}, length = hypot(by[0], by[1]);
    *line = (struct placed_line){0};
    if (!(length > MIN_DISTANCE))
        return err_set(err, ST_DATA,
                       "%s:%d: the pixels %.9g %.9g of %s and %.9g %.9g of %s are at one place; mark two ends of the "
                       "wall.",
                       path, number, start->x, start->y, start->view, end->x, end->y, end->view);
    const double straight[2] = {by[0] / length, by[1] / length};
    if (is_free)
        memcpy(line->d, straight, sizeof straight);
    else if (along)
        memcpy(line->d, along, sizeof line->d);
    else
        nearest_axis(line->d, straight);
    const double same = line->d[0] * straight[0] + line->d[1] * straight[1];
    for (int k = 0; k < 2 && same < 0; k++) line->d[k] = -line->d[k];
    const double n[2] = {line->d[1], -line->d[0]}, across[2] = {straight[1], -straight[0]};
    line->turn = is_free ? 0 : atan2(fabs(n[0] * straight[0] + n[1] * straight[1]), fabs(same)) / DEGREE;
    line->turn_error = atan(sqrt(variance_along(start, across) + variance_along(end, across)) / length) / DEGREE;
    line->max_turn = fmin(LARGEST, placer->params->max_turn + CONFIDENT * line->turn_error);
    double weight = 0, sum = 0, variance[2];
    for (int i = 0; i < 2; i++) {
        variance[i] = fmax(variance_along(corners[i], n), MIN_DISTANCE * MIN_DISTANCE);
        weight += 1 / variance[i];
        sum += (n[0] * corners[i]->p[0] + n[1] * corners[i]->p[1]) / variance[i];
    }
    line->c = sum / weight;
    line->error = sqrt(1 / weight);
    for (int i = 0; i < 2; i++) {
        const struct placed_corner *q = corners[i];
        const double off = (line->c - n[0] * q->p[0] - n[1] * q->p[1]) / variance[i];
        line->ends[i][0] = q->p[0] + (q->xx * n[0] + q->xy * n[1]) * off;
        line->ends[i][1] = q->p[1] + (q->xy * n[0] + q->yy * n[1]) * off;
    }
    return ST_OK;
}
