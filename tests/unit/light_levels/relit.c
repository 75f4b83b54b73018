/* Photographs in any light: parts of skies, pictures as sums beside full gathers, files. */
#include <stdio.h>
#include <string.h>

#include "common/image/image.h"
#include "common/math/numbers.h"
#include "stages/light_levels/light_codes.h"
#include "stages/light_levels/patch_values.h"
#include "stages/light_levels/relit_file.h"
#include "stages/light_levels/relit_picture.h"
#include "stages/light_levels/sky_basis.h"
#include "tests/unit/level_room.h"

/* ------------------------------------------------------------------------------------------------------------ parts */

/* Light of three lamps with factors of their own has three parts, whatever the number of skies. */
static void skies_of_three_shapes_have_three_parts(void **state)
{
    enum { PLACES = 200, SKIES = 40 };
    static float values[PLACES * SKIES];
    struct sky_basis b;
    struct err err = ERR_INIT;
    (void)state;
    for (int s = 0; s < SKIES; s++)
        for (int i = 0; i < PLACES; i++)
            values[s * PLACES + i] =
                (float)((1 + s) * (1 + i % 7) + (s % 5) * exp(-0.02 * i) * 40 + (s % 3) * (i % 11));
    assert_ok(sky_basis_make(&b, values, PLACES, SKIES, 1e-4, &err), err);
    assert_true(b.count >= 2 && b.count <= 4); /* dividing by means of skies keeps the rank */
    for (int s = 0; s < SKIES; s++)
        for (int i = 0; i < PLACES; i++) {
            double sum = 0;
            for (int k = 0; k < b.count; k++) sum += (double)b.parts[k * PLACES + i] * b.mixes[s * b.count + k];
            assert_near((double)b.level[i] * sum / (double)values[s * PLACES + i], 1, 2e-4);
        }
    sky_basis_release(&b);
    memset(values, 0, sizeof values);
    assert_ok(sky_basis_make(&b, values, PLACES, SKIES, 1e-4, &err), err);
    assert_int_equal(b.count, 0);
    sky_basis_release(&b);
}

static void runs_come_back_and_damaged_ones_are_found(void **state)
{
    static const unsigned char good[] = {3, 5, 0x81, 1, 200, 1}, cut[] = {3, 5, 0x81}, more[] = {4, 5, 1, 1};
    int values[132];
    (void)state;
    assert_true(light_codes_take_runs(values, good, sizeof good, 132)); /* 3 times 5, 129 times 200 */
    assert_int_equal(values[2], 5);
    assert_int_equal(values[3], 200);
    assert_int_equal(values[131], 200);
    assert_false(light_codes_take_runs(values, good, sizeof good, 131));
    assert_false(light_codes_take_runs(values, cut, sizeof cut, 132));
    assert_false(light_codes_take_runs(values, more, sizeof more, 4));
}

/* --------------------------------------------------------------------------------------------------------- pictures */

enum { WIDE = 360, HIGH = 240, SOME = 7 };
static const double DARK_LUX = 1; /* less is rounding */

/* The room with a lamp and a sky of radiance 1, both multiplied. */
static void light_up(struct room *r, double lamp, double sky, int rays, uint64_t key, bool hours)
{
    start(r, room_with_hole, ROOM_BOXES);
    add_lamp(r);
    r->lamp.radiance = rgb_make(8 * lamp, 6 * lamp, 4 * lamp);
    r->lamp.centre = vec3_make(2.5, 1.5, 2.9);
    field_dual(r->ready.dual, r->lamp.x, r->lamp.y);
    const struct light_list lamps = r->field.lights;
    add_sky(r);
    r->field.lights.lamps = lamps.lamps;
    r->field.lights.lamp_count = 1;
    for (int i = 0; i < 3 * 16 * 32; i++) r->field.outdoors.rgb[i] = (float)sky;
    trace_with(r, 400, rays, 0.6, key, hours);
    for (int i = 0; i < r->patches.count; i++) r->colours[i].reflectance = rgb_make(0.7, 0.6, 0.3);
    solve(r);
}

/* A camera in the back of the room that looks at the window. */
static void look(struct level_view *v, const struct room *r)
{
    *v = (struct level_view){.name = "photo 1", .width = WIDE, .height = HIGH, .from = {2, 3.8, 1.6}};
    v->pixels = calloc(WIDE * HIGH, sizeof *v->pixels);
    v->photo = malloc(3 * WIDE * HIGH);
    memset(v->photo, 128, 3 * WIDE * HIGH);
    for (int i = 0; i < WIDE * HIGH; i++) {
        const struct vec3 ray = vec3_normalize(
            vec3_make((WIDE / 2 - i % WIDE - 0.5) / 150, -1, (HIGH / 2 - (double)(i / WIDE) - 0.5) / 150));
        struct level_pixel *p = &v->pixels[i];
        struct ray_hit hit;
        *p = (struct level_pixel){{(float)ray.x, (float)ray.y, (float)ray.z}, 0, -1};
        if (!ray_scene_hit(&r->field.model.rays, v->from, ray, &hit)) continue;
        const int patch = patches_hit(&r->patches, &hit);
        if (patch < 0) continue;
        p->surface = r->patches.list[patch].face;
        p->away = (float)hit.t;
    }
}

struct fixture {
    struct room room;
    struct level_light light;
    struct level_view view;
    struct level_views views;
    struct level_points points;
    struct state_list states;
    struct level_days days;
    struct relit_light relit;
    int chosen[2];
};
static const struct gather_point two_points[] = {{{1, 1, 0.75}, {0, 0, 1}}, {{3, 3, 0.75}, {0, 0, 1}}};
static const struct levels_params params = LEVELS_PARAMS_DEFAULT;

/* Three hours are enough. */
static int keep_hours(struct level_hour *hours, int count)
{
    static const int kept[][2] = {{12, 12}, {6, 15}, {3, 10}};
    int left = 0;
    for (int i = 0; i < count; i++)
        for (int k = 0; k < 3; k++)
            if (hours[i].time.month == kept[k][0] && hours[i].time.hour == kept[k][1]) hours[left++] = hours[i];
    return left;
}

static void make_fixture(struct fixture *f)
{
    struct err err = ERR_INIT;
    *f = (struct fixture){.chosen = {0, 1}};
    light_up(&f->room, 1, 1, 256, 1, true);
    f->light = (struct level_light){f->room.groups, f->room.patches, f->room.rows, f->room.colours, f->room.light, 0};
    look(&f->view, &f->room);
    f->views = (struct level_views){.list = &f->view, .count = 1};
    assert_ok(state_list_read(&f->states, NULL, NULL, &err), err);
    f->states.has_site = true;
    f->states.site = (struct sun_place){52.5, 13.4, 1};
    f->states.north = 90; /* the window looks south */
    assert_ok(level_days_make(&f->days, &f->states, NULL, 1, &err), err);
    f->days.hour_count = keep_hours(f->days.hours, f->days.hour_count);
    assert_ok(level_points_make(&f->points, &f->light, two_points, 2, &(struct levels_params){.point_rays = 256}, &err),
              err);
    const struct relit_sources from = {.light = &f->light,
                                       .views = &f->views,
                                       .states = &f->states,
                                       .params = &params,
                                       .days = &f->days,
                                       .points = &f->points,
                                       .chosen = f->chosen,
                                       .chosen_count = 2,
                                       .scale = 0};
    struct relit_light made;
    assert_ok(relit_light_make(&made, &from, &err), err);
    const char *path = scratch_path("relit.js");
    assert_ok(relit_file_write(&made, path, &err), err);
    assert_ok(relit_file_read(&f->relit, path, &err), err);
    relit_light_release(&made);
}

static void release_fixture(struct fixture *f)
{
    relit_light_release(&f->relit);
    level_points_release(&f->points);
    level_days_release(&f->days);
    state_list_release(&f->states);
    free(f->view.pixels);
    free(f->view.photo);
    release(&f->room);
}

static struct fixture f; /* of all tests */

static int begin(void **state)
{
    const int failed = scratch_make(state);
    if (!failed) make_fixture(&f);
    return failed;
}

static int end(void **state)
{
    release_fixture(&f);
    return scratch_remove(state);
}

/* The irradiance of all patches from everything, one channel. */
static double *gathered(const struct room *r, int channel)
{
    double *values = malloc((size_t)r->patches.count * sizeof *values);
    float *found = calloc(3 * (size_t)r->groups.count, sizeof *found);
    for (int i = 0; i < r->patches.count; i++) {
        radiosity_gather(found, &r->rows, i, &r->light);
        values[i] = 0;
        for (int g = 0; g < r->groups.patch; g++) values[i] += (double)found[3 * g + channel];
    }
    free(found);
    return values;
}

static double value_at(const double *patches, int pixel)
{
    const struct level_pixel *p = &f.view.pixels[pixel];
    const struct vec3 ray = vec3_make((double)p->ray[0], (double)p->ray[1], (double)p->ray[2]);
    return patch_values_at(&f.light.patches, patches, p->surface,
                           vec3_add(f.view.from, vec3_scale(ray, (double)p->away)));
}

static struct light_state read_state(struct state_list *l, const char *words)
{
    struct err err = ERR_INIT;
    assert_ok(state_list_read_words(l, words, &err), err);
    return l->items[l->count - 1];
}

/* Each pixel of a picture of switches is within half a per cent of a room that was solved as a whole in that state with
 * the same rays, and their mean with other rays. */
static void a_picture_of_switches_is_a_full_gather_of_that_state(void **state)
{
    static const struct tried {
        const char *words;
        double lamp, sky;
    } tried[] = {{"sky photographed", 1, 1},
                 {"lamp spot 0.3 sky photographed", 0.3, 1},
                 {"lamp spot 3", 3, 0},
                 {"lamps off sky photographed", 0, 1},
                 {"lamp spot 2 sky photographed", 2, 1}};
    (void)state;
    for (int k = 0; k < 5; k++) {
        struct err err = ERR_INIT;
        struct state_list words;
        struct relit_sum sum;
        const struct light_state is = read_state(&words, tried[k].words);
        assert_ok(relit_sum_make(&sum, &f.relit, &is, &err), err);
        for (int other = 0; other < (k == 1 ? 2 : 1); other++) {
            struct room whole;
            light_up(&whole, tried[k].lamp, tried[k].sky, other ? 512 : 256, other ? 99 : 1, false);
            for (int c = 0; c < 3; c++) {
                double *after = gathered(&whole, c), *before = gathered(&f.room, c), sums[2] = {0, 0};
                int pixels = 0;
                for (int i = 0; i < WIDE * HIGH; i += SOME) {
                    double by[3];
                    if (f.view.pixels[i].surface < 0) continue;
                    const int number = f.relit.photos[0].pixels[i] - 1 - f.relit.window_count;
                    if (number < f.relit.lamp_count) continue; /* the lamp itself */
                    relit_sum_quotient(by, &sum, &f.relit, &f.relit.photos[0], i % WIDE, i / WIDE);
                    const double wanted = value_at(after, i), was = value_at(before, i);
                    if (!other) assert_near(by[c] * was / wanted, 1, 0.005);
                    sums[0] += by[c] * was;
                    sums[1] += wanted;
                    pixels++;
                }
                assert_true(pixels > WIDE * HIGH / SOME / 2);
                assert_near(sums[0] / sums[1], 1, 0.005);
                free(after);
                free(before);
            }
            release(&whole);
        }
        relit_sum_release(&sum);
        state_list_release(&words);
    }
}

/* Whether neighbours are all in the sun, or all out of it. */
static bool is_off_edges(const double *direct, int pixel)
{
    const int x = pixel % WIDE, y = pixel / WIDE;
    if (x < 2 || y < 2 || x >= WIDE - 2 || y >= HIGH - 2) return false;
    for (int k = 0; k < 25; k++)
        if ((direct[(y + k / 5 - 2) * WIDE + x + k % 5 - 2] > DARK_LUX) != (direct[pixel] > DARK_LUX)) return false;
    return true;
}

/* The same of skies and hours, beside sums over all their parts, in lx; at edges of the sun, which have half of the
 * picture's resolution, nothing is said. */
static void a_picture_of_an_hour_is_the_sum_over_all_parts_of_the_sky(void **state)
{
    static const char *const tried[] = {"lamps off sky overcast 5000",  "lamps off sky overcast 10000 blind hole 0.5",
                                        "lamps off sky clear 12 21 12", "lamps off sky partly 6 21 15",
                                        "lamps off sky cloudy 3 21 10", "lamps off sky clear 3 21 10 blind hole 0.2"};
    static double direct[WIDE * HIGH];
    static float values[WIDE * HIGH];
    double *texture[3];
    int sunny = 0, shaded = 0;
    (void)state;
    double *patches = malloc((size_t)f.room.patches.count * sizeof *patches);
    for (int c = 0; c < 3; c++) texture[c] = gathered(&f.room, c);
    for (int k = 0; k < 6; k++) {
        struct err err = ERR_INIT;
        struct state_list words;
        struct relit_sum sum;
        struct state_weights w;
        const struct light_state is = read_state(&words, tried[k]);
        assert_ok(relit_sum_make(&sum, &f.relit, &is, &err), err);
        assert_ok(level_weights_make(&w, &is, &f.states, &f.room.groups, &params, &err), err);
        const struct level_views_state all = {"", "lx", {0, 1}, &w};
        assert_ok(level_views_patches(patches, &f.light, &all, &err), err);
        level_views_values(values, &f.view, &f.light, patches, &all);
        for (int i = 0; i < WIDE * HIGH; i++)
            direct[i] = f.view.pixels[i].surface < 0 ? 0 : (double)values[i] - value_at(patches, i);
        for (int i = 0; i < WIDE * HIGH; i += SOME) {
            double by[3], lx[3];
            const int number = f.relit.photos[0].pixels[i] - 1 - f.relit.window_count;
            if (f.view.pixels[i].surface < 0 || number < f.relit.lamp_count || !is_off_edges(direct, i)) continue;
            relit_sum_quotient(by, &sum, &f.relit, &f.relit.photos[0], i % WIDE, i / WIDE);
            for (int c = 0; c < 3; c++) lx[c] = by[c] * value_at(texture[c], i);
            assert_near(rgb_luminance(rgb_make(lx[0], lx[1], lx[2])) / (double)values[i], 1, 0.005);
            sunny += direct[i] > DARK_LUX;
            shaded += !(direct[i] > DARK_LUX);
        }
        level_weights_release(&w);
        relit_sum_release(&sum);
        state_list_release(&words);
    }
    assert_true(sunny > 20 && shaded > 2000);
    for (int c = 0; c < 3; c++) free(texture[c]);
    free(patches);
}

/* A blind takes its part of what comes through its window; a hundredth comes past the pane's edges. */
static void a_blind_takes_its_part_of_a_window(void **state)
{
    static const char *const words[] = {"lamps off sky photographed blind hole 0",
                                        "lamps off sky photographed blind hole 0.4", "lamps off sky photographed"};
    (void)state;
    double sums[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        struct err err = ERR_INIT;
        struct state_list list;
        struct relit_sum sum;
        const struct light_state is = read_state(&list, words[k]);
        assert_ok(relit_sum_make(&sum, &f.relit, &is, &err), err);
        for (int i = 0; i < WIDE * HIGH; i += SOME) {
            double by[3];
            relit_sum_quotient(by, &sum, &f.relit, &f.relit.photos[0], i % WIDE, i / WIDE);
            sums[k] += by[1];
        }
        relit_sum_release(&sum);
        state_list_release(&list);
    }
    assert_true(sums[0] < 0.02 * sums[2]);
    assert_near(sums[1] / (0.6 * sums[0] + 0.4 * sums[2]), 1, 1e-4);
}

static void assert_refused(const struct relit_light *r, const char *words, const char *said)
{
    struct err err = ERR_INIT;
    struct state_list list;
    struct relit_sum sum;
    const struct light_state is = read_state(&list, words);
    assert_int_equal(relit_sum_make(&sum, r, &is, &err), ST_DATA);
    if (!strstr(err.text, said)) fail_msg("found: %s", err.text);
    relit_sum_release(&sum);
    state_list_release(&list);
}

static void states_that_the_pictures_lack_are_refused(void **state)
{
    (void)state;
    assert_refused(&f.relit, "lamp none-such 1", "found the lamp none-such");
    assert_refused(&f.relit, "blind none-such 1", "a blind of the window none-such");
    assert_refused(&f.relit, "lamps off sky clear 12 21 12.25", "no sky of 12 21, 12.25 o'clock");
    assert_refused(&f.relit, "sky overcast 1000", "their sum needs lux/scale.txt");
    f.relit.scale = 100;
    struct err err = ERR_INIT;
    struct state_list list;
    struct relit_sum sum;
    const struct light_state is = read_state(&list, "sky overcast 1000");
    assert_ok(relit_sum_make(&sum, &f.relit, &is, &err), err);
    relit_sum_release(&sum);
    state_list_release(&list);
    f.relit.scale = 0;
}

/* A grey photo in its own light, as exposed, stays what it was; a name with a blank comes back. */
static void a_picture_in_its_own_light_is_the_photograph(void **state)
{
    static unsigned char rgb[3 * WIDE * HIGH];
    struct err err = ERR_INIT;
    struct state_list list;
    struct relit_sum sum;
    double exposure = 1;
    (void)state;
    const struct light_state is = read_state(&list, "sky photographed");
    const struct relit_photo *p = &f.relit.photos[0];
    assert_string_equal(p->name, "photo 1");
    assert_ok(relit_sum_make(&sum, &f.relit, &is, &err), err);
    assert_ok(relit_picture_draw(rgb, &f.relit, p, &sum, &exposure, &err), err);
    for (int i = 0; i < WIDE * HIGH; i++)
        for (int c = 0; c < 3; c++)
            if (f.view.pixels[i].surface >= 0) assert_in_range(rgb[3 * i + c], 126, 130);
    exposure = 0;
    assert_ok(relit_picture_draw(rgb, &f.relit, p, &sum, &exposure, &err), err);
    assert_near(exposure, 0.8 / (double)linear_from_srgb(128.0f / 255), 0.02);
    relit_sum_release(&sum);
    state_list_release(&list);
}

static void damaged_files_are_refused_with_their_line(void **state)
{
    static const struct damage {
        const char *text, *said;
    } damages[] = {
        {"", "wanted"},
        {"remodelRelit(String.raw`\nremodel-relit 2\n", ":2: found"},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 2 1 0\nscale 0\nhorizontal 1\n", "wanted `);."},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 2 3 0\nscale 0\nhorizontal 1\n`);\n", ":3: found \"3\""},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 1 1 0\nscale 0\nhorizontal 1\nlamp a\nfield lamp 1 2 "
         "AAAA\n",
         ":7: found \"1\""},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 1 1 0\nscale 0\nhorizontal 1\nlamp a\nfield lamp 0 2 "
         "AAAA\n",
         ":7: found \"another count"},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 1 1 0\nscale 0\nhorizontal 1\npixels AAAA\n",
         ":6: found \"pixels\""},
        {"remodelRelit(String.raw`\nremodel-relit 1\nplaces 1 1 0\nscale 0\nhorizontal 1\nnormals A\n", "in base64"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof damages / sizeof *damages; i++) {
        struct err err = ERR_INIT;
        struct relit_light r;
        const char *path = scratch_write("damaged.js", damages[i].text);
        assert_int_equal(relit_file_read(&r, path, &err), ST_DATA);
        if (!strstr(err.text, damages[i].said)) fail_msg("%zu: %s", i, err.text);
        relit_light_release(&r);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(skies_of_three_shapes_have_three_parts),
        cmocka_unit_test(runs_come_back_and_damaged_ones_are_found),
        cmocka_unit_test(a_picture_of_switches_is_a_full_gather_of_that_state),
        cmocka_unit_test(a_picture_of_an_hour_is_the_sum_over_all_parts_of_the_sky),
        cmocka_unit_test(a_blind_takes_its_part_of_a_window),
        cmocka_unit_test(states_that_the_pictures_lack_are_refused),
        cmocka_unit_test(a_picture_in_its_own_light_is_the_photograph),
        cmocka_unit_test(damaged_files_are_refused_with_their_line),
    };
    return cmocka_run_group_tests_name("relit", tests, begin, end);
}
