/* furniture_sweep.c - furniture that depth missed is found by what matches on planes before the model. */
#include "stages/segment_depth/furniture_sweep.h"

#include "tests/unit/segment_depth/problem.h"

#define WIDE    90  /* focal length, px */
#define FLOOR_Y 1.2 /* below the camera, which looks along z */
#define WALL_Z  4.0

static struct plane_prior prior;
static struct plane planes[MAX_SEGMENTS], found[MAX_SEGMENTS];
static double distinct[MAX_SEGMENTS];
static struct furniture_planes largest;

static void level(double x, double y, double z, double half_x, double half_z, double contrast)
{
    struct painted_surface *s = scene_surface(&b.scene, vec3_make(x, y, z));
    s->across = vec3_make(half_x, 0, 0);
    s->down = vec3_make(0, 0, half_z);
    s->contrast = contrast;
    s->cell = 0.12;
}

static void upright(double x, double y, double z, double half_x, double half_y, double contrast)
{
    struct painted_surface *s = scene_wall(&b.scene, x, y, z, half_x, half_y, 0);
    s->contrast = contrast;
    s->cell = 0.12;
}

/* A room of which the view sees the floor and the wall ahead. */
static void room(double contrast)
{
    bench_empty();
    for (int i = 0; i < 3; i++) scene_view(&b.scene, W, H, WIDE, i == 1 ? 0.3 : i == 2 ? -0.3 : 0, 0, 0, 0);
    level(0, FLOOR_Y, WALL_Z / 2, 9, WALL_Z / 2, contrast);
    upright(0, -4, WALL_Z, 9, FLOOR_Y + 4, contrast);
}

/* All segments lie on the faces of the room, as they do where depth found nothing else. */
static void expect_faces(bool knows_floor)
{
    struct err err = ERR_INIT;
    assert_int_equal(plane_prior_init(&prior, b.segments.count, &err), ST_OK);
    prior.planes[0] = (struct plane){0, 0, 1 / WALL_Z};
    prior.planes[1] = plane_of_normal(&b.scene.views[0], vec3_make(0, 1 / FLOOR_Y, 0));
    prior.count = knows_floor ? 2 : 1;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        const double floor = plane_at(prior.planes[1], g->cx, g->cy);
        prior.expected[i] = knows_floor && floor > 1 / WALL_Z;
        planes[i] = prior.planes[prior.expected[i]];
        distinct[i] = 0;
        found[i] = (struct plane){0, 0, 0};
    }
    b.problem.prior = &prior;
}

/* Whether both other views show what the first shows at a pixel. */
static bool others_see(double u, double v)
{
    const struct view *first = &b.scene.views[0];
    int surface, seen = 0;
    const struct vec3 p = view_unproject(first, u, v, scene_depth(&b.scene, first, u, v, &surface));
    for (int k = 1; k < b.scene.set.view_count; k++) {
        const struct view *other = &b.scene.views[k];
        double pu = -1, pv = -1;
        const double z = view_project(other, p, &pu, &pv);
        seen += z > 0 && pu > 3 && pv > 3 && pu < other->width - 3 && pv < other->height - 3 &&
                fabs(scene_depth(&b.scene, other, pu, pv, &surface) / z - 1) < 1e-6;
    }
    return seen == 2;
}

struct share {
    double right; /* of the pixels of what stands in the room that both other views see */
    double wrong; /* of the pixels of the room's faces: that were moved */
};

static struct share find_and_keep(bool knows_floor)
{
    struct err err = ERR_INIT;
    double thing = 0, other = 0, right = 0, wrong = 0;
    bench_make(0.2, 0.36);
    expect_faces(knows_floor);
    largest = (struct furniture_planes){.count = 0};
    b.problem.max_inverse_z = fmax(0.36, furniture_sweep_nearest(&b.problem));
    assert_int_equal(furniture_sweep_find(planes, distinct, found, &largest, &b.problem, &err), ST_OK);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        int surface;
        const double truth = 1 / scene_depth(&b.scene, &b.scene.views[0], g->cx, g->cy, &surface);
        const double at = plane_at(found[i], g->cx, g->cy);
        assert_true(at > 0 ? memcmp(&planes[i], &found[i], sizeof planes[i]) == 0 && distinct[i] > 0
                           : distinct[i] <= 0);
        if (surface >= 2) {
            if (!others_see(g->cx, g->cy)) continue;
            thing += g->pixels;
            right += fabs(at / truth - 1) < 0.02 ? g->pixels : 0;
        } else {
            other += g->pixels;
            wrong += at > 0 ? g->pixels : 0;
        }
    }
    return (struct share){thing > 0 ? right / thing : 0, wrong / other};
}

static struct share find(bool knows_floor)
{
    const struct share s = find_and_keep(knows_floor);
    plane_prior_release(&prior);
    bench_release();
    return s;
}

/* The whole table and a fifth of all else took the table's plane. */
static void what_took_a_plane_counts_where_it_matches(void **state)
{
    (void)state;
    room(0.8);
    level(0, 0.5, 1.6, 0.6, 0.55, 0.8);
    assert_true(find_and_keep(true).right > 0.85);
    assert_true(largest.count >= 1);
    const struct plane top = largest.planes[0];
    double table = 0, kept = 0;
    int others = 0;
    b.problem.furniture = &largest;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        int surface;
        scene_depth(&b.scene, &b.scene.views[0], g->cx, g->cy, &surface);
        found[i] = (struct plane){0, 0, 0};
        distinct[i] = 0;
        planes[i] = surface == 2 || i % 5 == 0 ? top : prior.planes[prior.expected[i]];
    }
    furniture_sweep_extend(distinct, found, planes, &b.problem);
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        int surface;
        scene_depth(&b.scene, &b.scene.views[0], g->cx, g->cy, &surface);
        const bool counts = plane_at(found[i], g->cx, g->cy) > 0;
        if (surface == 2 && !others_see(g->cx, g->cy)) continue;
        if (surface == 2) table += g->pixels;
        if (surface == 2 && counts) kept += g->pixels;
        others += surface != 2 && counts;
        assert_true(counts == (distinct[i] > 0));
    }
    assert_true(kept > 0.85 * table);
    assert_true(others <= 2); /* at the table's edge */
    plane_prior_release(&prior);
    bench_release();
}

/* The range of depths ends at 2.8, behind the table. */
static void a_table_nearer_than_all_points_is_found(void **state)
{
    (void)state;
    room(0.8);
    level(0, 0.5, 1.6, 0.6, 0.55, 0.8);
    const struct share s = find(true);
    assert_true(s.right > 0.85);
    assert_true(s.wrong < 0.03);
}

static void so_is_the_front_of_a_cupboard(void **state)
{
    (void)state;
    room(0.8);
    upright(-0.3, 0.4, 1.8, 0.45, 0.6, 0.8);
    const struct share s = find(true);
    assert_true(s.right > 0.85);
    assert_true(s.wrong < 0.03);
}

static void an_empty_room_keeps_its_faces(void **state)
{
    (void)state;
    room(0.8);
    assert_near(find(true).wrong, 0, 0);
}

static void blank_faces_match_everywhere_and_keep_their_planes(void **state)
{
    (void)state;
    room(0);
    assert_near(find(true).wrong, 0, 0);
}

static void without_a_floor_nothing_is_looked_for(void **state)
{
    (void)state;
    room(0.8);
    level(0, 0.5, 1.6, 0.6, 0.55, 0.8);
    assert_near(find(false).right, 0, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_table_nearer_than_all_points_is_found),
        cmocka_unit_test(so_is_the_front_of_a_cupboard),
        cmocka_unit_test(what_took_a_plane_counts_where_it_matches),
        cmocka_unit_test(an_empty_room_keeps_its_faces),
        cmocka_unit_test(blank_faces_match_everywhere_and_keep_their_planes),
        cmocka_unit_test(without_a_floor_nothing_is_looked_for),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
