/* cross_view.c - consistency of known planes with neighbours' depth maps that are made of world planes. */
#include "stages/segment_depth/cross_view.h"

#include "tests/unit/segment_depth/scene.h"

enum { W = 64, H = 48, CELL = 8, ACROSS = W / CELL, SEGMENTS = ACROSS * (H / CELL), FOCAL = 64 };

static const double step = 0.002; /* small, so that steps are equal over the whole depth range */

struct world_plane { /* normal . X = distance */
    struct vec3 normal;
    double distance;
};

/* One surface in all views; a card in front of it (distance > 0) covers the left half of a neighbour's picture. */
struct bench {
    struct scene scene;
    struct segmentation s;
    struct world_plane surface[MAX_VIEWS];
    double confidence;
    int unknown; /* pixels left of this column have no depth in the neighbours */
    int broken;  /* a view that cannot be read */
    struct cross_view x;
};

static struct bench b; /* large */

/* In the pixel coordinates of a view: with X = R' (ray z - t), normal . X = distance. */
static struct plane plane_in(const struct world_plane *w, const struct view *v)
{
    const struct vec3 n = mat3_apply(v->cam_from_world, w->normal);
    const double d = w->distance + vec3_dot(n, v->translation);
    const struct plane p = {n.x / v->fx / d, n.y / v->fy / d, 0};
    return (struct plane){p.a, p.b, n.z / d - p.a * v->cx - p.b * v->cy};
}

static struct world_plane facing(double z) { return (struct world_plane){vec3_make(0, 0, 1), z}; }

/* Segments of CELL x CELL pixels. */
static void start(void)
{
    memset(&b, 0, sizeof b);
    b.confidence = 1;
    b.broken = -1;
    b.s = (struct segmentation){.width = W, .height = H, .count = SEGMENTS};
    b.s.label = malloc(sizeof(int) * W * H);
    b.s.pixel = malloc(sizeof(int) * W * H);
    b.s.segments = calloc(SEGMENTS, sizeof *b.s.segments);
    assert_true(b.s.label && b.s.pixel && b.s.segments);
    for (int i = 0; i < SEGMENTS; i++) {
        const int x0 = i % ACROSS * CELL, y0 = i / ACROSS * CELL;
        b.s.segments[i] = (struct segment){.first = i * CELL * CELL,
                                           .pixels = CELL * CELL,
                                           .cx = x0 + CELL / 2.0,
                                           .cy = y0 + CELL / 2.0,
                                           .x0 = x0,
                                           .y0 = y0,
                                           .x1 = x0 + CELL - 1,
                                           .y1 = y0 + CELL - 1};
        for (int k = 0; k < CELL * CELL; k++) {
            const int pixel = (y0 + k / CELL) * W + x0 + k % CELL;
            b.s.pixel[i * CELL * CELL + k] = pixel;
            b.s.label[pixel] = i;
        }
    }
    for (int k = 0; k < MAX_VIEWS; k++) b.surface[k] = facing(4);
}

static enum status read_depth(void *ctx, int view_idx, struct layered_depth *d, struct err *err)
{
    (void)ctx;
    const struct view *v = &b.scene.views[view_idx];
    if (view_idx == b.broken) return err_set(err, ST_IO, "cannot read depth %d.", view_idx);
    assert_null(d->interior.id);
    *d = (struct layered_depth){.width = v->width, .height = v->height, .segment_count = SEGMENTS};
    d->interior.id = calloc((size_t)v->width * (size_t)v->height, sizeof *d->interior.id);
    d->segments = calloc(SEGMENTS, sizeof *d->segments);
    assert_true(d->interior.id && d->segments);
    const struct plane p = plane_in(&b.surface[view_idx], v);
    for (int i = 0; i < SEGMENTS; i++)
        d->segments[i] = (struct depth_segment){
            .id = (uint32_t)i + 1, .plane = {p.a, p.b, p.c}, .sigma = 0.01, .confidence = b.confidence};
    for (int y = 0; y < v->height; y++)
        for (int x = b.unknown; x < v->width; x++)
            d->interior.id[y * v->width + x] =
                (uint32_t)(y * (H / CELL) / v->height * ACROSS + x * ACROSS / v->width) + 1;
    return ST_OK;
}

static enum status make(struct err *err)
{
    int neighbours[MAX_NEIGHBOURS];
    const struct previous_depth_source source = {read_depth, NULL};
    const int count = b.scene.set.view_count - 1;
    for (int k = 0; k < count; k++) neighbours[k] = k + 1;
    return cross_view_make(&b.x, &b.s, &b.scene.set, 0, neighbours, count, step, &source, err);
}

static void must_make(void)
{
    struct err err = ERR_INIT;
    if (make(&err)) fail_msg("%s", err.text);
}

static void finish(void)
{
    cross_view_release(&b.x);
    oversegment_release(&b.s);
}

/* Whether the segment, if it lies on the plane, is inside the frames of all neighbours. */
static bool framed(int segment, struct plane p)
{
    const struct segment *g = &b.s.segments[segment];
    for (int k = 1; k < b.scene.set.view_count; k++)
        for (int c = 0; c < 4; c++) {
            const double u = c & 1 ? g->x1 + 1 : g->x0, v = c & 2 ? g->y1 + 1 : g->y0;
            double pu = -1, pv = -1;
            const struct view *n = &b.scene.views[k];
            if (!(view_project(n, view_unproject(&b.scene.views[0], u, v, 1 / plane_at(p, u, v)), &pu, &pv) > 0))
                return false;
            if (!(pu > 1 && pv > 1 && pu < n->width - 1 && pv < n->height - 1)) return false;
        }
    return true;
}

/* Three cameras: one shifted sideways, one rotated, moved forward and of another size. */
static void place_cameras(void)
{
    scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
    scene_view(&b.scene, W, H, FOCAL, 0.4, 0, 0, 0);
    scene_view(&b.scene, 110, 84, 80, -0.5, 0.1, 0.6, 0.15);
}

static void agreeing_views_cost_nothing(void **state)
{
    (void)state;
    int count = 0;
    start();
    place_cameras();
    const struct world_plane wall = {vec3_normalize(vec3_make(0.3, -0.2, 1)), 4};
    for (int k = 0; k < 3; k++) b.surface[k] = wall;
    b.confidence = 0.75;
    must_make();
    const struct plane p = plane_in(&wall, &b.scene.views[0]);
    for (int i = 0; i < SEGMENTS; i++) {
        unsigned occluded = 99;
        if (!framed(i, p)) continue;
        assert_near(cross_view_cost(&b.x, i, p, &occluded), 0, 1e-4); /* samples are float */
        assert_int_equal(occluded, 0);
        assert_near(cross_view_support(&b.x, i, p), 2 * 0.75, 1e-6);
        count++;
    }
    assert_true(count > SEGMENTS / 2);
    finish();
}

/* The cost grows with the gap up to two steps, for any motion of the neighbour. */
static void planes_within_two_steps_agree(void **state)
{
    (void)state;
    start();
    place_cameras();
    scene_view(&b.scene, W, H, FOCAL, 0, 0.1, -3, 0); /* farther back */
    must_make();
    for (int i = 0; i < SEGMENTS; i++) {
        float before = -1;
        if (!framed(i, (struct plane){0, 0, 0.25})) continue;
        for (double off = 0; off < 2; off += 0.1) {
            unsigned occluded;
            const float near = cross_view_cost(&b.x, i, (struct plane){0, 0, 0.25 + off * step}, &occluded);
            const float far = cross_view_cost(&b.x, i, (struct plane){0, 0, 0.25 - off * step}, &occluded);
            assert_near(near, far, 0.01);
            assert_true(near > before && near < 0.2f);
            before = near;
            if (off < 1.85) assert_near(cross_view_support(&b.x, i, (struct plane){0, 0, 0.25 + off * step}), 3, 1e-6);
        }
        assert_near(cross_view_support(&b.x, i, (struct plane){0, 0, 0.25 + 2.15 * step}), 0, 0);
        assert_near(cross_view_support(&b.x, i, (struct plane){0, 0, 0.25 - 2.15 * step}), 0, 0);
    }
    finish();
}

static const double confidences[] = {1, 0.5, 0.2, 0};

/* The wall at depth 4 in all views, which are confident of it to the degree k. */
static void make_wall(int k)
{
    start();
    place_cameras();
    b.confidence = confidences[k];
    must_make();
}

/* The plane lies in front of the neighbours' surface and would occlude it. */
static void seeing_through_a_plane_costs_in_proportion_to_confidence(void **state)
{
    (void)state;
    float before = 9;
    for (int k = 0; k < 4; k++) {
        int count = 0;
        make_wall(k);
        const struct plane p = {0, 0, 0.25 + 12 * step};
        float min_cost = 9, max_cost = 0;
        for (int i = 0; i < SEGMENTS; i++) {
            unsigned occluded = 99;
            if (!framed(i, p)) continue;
            const float cost = cross_view_cost(&b.x, i, p, &occluded);
            assert_int_equal(occluded, 0);
            min_cost = fminf(min_cost, cost);
            max_cost = fmaxf(max_cost, cost);
            /* even farther in front costs no less */
            assert_true(cross_view_cost(&b.x, i, (struct plane){0, 0, 0.25 + 20 * step}, &occluded) >= cost - 1e-6f);
            count++;
        }
        assert_true(count > SEGMENTS / 3);
        assert_near(min_cost, max_cost, 1e-5);
        if (k == 0) assert_true(max_cost > 0.9f && max_cost < 1.2f);
        assert_true(max_cost < before);
        before = max_cost;
        finish();
    }
    assert_true(before > 0.2f); /* even a neighbour of no confidence counts */
}

/* A confident surface in front of the plane occludes it in the neighbour. That costs little if only one neighbour has
 * such a surface, which may be wrong. */
static void a_plane_behind_a_confident_surface_is_occluded(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        int count = 0;
        start();
        place_cameras();
        b.confidence = k == 2 ? 0.2 : 1;
        if (k == 1) b.surface[1] = facing(3); /* in one neighbour only */
        const struct plane p = {0, 0, k == 1 ? 0.25 : 0.25 - 15 * step};
        must_make();
        for (int i = 0; i < SEGMENTS; i++) {
            unsigned occluded = 99;
            if (!framed(i, p)) continue;
            const float cost = cross_view_cost(&b.x, i, p, &occluded);
            assert_int_equal(occluded, k == 0 ? 3 : k == 1 ? 1 : 0);
            if (k == 1) assert_true(cost > 0 && cost < 0.4f);
            assert_near(cross_view_support(&b.x, i, p), k == 1 ? 1 : 0, 1e-6);
            count++;
        }
        assert_true(count > SEGMENTS / 2);
        finish();
    }
}

/* Two neighbours have a surface in front of the plane: the view itself would have to see it. That costs more than being
 * seen through, in proportion to their confidence: nothing hides there. */
static void a_plane_behind_surfaces_of_two_neighbours_costs_much(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        int count = 0;
        make_wall(k);
        for (int i = 0; i < SEGMENTS; i++) {
            const struct plane behind = {0, 0, 0.25 - 15 * step}, in_front = {0, 0, 0.25 + 15 * step};
            unsigned occluded;
            if (!framed(i, behind) || !framed(i, in_front)) continue;
            const float cost = cross_view_cost(&b.x, i, behind, &occluded);
            assert_near(cost, 0.15 + 1.5 * fmax(confidences[k], 0.05), 0.02);
            if (k < 2) assert_true(cost > cross_view_cost(&b.x, i, in_front, &occluded));
            count++;
        }
        assert_true(count > SEGMENTS / 3);
        finish();
    }
}

/* Two of three neighbours agree on a surface, the third has another one in front: that one counts as little as if it
 * were not there. */
static void one_wrong_neighbour_in_front_costs_only_an_occlusion(void **state)
{
    (void)state;
    float cost[2] = {0};
    int count = 0;
    for (int wrong = 0; wrong < 2; wrong++) {
        start();
        place_cameras();
        scene_view(&b.scene, W, H, FOCAL, 0, 0.3, 0, 0);
        if (wrong) b.surface[3] = facing(2.5);
        must_make();
        for (int i = 0; i < SEGMENTS; i++) {
            unsigned occluded = 99;
            if (!framed(i, (struct plane){0, 0, 0.25})) continue;
            const float here = cross_view_cost(&b.x, i, (struct plane){0, 0, 0.25}, &occluded);
            assert_int_equal(occluded, wrong ? 4 : 0);
            cost[wrong] = fmaxf(cost[wrong], here);
            count++;
        }
        finish();
    }
    assert_true(count > SEGMENTS / 2);
    assert_near(cost[1] - cost[0], 0.15 / 3, 0.01);
}

/* Outside the frame, behind the camera, without depth: the cost lies between agreement and violation. */
static void a_neighbour_without_depth_costs_the_same_for_any_plane(void **state)
{
    (void)state;
    const struct plane p = {0, 0, 0.25};
    float unknown = -1;
    for (int k = 0; k < 4; k++) {
        start();
        scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
        scene_view(&b.scene, W, H, FOCAL, k == 1 ? 30 : 0.2, 0, k == 2 ? 6 : 0, k == 0 ? M_PI : 0);
        if (k == 3) b.unknown = W;
        must_make();
        for (int i = 0; i < SEGMENTS; i++) {
            unsigned occluded = 99;
            const float cost = cross_view_cost(&b.x, i, p, &occluded);
            if (unknown < 0) unknown = cost;
            assert_near(cost, unknown, 1e-6);
            assert_int_equal(occluded, 0);
            assert_near(cross_view_support(&b.x, i, p), 0, 0);
        }
        finish();
    }
    assert_true(unknown > 0.01f && unknown < 0.5f);
}

static void without_neighbours_there_is_no_cost(void **state)
{
    (void)state;
    unsigned occluded = 99;
    start();
    scene_view(&b.scene, W, H, FOCAL, 0, 0, 0, 0);
    must_make();
    assert_near(cross_view_cost(&b.x, 3, (struct plane){0, 0, 1}, &occluded), 0, 0);
    assert_int_equal(occluded, 0);
    assert_int_equal(b.x.first_proposal[SEGMENTS], 0);
    finish();
}

/* Random planes, some through a camera or behind it. */
static void any_plane_has_a_finite_cost(void **state)
{
    (void)state;
    static const double sizes[] = {0, 1e-9, 1e-3, 0.3, 20, 1e6, 1e15, 1e100};
    start();
    place_cameras();
    b.unknown = 20;
    must_make();
    for (int i = 0; i < SEGMENTS; i += 5)
        for (int k = 0; k < 64; k++) {
            unsigned occluded = 0;
            const struct plane p = {sizes[k % 8] * (k % 2 ? 1 : -1), -0.5 * sizes[k % 8], sizes[k / 8]};
            const float cost = cross_view_cost(&b.x, i, p, &occluded);
            assert_true(cost >= 0 && cost < 1.66f && occluded < 4);
            assert_true(cross_view_support(&b.x, i, p) <= 2);
        }
    finish();
}

/* Proposals express the neighbours' planes in the view's pixels; each segment of a neighbour proposes its plane to the
 * segment that its centroid projects into. */
static void proposals_are_the_neighbours_planes_in_this_views_pixels(void **state)
{
    (void)state;
    static const double normals[][3] = {{0, 0, 1}, {0.5, 0.1, 1}, {0, 1, 0.3}, {-0.4, 0.8, 0.6}};
    for (int n = 0; n < 4; n++) {
        int wanted[SEGMENTS] = {0}, total = 0;
        start();
        place_cameras();
        const struct world_plane w = {vec3_normalize(vec3_make(normals[n][0], normals[n][1], normals[n][2])), 3};
        const struct plane truth = plane_in(&w, &b.scene.views[0]);
        for (int k = 0; k < 3; k++) b.surface[k] = w;
        must_make();
        for (int k = 1; k < 3; k++) {
            const struct view *v = &b.scene.views[k];
            const struct plane p = plane_in(&w, v);
            for (int i = 0; i < SEGMENTS; i++) { /* centroids of a neighbour's segments, as in read_depth() */
                double su = 0, sv = 0, u, x;
                int pixels = 0;
                for (int y = 0; y < v->height; y++)
                    for (int c = 0; c < v->width; c++)
                        if (y * (H / CELL) / v->height * ACROSS + c * ACROSS / v->width == i) {
                            su += c + 0.5;
                            sv += y + 0.5;
                            pixels++;
                        }
                const double inverse = plane_at(p, su / pixels, sv / pixels);
                if (!(inverse > 0)) continue;
                const struct vec3 at = view_unproject(v, su / pixels, sv / pixels, 1 / inverse);
                if (!(view_project(&b.scene.views[0], at, &u, &x) > 0) || !(u >= 0 && x >= 0 && u < W && x < H))
                    continue;
                wanted[(int)x / CELL * ACROSS + (int)u / CELL]++;
                total++;
            }
        }
        assert_true(total > 20);
        for (int i = 0; i < SEGMENTS; i++) {
            assert_int_equal(b.x.first_proposal[i + 1] - b.x.first_proposal[i], wanted[i]);
            for (int k = b.x.first_proposal[i]; k < b.x.first_proposal[i + 1]; k++) {
                const struct plane *p = &b.x.proposals[k];
                assert_near(p->a, truth.a, 1e-12);
                assert_near(p->b, truth.b, 1e-12);
                assert_near(p->c, truth.c, 1e-10);
            }
        }
        finish();
    }
}

static void an_unreadable_depth_map_is_an_error(void **state)
{
    (void)state;
    for (int k = 1; k < 3; k++) {
        struct err err = ERR_INIT;
        start();
        place_cameras();
        b.broken = k;
        assert_int_equal(make(&err), ST_IO);
        assert_string_equal(err.text, k == 1 ? "cannot read depth 1." : "cannot read depth 2.");
        finish();
        cross_view_release(&b.x);
    }
    cross_view_release(NULL);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(agreeing_views_cost_nothing),
        cmocka_unit_test(planes_within_two_steps_agree),
        cmocka_unit_test(seeing_through_a_plane_costs_in_proportion_to_confidence),
        cmocka_unit_test(a_plane_behind_a_confident_surface_is_occluded),
        cmocka_unit_test(a_plane_behind_surfaces_of_two_neighbours_costs_much),
        cmocka_unit_test(one_wrong_neighbour_in_front_costs_only_an_occlusion),
        cmocka_unit_test(a_neighbour_without_depth_costs_the_same_for_any_plane),
        cmocka_unit_test(without_neighbours_there_is_no_cost),
        cmocka_unit_test(any_plane_has_a_finite_cost),
        cmocka_unit_test(proposals_are_the_neighbours_planes_in_this_views_pixels),
        cmocka_unit_test(an_unreadable_depth_map_is_an_error),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
