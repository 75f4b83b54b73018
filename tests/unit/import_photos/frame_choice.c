/* frame_choice.c - which frames become photos, on pictures of known motion and blur: a wall with a board before it,
 * seen from a camera that moves sideways or turns. */
#include "tests/unit/scratch.h"

#include <math.h>

#include "stages/import_photos/frame_choice.h"

enum { W = 640, H = 360, MOST = 1000 };

/* Smooth noise, the same for the same place. */
static double noise(int seed, double x, double y)
{
    double sum = 0;
    for (int octave = 0; octave < 4; octave++) {
        const double s = 5 << octave, u = x / s, v = y / s;
        const double iu = floor(u), iv = floor(v), fu = u - iu, fv = v - iv;
        double corner[4];
        for (int k = 0; k < 4; k++) {
            uint32_t h = (uint32_t)(seed * 4 + octave) * 2654435761u + (uint32_t)((int)iu + (k & 1)) * 2246822519u +
                         (uint32_t)((int)iv + (k >> 1)) * 3266489917u;
            h ^= h >> 15;
            h *= 2654435761u;
            h ^= h >> 13;
            corner[k] = (h & 65535) / 65535.0;
        }
        const double top = corner[0] + fu * (corner[1] - corner[0]), low = corner[2] + fu * (corner[3] - corner[2]);
        sum += (top + fv * (low - top)) / 4;
    }
    return sum;
}

/* The same at whole places, computed once. */
static double texture(int seed, int x, int y)
{
    enum { SEEDS = 11, WIDE = 1400 };
    static float *known[SEEDS];
    if (!known[seed]) {
        known[seed] = malloc((size_t)WIDE * H * sizeof **known);
        assert_non_null(known[seed]);
        for (int v = 0; v < H; v++)
            for (int u = 0; u < WIDE; u++) known[seed][v * WIDE + u] = (float)noise(seed, u, v);
    }
    return (double)known[seed][y * WIDE + x];
}

struct shot {
    int wall, board; /* px by which they have moved */
    int blur;        /* px to each side */
    int scene;       /* other pictures on both; below 0: black */
};

static double light_at(const struct shot *s, int x, int y)
{
    if (s->scene < 0) return 0;
    const int on_board = x - 200 - s->board;
    const bool board = on_board >= 0 && on_board < 300 && y >= 80 && y < 300;
    return board ? texture(1 + 2 * s->scene, on_board, y) : texture(2 + 2 * s->scene, x - s->wall, y);
}

static void draw(unsigned char *grey, const struct shot *s)
{
    double row[W];
    for (int y = 0; y < H; y++) {
        for (int x = 0; x < W; x++) row[x] = light_at(s, x, y);
        for (int x = 0; x < W; x++) {
            double sum = 0;
            for (int k = -s->blur; k <= s->blur; k++) sum += row[x + k < 0 ? 0 : x + k >= W ? W - 1 : x + k];
            grey[y * W + x] = (unsigned char)lrint(255 * sum / (2 * s->blur + 1));
        }
    }
}

static void choose(struct chosen_frames *chosen, const struct shot *shots, int count, int most)
{
    static unsigned char grey[W * H];
    struct frame_choice *c = NULL;
    struct err err = ERR_INIT;
    assert_ok(frame_choice_begin(&c, W, H, &err), err);
    for (int i = 0; i < count; i++) {
        draw(grey, &shots[i]);
        assert_ok(frame_choice_add(c, grey, i, i / 30.0, &err), err);
    }
    assert_ok(frame_choice_end(chosen, c, most, &err), err);
    frame_choice_release(c);
}

/* The board moves by 4 px a frame against the wall, 1/160 of the picture: progress 1 is 3.2 frames. */
static void frames_have_parallax_between_them(void **state)
{
    struct shot shots[60];
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 60; i++) shots[i] = (struct shot){-2 * i, 2 * i, 0, 0};
    choose(&chosen, shots, 60, MOST);
    assert_in_range(chosen.count, 60 / 4.2, 60 / 2.2);
    for (int i = 1; i < chosen.count; i++) {
        const struct chosen_frame *f = &chosen.frames[i];
        const int steps = f->number - f[-1].number;
        assert_true(f->seconds == f->number / 30.0);
        if (steps < 2 || steps > 5) fail_msg("frames %d and %d", f[-1].number, f->number);
        if (fabs(f->parallax - steps / 160.0) > 0.15 * steps / 160.0)
            fail_msg("frame %d: parallax %g, wanted %g", f->number, f->parallax, steps / 160.0);
    }
    frame_choice_free(&chosen);
}

/* One frame of four is sharp. */
static void blurred_frames_are_passed_over(void **state)
{
    struct shot shots[60];
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 60; i++) shots[i] = (struct shot){-i, i, i % 4 == 2 ? 0 : 3 + i % 3, 0};
    choose(&chosen, shots, 60, MOST);
    assert_in_range(chosen.count, 6, 20);
    for (int i = 0; i < chosen.count; i++)
        if (chosen.frames[i].number % 4 != 2) fail_msg("frame %d is blurred", chosen.frames[i].number);
    frame_choice_free(&chosen);
}

static void a_camera_at_rest_gives_one_frame(void **state)
{
    struct shot shots[200] = {{0}};
    struct chosen_frames chosen = {0};
    (void)state;
    choose(&chosen, shots, 200, MOST);
    assert_int_equal(chosen.count, 1);
    frame_choice_free(&chosen);
}

/* A camera that turns: the whole picture moves by 8 px a frame. Frames follow the overlap. */
static void turns_are_covered_without_parallax(void **state)
{
    struct shot shots[80];
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 80; i++) shots[i] = (struct shot){-8 * i, -8 * i, 0, 0};
    choose(&chosen, shots, 80, MOST);
    assert_in_range(chosen.count, 3, 8);
    assert_true(chosen.most_parallax < FRAME_PARALLAX / 4);
    for (int i = 1; i < chosen.count; i++)
        assert_in_range(chosen.frames[i].number - chosen.frames[i - 1].number, 10, 30);
    frame_choice_free(&chosen);
}

static void a_cut_begins_anew(void **state)
{
    struct shot shots[60];
    struct chosen_frames chosen = {0};
    int after = 0;
    (void)state;
    for (int i = 0; i < 60; i++) shots[i] = (struct shot){-2 * (i % 30), 2 * (i % 30), 0, i / 30};
    choose(&chosen, shots, 60, MOST);
    for (int i = 1; i < chosen.count; i++) {
        if (chosen.frames[i].number < 30) continue;
        if (!after++) assert_true(chosen.frames[i].parallax == 0 && chosen.frames[i].overlap == 0);
    }
    assert_true(after > 2 && after < chosen.count - 2);
    frame_choice_free(&chosen);
}

/* Each frame shows something else: none is lost. */
static void a_clip_that_jumps_gives_all_frames(void **state)
{
    struct shot shots[5] = {{0}};
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 5; i++) shots[i].scene = i;
    choose(&chosen, shots, 5, MOST);
    assert_int_equal(chosen.count, 5);
    frame_choice_free(&chosen);
}

/* Fades from black and to black, and a wall without texture in between. */
static void frames_that_show_nothing_are_passed_over(void **state)
{
    struct shot shots[60];
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 60; i++)
        shots[i] = (struct shot){-2 * i, 2 * i, 0, i < 10 || i >= 50 || (i >= 25 && i < 35) ? -1 : 0};
    choose(&chosen, shots, 60, MOST);
    assert_in_range(chosen.count, 30 / 4.2, 30 / 2.2 + 2);
    for (int i = 0; i < chosen.count; i++)
        if (shots[chosen.frames[i].number].scene < 0) fail_msg("frame %d is black", chosen.frames[i].number);
    frame_choice_free(&chosen);
}

/* It ends, which is not a matter of course. */
static void a_black_clip_gives_no_frame(void **state)
{
    struct shot shots[60];
    struct chosen_frames chosen = {0};
    (void)state;
    for (int i = 0; i < 60; i++) shots[i] = (struct shot){0, 0, 0, -1};
    choose(&chosen, shots, 60, MOST);
    assert_int_equal(chosen.count, 0);
    frame_choice_free(&chosen);
}

static void too_many_frames_are_thinned_evenly(void **state)
{
    struct shot shots[60];
    struct chosen_frames all = {0}, few = {0};
    (void)state;
    for (int i = 0; i < 60; i++) shots[i] = (struct shot){-2 * i, 2 * i, 0, 0};
    choose(&all, shots, 60, MOST);
    choose(&few, shots, 60, 4);
    assert_int_equal(few.count, 4);
    assert_int_equal(few.frames[0].number, all.frames[0].number);
    assert_int_equal(few.frames[3].number, all.frames[all.count - 1].number);
    for (int i = 1; i < 4; i++) assert_in_range(few.frames[i].number - few.frames[i - 1].number, 14, 25);
    frame_choice_free(&all);
    frame_choice_free(&few);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_have_parallax_between_them),
        cmocka_unit_test(blurred_frames_are_passed_over),
        cmocka_unit_test(a_camera_at_rest_gives_one_frame),
        cmocka_unit_test(turns_are_covered_without_parallax),
        cmocka_unit_test(a_cut_begins_anew),
        cmocka_unit_test(a_clip_that_jumps_gives_all_frames),
        cmocka_unit_test(frames_that_show_nothing_are_passed_over),
        cmocka_unit_test(a_black_clip_gives_no_frame),
        cmocka_unit_test(too_many_frames_are_thinned_evenly),
    };
    return cmocka_run_group_tests_name("frame_choice", tests, NULL, NULL);
}
