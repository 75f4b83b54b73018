/* view_cluster.c - clusters of views, on made cameras and points whose clusters and scores are known. */
#include "stages/choose_views/view_cluster.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#define DEGREES (M_PI / 180)

enum { MAX_VIEWS = 64, MAX_POINTS = 4096, SIDE = 100 };

/* Views of 90 degrees in the plane y = 0; a point is seen by every view whose picture contains it, unless a view's bit
 * in `hidden` says that something is in front of it. */
struct world {
    struct camera_set set;
    struct view views[MAX_VIEWS];
    struct sfm_point points[MAX_POINTS];
    struct sfm_track tracks[MAX_POINTS][MAX_VIEWS];
};

static struct world *world_new(void)
{
    struct world *w = calloc(1, sizeof *w);
    assert_non_null(w);
    w->set.views = w->views;
    w->set.model.points = w->points;
    return w;
}

/* A camera at (x, 0, z) that looks along (sin a, 0, cos a). */
static void add_view(struct world *w, double x, double z, double degrees)
{
    const double s = sin(degrees * DEGREES), c = cos(degrees * DEGREES);
    struct view *v = &w->views[w->set.view_count++];
    *v = (struct view){.name = "v", .width = SIDE, .height = SIDE, .fx = SIDE / 2, .fy = SIDE / 2};
    v->cx = v->cy = SIDE / 2;
    v->cam_from_world = (struct mat3){{{c, 0, -s}, {0, 1, 0}, {s, 0, c}}};
    v->center = vec3_make(x, 0, z);
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
}

static void add_point(struct world *w, struct vec3 at, uint64_t hidden)
{
    const int i = w->set.model.point_count++;
    w->points[i] = (struct sfm_point){.position = at, .track = w->tracks[i]};
    for (int v = 0; v < w->set.view_count; v++) {
        double x, y;
        if (hidden >> v & 1 || !(view_project(&w->views[v], at, &x, &y) > 0)) continue;
        if (x < 0 || y < 0 || x >= SIDE || y >= SIDE) continue;
        w->tracks[i][w->points[i].track_count++] = (struct sfm_track){v, 0};
    }
}

/* One point in the middle of each of the 8 x 8 cells of a camera at the origin that looks along `degrees`; its depth is
 * near in the columns below `columns`, else far. */
static void add_grid(struct world *w, double degrees, double near, double far, int columns)
{
    const double s = sin(degrees * DEGREES), c = cos(degrees * DEGREES);
    for (int i = 0; i < 64; i++) {
        const double z = i % 8 < columns ? near : far;
        const double x = (i % 8 - 3.5) / 4 * z, y = (i / 8 - 3.5) / 4 * z;
        add_point(w, vec3_make(c * x + s * z, y, -s * x + c * z), 0);
    }
}

/* Three views at and beside the origin, 1 apart, that look along `degrees`. */
static void add_three(struct world *w, double degrees)
{
    const double s = sin(degrees * DEGREES), c = cos(degrees * DEGREES);
    for (int i = -1; i <= 1; i++) add_view(w, i * c, -i * s, degrees);
}

static struct view_cluster find(const struct world *w, int seed, const int *wanted, int wanted_count)
{
    const struct cluster_params params = CLUSTER_PARAMS_DEFAULT;
    struct view_cluster c;
    struct err err = ERR_INIT;
    assert_int_equal(view_cluster_find(&c, &w->set, seed, wanted, wanted_count, &params, &err), ST_OK);
    return c;
}

static void agreement_is_the_length_of_the_mean_direction(void **state)
{
    (void)state;
    struct world *w = world_new();
    for (int i = 0; i < 5; i++) add_view(w, i, 0, 30);
    assert_float_equal(views_agreement(&w->set), 1, 1e-12);
    w->set.view_count = 0;
    for (int i = 0; i < 12; i++) add_view(w, i, 0, 30 * i);
    assert_float_equal(views_agreement(&w->set), 0, 1e-12);
    w->set.view_count = 0;
    for (int i = 0; i < 60; i++) add_view(w, 0, 0, 2 * (i + 0.5) - 60); /* a fan of 2a = 120 degrees: sin(a) / a */
    assert_float_equal(views_agreement(&w->set), sin(60 * DEGREES) / (60 * DEGREES), 1e-3);
    free(w);
}

/* Ahead a blank wall; to the right a wall of posters, with a chair as far away as `chair` before a quarter of it;
 * behind, furniture before half of a wall. */
static struct world *room(double chair)
{
    struct world *w = world_new();
    for (int k = 0; k < 4; k++) add_three(w, 90 * k);
    add_grid(w, 90, chair, 4, 2);
    add_grid(w, 180, 2, 4, 4);
    return w;
}

static void the_cluster_with_texture_and_depth_wins(void **state)
{
    (void)state;
    struct world *w = room(4);
    struct view_cluster c = find(w, -1, NULL, 0);
    assert_non_null(c.member);
    assert_int_equal(c.count, 3);
    for (int v = 0; v < 12; v++) assert_int_equal(c.member[v], v >= 6 && v < 9);
    assert_int_equal(c.central, 7);
    /* half of the cells have depth 2, half 4: ln z deviates from the median of one kind by ln 2 in half of them. At
     * those depths a baseline of 1 subtends more than 10 degrees at the middle cells */
    assert_float_equal(c.variety, 0.5 * log(2), 0.1);
    assert_true(c.coverage > 0.5 && c.coverage <= 1);
    view_cluster_release(&c);
    free(w);
}

static void coverage_and_variety_have_their_closed_form(void **state)
{
    (void)state;
    struct world *w = world_new();
    add_three(w, 0);
    add_grid(w, 0, 2, 4, 4);
    struct view_cluster c = find(w, -1, NULL, 0);
    double sum = 0, near = 0;
    for (int i = 0; i < 64; i++) {
        const double z = i % 8 < 4 ? 2 : 4;
        const struct vec3 p = vec3_make((i % 8 - 3.5) / 4 * z, (i / 8 - 3.5) / 4 * z, z);
        double largest = 0;
        for (int side = -1; side <= 1; side += 2) {
            const struct vec3 q = vec3_sub(p, vec3_make(side, 0, 0));
            if (!(fabs(q.x) < q.z)) continue; /* outside that view's picture */
            largest = fmax(largest, acos(vec3_dot(vec3_normalize(p), vec3_normalize(q))) / DEGREES);
        }
        const double weight = fmin(1, largest * largest / 100);
        sum += weight;
        near += z == 2 ? weight : 0;
    }
    assert_int_equal(c.central, 1);
    assert_float_equal(c.coverage, sum / 64, 1e-9);
    /* the weighted median is the depth of the heavier half */
    assert_float_equal(c.variety, log(2) * fmin(near, sum - near) / sum, 1e-9);
    view_cluster_release(&c);
    free(w);
}

static void a_flat_wall_alone_has_no_cluster(void **state)
{
    (void)state;
    struct world *w = world_new();
    add_three(w, 0);
    add_grid(w, 0, 4, 4, 0);
    struct view_cluster c = find(w, -1, NULL, 0);
    assert_null(c.member);
    view_cluster_release(&c);
    free(w);
}

static void views_from_one_place_have_no_cluster(void **state)
{
    (void)state;
    struct world *w = world_new();
    for (int i = 0; i < 12; i++) add_view(w, 0, 0, 30 * i);
    add_grid(w, 0, 2, 4, 4);
    add_grid(w, 90, 2, 4, 4);
    struct view_cluster c = find(w, -1, NULL, 0);
    assert_null(c.member);
    free(w);
}

static void a_seed_or_a_subject_decides(void **state)
{
    (void)state;
    struct world *w = room(3);
    struct view_cluster c = find(w, 4, NULL, 0);
    assert_int_equal(c.seed, 4);
    assert_true(c.member[4] && !c.member[7]);
    view_cluster_release(&c);
    const int subject = 3, both[2] = {3, 7};
    c = find(w, -1, &subject, 1);
    assert_true(c.member && c.member[3] && !c.member[7]);
    view_cluster_release(&c);
    c = find(w, -1, both, 2);
    assert_null(c.member);
    free(w);
}

/* Views that look the same way but are kept apart by a wall see nothing in common. */
static void views_of_two_rooms_are_two_clusters(void **state)
{
    (void)state;
    struct world *w = world_new();
    add_three(w, 0);
    for (int i = -1; i <= 1; i++) add_view(w, i, 20, 0);
    for (int i = 0; i < 64; i++) {
        const double z = i % 8 < 4 ? 2 : 4, x = (i % 8 - 3.5) / 4 * z, y = (i / 8 - 3.5) / 4 * z;
        add_point(w, vec3_make(x, y, z), 0);
        add_point(w, vec3_make(x, y, 20 + z), 7); /* hidden from the first room */
    }
    struct view_cluster c = find(w, 1, NULL, 0);
    for (int v = 0; v < 6; v++) assert_int_equal(c.member[v], v < 3);
    view_cluster_release(&c);
    c = find(w, 4, NULL, 0);
    for (int v = 0; v < 6; v++) assert_int_equal(c.member[v], v >= 3);
    view_cluster_release(&c);
    free(w);
}

static void a_view_listed_twice_in_a_track_counts_once(void **state)
{
    (void)state;
    struct world *w = room(4);
    struct view_cluster once = find(w, -1, NULL, 0);
    for (int i = 0; i < w->set.model.point_count; i++)
        if (w->points[i].track_count) w->tracks[i][w->points[i].track_count++] = w->tracks[i][0];
    struct view_cluster twice = find(w, -1, NULL, 0);
    assert_memory_equal(once.member, twice.member, 12);
    assert_true(once.coverage == twice.coverage && once.variety == twice.variety);
    view_cluster_release(&once);
    view_cluster_release(&twice);
    free(w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agreement_is_the_length_of_the_mean_direction),
        cmocka_unit_test(the_cluster_with_texture_and_depth_wins),
        cmocka_unit_test(coverage_and_variety_have_their_closed_form),
        cmocka_unit_test(a_flat_wall_alone_has_no_cluster),
        cmocka_unit_test(views_from_one_place_have_no_cluster),
        cmocka_unit_test(a_seed_or_a_subject_decides),
        cmocka_unit_test(views_of_two_rooms_are_two_clusters),
        cmocka_unit_test(a_view_listed_twice_in_a_track_counts_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
