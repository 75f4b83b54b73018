/* Light transport against closed forms: furnaces, lamps over a floor, the sun through a window, a box that absorbs
 * nothing; and next-event estimation against brdf sampling alone. */
#include "tests/unit/simulate/worlds.h"

static const struct vec3 up = {0, 0, 1};

/* In a closed room that reflects half of the light and emits 1/2 everywhere, the radiance is 1. */
static void a_closed_room_that_reflects_and_emits_half_has_radiance_one(void **state)
{
    (void)state;
    const struct vec3 directions[] = {{1, 0.2, 0.1}, {-0.3, 0.4, -1}, {0.1, 0.9, 0.5}};
    struct world w = world_from("texture half rgb 0.5 0.5 0.5\nmaterial m lambert half\nglow m 0.5 0.5 0.5\n"
                                "box room 0 0 0 4 3 2.5 m\n");
    for (int i = 0; i < 3; i++) {
        const struct rgb l = mean_radiance(&w, vec3_make(1, 1, 1), directions[i], 60000, i);
        assert_near(l.r, 1, 0.005);
        assert_near(l.g, 1, 0.005);
        assert_near(l.b, 1, 0.005);
    }
    assert_near(mean_irradiance(&w, vec3_make(2, 1, 0.02), up, 60000, 1).g, PI, 0.005);
    w.max_bounces = 3; /* 1/2 + 1/4 + 1/8 + 1/16 */
    assert_near(mean_radiance(&w, vec3_make(1, 1, 1), directions[0], 60000, 5).r, 0.9375, 0.005);
    path_world_release(&w);
}

/* The same with glossy walls. The lobe loses what falls below the horizon, so the radiance has only bounds: above
 * that of the diffuse part alone, below that of the full lobe. */
static void glossy_walls_keep_the_furnace_within_its_bound(void **state)
{
    (void)state;
    const char *const kinds[] = {"phong half 0.8 20", "ward half 0.45 0.2", "ward half 0.4 0.6"};
    for (int i = 0; i < 3; i++) {
        char text[300];
        snprintf(text, sizeof text,
                 "texture half rgb 0.5 0.5 0.5\nmaterial m %s\nglow m 0.5 0.5 0.5\nbox room 0 0 0 4 3 2 m\n", kinds[i]);
        struct world w = world_from(text);
        const double bound = 0.5 / (1 - 0.5 - w.scene.materials[0].gloss);
        const struct rgb l = mean_radiance(&w, vec3_make(1, 1, 1), vec3_make(1, 0.3, 0.2), 100000, i);
        assert_true(l.r > 1.05 && l.r < bound * 1.005);
        path_world_release(&w);
    }
}

/* Form factor of a rectangle parallel to a surface element, with one corner above the element; a and b are the sides
 * divided by the height. */
static double corner_factor(double a, double b)
{
    return (a / sqrt(1 + a * a) * atan(b / sqrt(1 + a * a)) + b / sqrt(1 + b * b) * atan(a / sqrt(1 + b * b))) /
           (2 * PI);
}

static double rectangle_factor(double x0, double x1, double y0, double y1, double h)
{
#define F(x, y) (((x) < 0) != ((y) < 0) ? -1 : 1) * corner_factor(fabs(x) / h, fabs(y) / h)
    return F(x1, y1) - F(x0, y1) - F(x1, y0) + F(x0, y0);
#undef F
}

static void a_square_lamp_gives_the_irradiance_of_its_form_factor(void **state)
{
    (void)state;
    const struct vec3 places[] = {{0, 0, 0.001}, {0.5, 0.3, 0.001}, {-2, 1, 0.001}, {4, 4, 0.001}};
    struct world w =
        world_from("texture grey rgb 0.5 0.25 0.1\nmaterial m lambert grey\nquad floor -9 -9 0 18 0 0 0 18 0 m\n"
                   "lamp l quad 0 0 2  0 0.6 0  1 0 0  10 20 5\n");
    for (int i = 0; i < 4; i++) {
        const struct vec3 p = places[i];
        const double factor = rectangle_factor(0 - p.x, 1 - p.x, 0 - p.y, 0.6 - p.y, 2 - p.z);
        for (int way = 0; way < 2; way++) {
            w.brdf_sampling_only = way;
            const int paths = way ? 1000000 : 20000;
            if (way && i > 1) continue; /* too small from there to be hit by chance */
            const struct rgb e = mean_irradiance(&w, p, up, paths, i);
            assert_near(e.r, PI * 10 * factor, 0.005);
            assert_near(e.g, PI * 20 * factor, 0.005);
        }
        w.brdf_sampling_only = false; /* as a camera sees the floor */
        const struct rgb l = mean_radiance(&w, vec3_make(p.x, p.y, 1), vec3_make(0, 0, -1), 20000, i);
        assert_near(l.r, 0.5 * 10 * factor, 0.005);
        assert_near(l.b, 0.1 * 5 * factor, 0.005);
    }
    /* dark above the lamp; the lamp itself has the radiance of its description */
    assert_true(mean_irradiance(&w, vec3_make(0.5, 0.3, 2.5), vec3_make(0, 0, -1), 4096, 1).r < 10);
    assert_near(mean_radiance(&w, vec3_make(0.5, 0.3, 1), up, 4096, 1).g, 20, 1e-12);
    assert_true(mean_radiance(&w, vec3_make(0.5, 0.3, 3), vec3_make(0, 0, -1), 4096, 1).g == 0);
    path_world_release(&w);
}

static void a_round_lamp_gives_the_irradiance_of_its_form_factor(void **state)
{
    (void)state;
    struct world w =
        world_from("texture black rgb 0 0 0\nmaterial m lambert black\nquad floor -9 -9 0 18 0 0 0 18 0 m\n"
                   "lamp l disk 0 0 2  0 0 -1  0.5  10 20 5  90\n");
    for (int i = 0; i < 4; i++) { /* off the axis */
        const double d = 0.01 + 0.7 * i, h = 2 / d, r = 0.5 / d, z = 1 + h * h + r * r;
        const double factor = 0.5 * (1 - (1 + h * h - r * r) / sqrt(z * z - 4 * r * r));
        for (int way = 0; way < 2; way++) {
            w.brdf_sampling_only = way;
            const struct rgb e = mean_irradiance(&w, vec3_make(0.6 * d, -0.8 * d, 0), up, way ? 1000000 : 20000, i);
            assert_near(e.r, PI * 10 * factor, way ? 0.007 : 0.005);
        }
    }
    path_world_release(&w);
}

static void a_spot_lights_its_cone_only(void **state)
{
    (void)state;
    struct world w =
        world_from("texture black rgb 0 0 0\nmaterial m lambert black\nquad floor -9 -9 0 18 0 0 0 18 0 m\n"
                   "lamp l disk 0 0 2  0 0 -1  0.1  100 100 100  30 3\n");
    const double h = 2, r = 0.1, power = 1 + 1.5, wanted = PI * 100 / power * (1 - pow(h * h / (h * h + r * r), power));
    assert_near(mean_irradiance(&w, vec3_make(0, 0, 0), up, 20000, 1).r, wanted, 0.005);
    /* beyond the cone of the lamp's rim there is no light; at the border of the centre's cone, nearly half */
    const double reach = 2 * tan(30 * PI / 180);
    assert_true(mean_irradiance(&w, vec3_make(reach + 0.101, 0, 0), up, 4096, 1).r == 0);
    assert_true(mean_irradiance(&w, vec3_make(reach + 0.095, 0, 0), up, 4096, 1).r > 0);
    const double inside = mean_irradiance(&w, vec3_make(reach - 0.11, 0, 0), up, 20000, 1).r;
    const double border = mean_irradiance(&w, vec3_make(reach, 0, 0), up, 20000, 1).r;
    assert_true(border > 0.4 * inside && border < 0.6 * inside);
    path_world_release(&w);
}

#define ROOM                                                                             \
    "room r 0 0 5 4 0 2.5 m m\nwall s 0 0 5 0 0 2.5 0.2 m\nwall e 5 0 5 4 0 2.5 0.2 m\n" \
    "wall n 5 4 0 4 0 2.5 0.2 m\nwall w 0 4 0 0 0 2.5 0.2 m\nwindow o s 1.5 3.5 0.8 2.2\n"

/* A fully visible disk of angular radius a and radiance L gives the irradiance pi L sin^2(a) cos. */
static void the_sun_through_a_window_gives_its_irradiance(void **state)
{
    (void)state;
    struct world w =
        world_from("texture black rgb 0 0 0\nmaterial m lambert black\n" ROOM "sun -90 45 1.2 5000 4000 3000\n");
    const double s = sin(1.2 * PI / 180), wanted = PI * 5000 * s * s * cos(45 * PI / 180);
    const struct rgb e = mean_irradiance(&w, vec3_make(2.5, 1.3, 0), up, 20000, 1);
    assert_near(e.r, wanted, 0.005);
    assert_near(e.b, wanted * 0.6, 0.005);
    assert_true(mean_irradiance(&w, vec3_make(2.5, 3.5, 0), up, 4096, 1).r == 0);
    assert_true(mean_irradiance(&w, vec3_make(0.8, 1.3, 0), up, 4096, 1).r == 0);
    path_world_release(&w);
}

#define LAMP_FOR_A_CEILING "lamp l quad 0 0 1.9999  0 2 0  2 0 0  3 3 3\n"

/* In a white box under a ceiling that is one lamp, every path ends at the lamp: the radiance is the lamp's
 * everywhere. */
static void a_box_that_absorbs_nothing_keeps_its_light(void **state)
{
    (void)state;
    struct world w =
        world_from("texture white rgb 1 1 1\nmaterial m lambert white\nbox room 0 0 0 2 2 2 m\n" LAMP_FOR_A_CEILING);
    for (int way = 0; way < 2; way++) {
        w.brdf_sampling_only = way;
        assert_near(mean_radiance(&w, vec3_make(0.2, 0.2, 0.2), vec3_make(0.2, 1, 0.1), 300000, 1).r, 3, 0.005);
        assert_near(mean_radiance(&w, vec3_make(0.2, 0.2, 1.9), vec3_make(-0.2, 0.3, -0.1), 300000, 2).g, 3, 0.005);
    }
    path_world_release(&w);
    /* half of the reflectance is gloss: the lobe loses what falls below the horizon, and must not gain */
    w = world_from(
        "texture part rgb 0.5 0.5 0.5\nmaterial m phong part 0.8 9.3\nbox room 0 0 0 2 2 2 m\n" LAMP_FOR_A_CEILING);
    const double l = mean_radiance(&w, vec3_make(0.2, 0.2, 0.2), vec3_make(0.2, 1, 0.1), 300000, 1).r;
    assert_true(l > 1 && l < 3 * 1.005);
    path_world_release(&w);
}

/* A room with all kinds of lights and materials. */
static void next_event_estimation_agrees_with_brdf_sampling(void **state)
{
    (void)state;
    struct world w = world_from(
        "texture grey rgb 0.5 0.45 0.4\nmaterial m lambert grey\nmaterial shiny phong grey 0.5 10\n"
        "material ward ward grey 0.3 0.4\n" ROOM "opening door e 1 2 0 2\nbox b 1 2 0 2 3 0.5 shiny turn 20\n"
        "quad table 2.5 1 0.7 1 0 0 0 1 0 ward\nlamp l quad 3 2 2.4 0 1 0 1 0 0 4 4 3\n"
        "lamp d disk 1 1 2.4 0 0 -1 0.3 20 20 20 40 1\nsun -80 35 12 40 36 30\npanorama 3 2 2 2.5 1 0.9 0.8\n");
    const struct vec3 eye = {4.5, 3.5, 1.6},
                      at[] = {{1.5, 2.4, 0.5}, {3, 1.5, 0.7}, {2, 1, 0}, {0, 2, 1.5}, {2.5, 0, 0.4}, {5, 1.5, 1}};
    for (int i = 0; i < 6; i++) {
        double l[2];
        for (int way = 0; way < 2; way++) {
            w.brdf_sampling_only = way;
            l[way] = rgb_luminance(mean_radiance(&w, eye, vec3_sub(at[i], eye), way ? 200000 : 30000, 10 * i + way));
        }
        assert_near(l[0], l[1], 0.015);
    }
    path_world_release(&w);
}

/* Rays from one eye in a narrow fan; ray 0 goes through `at`. */
static void fan(struct path_ray ray[SHARED_RAYS], struct vec3 eye, struct vec3 at, double step)
{
    for (int i = 0; i < SHARED_RAYS; i++) {
        const struct vec3 to = vec3_add(at, vec3_make(step * (i % 4), step * (i / 4), step * (i % 3)));
        ray[i] = (struct path_ray){eye, vec3_normalize(vec3_sub(to, eye))};
    }
}

static void all_rays_of_a_group_see_the_furnace(void **state)
{
    (void)state;
    static const char *const kinds[] = {"lambert half", "phong half 0.0001 300"};
    for (int kind = 0; kind < 2; kind++) {
        char text[300];
        snprintf(text, sizeof text,
                 "texture half rgb 0.5 0.5 0.5\nmaterial m %s\nglow m 0.5 0.5 0.5\n"
                 "box room 0 0 0 4 3 2.5 m\n",
                 kinds[kind]);
        struct world w = world_from(text);
        struct path_ray ray[SHARED_RAYS];
        struct rgb mean[SHARED_RAYS];
        fan(ray, vec3_make(1, 1, 1), vec3_make(3.6, 2.6, 0.1), 0.25); /* across the corner of two walls and the floor */
        mean_radiances(mean, &w, ray, 0xffff, 20000, kind);
        for (int i = 0; i < SHARED_RAYS; i++) assert_near(mean[i].g, 1, 0.005);
        w.max_bounces = 2; /* 1/2 + 1/4 + 1/8 */
        mean_radiances(mean, &w, ray, 0xffff, 20000, 2);
        for (int i = 0; i < SHARED_RAYS; i++) assert_near(mean[i].g, 0.875, 0.005);
        w.max_bounces = 1;
        mean_radiances(mean, &w, ray, 0xffff, 4096, 2);
        for (int i = 0; i < SHARED_RAYS; i++) assert_near(mean[i].g, 0.75, 0.005);
        path_world_release(&w);
    }
}

enum { SETS = 16 };

/* Mean and squared standard error of a ray's green, from SETS independent sets of estimates. */
struct measured {
    double mean, error2;
};

static void measure_group(struct measured out[SHARED_RAYS], const struct world *w,
                          const struct path_ray ray[SHARED_RAYS], uint32_t active, int paths, int seed)
{
    double sum[SHARED_RAYS] = {0}, squares[SHARED_RAYS] = {0};
    for (int set = 0; set < SETS; set++) {
        struct rgb mean[SHARED_RAYS];
        mean_radiances(mean, w, ray, active, paths, SETS * seed + set);
        for (int i = 0; i < SHARED_RAYS; i++) sum[i] += mean[i].g, squares[i] += mean[i].g * mean[i].g;
    }
    for (int i = 0; i < SHARED_RAYS; i++)
        out[i] = (struct measured){sum[i] / SETS, (squares[i] - sum[i] * sum[i] / SETS) / (SETS - 1) / SETS};
}

/* Groups across edges, shadows and glossy surfaces; one ray is left out. */
static void compare_groups_with_single_rays(const char *lights, int seed)
{
    const struct vec3 eye = {4.5, 3.5, 1.6}, at[] = {{1.6, 2.5, 0.3}, {2.9, 1.4, 0.6}, {3.5, 2.6, 0.8}};
    char text[1200];
    snprintf(text, sizeof text,
             "texture grey rgb 0.5 0.45 0.4\ntexture red rgb 0.7 0.2 0.1\nmaterial m lambert grey\n"
             "material r lambert red\nmaterial shiny phong grey 0.5 30\nmaterial ward ward grey 0.1 0.3\n" ROOM
             "box b 1 2 0 2 3 0.5 shiny turn 20\nquad table 2.5 1 0.7 1 0 0 0 1 0 ward\n"
             "box c 3.4 2.5 0 3.9 3.2 1 r\n%s",
             lights);
    struct world w = world_from(text);
    for (int k = 0; k < 3; k++) {
        struct path_ray ray[SHARED_RAYS], single[SHARED_RAYS];
        struct measured group[SHARED_RAYS], alone[SHARED_RAYS];
        fan(ray, eye, at[k], 0.15);
        measure_group(group, &w, ray, 0xfffd, 1024, seed + k);
        assert_true(group[1].mean == 0); /* left out */
        for (int i = 0; i < SHARED_RAYS; i += 5) {
            single[0] = ray[i];
            measure_group(alone, &w, single, 1, 2048, seed + 10 * k + i + 50);
            const double error = sqrt(group[i].error2 + alone[0].error2), off = group[i].mean - alone[0].mean;
            assert_true(error < 0.02 * alone[0].mean); /* the comparison means something */
            assert_true(fabs(off) < 4 * error);
        }
    }
    path_world_release(&w);
}

static void sharing_paths_does_not_change_the_radiance(void **state)
{
    (void)state;
    compare_groups_with_single_rays(
        "lamp l quad 3 2 2.4 0 1 0 1 0 0 4 4 3\nlamp d disk 1 1 2.4 0 0 -1 0.3 20 20 20 40 1\n", 1);
    compare_groups_with_single_rays("sun -80 35 12 40 36 30\npanorama 3 2 2 2.5 1 0.9 0.8\n", 7);
}

/* What one estimate costs in noise: the mean square deviation of a pixel's estimate falls if its group is whole. */
static void sharing_paths_lowers_the_noise(void **state)
{
    (void)state;
    struct world w = world_from("texture grey rgb 0.5 0.45 0.4\nmaterial m lambert grey\n" ROOM
                                "lamp l quad 3 2 2.4 0 0.3 0 0.3 0 0 40 40 30\nbox b 1 2 0 2 3 0.5 m turn 20\n");
    const struct rng rng = rng_make(1, "test", "noise");
    struct path_ray ray[SHARED_RAYS];
    double variance[2];
    fan(ray, vec3_make(4.5, 3.5, 1.6), vec3_make(1, 0.5, 0), 0.03);
    for (int whole = 0; whole < 2; whole++) {
        double sum = 0, squares = 0;
        struct sobol s = sobol_make(&rng, (uint64_t)whole, SHARED_RAYS);
        for (; s.sample < 4000; s.sample++) {
            struct rgb mean[SHARED_RAYS] = {{0, 0, 0}};
            uint64_t rays = 0;
            shared_paths_radiance(mean, &w, ray, whole ? 0xffff : 1, &s, &rays);
            sum += mean[0].g;
            squares += mean[0].g * mean[0].g;
        }
        variance[whole] = squares / 4000 - sum * sum / 4000 / 4000;
    }
    print_message("variance of one estimate: %.4g alone, %.4g in a group\n", variance[0], variance[1]);
    assert_true(variance[1] < 0.25 * variance[0]);
    path_world_release(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_closed_room_that_reflects_and_emits_half_has_radiance_one),
        cmocka_unit_test(glossy_walls_keep_the_furnace_within_its_bound),
        cmocka_unit_test(a_square_lamp_gives_the_irradiance_of_its_form_factor),
        cmocka_unit_test(a_round_lamp_gives_the_irradiance_of_its_form_factor),
        cmocka_unit_test(a_spot_lights_its_cone_only),
        cmocka_unit_test(the_sun_through_a_window_gives_its_irradiance),
        cmocka_unit_test(a_box_that_absorbs_nothing_keeps_its_light),
        cmocka_unit_test(next_event_estimation_agrees_with_brdf_sampling),
        cmocka_unit_test(all_rays_of_a_group_see_the_furnace),
        cmocka_unit_test(sharing_paths_does_not_change_the_radiance),
        cmocka_unit_test(sharing_paths_lowers_the_noise),
    };
    return cmocka_run_group_tests_name("simulate light", tests, scratch_make, scratch_remove);
}
