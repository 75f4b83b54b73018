/* plane_refit.c - planes that many segments share, on photographs of a wall, a ceiling and a roof. */
#include "stages/segment_depth/plane_refit.h"

#include "tests/unit/segment_depth/problem.h"

#include "common/base/parallel.h"

static struct scene_planes planes;

/* The plane of a surface of the scene as the first view sees it. */
static struct plane true_plane(const struct painted_surface *s)
{
    const struct vec3 n = vec3_cross(s->across, s->down);
    return plane_of_normal(&b.scene.views[0], vec3_scale(n, 1 / vec3_dot(n, s->center)));
}

/* The segments whose centre the first view sees on a surface. */
static int members_of(int *members, int surface)
{
    int count = 0, at;
    for (int i = 0; i < b.segments.count; i++) {
        const struct segment *g = &b.segments.segments[i];
        scene_depth(&b.scene, &b.scene.views[0], g->cx, g->cy, &at);
        if (at == surface) members[count++] = i;
    }
    return count;
}

/* Fits a plane that is off to a surface. Returns by how many steps it is off then, at most, over the surface. */
static double refit(struct plane off, int surface)
{
    static int members[MAX_SEGMENTS];
    const int count = members_of(members, surface);
    const struct plane truth = true_plane(&b.scene.surfaces[surface]);
    double worst = 0;
    assert_true(count > 50);
    planes = (struct scene_planes){.count = 1};
    scene_planes_set(&planes, 0, (struct plane){truth.a + off.a, truth.b + off.b, truth.c + off.c});
    b.problem.scene = &planes;
    plane_refit(&planes, 0, members, count, &b.problem);
    assert_true(scene_planes_have(&planes, planes.planes[0]));
    for (int k = 0; k < count; k++) {
        const struct segment *g = &b.segments.segments[members[k]];
        const double wrong = fabs(plane_at(planes.planes[0], g->cx, g->cy) - plane_at(truth, g->cx, g->cy));
        if (wrong > worst) worst = wrong; /* not fmax: gcc 12 for arm64 stops with an internal error */
    }
    if (getenv("VERDICT")) print_message("  %.3f steps off\n", worst / b.problem.step);
    return worst / b.problem.step;
}

/* How far the scene's plane is from horizontal, in radians. */
static double tilt(void)
{
    const struct vec3 n = vec3_normalize(plane_normal(&b.scene.views[0], planes.planes[0]));
    return vec3_length(vec3_cross(n, b.problem.down));
}

static void a_plane_moves_to_where_all_its_segments_match(void **state)
{
    (void)state;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 5, 8, 8, 0.4);
    bench_views();
    bench_make(0.12, 0.45);
    const double step = b.problem.step;
    for (int k = 0; k < 4; k++) {
        const double turn = (k & 1 ? 1 : -1) * 3 * step / W, shift = (k & 2 ? 1 : -1) * 2 * step;
        assert_true(refit((struct plane){turn, -turn, shift}, 0) < 0.3);
    }
    bench_release();
}

/* A ceiling with a few grains beside the far wall and none nearer, whose plane has the slant of a few votes. */
static void a_blank_ceiling_is_made_horizontal(void **state)
{
    (void)state;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 9, 20, 20, 0);
    struct painted_surface *grained = scene_surface(&b.scene, vec3_make(0, -1.2, 7.5)),
                           *blank = scene_surface(&b.scene, vec3_make(0, -1.2, 4));
    grained->across = blank->across = vec3_make(15, 0, 0);
    grained->down = vec3_make(0, 0, 1.5);
    blank->down = vec3_make(0, 0, 2);
    grained->cell = 0.25;
    blank->contrast = 0;
    for (int c = 0; c < 3; c++) blank->colour[c] = grained->colour[c];
    bench_views();
    bench_make(0.1, 0.5);
    /* right at the far wall, and off by some steps at the picture's edge */
    const double horizon = H / 2.0, far = horizon - FOCAL * 1.2 / 9, off = 6 * b.problem.step / far;
    static int members[MAX_SEGMENTS];
    const int count = members_of(members, 1);
    const int all = count + members_of(members + count, 2);
    const struct plane truth = true_plane(blank);
    planes = (struct scene_planes){.count = 1};
    scene_planes_set(&planes, 0, (struct plane){truth.a, truth.b - off, truth.c + off * far});
    b.problem.scene = &planes;
    assert_true(tilt() > 0.03);
    plane_refit(&planes, 0, members, all, &b.problem);
    assert_true(tilt() < 1e-6);
    const double wrong = (plane_at(planes.planes[0], W / 2.0, 0) - plane_at(truth, W / 2.0, 0)) / b.problem.step;
    if (getenv("VERDICT")) print_message("  %.3f steps off at the picture's edge\n", wrong);
    assert_true(fabs(wrong) < 1);
    bench_release();
}

static void a_roof_that_is_nearly_horizontal_is_left_as_it_is(void **state)
{
    (void)state;
    bench_empty();
    scene_wall(&b.scene, 0, 0, 9, 20, 20, 0);
    struct painted_surface *roof = scene_surface(&b.scene, vec3_make(0, -1.5, 5));
    roof->across = vec3_make(15, 0, 0);
    roof->down = vec3_make(0, 0.8, 3.5);
    roof->cell = 0.25;
    bench_views();
    bench_make(0.1, 0.8);
    assert_true(refit((struct plane){0, 0, 1.5 * b.problem.step}, 1) < 0.5);
    assert_true(tilt() > 0.15);
    bench_release();
}

static void a_plane_of_few_segments_stays(void **state)
{
    (void)state;
    const int members[2] = {0, 1};
    const struct plane plane = {0.001, 0, 0.2};
    planes = (struct scene_planes){.count = 1};
    scene_planes_set(&planes, 0, plane);
    plane_refit(&planes, 0, members, 2, &b.problem);
    assert_memory_equal(&planes.planes[0], &plane, sizeof plane);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plane_moves_to_where_all_its_segments_match),
        cmocka_unit_test(a_blank_ceiling_is_made_horizontal),
        cmocka_unit_test(a_roof_that_is_nearly_horizontal_is_left_as_it_is),
        cmocka_unit_test(a_plane_of_few_segments_stays),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
