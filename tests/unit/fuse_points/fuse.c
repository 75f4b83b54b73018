/* fuse.c - fusion of the exact depth maps of two planes from four cameras, and of wrong ones. */
#include "planes.h"

#include "common/base/parallel.h"
#include "stages/fuse_points/fuse.h"

static const struct fuse_params defaults = FUSE_PARAMS_DEFAULT;

static void fuse(struct point_cloud *cloud, struct fuse_stats *stats, struct world *w, const struct fuse_params *params)
{
    struct err err = ERR_INIT;
    const struct depth_reader source = source_of(w);
    *cloud = (struct point_cloud){0};
    assert_ok(fuse_points(cloud, stats, &w->set, &source, params, 1 << 20, &err), err);
}

static struct vec3 normal_of(const struct cloud_point *p)
{
    return vec3_make(p->normal[0], p->normal[1], p->normal[2]);
}

static double degrees_between(struct vec3 a, struct vec3 b) { return acos(fmin(vec3_dot(a, b), 1)) * 180 / M_PI; }

static void exact_maps_give_exact_points(void **state)
{
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    int boards = 0, hidden = 0, all = 0;
    (void)state;
    world_make(&w);
    fuse(&cloud, &stats, &w, &defaults);
    assert_int_equal(stats.samples, VIEWS * WIDTH * HEIGHT);
    assert_int_equal(stats.views, 3);
    assert_true(stats.depth > 2.5 && stats.depth < 5);
    assert_near(cloud.cell, 0.002 * stats.depth, 1e-12);
    assert_true(cloud.count > WIDTH * HEIGHT / 2);
    for (size_t i = 0; i < cloud.count; i++) {
        const struct cloud_point *p = &cloud.points[i];
        const bool near = p->color[0] == 255;
        const struct flat f = near ? board() : wall();
        assert_near(distance_to(f, p->position), 0, 1e-5);
        assert_true(degrees_between(normal_of(p), f.normal) < 0.1);
        assert_int_equal(p->color[1], 137); /* sRGB of 0.25 */
        assert_true(p->views >= 3 && p->views <= 4 && p->confidence > 0.7f && p->confidence <= 1);
        boards += near;
        all += p->views == 4;
        hidden += !near && p->views == 3;
    }
    assert_true(boards > 500 && all > 1000 && hidden > 20);
    /* only pixels on the board's rim, where another view's nearest pixel may belong to the wall */
    assert_true(stats.seen_through < 400);
    point_cloud_release(&cloud);
    world_release(&w);
}

/* One view has the board at half its distance, with the same confidence as the others. */
static void a_wrong_map_is_outvoted(void **state)
{
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    struct fuse_params params = defaults;
    (void)state;
    world_make(&w);
    for (int k = 0; k < 3; k++) w.depths[2].segments[0].plane[k] *= 2;
    for (params.min_views = 3; params.min_views > 0;
         params.min_views -= 2) { /* with 1, only seeing through rejects it */
        fuse(&cloud, &stats, &w, &params);
        size_t boards = 0;
        for (size_t i = 0; i < cloud.count; i++) {
            const struct cloud_point *p = &cloud.points[i];
            assert_near(distance_to(p->color[0] ? board() : wall(), p->position), 0, 1e-5);
            boards += p->color[0] == 255;
        }
        assert_true(boards > 300);
        point_cloud_release(&cloud);
    }
    world_release(&w);
}

/* Depth maps with small offsets give one thin surface, not four. */
static void inaccurate_maps_are_fused_into_one_surface(void **state)
{
    static const double off[VIEWS] = {1.002, 0.9985, 0.9995, 1.001};
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    struct fuse_params params = defaults;
    double min_distance = INFINITY, max_distance = -INFINITY;
    (void)state;
    world_make(&w);
    params.min_views = VIEWS;
    for (int i = 0; i < VIEWS; i++)
        for (int k = 0; k < 3; k++) w.depths[i].segments[1].plane[k] *= off[i];
    fuse(&cloud, &stats, &w, &params);
    for (size_t i = 0; i < cloud.count; i++) {
        if (cloud.points[i].color[0]) continue;
        const double d = distance_to(wall(), cloud.points[i].position);
        min_distance = fmin(min_distance, d);
        max_distance = fmax(max_distance, d);
    }
    /* the maps lie up to 0.008 in front of and behind the wall */
    assert_true(max_distance < 0.003 && min_distance > -0.003 && max_distance - min_distance < 0.0015);
    point_cloud_release(&cloud);
    world_release(&w);
}

/* A slanted wall of narrow segments of constant depth, whose normals do not show its slant. */
static void surrounding_depths_correct_the_normals(void **state)
{
    enum { STRIPE = 8, STRIPES = WIDTH / STRIPE };
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    struct fuse_params params = defaults;
    (void)state;
    world_make(&w);
    for (int i = 0; i < VIEWS; i++) {
        struct layered_depth *d = &w.depths[i];
        const struct depth_segment whole = d->segments[1];
        free(d->segments);
        d->segments = calloc(STRIPES, sizeof *d->segments);
        d->segment_count = STRIPES;
        for (int k = 0; k < STRIPES; k++) {
            const double u = STRIPE * (k + 0.5), v = HEIGHT / 2.0;
            d->segments[k] = (struct depth_segment){
                (uint32_t)k + 1, 0, {0, 0, whole.plane[0] * u + whole.plane[1] * v + whole.plane[2]}, 0.03, 1, 0};
        }
        for (int at = 0; at < WIDTH * HEIGHT; at++) d->interior.id[at] = (uint32_t)(at % WIDTH / STRIPE) + 1;
    }
    double error[2] = {0};
    for (int k = 0; k < 2; k++) {
        params.normal_window = k ? 24 : 0;
        fuse(&cloud, &stats, &w, &params);
        for (size_t i = 0; i < cloud.count; i++)
            error[k] += degrees_between(normal_of(&cloud.points[i]), wall().normal) / (double)cloud.count;
        point_cloud_release(&cloud);
    }
    assert_true(error[0] > 12);
    assert_true(error[1] < 8); /* the vertical slant of 5.5 degrees remains unknown */
    world_release(&w);
}

static void thread_counts_and_cache_sizes_give_the_same_bits(void **state)
{
    struct world w;
    struct point_cloud clouds[3] = {{0}};
    struct fuse_stats stats[3];
    struct err err = ERR_INIT;
    (void)state;
    world_make(&w);
    const struct depth_reader source = source_of(&w);
    for (int k = 0; k < 3; k++) {
        parallel_set_threads(k == 1 ? 3 : 1);
        assert_ok(fuse_points(&clouds[k], &stats[k], &w.set, &source, &defaults, k == 2 ? 0 : 1 << 30, &err), err);
        assert_int_equal(clouds[k].count, clouds[0].count);
        for (size_t i = 0; i < clouds[0].count; i++) {
            const struct cloud_point *a = &clouds[0].points[i], *b = &clouds[k].points[i];
            assert_memory_equal(&a->position, &b->position, sizeof a->position);
            assert_memory_equal(a->normal, b->normal, sizeof a->normal);
            assert_memory_equal(a->color, b->color, sizeof a->color);
            assert_true(a->views == b->views && a->confidence == b->confidence);
        }
    }
    parallel_set_threads(0);
    assert_int_equal(stats[0].reads, VIEWS);
    assert_true(stats[2].reads > VIEWS * (VIEWS - 1));
    for (int k = 0; k < 3; k++) point_cloud_release(&clouds[k]);
    world_release(&w);
}

static void with_few_views_all_must_agree(void **state)
{
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    (void)state;
    world_make(&w);
    for (int n = 1; n <= 2; n++) {
        w.set.view_count = n;
        fuse(&cloud, &stats, &w, &defaults);
        assert_int_equal(stats.views, n);
        assert_true(cloud.count > 3000);
        point_cloud_release(&cloud);
    }
    world_release(&w);
}

/* Mixed pixels, unknown pixels, planes behind the camera. */
static void pixels_without_a_surface_give_no_points(void **state)
{
    struct world w;
    struct point_cloud cloud;
    struct fuse_stats stats;
    (void)state;
    world_make(&w);
    for (int i = 0; i < VIEWS; i++)
        for (int at = 0; at < WIDTH * HEIGHT; at++) {
            if (w.depths[i].interior.id[at] == BOARD)
                w.depths[i].interior.rgba[4 * at + 3] = 0.75f;
            else if (at % WIDTH < WIDTH / 4)
                w.depths[i].interior.id[at] = 0;
        }
    for (int k = 0; k < 3; k++) w.depths[3].segments[1].plane[k] *= -1;
    fuse(&cloud, &stats, &w, &defaults);
    assert_true(cloud.count > 500);
    for (size_t i = 0; i < cloud.count; i++) assert_int_equal(cloud.points[i].color[0], 0);
    assert_true(stats.samples < (VIEWS - 1) * WIDTH * HEIGHT * 3 / 4);
    point_cloud_release(&cloud);
    world_release(&w);
}

static void depth_maps_without_confidence_are_an_error(void **state)
{
    struct world w;
    struct point_cloud cloud = {0};
    struct fuse_stats stats;
    struct err err = ERR_INIT;
    (void)state;
    world_make(&w);
    const struct depth_reader source = source_of(&w);
    for (int i = 0; i < VIEWS; i++)
        for (int k = 0; k < 3; k++)
            w.depths[i].segments[0].plane[k] *= 1 + 0.1 * i, w.depths[i].segments[1].plane[k] *= 1 - 0.1 * i;
    assert_int_equal(fuse_points(&cloud, &stats, &w.set, &source, &defaults, 0, &err), ST_DATA);
    assert_err(err, ST_DATA, "3 views agree");
    for (int i = 0; i < VIEWS; i++) w.depths[i].segments[0].confidence = w.depths[i].segments[1].confidence = 0.2;
    err = (struct err)ERR_INIT;
    assert_int_equal(fuse_points(&cloud, &stats, &w.set, &source, &defaults, 0, &err), ST_DATA);
    assert_err(err, ST_DATA, "confidence 0.5");
    w.views[1].width++;
    err = (struct err)ERR_INIT;
    assert_int_equal(fuse_points(&cloud, &stats, &w.set, &source, &defaults, 0, &err), ST_DATA);
    assert_err(err, ST_DATA, "97 x 72");
    assert_null(cloud.points);
    world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(exact_maps_give_exact_points),
        cmocka_unit_test(a_wrong_map_is_outvoted),
        cmocka_unit_test(inaccurate_maps_are_fused_into_one_surface),
        cmocka_unit_test(surrounding_depths_correct_the_normals),
        cmocka_unit_test(thread_counts_and_cache_sizes_give_the_same_bits),
        cmocka_unit_test(with_few_views_all_must_agree),
        cmocka_unit_test(pixels_without_a_surface_give_no_points),
        cmocka_unit_test(depth_maps_without_confidence_are_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
