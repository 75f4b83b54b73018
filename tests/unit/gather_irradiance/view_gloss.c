/* What glossy materials reflect to a view: closed forms in a room of uniform light. */
#include "stages/gather_irradiance/view_gloss.h"

#include <math.h>

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "tests/unit/common/gather/glossy_field.h"

enum { PIXELS = 64 };

/* A row of pixels that show points of the floor. */
struct row {
    struct built built;
    struct gather_job job;
    struct view view;
    struct gather_point points[PIXELS];
    int faces[PIXELS];
    struct irradiance irradiance[PIXELS];
    struct view_gloss gloss;
};

static void make_row(struct row *r, const char *line)
{
    *r = (struct row){.job.params = GATHER_PARAMS_DEFAULT, .view = {.width = PIXELS, .height = 1}};
    r->view.center = vec3_make(1.5, -1, -1.5);
    r->job.field = *glossy_floor(&r->built, grey, line);
    r->job.field.field.ctx = r->job.field.plain.ctx = &r->job.field; /* it moved */
    for (int i = 0; i < PIXELS; i++) {
        r->points[i] = (struct gather_point){vec3_make(-1.9 + 0.05 * i, 0.3, -2), vec3_make(0, 0, 1)};
        r->faces[i] = i % 8 ? FLOOR : 0;
        r->irradiance[i].value = rgb_grey(PI);
    }
}

static void gather_row(struct row *r)
{
    struct err err = ERR_INIT;
    assert_ok(view_gloss_gather(&r->gloss, &r->job, &r->view, r->points, r->faces, r->irradiance, &err), err);
}

static void release_row(struct row *r)
{
    view_gloss_release(&r->gloss);
    gather_job_release(&r->job);
}

/* Floor texels are plain to each other: light is 1 everywhere above it. */
static void pixels_get_the_closed_form_of_the_integral_without_k_s(void **state)
{
    static const double shapes[2] = {1, 5000};
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct row r;
        make_row(&r, phong(0.3, shapes[k]));
        gather_row(&r);
        for (int i = 0; i < PIXELS; i++) {
            const struct vec3 to = vec3_normalize(vec3_sub(r.view.center, r.points[i].at));
            const double wanted = k ? 2 * PI / 5001 : PI / 2 * (1 + to.z);
            assert_int_equal(r.gloss.material[i], i % 8 ? 1 : 0);
            assert_near(r.gloss.specular[i].g, i % 8 ? wanted : 0, 0.03);
        }
        release_row(&r);
    }
}

static void k_s_of_0_and_lambert_reflect_nothing_but_have_their_material(void **state)
{
    static const char *const lines[] = {"phong 1 1 1 0 5000", "ward 1 1 1 0 0.1", "lambert 1 1 1 0 0"};
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct row r;
        make_row(&r, lines[k]);
        gather_row(&r);
        for (int i = 0; i < PIXELS; i++) {
            assert_int_equal(r.gloss.material[i], i % 8 ? 1 : 0);
            assert_near(rgb_max(r.gloss.specular[i]), 0, 0);
        }
        release_row(&r);
    }
}

static void bits_do_not_depend_on_threads(void **state)
{
    struct row r[2];
    (void)state;
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(k ? 3 : 1);
        make_row(&r[k], phong(0.3, 20));
        gather_row(&r[k]);
    }
    parallel_set_threads(0);
    assert_memory_equal(r[0].gloss.specular, r[1].gloss.specular, PIXELS * sizeof *r[0].gloss.specular);
    for (int k = 0; k < 2; k++) release_row(&r[k]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pixels_get_the_closed_form_of_the_integral_without_k_s),
        cmocka_unit_test(k_s_of_0_and_lambert_reflect_nothing_but_have_their_material),
        cmocka_unit_test(bits_do_not_depend_on_threads),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
