/* unseen.c - segments that no neighbour sees: strips at each side of the picture, outside the neighbours' frames. They
 * continue the surface beside them, never one in front of it, and have low confidence. */
#include "tests/unit/segment_depth/whole.h"

#include "common/base/parallel.h"
#include "common/math/numbers.h"

static const struct segment_params params = SEGMENT_PARAMS_DEFAULT;

/* From the strip's side of the picture into the picture. */
struct side {
    const char *name;
    int x, y;
};
static const struct side sides[] = {{"left", 1, 0}, {"right", -1, 0}, {"top", 0, 1}, {"bottom", 0, -1}};
enum { SIDES = 4 };

/* The neighbours are placed towards the middle of the picture, so that the strip is out of their frames. */
static void place_cameras_towards(const struct side *side)
{
    static const double distance[] = {0, 1.0, 1.2, 1.4};
    for (int k = 0; k < 4; k++)
        scene_view(&scene, W, H, FOCAL, side->x * distance[k] + side->y * 0.1 * k,
                   side->y * distance[k] + side->x * 0.1 * k, 0, 0);
}

/* Of the pixels that no neighbour sees, but for those beside seen ones. */
struct unseen {
    int pixels;
    double good, near, confident; /* fractions: within 2 %; more than 5 % nearer; of confidence above DEPTH_INHERITED */
};

static struct unseen measure(const char *what, const struct layered_depth *d)
{
    struct unseen sum = {0};
    for (int y = 0; y < H; y++)
        for (int x = 0; x < W; x++) {
            int at;
            bool alone = true;
            for (int k = 0; k < 9 && alone; k++)
                alone = !scene_seen_elsewhere(&scene, clamp(x + 8 * (k % 3 - 1), 0, W - 1) + 0.5,
                                              clamp(y + 8 * (k / 3 - 1), 0, H - 1) + 0.5);
            if (!alone) continue;
            const double ratio =
                (double)d->interior.z[y * W + x] / scene_depth(&scene, &scene.views[0], x + 0.5, y + 0.5, &at);
            sum.pixels++;
            sum.good += fabs(ratio - 1) <= 0.02;
            sum.near += ratio < 0.95;
            sum.confident += d->segments[d->interior.id[y * W + x] - 1].confidence >= DEPTH_INHERITED;
        }
    assert_true(sum.pixels > 0);
    sum.good /= sum.pixels;
    sum.near /= sum.pixels;
    sum.confident /= sum.pixels;
    if (getenv("VERDICT"))
        print_message("  %s: of %d unseen px %.3f within 2 %%, %.3f near, %.3f confident\n", what, sum.pixels, sum.good,
                      sum.near, sum.confident);
    return sum;
}

/* A wall through (0, 0, 5) whose depth grows by `lean` towards the strip. */
static struct painted_surface *leaning_wall(const struct side *side, double lean)
{
    struct painted_surface *wall = scene_surface(&scene, vec3_make(0, 0, 5));
    wall->across = vec3_make(12, 0, -12 * lean * side->x);
    wall->down = vec3_make(0, 12, -12 * lean * side->y);
    if (side->x) wall->across = vec3_scale(wall->across, 0.5);
    if (side->y) wall->down = vec3_scale(wall->down, 0.5);
    return wall;
}

static void an_oblique_wall_continues_out_of_the_neighbours_view(void **state)
{
    (void)state;
    for (int k = 0; k < SIDES; k++)
        for (int lean = -1; lean <= 1; lean += 2) {
            struct layered_depth d[2];
            start();
            leaning_wall(&sides[k], 0.4 * lean);
            place_cameras_towards(&sides[k]);
            scene_points(&scene, 200);
            must_work_in_rounds(d, 1, &params);
            for (int round = 0; round < 2; round++) {
                const struct unseen strip = measure(sides[k].name, &d[round]);
                assert_true(strip.pixels > 0.1 * W * H && strip.good > 0.97 && strip.confident < 0.02);
                layered_depth_release(&d[round]);
            }
        }
}

/* A card in front of the wall, at the inner edge of the strip; other parts of the strip touch the wall. */
static void a_strip_beside_foreground_takes_the_depth_of_the_wall(void **state)
{
    (void)state;
    for (int k = 0; k < SIDES; k++)
        for (int dark = 0; dark < 2; dark++) {
            struct layered_depth d[2];
            start();
            struct painted_surface *wall = leaning_wall(&sides[k], 0.2);
            if (dark) {
                wall->contrast = 0.15;
                for (int c = 0; c < 3; c++) wall->colour[c] *= 0.2f;
            }
            struct painted_surface *card = scene_wall(&scene, -0.55 * sides[k].x, -0.35 * sides[k].y, 3, 0.35, 0.35, 0);
            card->colour[0] = 0.12f;
            place_cameras_towards(&sides[k]);
            scene_points(&scene, 200);
            must_work_in_rounds(d, 1, &params);
            for (int round = 0; round < 2; round++) {
                const struct unseen strip = measure(sides[k].name, &d[round]);
                assert_true(strip.pixels > 0.1 * W * H && strip.near < 0.02 && strip.confident < 0.02);
                if (!dark) assert_true(strip.good > 0.97);
                layered_depth_release(&d[round]);
            }
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(an_oblique_wall_continues_out_of_the_neighbours_view),
        cmocka_unit_test(a_strip_beside_foreground_takes_the_depth_of_the_wall),
    };
    parallel_set_threads(1); /* tests run in parallel */
    return cmocka_run_group_tests(tests, NULL, NULL);
}
