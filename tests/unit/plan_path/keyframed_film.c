/* keyframed_film.c - tests of keyframed films: poses and lenses of keys, planned moves, joins, layers, error messages.
 * */
#include "stages/plan_path/keyframed_film.h"

#include "tests/unit/scratch.h"

/* Two views side by side along z with the film's size, and one that is stored on its side. */
static struct view views[] = {
    {.name = "a", .width = 320, .height = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120},
    {.name = "b", .width = 320, .height = 240, .fx = 330, .fy = 330, .cx = 160, .cy = 120},
    {.name = "side", .width = 240, .height = 320, .fx = 310, .fy = 310, .cx = 120, .cy = 160},
};
static const struct vec3 ups[] = {{0, -1, 0}, {0, -1, 0}, {-1, 0, 0}};
static struct camera_set set = {.views = views, .view_count = 3};

static struct film_settings settings(void)
{
    for (int i = 0; i < 3; i++) {
        views[i].cam_from_world = (struct mat3){{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
        if (i == 2) views[i].cam_from_world = (struct mat3){{{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}}};
        views[i].center = vec3_make(i, 0, 0);
        views[i].translation = vec3_scale(mat3_apply(views[i].cam_from_world, views[i].center), -1);
    }
    return (struct film_settings){.name = "f",
                                  .set = &set,
                                  .ups = ups,
                                  .fps = 10,
                                  .rest = true,
                                  .moves = scratch,
                                  .up = {0, -1, 0},
                                  .lens = {.width = 320, .height = 240, .fx = 300, .fy = 300, .cx = 160, .cy = 120}};
}

static void make(struct camera_path *path, struct effects *layers, const char *text)
{
    struct err err = ERR_INIT;
    const struct film_settings film = settings();
    *path = (struct camera_path){0};
    *layers = (struct effects){0};
    if (keyframed_path(path, layers, scratch_write("f.txt", text), &film, NULL, &err)) fail_msg("%s", err.text);
    for (int i = 0; i < path->frame_count; i++) {
        const struct view *v = &path->frames[i].camera;
        assert_true(v->width == 320 && v->height == 240 && v->fx > 0 && v->fy > 0);
        assert_true(vec3_length(vec3_add(mat3_apply(v->cam_from_world, v->center), v->translation)) < 1e-12);
        assert_float_equal(path->frames[i].time, i / 10.0, 1e-12);
        assert_true((path->frames[i].aperture > 0) == (path->frames[i].focus > 0));
    }
}

static void release(struct camera_path *path, struct effects *layers)
{
    camera_path_release(path);
    effects_release(layers);
}

static void assert_near(double a, double b) { assert_true(fabs(a - b) < 1e-12 * (1 + fabs(b))); }

#define HEAD "remodel-keyframes 1\n"

static void frames_show_what_the_keys_describe(void **state)
{
    (void)state;
    struct camera_path p;
    struct effects e;
    make(&p, &e,
         HEAD "key 0 view b aperture 0.5 focus at 9 9 4\n"
              "key 1 camera 2 0 0 0 -3 -1 0 focal 600\n"
              "key 2.5 at 5 0 0 look 5 0 -7 up 0 1 0 focal x3 aperture 0 focus 8\n"
              "remodel-effects 1\nlayer l brightness\nregion all\nkey 0 1\nkey 1 2\n");
    assert_int_equal(p.frame_count, 26);
    const struct path_frame *f = p.frames;
    assert_true(f[0].camera.center.x == 1 && f[0].camera.center.y == 0);
    assert_near(f[0].camera.fx, 330);
    assert_near(f[0].aperture, 0.5);
    assert_near(f[0].focus, 4);
    assert_near(f[10].camera.center.x, 3);
    assert_near(f[10].camera.center.y, 1);
    assert_near(f[10].camera.fx, 600);
    assert_near(f[25].camera.center.x, 5);
    assert_near(f[25].camera.fx, 900);
    assert_near(f[25].camera.cam_from_world.m[2][2], -1);
    assert_near(f[25].camera.cam_from_world.m[1][1], -1); /* up is +y */
    assert_near(f[25].camera.cam_from_world.m[0][0], 1);
    assert_true(f[25].aperture == 0 && f[25].focus == 0);
    for (int i = 1; i < 26; i++) {
        assert_true(f[i].camera.fx >= f[i - 1].camera.fx && f[i].aperture <= f[i - 1].aperture);
        assert_true(f[i].focus == 0 || f[i].focus >= f[i - 1].focus);
    }
    assert_int_equal(e.layer_count, 1);
    assert_int_equal(e.layers[0].key_count, 2);
    release(&p, &e);
    /* a photo stored on its side is shown upright, filling the frame */
    make(&p, &e, HEAD "key 0 view side\nkey 1 view side\n");
    assert_int_equal(p.frame_count, 11);
    for (int i = 0; i < 11; i++) {
        assert_near(p.frames[i].camera.cam_from_world.m[0][0], 1);
        assert_near(p.frames[i].camera.cam_from_world.m[1][1], 1);
        assert_near(p.frames[i].camera.fx, 310);
        assert_true(p.frames[i].camera.center.x == 2);
    }
    release(&p, &e);
    /* without its own up, a key uses the film's */
    make(&p, &e, HEAD "key 0 at 0 0 0 look 0 0 1\nkey 0.5 at 0 0 0 look 1 0 0\n");
    assert_near(p.frames[5].camera.cam_from_world.m[0][2], -1);
    assert_near(p.frames[5].camera.cam_from_world.m[1][1], 1);
    assert_near(p.frames[5].camera.fx, 300);
    release(&p, &e);
}

static void the_last_frame_shows_the_last_key(void **state)
{
    (void)state;
    struct camera_path p;
    struct effects e;
    static const double seconds[] = {0.04, 0.26, 0.94, 1, 1.07};
    static const int frames[] = {2, 4, 10, 11, 12};
    for (int i = 0; i < 5; i++) {
        char text[200];
        snprintf(text, sizeof text, HEAD "key 0 view a\nkey %g view b\n%s", seconds[i], i ? "" : "cut\nkey 0 view b\n");
        make(&p, &e, text);
        assert_int_equal(p.frame_count, frames[i]);
        assert_near(p.frames[p.frame_count - 1].camera.center.x, 1);
        release(&p, &e);
    }
}

/* A straight move of 11 frames from x = 0 to 1 at constant velocity, 10 frames per second. */
static void write_move(const char *effect, int width)
{
    struct camera_path p;
    struct err err = ERR_INIT;
    const struct film_settings film = settings();
    assert_ok(camera_path_init(&p, effect, 10, 11, &err), err);
    for (int i = 0; i < 11; i++) {
        const char *name = p.frames[i].camera.name;
        p.frames[i].camera = film.lens;
        p.frames[i].camera.name = name;
        p.frames[i].camera.width = width;
        p.frames[i].camera.cam_from_world = views[0].cam_from_world;
        p.frames[i].camera.center = vec3_make(i / 10.0, 0, 0);
        p.frames[i].camera.translation = vec3_make(-i / 10.0, 0, 0);
        p.frames[i].aperture = i / 20.0;
        p.frames[i].focus = i ? 5 : 0;
    }
    const struct provenance prov = {.stage = "plan_path", .version = "0"};
    assert_ok(camera_path_write(&p, scratch_path(effect), &prov, &err), err);
    camera_path_release(&p);
}

static void moves_and_keys_are_joined(void **state)
{
    (void)state;
    struct camera_path p;
    struct effects e;
    write_move("move", 320);
    make(&p, &e, HEAD "move move\ncut\nmove move reversed seconds 2.1\njoin 0.5\nkey 0 at 0 0 0 look 0 0 1\n");
    assert_int_equal(p.frame_count, 11 + 21 + 5);
    const struct path_frame *f = p.frames;
    for (int i = 0; i < 11; i++) {
        assert_near(f[i].camera.center.x, i / 10.0);
        assert_near(f[i].aperture, i / 20.0);
        assert_true(f[i].focus == (i ? 5 : 0));
    }
    for (int i = 0; i < 21; i++) { /* backwards at half the speed */
        assert_near(f[11 + i].camera.center.x, 1 - i / 20.0);
        assert_near(f[11 + i].aperture, 0.5 - i / 40.0);
    }
    /* the transition continues the move's velocity and comes to rest: a cubic with slope -0.5 at its start */
    for (int i = 0; i < 5; i++) {
        const double t = (i + 1) / 5.0, u = 1 - t;
        assert_near(f[32 + i].camera.center.x, -0.5 * 0.5 * t * u * u);
        assert_true(f[32 + i].aperture == 0);
    }
    assert_int_equal(p.score_count, 3);
    assert_near(p.scores[2].value, 3.6);
    release(&p, &e);
}

static void effect_layers_of_moves_are_carried_over(void **state)
{
    (void)state;
    struct camera_path p;
    struct effects e;
    double v[3];
    write_move("move+fade", 320);
    scratch_write("move+fade/effects.txt",
                  "remodel-effects 1\nlayer s saturation\nregion inside 0 0 0 1 2 3 4\nkey 0 1\nkey 1 0\nkey 7 9\n");
    make(&p, &e,
         HEAD "key 0 view a\nkey 1 view b\nmove move+fade\njoin 1\nmove move+fade reversed seconds 2.1\n"
              "remodel-effects 1\nlayer own color\nregion all\nkey 0 1 2 3\n");
    assert_int_equal(p.frame_count, 11 + 11 + 9 + 21);
    assert_int_equal(e.layer_count, 3);
    assert_string_equal(e.layers[0].name, "2:s");
    assert_string_equal(e.layers[1].name, "3:s");
    assert_string_equal(e.layers[2].name, "own");
    assert_true(e.layers[0].region == EFFECT_INSIDE && e.layers[0].box_count == 1);
    assert_true(e.layers[0].boxes[0].falloff == 4 && e.layers[0].boxes[0].high.z == 3);
    for (int i = 0; i < p.frame_count; i++) {
        /* no change before the cut; the move's own value; back to no change over the join */
        const double first = i <= 10 ? 1 : i <= 21 ? 1 - (i - 11) / 10.0 : fmin(1, (i - 21) / 10.0);
        effect_layer_value(&e.layers[0], i / 10.0, v);
        assert_true(fabs(v[0] - first) < 1e-9);
        const double second = i <= 21 ? 1 : i <= 31 ? 1 - (i - 21) / 10.0 : (i - 31) / 20.0;
        effect_layer_value(&e.layers[1], i / 10.0, v);
        assert_true(fabs(v[0] - second) < 1e-9);
    }
    release(&p, &e);
}

/* A box that moves by 1, softens and turns by a right angle over its move's second. */
static void boxes_of_moves_follow_their_shots(void **state)
{
    (void)state;
    struct camera_path p;
    struct effects e, again;
    struct err err = ERR_INIT;
    struct effect_box b;
    write_move("move+box", 320);
    scratch_write("move+box/effects.txt", "remodel-effects 1\nlayer s saturation\n"
                                          "region inside 0 0 0 1 2 3 4 at 0.22\n"
                                          "region inside 1 0 0 2 2 3 6 axes 1 1 0 0 at 0.78\nkey 0 0.5\n");
    make(&p, &e,
         HEAD "key 0 view a\nkey 1 view b\nmove move+box\njoin 1\nmove move+box reversed seconds 2.1\n"
              "remodel-effects 1\nlayer own color\nregion outside 0 0 0 1 1 1 0\n"
              "region outside 5 5 5 6 6 6 1 at 2.5\nkey 0 1 2 3\n");
    assert_int_equal(e.layer_count, 3);
    for (int i = 0; i < p.frame_count; i++) {
        for (int k = 0; k < 2; k++) {
            const double time = k ? (i - 31) / 20.0 : (i - 11) / 10.0; /* in the move; backwards at half the speed */
            const double way = fmin(fmax(((k ? 1 - time : time) - 0.22) / 0.56, 0), 1);
            effect_layer_box(&e.layers[k], i / 10.0, &b);
            assert_true(fabs(b.low.x - way) < 1e-9 && fabs(b.high.x - 1 - way) < 1e-9);
            assert_true(fabs(b.high.z - 3) < 1e-9 && fabs(b.falloff - 4 - 2 * way) < 1e-9);
            assert_true(fabs(atan2(b.box_from_world.x, b.box_from_world.w) - way * acos(-1) / 4) < 1e-9);
        }
        effect_layer_box(&e.layers[2], i / 10.0, &b); /* the film's own, in its time */
        assert_true(fabs(b.low.x - 5 * fmin(i / 25.0, 1)) < 1e-9);
    }
    /* boxes that are held need no keys: at frames 0, 2 to 8 and 10, and 0, 4 to 16 and 20 */
    assert_int_equal(e.layers[0].box_count, 9);
    assert_int_equal(e.layers[1].box_count, 15);
    const char *path = scratch_path("written.txt");
    assert_ok(effects_write(&e, path, NULL, &err), err);
    assert_ok(effects_read(&again, path, NULL, &err), err);
    for (int k = 0; k < 3; k++)
        assert_memory_equal(again.layers[k].boxes, e.layers[k].boxes, (size_t)e.layers[k].box_count * sizeof b);
    effects_release(&again);
    release(&p, &e);
}

static void bad_files_are_refused_with_file_and_line(void **state)
{
    (void)state;
#define KEY HEAD "key 0 view a\n"
    static const struct {
        const char *text, *line, *words;
    } bad[] = {
        {"", "an empty file", "wanted remodel-keyframes 1"},
        {"remodel-path 1\n", ":1:", "wanted remodel-keyframes 1"},
        {"remodel-keyframes 2\n", ":1:", "found \"2\""},
        {HEAD, ":1:", "wanted a key or a move"},
        {HEAD "keys 0\n", ":2:", "wanted key, move, join, cut or remodel-effects"},
        {HEAD "key\n", ":2:", "a time in seconds"},
        {HEAD "key nan view a\n", ":2:", "found \"nan\", wanted a time"},
        {HEAD "key -1 view a\n", ":2:", "found \"-1\", wanted a time"},
        {HEAD "key 1e9 view a\n", ":2:", "found \"1e9\", wanted a time"},
        {HEAD "key 1 view a\n", ":2:", "found \"1\", wanted 0"},
        {HEAD "key 0 view z\n", ":2:", "found \"z\", wanted a view"},
        {HEAD "key 0 sight a\n", ":2:", "wanted view, camera or at"},
        {KEY "key 2 view a\nkey 1 view b\n", ":4:", "found \"1\", wanted a time 0.001 s or more after 2"},
        {KEY "key 0 view b\n", ":3:", "begins a new shot"},
        {HEAD "key 0 camera 0 0 0 0 1 2 3\n", ":2:", "a quaternion of length 0"},
        {HEAD "key 0 camera 1 0 0 0 1 2\n", ":2:", "wanted tz"},
        {HEAD "key 0 camera 1 0 0 0 1 2 1e99\n", ":2:", "found \"1e99\", wanted tz, a number from"},
        {HEAD "key 0 at 1 2 3 view a\n", ":2:", "\"look\""},
        {HEAD "key 0 at 1 2 3 look 1 2 3\n", ":2:", "looks at its own position"},
        {HEAD "key 0 at 0 0 0 look 0 9 0\n", ":2:", "a camera axis parallel to the film's up"},
        {HEAD "key 0 at 0 0 0 look 0 0 1 up 0 0 4\n", ":2:", "an up parallel to the camera's axis"},
        {HEAD "key 0 at 0 0 0 look 0 0 1 up 0 0 0\n", ":2:", "an up parallel to the camera's axis"},
        {HEAD "key 0 view a up 0 1 0\n", ":2:", "found \"up\", wanted focal, aperture or focus"},
        {HEAD "key 0 view a zoom 2\n", ":2:", "wanted focal, aperture or focus"},
        {HEAD "key 0 view a focal 0\n", ":2:", "found \"0\", wanted a focal length"},
        {HEAD "key 0 view a focal x\n", ":2:", "found \"x\", wanted a focal length"},
        {HEAD "key 0 view a focal 1 focal 2\n", ":2:", "each option once"},
        {HEAD "key 0 view a aperture -1\n", ":2:", "found \"-1\", wanted the diameter"},
        {HEAD "key 0 view a aperture 1\n", ":2:", "no focus"},
        {HEAD "key 0 view a focus 0\n", ":2:", "a focus at depth 0"},
        {HEAD "key 0 view a focus at 0 0 -2\n", ":2:", "a focus at depth -2"},
        {HEAD "key 0 view a focus near\n", ":2:", "found \"near\", wanted a depth"},
        {KEY, ":2:", "a single key"},
        {HEAD "cut\n" KEY, ":2:", "join and cut go between two shots"},
        {KEY "join 1\ncut\n", ":4:", "join and cut go between two shots"},
        {KEY "join 0\n", ":3:", "found \"0\", wanted a transition's duration"},
        {KEY "join 1\n", ":3:", "wanted a key or a move after the join or cut"},
        {KEY "join 1\nremodel-effects 1\n", ":4:", "wanted a key or a move after"},
        {KEY "join 99999\nkey 0 view b\njoin 99999\nmove move\n", ":6:", "more than 1000000 frames"},
        {KEY "key 99999.8 view b\ncut\nkey 0 view a\nkey 2 view a\n", ":5:", "more than 1000000 frames"},
        {HEAD "move\n", ":2:", "a planned move's name"},
        {HEAD "move ../x\n", ":2:", "letters, digits"},
        {HEAD "move x back\n", ":2:", "reversed or seconds"},
        {HEAD "move x reversed reversed\n", ":2:", "each once"},
        {HEAD "move x seconds 0\n", ":2:", "found \"0\""},
        {HEAD "move nowhere\n", ":2:", "nowhere/path"},
        {HEAD "move wide\n", ":2:", "frames of 640 x 240, and the film of 320 x 240"},
        {KEY "key 1 view b\nremodel-effects 1\nlayer a hue\n", ":5:", "found \"hue\""},
        {KEY "key 1 view b\nremodel-effects 3\n", ":4:", "found \"3\""},
    };
    write_move("move", 320);
    write_move("wide", 640);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        struct camera_path p = {0};
        struct effects e = {0};
        struct err err = ERR_INIT;
        const struct film_settings film = settings();
        const char *path = scratch_write("bad.txt", bad[i].text);
        const enum status st = keyframed_path(&p, &e, path, &film, NULL, &err);
        if (!st) fail_msg("accepted: %s", bad[i].text);
        assert_err(err, st, bad[i].words);
        assert_contains(err.text, bad[i].line);
        assert_contains(err.text, path);
        assert_true(!p.frames && !e.layers);
    }
    struct film_settings film = settings();
    struct camera_path p = {0};
    struct effects e = {0};
    struct err err = ERR_INIT;
    film.moves = NULL;
    assert_int_equal(keyframed_path(&p, &e, scratch_write("f.txt", HEAD "move move\n"), &film, NULL, &err), ST_DATA);
    assert_contains(err.text, "there is no folder of planned moves");
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(frames_show_what_the_keys_describe),
        cmocka_unit_test(the_last_frame_shows_the_last_key),
        cmocka_unit_test(moves_and_keys_are_joined),
        cmocka_unit_test(effect_layers_of_moves_are_carried_over),
        cmocka_unit_test(boxes_of_moves_follow_their_shots),
        cmocka_unit_test(bad_files_are_refused_with_file_and_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
