/* Tests of scenes/NAME/materials.txt: stages/fit_materials/marked_materials.h. */
#include "stages/fit_materials/marked_materials.h"

#include "tests/unit/scratch.h"

static const char *file(const char *lines)
{
    static char path[400];
    snprintf(path, sizeof path, "%s/materials.txt", scratch);
    FILE *f = fopen(path, "w");
    assert_non_null(f);
    fprintf(f, "remodel-marked-materials 1\n%s", lines);
    fclose(f);
    return path;
}

static void regions_and_declared_models_are_read(void **state)
{
    (void)state;
    struct marked_materials m;
    struct err err = ERR_INIT;
    const char *path = file("# a floor in two photos\n"
                            "material floor in v07 1 2 30 4 5 60 in v08@1 0 0 10 0 10 10 0 10 model ward\n"
                            "material wall in v07 0 0 9 0 0 9\n");
    assert_int_equal(marked_materials_read(&m, path, NULL, &err), ST_OK);
    assert_int_equal(m.list.count, 2);
    assert_true(m.declared[0] && !m.declared[1]);
    assert_int_equal(m.list.items[0].kind, BRDF_WARD);
    assert_int_equal(m.list.items[0].region_count, 2);
    assert_string_equal(m.list.items[0].regions[1].view, "v08@1");
    assert_int_equal(m.list.items[0].regions[1].corners, 4);
    assert_true(m.list.items[0].regions[0].pixel[3] == 4);
    marked_materials_release(&m);
}

static void damaged_marks_are_refused_with_file_and_line(void **state)
{
    (void)state;
    static const char *const lines[][2] = {
        {"", "a line `material NAME in VIEW"},
        {"material floor", "in VIEW X Y X Y X Y"},
        {"material floor model ward", "in VIEW X Y X Y X Y"},
        {"material floor in v07 1 2 3 4", "three corners or more"},
        {"material floor in v07 1 2 3", "y of a pixel"},
        {"material floor in v07 0 0 1 1 2 2", "corners around an area"},
        {"material floor in v07 0 0 9 0 0 9 model shiny", "lambert, phong or ward"},
        {"material floor in v07 0 0 9 0 0 9 model ward model ward", "in, and a region"},
        {"material floor on v07 0 0 9 0 0 9", "in or model"},
        {"material ../floor in v07 0 0 9 0 0 9", "a name of letters, digits"},
        {"region floor", "material"},
    };
    for (size_t i = 0; i < sizeof lines / sizeof *lines; i++) {
        struct marked_materials m;
        struct err err = ERR_INIT;
        assert_int_equal(marked_materials_read(&m, file(lines[i][0]), NULL, &err), ST_DATA);
        assert_non_null(strstr(err.text, "materials.txt:"));
        assert_non_null(strstr(err.text, lines[i][1]));
        assert_null(m.declared);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(regions_and_declared_models_are_read),
        cmocka_unit_test(damaged_marks_are_refused_with_file_and_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
