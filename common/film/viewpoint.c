/* viewpoint.c - validity of a viewpoint.
 *
 * A viewpoint is valid if H < max_h, the hole measure of [Colburn 2014, 3.4.2] (common/layers/hole_measure.h). Two
 * limits are added to the thesis's, because pictures without holes can still be bad:
 * - the part of the frame beyond the borders of the views that the view mesh blends there, where other views fill in
 *   with a visible seam. It is measured in a small picture at the depth of the centroid; each pixel counts by the
 *   weight of the blended views that do not contain it;
 * - the part of the scene nearer than shot->near_limit, measured on the scene's points.
 *
 * Where validity alone is asked for, coverage is rendered only if the other two limits are kept, and the first invalid
 * viewpoint of several ends the test. */
#include "common/film/viewpoint.h"

#include <stdatomic.h>
#include <stdlib.h>

#include "common/base/parallel.h"
#include "common/layers/hole_measure.h"
#include "common/math/lanes.h"

#define OUTSIDE_SIDE   64    /* longer side of the picture in which `outside` is measured, px */
#define NEAR_TOLERANCE 0.005 /* largest fraction of points that may be too near */

static enum status measure_holes(struct viewpoint *v, struct viewpoint_test *test, const struct view *camera,
                                 struct err *err)
{
    const int longer = camera->width > camera->height ? camera->width : camera->height;
    const double scale = test->limits.side < longer ? (double)test->limits.side / longer : 1;
    struct rendered_frame *c = &test->coverage;

    if (layer_coverage(c, test->scene, camera, scale, err)) return err->status;
    test->renders++;
    const size_t pixels = (size_t)c->width * (size_t)c->height;
    if (pixels > test->distance_room) {
        free(test->distance);
        test->distance_room = 0;
        test->distance = malloc(pixels * sizeof *test->distance);
        if (!test->distance) return err_nomem(err, "distances in holes", pixels * sizeof *test->distance);
        test->distance_room = pixels;
    }
    v->holes = c->hole_fraction;
    v->h = 0;
    return c->hole_fraction > 0 ? hole_measure(&v->h, c->hole, c->width, c->height, test->distance, err) : ST_OK;
}

static double outside_fraction(const struct viewpoint_test *test, const struct view *camera)
{
    const struct camera_set *set = test->scene->set;
    struct view_weights row[OUTSIDE_SIDE];
    struct view_mesh_camera mesh;
    struct view small = *camera;
    const double scale = (double)OUTSIDE_SIDE / (camera->width > camera->height ? camera->width : camera->height);
    double sum = 0, x, y;
    const double depth = view_project(camera, test->shot->centroid, &x, &y);

    if (!(depth > 0)) return 1;
    view_resize(&small, (int)fmax(1, floor(camera->width * scale)), (int)fmax(1, floor(camera->height * scale)));
    view_mesh_prepare(&mesh, &test->scene->mesh, &small);
    for (int j = 0; j < small.height; j++) {
        view_mesh_row(&mesh, j, row);
        for (int i = 0; i < small.width; i++) {
            const struct vec3 point = view_unproject(&small, i + 0.5, j + 0.5, depth);
            for (int k = 0; k < row[i].count; k++) {
                const struct view *view = &set->views[row[i].view[k]];
                double u = -1, t = -1;
                if (!(view_project(view, point, &u, &t) > 0) || u < 0 || u > view->width || t < 0 || t > view->height)
                    sum += (double)row[i].weight[k];
            }
        }
    }
    return sum / (small.width * small.height);
}

/* The weight of the points in a frame, and of those of them that are too near. Weights are whole numbers of pixels, so
 * sums are exact in any order. Four points at a time, with the operations of view_project(). */
static void weigh_points(double *within, double *too_near, const struct viewpoint_test *test, const struct view *camera)
{
    const struct scene_point *points = test->points->points;
    const size_t count = test->points->count;
    const double(*m)[3] = camera->cam_from_world.m;
    const double shift[3] = {camera->translation.x, camera->translation.y, camera->translation.z};
    const f64x4 zero = {0}, limit = f64x4_all(test->shot->near_limit);
    const f64x4 width = f64x4_all(camera->width), height = f64x4_all(camera->height);
    f64x4 near = zero, total = zero;

    for (size_t i = 0; i < count; i += 4) {
        double in[4][4]; /* x, y, z and weight; the padding weighs nothing */
        f64x4 c[3];
        for (size_t k = 0; k < 4; k++) {
            const struct scene_point *p = &points[i + k < count ? i + k : i];
            in[0][k] = p->position.x;
            in[1][k] = p->position.y;
            in[2][k] = p->position.z;
            in[3][k] = i + k < count ? p->weight : 0;
        }
        const f64x4 x = f64x4_load(in[0]), y = f64x4_load(in[1]), z = f64x4_load(in[2]);
        for (int r = 0; r < 3; r++) {
            const f64x4 turned = m[r][0] * x + m[r][1] * y + m[r][2] * z;
            c[r] = turned + shift[r];
        }
        const f64x4 u = camera->fx * (c[0] / c[2]) + camera->cx;
        const f64x4 v = camera->fy * (c[1] / c[2]) + camera->cy;
        i64x4 seen = c[2] > zero;
        seen &= ~(u < zero) & ~(u > width);
        seen &= ~(v < zero) & ~(v > height);
        const f64x4 weight = f64x4_where(seen, f64x4_load(in[3]));
        total += weight;
        near += f64x4_where(c[2] < limit, weight);
    }
    double sums[2][4];
    f64x4_store(sums[0], near);
    f64x4_store(sums[1], total);
    for (int k = 1; k < 4; k++) sums[0][0] += sums[0][k], sums[1][0] += sums[1][k];
    *too_near = sums[0][0];
    *within = sums[1][0];
}

static double near_fraction(const struct viewpoint_test *test, const struct view *camera)
{
    double within, too_near;
    weigh_points(&within, &too_near, test, camera);
    return within > 0 ? too_near / within : 1;
}

double viewpoint_pixels_within(const struct viewpoint_test *test, const struct view *camera)
{
    double within, too_near;
    weigh_points(&within, &too_near, test, camera);
    return within;
}

enum status viewpoint_measure(struct viewpoint *v, struct viewpoint_test *test, const struct view *camera,
                              struct err *err)
{
    *v = (struct viewpoint){.h = INFINITY, .holes = 1, .outside = 1, .near = 1};
    if (!(camera->fx > 0)) return ST_OK;
    v->near = near_fraction(test, camera);
    v->outside = outside_fraction(test, camera);
    if (measure_holes(v, test, camera, err)) return err->status;
    v->valid = v->near <= NEAR_TOLERANCE && v->outside <= test->limits.max_outside && v->h < test->limits.max_h;
    return ST_OK;
}

enum status viewpoint_is_valid(bool *valid, struct viewpoint_test *test, const struct view *camera, struct err *err)
{
    struct viewpoint v;
    *valid = false;
    if (!(camera->fx > 0) || near_fraction(test, camera) > NEAR_TOLERANCE ||
        outside_fraction(test, camera) > test->limits.max_outside)
        return ST_OK;
    if (measure_holes(&v, test, camera, err)) return err->status;
    *valid = v.h < test->limits.max_h;
    return ST_OK;
}

void viewpoint_test_copy(struct viewpoint_test *test, const struct viewpoint_test *from)
{
    *test = (struct viewpoint_test){
        .scene = from->scene, .points = from->points, .shot = from->shot, .limits = from->limits};
}

void viewpoint_test_release(struct viewpoint_test *test)
{
    rendered_frame_release(&test->coverage);
    free(test->distance);
    test->distance = NULL;
    test->distance_room = 0;
}

struct viewpoint_batch {
    struct viewpoint *out; /* NULL: validity alone */
    const struct view *cameras;
    struct viewpoint_test *tests; /* one per thread */
    struct err *errors;           /* one per camera */
    atomic_bool invalid;          /* some viewpoint is, or could not be tested */
};

static void measure_some(void *ctx, size_t begin, size_t end, int thread)
{
    const struct viewpoint_batch *m = ctx;
    for (size_t i = begin; i < end; i++)
        viewpoint_measure(&m->out[i], &m->tests[thread], &m->cameras[i], &m->errors[i]);
}

static void test_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct viewpoint_batch *m = ctx;
    for (size_t i = begin; i < end && !atomic_load_explicit(&m->invalid, memory_order_relaxed); i++) {
        bool valid = false;
        viewpoint_is_valid(&valid, &m->tests[thread], &m->cameras[i], &m->errors[i]);
        if (!valid) atomic_store_explicit(&m->invalid, true, memory_order_relaxed);
    }
}

static enum status run_batch(struct viewpoint_batch *m, int count, struct viewpoint_test *test, struct err *err)
{
    const int threads = parallel_threads();
    m->tests = calloc((size_t)threads, sizeof *m->tests);
    m->errors = calloc((size_t)count + 1, sizeof *m->errors);
    if (!m->tests || !m->errors) err_nomem(err, "viewpoints", (size_t)count * sizeof *m->errors);

    for (int t = 0; !err->status && t < threads; t++) viewpoint_test_copy(&m->tests[t], test);
    if (!err->status) parallel_for((size_t)count, 1, m->out ? measure_some : test_some, m);
    for (int i = 0; !err->status && i < count; i++)
        if (m->errors[i].status) err_set(err, m->errors[i].status, "%s", m->errors[i].text);
    for (int t = 0; m->tests && t < threads; t++) {
        test->renders += m->tests[t].renders;
        viewpoint_test_release(&m->tests[t]);
    }
    free(m->tests);
    free(m->errors);
    return err->status;
}

enum status viewpoints_measure(struct viewpoint *out, const struct view *cameras, int count,
                               struct viewpoint_test *test, struct err *err)
{
    struct viewpoint_batch m = {.out = out, .cameras = cameras};
    return run_batch(&m, count, test, err);
}

enum status viewpoints_are_valid(bool *valid, const struct view *cameras, int count, struct viewpoint_test *test,
                                 struct err *err)
{
    struct viewpoint_batch m = {.cameras = cameras};
    run_batch(&m, count, test, err);
    *valid = !err->status && !atomic_load(&m.invalid);
    return err->status;
}
