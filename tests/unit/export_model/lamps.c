/* lamps.c - lamps that an edit adds, as other programs take them: a cone with the file's lumens, a lamp to all sides,
 * the outline of an opening. */
#include "stages/export_model/export_lamps.h"

#include <math.h>

#include "common/math/numbers.h"
#include "common/texture/texture_map.h"
#include "tests/unit/common/light/near.h"
#include "tests/unit/scratch.h"

/* The same intensity to 30 degrees, none from 30.001 on. */
#define BEAM "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 4 1 1 2 0 0 0\n1 1 12\n0 30 30.001 90\n0\n600 600 0 0\n"
/* The same to all sides. */
#define BALL "IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 -0.3 -0.3 0\n1 1 12\n0 180\n0\n100 100\n"

static void read_lamp(struct export_lamps *l, const char *text, double scale)
{
    struct texture_planned lamp = {.name = (char *)"new",
                                   .file = (char *)"lamp.ies",
                                   .at = {1, 2, 3},
                                   .aim = {0, 0, -1},
                                   .colour = {1, 1, 1},
                                   .scale = {scale, scale, scale}};
    const struct texture_map map = {.planned = &lamp, .planned_count = 1};
    const struct model_axes axes = {.scale = 1, .metric = true};
    const struct model_plan plan = {.room_count = 0};
    struct err err = ERR_INIT;
    scratch_write("lamp.ies", text);
    assert_ok(export_lamps_read(l, &map, scratch, &axes, &plan, NULL, &err), err);
    assert_string_equal(l->files[0], "lamp.ies");
}

/* All light of KHR_lights_punctual's cone, by the midpoint rule. */
static double light_of(const struct lamp_cone *c)
{
    enum { PARTS = 20000 };
    double sum = 0;
    for (int i = 0; i < PARTS; i++) {
        const double angle = 0.5 * PI * (i + 0.5) / PARTS;
        const double fall = clamp((cos(angle) - cos(c->outer)) / (cos(c->inner) - cos(c->outer)), 0, 1);
        sum += c->candela * fall * fall * 2 * PI * sin(angle) * 0.5 * PI / PARTS;
    }
    return sum;
}

static void a_cone_has_the_lumens_of_the_file(void **state)
{
    struct export_lamps l;
    struct lamp_cone cone;
    const double lumens = 2 * PI * 600 * (1 - cos(30 * DEGREE));
    (void)state;
    for (int half = 0; half < 2; half++) {
        const double by = half ? 0.5 : 1;
        read_lamp(&l, BEAM, by);
        assert_near(export_lamps_lumens(&l.planned.list[0]), by * lumens, 1e-4);
        assert_true(export_lamps_cone(&cone, &l.planned.list[0]));
        assert_near(light_of(&cone), by * lumens, 1e-3);
        assert_near(cone.outer, 30 * DEGREE, 1e-6);
        assert_near(cone.candela, by * 600, 0.02); /* the cone's rim falls off */
        export_lamps_release(&l);
    }
}

static void a_lamp_to_all_sides_has_its_mean_intensity(void **state)
{
    struct export_lamps l;
    struct lamp_cone cone;
    (void)state;
    read_lamp(&l, BALL, 1);
    assert_false(export_lamps_cone(&cone, &l.planned.list[0]));
    assert_near(cone.candela, 100, 1e-6);
    export_lamps_release(&l);
}

/* Corners run counter-clockwise seen from where the light goes. */
static void an_opening_is_seen_from_the_side_to_which_it_shines(void **state)
{
    static const char *const files[] = {BEAM, BALL};
    (void)state;
    for (int k = 0; k < 2; k++) { /* a point is shown as a square of 4 cm, a round opening by its outline */
        struct vec3 p[PLANNED_LAMP_CORNERS], area = {0, 0, 0};
        struct export_lamps l;
        read_lamp(&l, files[k], 1);
        const int count = export_lamps_outline(p, &l, 0);
        assert_int_equal(count, k ? PLANNED_LAMP_CORNERS : 4);
        for (int i = 0; i < count; i++) {
            area = vec3_add(area, vec3_scale(vec3_cross(p[i], p[(i + 1) % count]), 0.5));
            assert_near(p[i].z, 3, 1e-12);
        }
        assert_near(area.z, k ? -0.5 * count * sin(2 * PI / count) * 0.15 * 0.15 : -0.04 * 0.04, 1e-9);
        export_lamps_release(&l);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cone_has_the_lumens_of_the_file),
        cmocka_unit_test(a_lamp_to_all_sides_has_its_mean_intensity),
        cmocka_unit_test(an_opening_is_seen_from_the_side_to_which_it_shines),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
