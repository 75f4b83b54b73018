/* Tests of materials.txt: common/gather/materials.h. */
#include "common/gather/materials.h"

#include <math.h>

#include "common/math/numbers.h"
#include "tests/unit/scratch.h"

static const struct provenance prov = {.stage = "test", .version = "0"};

static const char *file(const char *text)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/materials.txt", scratch);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fputs(text, f);
    fclose(f);
    return path;
}

static void what_is_written_is_read_back(void **state)
{
    (void)state;
    struct material_list l = {0}, again = {0};
    struct err err = ERR_INIT;
    const char *path = file("remodel-materials 1\n"
                            "material floor phong 0.1 0.2 0.3 1.5 40\n"
                            "range floor 0.09 0.11 0.19 0.21 0 - 1.4 1.6 38 42\n"
                            "evidence floor 400 100 4 1.5 3 1.1 -1 this lobe alone\n"
                            "region floor v07 0 0 10 0 10 10\n"
                            "region floor v08@1 0.5 0 10 0 10 10 0 10\n"
                            "material wall lambert 0.2 0.2 0.2 0 0\n");
    assert_int_equal(material_list_read(&l, path, NULL, &err), ST_OK);
    assert_int_equal(material_list_write(&l, path, &prov, &err), ST_OK);
    assert_int_equal(material_list_read(&again, path, NULL, &err), ST_OK);
    assert_int_equal(again.count, 2);
    const struct material *m = material_list_find(&again, "floor");
    assert_non_null(m);
    assert_int_equal(m->kind, BRDF_PHONG);
    assert_true(m->k_d[1] == 0.2 && m->ks == 1.5 && m->shape == 40);
    assert_true(isinf(m->k_d_range[2].high) && m->ks_range.low == 1.4 && m->shape_range.high == 42);
    assert_true(m->samples == 400 && m->points == 100 && m->views == 4 && m->scale == 1.5 && m->error[2] == -1);
    assert_string_equal(m->why, "this lobe alone");
    assert_int_equal(m->region_count, 2);
    assert_string_equal(m->regions[1].view, "v08@1");
    assert_int_equal(m->regions[1].corners, 4);
    assert_null(material_list_find(&again, "ceiling"));
    material_list_release(&l);
    material_list_release(&again);
}

static void the_reflectance_has_the_albedo_of_k_d(void **state)
{
    (void)state;
    const struct material m = {.kind = BRDF_PHONG, .k_d = {0.1, 0.2, 0.3}, .ks = 1.5, .shape = 40};
    const struct brdf b = material_brdf(&m);
    assert_true(fabs(b.albedo.b - 0.3 * PI) < 1e-15 && b.ks == 1.5 && b.shape == 40);
    assert_true(fabs(b.gloss - 2 * PI * 1.5 / 41) < 1e-12);
}

static void a_region_holds_what_is_inside(void **state)
{
    (void)state;
    double corner[] = {0, 0, 10, 0, 10, 10, 5, 5, 0, 10}; /* a square with a notch */
    const struct material_region r = {NULL, corner, 5, 1};
    assert_true(material_region_holds(&r, 2, 5));
    assert_true(material_region_holds(&r, 5, 2));
    assert_false(material_region_holds(&r, 5, 8));
    assert_false(material_region_holds(&r, 11, 5));
    assert_true(fabs(material_region_area(&r) - 75) < 1e-12);
}

static void damaged_lines_are_refused_with_file_and_line(void **state)
{
    (void)state;
    static const char *const lines[][2] = {
        {"material floor shiny 0 0 0 0 0", "lambert, phong or ward"},
        {"material floor lambert 0.1 0.1 0.1 0.1 0", "k_s, a number from 0 to 0"},
        {"material floor phong 0.1 0.1 0.1 0.1 0.5", "n, a number from 1 to 5000"},
        {"material floor ward 0.1 0.1 0.1 0.1 2", "alpha, a number from 0.02 to 1"},
        {"material floor ward -0.1 0.1 0.1 0.1 0.2", "k_d, a number from 0 to"},
        {"range wall 0 1 0 1 0 1 0 1 0 1", "the name of a material of a line above"},
        {"gloss floor 1", "material, range, evidence or region"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        struct material_list l;
        struct err err = ERR_INIT;
        char text[200];
        snprintf(text, sizeof text, "remodel-materials 1\n%s\n", lines[i][0]);
        assert_int_equal(material_list_read(&l, file(text), NULL, &err), ST_DATA);
        assert_non_null(strstr(err.text, "materials.txt:2:"));
        assert_non_null(strstr(err.text, lines[i][1]));
        assert_int_equal(l.count, 0);
    }
}

static void a_name_twice_is_refused(void **state)
{
    (void)state;
    struct material_list l;
    struct err err = ERR_INIT;
    assert_int_equal(material_list_read(&l,
                                        file("remodel-materials 1\nmaterial a lambert 0 0 0 0 0\n"
                                             "material a lambert 0 0 0 0 0\n"),
                                        NULL, &err),
                     ST_DATA);
    assert_non_null(strstr(err.text, "materials.txt:3:"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back),  cmocka_unit_test(the_reflectance_has_the_albedo_of_k_d),
        cmocka_unit_test(a_region_holds_what_is_inside), cmocka_unit_test(damaged_lines_are_refused_with_file_and_line),
        cmocka_unit_test(a_name_twice_is_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
