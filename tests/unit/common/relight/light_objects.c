/* Synthetic objects as surfaces: cut, grouped into elements, lit, written and read. */
#include "common/relight/light_objects.h"
#include "common/math/numbers.h"
#include "tests/unit/edit_room.h"

static const char object[] = "object block mesh.obj %s 2 0 0 1 0 2 0 0 0 0 2 -2 matt 0.5 0.25 1\n";

static void read_cube(struct light_objects *o, double side)
{
    struct err err = ERR_INIT;
    struct provenance prov = {0};
    assert_ok(light_objects_read(o, write_objects(object, cube), scratch, side, &prov, &err), err);
    provenance_release(&prov);
}

static void triangles_are_cut_to_size_and_keep_their_area(void **state)
{
    struct light_objects o;
    double area = 0;
    (void)state;
    read_cube(&o, 0.3);
    for (int i = 0; i < o.count; i++) {
        const struct vec3 *t = o.triangles[i];
        for (int k = 0; k < 3; k++) assert_true(vec3_length(vec3_sub(t[(k + 1) % 3], t[k])) <= 0.3);
        area += vec3_length(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0]))) / 2;
    }
    assert_near(area, 24, 1e-12);
    light_objects_release(&o);
    light_objects_release(&o);
}

static void elements_lie_on_their_side_and_are_as_wide_as_asked(void **state)
{
    struct light_objects o;
    int used = 0;
    (void)state;
    read_cube(&o, 0.5);
    for (int i = 0; i < o.count; i++)
        for (int side = 0; side < 2; side++) {
            const struct object_element *e = &o.elements[o.element[i][side]];
            const struct vec3 *t = o.triangles[i];
            const struct vec3 n = vec3_normalize(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
            assert_near(vec3_dot(n, e->point.normal), side ? -1 : 1, 1e-12);
            assert_true(fabs(vec3_dot(n, vec3_sub(e->point.at, t[0]))) < 1e-12);
            assert_true(vec3_length(vec3_sub(e->point.at, t[0])) < 2);
            used = o.element[i][side] > used ? o.element[i][side] : used;
        }
    assert_int_equal(used + 1, o.element_count);
    assert_true(o.element_count >= 2 * 6 * 16 && o.element_count <= 2 * 6 * 36);
    light_objects_release(&o);
}

/* A ball of radius 1 of flat pieces, 15 degrees wide. */
static const char *write_ball(void)
{
    enum { ROUND = 24, HIGH = 12 };
    static char text[65536];
    int n = 0;
    for (int i = 0; i <= HIGH; i++)
        for (int k = 0; k < ROUND; k++) {
            const double down = PI * i / HIGH, about = 2 * PI * k / ROUND, wide = i == HIGH ? 0 : sin(down);
            n += snprintf(text + n, sizeof text - (size_t)n, "v %.17g %.17g %.17g\n", wide * cos(about),
                          wide * sin(about), cos(down));
        }
    for (int i = 0; i < HIGH; i++)
        for (int k = 0; k < ROUND; k++) {
            const int a = i * ROUND + k + 1, b = i * ROUND + (k + 1) % ROUND + 1;
            n += snprintf(text + n, sizeof text - (size_t)n, "f %d %d %d %d\n", a, a + ROUND, b + ROUND, b);
        }
    return text;
}

static void a_ball_of_flat_pieces_is_lit_as_a_ball(void **state)
{
    static const struct vec3 middle = {1, 0, -2};
    struct light_objects o;
    struct err err = ERR_INIT;
    struct provenance prov = {0};
    double most = 0;
    (void)state;
    assert_ok(light_objects_read(&o, write_objects(object, write_ball()), scratch, 0.1, &prov, &err), err);
    provenance_release(&prov);
    for (int i = 0; i < o.count; i++) {
        const struct vec3 *t = o.triangles[i];
        const struct vec3 at = vec3_scale(vec3_add(t[0], vec3_add(t[1], t[2])), 1.0 / 3);
        const struct vec3 flat = vec3_normalize(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
        const struct gather_point p = light_objects_point(&o, i, at, flat);
        const struct vec3 out = vec3_sub(p.at, middle);
        most = fmax(most, acos(fmin(1, vec3_dot(p.normal, vec3_normalize(out)))) / DEGREE);
        assert_near(vec3_length(p.normal), 1, 1e-12);
        assert_true(vec3_length(out) >= vec3_length(vec3_sub(at, middle)) - 1e-12);
        /* no piece stands above the point's horizon: the ball does not shade itself */
        for (int k = 0; k < o.facet_count; k++)
            for (int c = 0; c < 3; c++) assert_true(vec3_dot(vec3_sub(o.facets[k].corners[c], p.at), p.normal) < 2e-3);
        const struct gather_point inside = light_objects_point(&o, i, at, vec3_scale(flat, -1));
        assert_true(vec3_dot(inside.normal, p.normal) < -0.999);
    }
    if (!(most < 1.5)) fail_msg("normals are %g degrees off", most); /* of 7.5 between the pieces and the ball */
    light_objects_release(&o);
}

static void a_cube_stays_flat(void **state)
{
    struct light_objects o;
    (void)state;
    read_cube(&o, 0.5);
    for (int i = 0; i < o.count; i++) {
        const struct vec3 *t = o.triangles[i];
        const struct vec3 flat = vec3_normalize(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
        const struct gather_point p = light_objects_point(&o, i, t[1], flat);
        assert_true(vec3_length(vec3_sub(p.normal, flat)) < 1e-12 && vec3_length(vec3_sub(p.at, t[1])) < 1e-12);
    }
    light_objects_release(&o);
}

static void light_is_read_as_it_was_written_and_gives_radiance(void **state)
{
    struct light_objects o, p;
    struct err err = ERR_INIT;
    const struct provenance prov = {.stage = "test", .version = "1"};
    const char *path = keep_path("light.txt");
    (void)state;
    read_cube(&o, 1);
    for (int i = 0; i < o.element_count; i++) o.elements[i].irradiance = rgb_make(i, 0.1 * i, 3);
    assert_ok(light_objects_write_light(&o, path, &prov, &err), err);
    read_cube(&p, 1);
    assert_ok(light_objects_read_light(&p, path, NULL, &err), err);
    for (int i = 0; i < p.count; i++)
        for (int side = 0; side < 2; side++) {
            const struct rgb e = o.elements[o.element[i][side]].irradiance, l = p.radiance[i][side];
            assert_near(l.r, 0.5 * e.r / PI, 1e-8);
            assert_near(l.g, 0.25 * e.g / PI, 1e-8);
            assert_near(l.b, e.b / PI, 1e-8);
        }
    light_objects_release(&p);
    read_cube(&p, 0.5);
    assert_int_equal(light_objects_read_light(&p, path, NULL, &err), ST_DATA);
    assert_contains(err.text, "update the VITA again");
    light_objects_release(&p);
    light_objects_release(&o);
}

static void damaged_light_is_refused_with_its_line(void **state)
{
    static const struct {
        const char *text, *says;
    } bad[] = {{"remodel-object-light 2\n", "bad.txt:1"},
               {"remodel-object-light 1\nelement 1 2\n", "bad.txt:2"},
               {"remodel-object-light 1\nelement 1 -2 1\n", "irradiance, a number of at least 0"},
               {"remodel-object-light 1\nelement 1 nan 1\n", "bad.txt:2"},
               {"remodel-object-light 1\nlamp 1 1 1\n", "element"}};
    struct light_objects o;
    (void)state;
    read_cube(&o, 1);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct err err = ERR_INIT;
        assert_int_equal(light_objects_read_light(&o, scratch_write("bad.txt", bad[i].text), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, bad[i].says);
    }
    light_objects_release(&o);
}

static void no_file_is_no_object(void **state)
{
    struct light_objects o;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(light_objects_read(&o, NULL, NULL, 1, NULL, &err), err);
    assert_int_equal(o.count + o.element_count, 0);
    light_objects_release(&o);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(triangles_are_cut_to_size_and_keep_their_area),
        cmocka_unit_test(elements_lie_on_their_side_and_are_as_wide_as_asked),
        cmocka_unit_test(a_ball_of_flat_pieces_is_lit_as_a_ball),
        cmocka_unit_test(a_cube_stays_flat),
        cmocka_unit_test(light_is_read_as_it_was_written_and_gives_radiance),
        cmocka_unit_test(damaged_light_is_refused_with_its_line),
        cmocka_unit_test(no_file_is_no_object),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
