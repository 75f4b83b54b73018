/* light.c - the section about light: none without products; lamps, materials and irradiance with their numbers. */
#include "stages/report/page.h"

#include "tests/unit/report/scratch_page.h"
#include "tests/unit/scratch.h"

#include "common/base/outfile.h"
#include "common/image/photo.h"

static const char LIGHTS[] = "remodel-lights 1\ndisk \"spot <1>\" 0 0 2 0 0 -1 0.1 9 8 7 20 1\n"
                             "opening in-west 0 0 1 0 1 0 0 0 1\n";
static const char FIT[] =
    "remodel-light-fit 1\nlamp \"spot <1>\" fitted 9 8 7 0.4 0.3 0.2 beta 20 0.5 exponent 1 0.1\n"
    "seen \"spot <1>\" 5 5 5 0 0 0 unsaturated 0 saturated 3 disagrees\n"
    "material plaster 0.2 0.2 0.2 0 0 0 spread 0.1 lit 2 unlit 1\n"
    "point 4 lit 0 0 0 radiance 1 1 1 explained 1.1 1.1 1.1 indirect 2 2 2 lamp \"spot <1>\"\n"
    "point 4 lit 0 0 0 radiance 1.5 1.5 1.5 explained 1.5 1.5 1.5 indirect 2 2 2 lamp \"spot <1>\"\n"
    "point 5 unlit 0 0 0 radiance 0.5 0.5 0.5 explained 0.5 0.5 0.5 indirect 2 2 2 lamp \"spot <1>\"\n";
static const char MATERIALS[] = "remodel-materials 1\nmaterial oak ward 0.2 0.1 0.05 0.03 0.1\n"
                                "range oak 0.19 0.21 0.09 0.11 0.04 0.06 0.02 0.04 0.05 -\n"
                                "evidence oak 400 100 4 1.2 2 -1 1.1 a gloss <explains> more\n";
static const char RECORD[] = "remodel-light-record 2\npoints 40 dark 1\nerror 0.01 0.02 0.05\n"
                             "shares none 0 texture 0.5 synthesised 0.2 sky 0 sky-guessed 0.1 lamp 0.15 "
                             "material 0 object 0.05\n";

static char *page_of_scratch(void) { return scratch_page("scene", "fit_lights"); }

static void page_has(const char *page, const char *text)
{
    if (!strstr(page, text)) fail_msg("the page lacks: %s", text);
}

static void page_lacks(const char *page, const char *text)
{
    if (strstr(page, text)) fail_msg("the page has: %s", text);
}

static void make_folder(const char *name)
{
    struct err err = ERR_INIT;
    assert_ok(outfile_make_folders(scratch_path(name), &err), err);
}

static void write_jpeg(const char *name)
{
    static const unsigned char grey[8 * 6 * 3] = {100};
    struct err err = ERR_INIT;
    assert_ok(jpeg_write(scratch_path(name), grey, 8, 6, 90, &err), err);
}

static void without_products_there_is_no_section(void **state)
{
    char *page = page_of_scratch();
    (void)state;
    page_lacks(page, "id=\"light\"");
    page_lacks(page, "#light\"");
    free(page);
}

static void lamps_have_their_fit_and_their_picture(void **state)
{
    (void)state;
    make_folder("lights");
    scratch_write("lights/lights.txt", LIGHTS);
    char *page = page_of_scratch(); /* also without fit.txt */
    page_has(page, "no view shows this lamp or its light");
    free(page);
    scratch_write("lights/fit.txt", FIT);
    write_jpeg("lights/spot%20%3C1%3E.jpg");
    page = page_of_scratch();
    page_has(page, "<a href=\"#light\">Light</a>");
    page_has(page, "1 lamp and 1 window or opening that daylight comes through: in-west.");
    page_has(page, "<h4>spot &lt;1&gt;</h4>");
    page_has(page, "alt=\"The light of lamp spot &lt;1&gt;\" src=\"");
    page_has(page, "red 9 ± 0.4, green 8 ± 0.3, blue 7 ± 0.2");
    page_has(page, "20 ± 0.5° to each side of its axis, weaker towards the edge (exponent 1 ± 0.1)");
    page_has(page, "at least 5, in 3 views, 3 overexposed <span class=\"tag\">disagrees with the fit</span>");
    page_has(page, "2 lit places</li>");
    page_has(page, "1 unlit place</li>");
    /* 1.5 of 2 to the right and upwards, from 44 to 348 and from 316 to 12 */
    page_has(page, "<circle class=\"lit\" cx=\"272.0\" cy=\"88.0\" r=\"3\"/>");
    page_lacks(page, "The fit of the lamps is not shown");
    free(page);
}

static void damaged_products_are_notes(void **state)
{
    (void)state;
    make_folder("lights");
    make_folder("relight");
    scratch_write("lights/lights.txt", LIGHTS);
    scratch_write("lights/fit.txt", "remodel-light-fit 1\nlamp other fitted 1 1 1 0 0 0 beta 1 1 exponent 0 0\n");
    scratch_write("lights/materials.txt", "remodel-materials 7\n");
    scratch_write("relight/irradiance.light.txt", "nothing\n");
    scratch_write("lights/spot%20%3C1%3E.jpg", "no picture");
    char *page = page_of_scratch();
    page_has(page, "The fit of the lamps is not shown in full. ");
    page_has(page, "The fitted materials are not shown. ");
    page_has(page, "Irradiance is not shown. ");
    page_has(page, "A picture of the light is not shown. ");
    free(page);
    scratch_write("lights/lights.txt", "nothing\n");
    page = page_of_scratch();
    page_has(page, "The lamps are not shown. ");
    page_lacks(page, "id=\"light\"");
    free(page);
}

static void materials_have_intervals_and_a_reason(void **state)
{
    (void)state;
    make_folder("lights/materials");
    scratch_write("lights/materials.txt", MATERIALS);
    write_jpeg("lights/materials/oak.jpg");
    char *page = page_of_scratch();
    page_has(page, "red 62.8 % <span class=\"muted\">(59.7 to 66)</span>");
    page_has(page, "roughness 0.1 <span class=\"muted\">(0.05 to no limit)</span>");
    page_has(page, "400 samples of 100 points in 4 views, off by 1.2 times the noise: a gloss &lt;explains&gt; more");
    page_has(page, "alt=\"Residuals of material oak\"");
    free(page);
}

static void irradiance_has_shares_errors_and_hemicubes(void **state)
{
    char text[1024];
    (void)state;
    make_folder("relight/irradiance");
    snprintf(text, sizeof text, "%shemicube 1 1 2 0 0 0 1 3 3 3 0.05\n", RECORD);
    scratch_write("relight/irradiance.light.txt", text);
    write_jpeg("relight/irradiance.hemicube1.jpg");
    snprintf(text, sizeof text, "%slevel 0.5 8\n", RECORD);
    scratch_write("relight/irradiance/v.light.txt", text);
    write_jpeg("relight/irradiance/v.level.jpg");
    char *page = page_of_scratch();
    page_has(page, "<h4>View v</h4>");
    page_has(page, "<h4>Chosen points</h4>");
    page_has(page, "<span>0.5</span><span>2</span><span>8</span>");
    page_has(page, "<th scope=\"row\">lamps</th><td class=\"n\">15.0 %<span class=\"bar\">");
    page_has(page, "<th scope=\"row\">furniture and objects</th><td class=\"n\">5.0 %<span class=\"bar\">");
    page_has(page, "guessed</th><td class=\"n\">10.0 %<span class=\"bar peak\">");
    page_lacks(page, "places without any picture");
    page_has(page, "half of them are off by less than 1 %");
    page_has(page, "1 place gets no light.");
    page_has(page, "on a floor or table at 1.00 2.00 0.00; light 3 ± 5 %");
    page_has(page, "alt=\"View all round, unfolded, of a place of irradiance\"");
    free(page);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(without_products_there_is_no_section, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(lamps_have_their_fit_and_their_picture, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(damaged_products_are_notes, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(materials_have_intervals_and_a_reason, scratch_make, scratch_remove),
        cmocka_unit_test_setup_teardown(irradiance_has_shares_errors_and_hemicubes, scratch_make, scratch_remove),
    };
    return cmocka_run_group_tests_name("light", tests, NULL, NULL);
}
