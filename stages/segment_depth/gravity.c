/* gravity.c - gravity and the ground of a scene, from its cameras and sparse points.
 *
 * Photographers hold the horizon level, so that the mean of what is down in the photos is free of roll. But all photos
 * of a building may be taken with the camera tilted up, and all of a table tilted down: between photos of one viewing
 * direction, pitch does not average out. Walls and furniture decide it: on a plan, seen along gravity, the points of a
 * wall fall on a line. So of all pitches, gravity is the one for which most pairs of points share a square of the plan.
 * [Gallup 2007] finds directions of walls like this, by the entropy of histograms of points.
 *
 * Gravels and lawns match badly between photos: their texture is fine, and near. What is known of them is where walls,
 * trees and posts end: hardly any sparse point lies below the ground. So of all planes that are level to within
 * GROUND_TILT, the ground is the one with the highest
 *   (points within BAND of it - BELOW_WEIGHT points below it) (1 - TILT_WEIGHT tilt in degrees),
 * and within the band it lies where most points are. Points at the lower edge of the photos do not count. */
#include "stages/segment_depth/gravity.h"

#include <math.h>
#include <stdlib.h>

#include "common/capture/upright.h"

#define MAX_POINTS 4000 /* a scene with more points is represented by evenly spaced ones of its list */

#define SQUARE      0.01  /* side of a square of the plan, of the points' median distance from the cameras' centre */
#define FINE_SQUARE 0.004 /* the same, for the last degree */
#define MIN_RIGHT   0.5   /* length of the mean of the cameras' right axes: below, they look all around */
#define PITCH       45    /* degrees: the largest that is tried */
#define OFF         6     /* degrees off the best: there are clearly fewer pairs */
#define PITCH_GAIN  2.0   /* least ratio of the pairs */
#define PITCH_PAIRS 0.1   /* least difference, for each point */

#define BAND         0.006 /* of the median distance, as the following lengths */
#define NARROW       0.5   /* of the band */
#define BELOW_WEIGHT 3.0
#define MAX_BELOW    0.02 /* share of all points: outliers */
#define MIN_SHARE    0.01 /* of all points, within BAND */
#define MIN_POINTS   30   /* the same, in points */
#define MIN_CAMERA   0.02 /* height of the lowest camera */
#define MIN_SPREAD   0.04 /* standard deviation of the points within BAND along the narrower direction */
#define TILT_WEIGHT  0.3
#define TILT_STEP    0.5 /* degrees */

/* Points from the cameras' centre, and axes: right and ahead are level. */
struct cloud {
    struct vec3 *points;
    double *value;   /* scratch, of each point */
    int feet;        /* how many of the first points may be feet: find_feet() */
    int count, all;  /* all: of which the count is a part */
    double distance; /* median */
    struct vec3 centre, down, right, ahead;
};

static int compare(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static void sort_values(struct cloud *c) { qsort(c->value, (size_t)c->count, sizeof *c->value, compare); }

/* Axes with `down` down, and `right` as far as it is level. */
static void set_axes(struct cloud *c, struct vec3 down, struct vec3 right)
{
    c->down = vec3_normalize(down);
    c->right = vec3_normalize(vec3_sub(right, vec3_scale(c->down, vec3_dot(right, c->down))));
    c->ahead = vec3_cross(c->right, c->down);
}

static void cloud_release(struct cloud *c)
{
    free(c->points);
    free(c->value);
}

static enum status cloud_take(struct cloud *c, const struct camera_set *set, struct err *err)
{
    const int all = set->model.point_count, stride = (all + MAX_POINTS - 1) / MAX_POINTS;
    const size_t most = (size_t)(all < MAX_POINTS ? all : MAX_POINTS) + 1;
    *c = (struct cloud){.all = all};
    c->points = malloc(most * sizeof *c->points);
    c->value = malloc(most * sizeof *c->value);
    if (!c->points || !c->value) return err_nomem(err, "the points of a scene", most * sizeof *c->points);
    for (int i = 0; i < set->view_count; i++)
        c->centre = vec3_add(c->centre, vec3_scale(set->views[i].center, 1.0 / set->view_count));
    for (int i = 0; i < all; i += stride) {
        c->points[c->count] = vec3_sub(set->model.points[i].position, c->centre);
        c->value[c->count] = vec3_length(c->points[c->count]);
        c->count++;
    }
    sort_values(c);
    c->distance = c->count ? c->value[c->count / 2] : 0;
    return ST_OK;
}

/* `down` tilted by angles in degrees. */
static struct vec3 tilted(const struct cloud *c, double right, double ahead)
{
    const double degree = M_PI / 180;
    return vec3_normalize(vec3_add(
        c->down, vec3_add(vec3_scale(c->right, tan(right * degree)), vec3_scale(c->ahead, tan(ahead * degree)))));
}

/* ---------------------------------------------------------------------------------------------------- gravity */

/* Ordered pairs of points that share a square of the plan after a pitch; side: of squares, of the median distance. */
static double pairs_on_plan(struct cloud *c, double pitch, double side)
{
    const struct vec3 ahead = vec3_cross(c->right, tilted(c, 0, pitch));
    const double square = side * c->distance, row = 0x1p26; /* far more squares than a row has */
    double sum = 0;
    for (int i = 0; i < c->count; i++)
        c->value[i] =
            floor(vec3_dot(c->right, c->points[i]) / square) + row * floor(vec3_dot(ahead, c->points[i]) / square);
    sort_values(c);
    for (int i = 0, end; i < c->count; i = end) {
        for (end = i; end < c->count && c->value[end] == c->value[i];) end++;
        sum += (double)(end - i) * (end - i - 1);
    }
    return sum;
}

/* False: no pitch is clearly better than the others. */
static bool find_pitch(double *found, struct cloud *c)
{
    static const struct {
        double reach, step, square;
    } stages[] = {{PITCH, 3, SQUARE}, {3, 0.5, SQUARE}, {0.5, 0.05, FINE_SQUARE}};
    double pitch = 0;
    for (int k = 0; k < 3; k++) {
        const int steps = (int)lrint(stages[k].reach / stages[k].step);
        const double middle = pitch;
        double best = pairs_on_plan(c, middle, stages[k].square);
        for (int i = -steps; i <= steps; i++) {
            const double at = middle + i * stages[k].step, pairs = pairs_on_plan(c, at, stages[k].square);
            if (pairs > best) best = pairs, pitch = at;
        }
    }
    const double pairs = pairs_on_plan(c, pitch, SQUARE),
                 off = fmax(pairs_on_plan(c, pitch - OFF, SQUARE), pairs_on_plan(c, pitch + OFF, SQUARE));
    *found = pitch;
    return pairs >= PITCH_GAIN * off && pairs - off >= PITCH_PAIRS * c->count && fabs(pitch) < PITCH;
}

enum status gravity_find(struct vec3 *down, bool *known, const struct camera_set *set, const struct vec3 *ups,
                         struct err *err)
{
    struct cloud c;
    struct vec3 right = {0, 0, 0};
    *down = vec3_scale(upright_mean(set, ups), -1);
    for (int i = 0; i < set->view_count; i++) {
        const struct vec3 up = ups ? ups[i] : vec3_make(0, -1, 0);
        right = vec3_add(right,
                         mat3_apply(mat3_transpose(set->views[i].cam_from_world), vec3_cross(vec3_make(0, 0, 1), up)));
    }
    *known = vec3_length(right) < MIN_RIGHT * set->view_count;
    if (*known) return ST_OK;
    cloud_take(&c, set, err);
    set_axes(&c, *down, right);
    double pitch;
    *known = !err->status && c.distance > 0 && find_pitch(&pitch, &c);
    if (*known) *down = tilted(&c, 0, pitch);
    cloud_release(&c);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------- ground */

struct level { /* a plane */
    struct vec3 down;
    double depth; /* below the centre */
    double score;
};

/* Moves the points that may be feet to the front of the list: views show what lies below them. At a photo's lower edge
 * points end as well, but not because of a ground. */
static void find_feet(struct cloud *c, const struct camera_set *set)
{
    c->feet = 0;
    for (int i = 0; i < c->count; i++) {
        const struct vec3 foot = c->points[i];
        if (!camera_set_shows_below(set, vec3_add(foot, c->centre), c->down)) continue;
        c->points[i] = c->points[c->feet];
        c->points[c->feet++] = foot;
    }
}

/* The best plane of a normal among depths from `least` to `most`, if it is better than *best. */
static void try_depths(struct level *best, struct cloud *c, struct vec3 down, double band, double least, double most,
                       double weight)
{
    double *feet = c->value, *others = c->value + c->feet;
    const int last = c->feet - 1, count = c->count - c->feet;
    for (int i = 0; i < c->count; i++) c->value[i] = vec3_dot(down, c->points[i]);
    qsort(feet, (size_t)c->feet, sizeof *feet, compare);
    qsort(others, (size_t)count, sizeof *others, compare);
    for (int i = last, first = last, end = last, other = count; i >= 0 && feet[i] >= least; i--) {
        while (end > 0 && feet[end] > feet[i] + band) end--;
        while (first > 0 && feet[first - 1] >= feet[i] - band) first--;
        while (other > 0 && others[other - 1] > feet[i] + band) other--;
        const int below = last - end + count - other;
        if (below > MAX_BELOW * c->count) break;
        const double score = (end - first + 1 - BELOW_WEIGHT * below) * weight;
        if (feet[i] <= most && score > best->score) *best = (struct level){down, feet[i], score};
    }
}

/* The best plane of one tilt, if it is better than *best. */
static void try_tilt(struct level *best, struct cloud *c, const struct camera_set *set, double right, double ahead)
{
    const double tilt = hypot(right, ahead);
    const struct vec3 down = tilted(c, right, ahead);
    double camera = -INFINITY; /* depth of the lowest */

    if (tilt > GROUND_TILT) return;
    for (int i = 0; i < set->view_count; i++)
        camera = fmax(camera, vec3_dot(down, vec3_sub(set->views[i].center, c->centre)));
    try_depths(best, c, down, BAND * c->distance, camera + MIN_CAMERA * c->distance, INFINITY, 1 - TILT_WEIGHT * tilt);
}

/* The ground in its band, which also has the feet of walls: most points within NARROW of it. */
static double exact_depth(struct cloud *c, const struct level *level)
{
    const double band = BAND * c->distance;
    struct level best = {level->down, level->depth, -INFINITY};
    try_depths(&best, c, level->down, NARROW * band, level->depth - band, level->depth + band, 1);
    return best.depth;
}

/* Whether enough points lie within the plane's band, spread over it. */
static bool is_ground(const struct cloud *c, const struct level *level)
{
    double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
    int n = 0;

    for (int i = 0; i < c->feet; i++) {
        if (!(fabs(vec3_dot(level->down, c->points[i]) - level->depth) <= BAND * c->distance)) continue;
        const double x = vec3_dot(c->right, c->points[i]), y = vec3_dot(c->ahead, c->points[i]);
        u += x, v += y, uu += x * x, uv += x * y, vv += y * y;
        n++;
    }
    if (n < MIN_SHARE * c->count || (double)n * c->all / c->count < MIN_POINTS) return false;
    uu = uu / n - u / n * (u / n), uv = uv / n - u / n * (v / n), vv = vv / n - v / n * (v / n);
    const double mean = (uu + vv) / 2, narrow = mean - sqrt(fmax(0, mean * mean - (uu * vv - uv * uv)));
    return narrow >= MIN_SPREAD * MIN_SPREAD * c->distance * c->distance;
}

enum status gravity_find_ground(struct ground *g, bool *found, const struct camera_set *set, struct vec3 down,
                                struct err *err)
{
    const int steps = (int)(GROUND_TILT / TILT_STEP);
    struct cloud c;
    struct level best = {0};
    *found = false;
    cloud_take(&c, set, err);
    if (!err->status && c.distance > 0) {
        set_axes(&c, down, fabs(down.x) < 0.9 ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0));
        find_feet(&c, set);
        for (int a = -steps; a <= steps; a++)
            for (int b = -steps; b <= steps; b++) try_tilt(&best, &c, set, a * TILT_STEP, b * TILT_STEP);
        *found = best.score > 0 && is_ground(&c, &best);
    }
    if (*found) *g = (struct ground){best.down, exact_depth(&c, &best) + vec3_dot(best.down, c.centre)};
    cloud_release(&c);
    return err->status;
}
