/* More kinds of truth: witnesses, rooms without furniture, irradiance, another sun, samples of truth. */
#include "tests/unit/simulate/worlds.h"

#include "common/base/parallel.h"
#include "common/capture/sfm_model.h"
#include "common/image/exr.h"
#include "stages/simulate/render_estimate.h"
#include "stages/simulate/scene_truth.h"
#include "stages/simulate/true_irradiance.h"

#define ROOM                                                                                                           \
    "texture t plaster 0.2 0.3 1 0.6 0.5 0.4\nmaterial m lambert t\nroom r 0 0 5 4 0 2.5 m m\n"                        \
    "wall s 0 0 5 0 0 2.5 0.2 m\nwall e 5 0 5 4 0 2.5 0.2 m\nwall n 5 4 0 4 0 2.5 0.2 m\nwall w 0 4 0 0 0 2.5 0.2 m\n" \
    "window o s 1.5 3.5 0.8 2.2\nlamp l quad 2 2 2.4 0 0.5 0 0.5 0 0 9 9 9\nsun -80 40 2 500 450 400\n"                \
    "panorama 1 2 2 2 1 1 1\n"
#define SHOOT                                                                                                  \
    "remodel-shoot 1\nlens p pinhole 48 32 32 32 24 16\nexposure 0.004\nexposure 0.016\nsensor 30000 6 60 1\n" \
    "photo a p 1 3 1.2 4 1 0.8\nwitness w p 1 3 1.2 4 1 0.8\n"

static struct simulate_params params = {
    .samples = 16, .scale = 1, .seed = 1, .truth = "yes", .irradiance_samples = 4096};

struct fixture {
    struct world world;
    struct shoot shoot;
    struct picture_job job;
    char out[300];
};

static void setup(struct fixture *f, const char *scene, const char *shoot, const char *folder)
{
    struct err err = ERR_INIT;
    *f = (struct fixture){.world = world_from(scene)};
    scratch_write("cameras.txt", shoot);
    assert_ok(shoot_read(&f->shoot, scratch, 1, NULL, &err), err);
    snprintf(f->out, sizeof f->out, "%s/%s", scratch, folder);
    f->job = (struct picture_job){&f->shoot, f->out, &params, NULL};
}

static void drop(struct fixture *f)
{
    shoot_release(&f->shoot);
    path_world_release(&f->world);
}

static struct exr_image picture(const struct fixture *f, const char *file)
{
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    char path[600];
    snprintf(path, sizeof path, "%s/%s", f->out, file);
    assert_ok(exr_read(&im, path, NULL, 0, &err), err);
    return im;
}

static void assert_same_bytes(const struct fixture *f, const char *a, const char *b)
{
    char path[2][600];
    snprintf(path[0], sizeof path[0], "%s/%s", f->out, a);
    snprintf(path[1], sizeof path[1], "%s/%s", f->out, b);
    FILE *x = fopen(path[0], "rb"), *y = fopen(path[1], "rb");
    assert_true(x && y);
    int c, d;
    do {
        c = getc(x), d = getc(y);
        if (c != d) fail_msg("%s differs from %s", a, b);
    } while (c != EOF);
    fclose(x);
    fclose(y);
}

/* The same camera with other random numbers: the pictures agree within their noise. */
static void a_witness_at_a_photos_camera_sees_its_radiance(void **state)
{
    struct fixture f;
    struct err err = ERR_INIT;
    (void)state;
    setup(&f, ROOM, SHOOT, "witness");
    for (int i = 0; i < 2; i++) assert_ok(photo_make(&f.job, &f.world, &f.shoot.photos[i], &err), err);
    assert_ok(truth_write(&f.world, &f.shoot, scratch, f.out, &params, NULL, &err), err);
    struct exr_image a = picture(&f, "truth/hdr/a.exr"), w = picture(&f, "truth/novel/hdr/w.exr");
    double sum[2] = {0, 0}, differing = 0;
    for (int i = 0; i < 48 * 32; i++) {
        sum[0] += exr_find(&a, "G")->f[i], sum[1] += exr_find(&w, "G")->f[i];
        differing += exr_find(&a, "G")->f[i] != exr_find(&w, "G")->f[i];
    }
    assert_true(sum[0] > 0 && fabs(sum[1] / sum[0] - 1) < 0.03); /* 5 standard deviations of the mean */
    assert_true(differing > 48 * 32 / 2);                        /* noise of its own */
    assert_same_bytes(&f, "truth/depth/a.exr", "truth/novel/depth/w.exr");
    assert_same_bytes(&f, "truth/ids/a.exr", "truth/novel/ids/w.exr");

    char path[600];
    struct sfm_model m = {0};
    snprintf(path, sizeof path, "%s/photos/w_e0.jpg", f.out);
    assert_int_not_equal(access(path, R_OK), 0); /* no photograph */
    snprintf(path, sizeof path, "%s/truth/novel", f.out);
    assert_ok(sfm_model_read_text(&m, path, NULL, &err), err);
    assert_true(m.image_count == 1 && m.camera_count == 1);
    assert_string_equal(m.images[0].name, "w.jpg");
    sfm_model_release(&m);
    snprintf(path, sizeof path, "%s/truth", f.out);
    assert_ok(sfm_model_read_text(&m, path, NULL, &err), err);
    assert_int_equal(m.image_count, 1);
    sfm_model_release(&m);
    exr_image_release(&a);
    exr_image_release(&w);
    drop(&f);
}

static void make_shell(struct fixture *f)
{
    struct err err = ERR_INIT;
    f->world.shell = true;
    assert_ok(photo_make_truth(&f->job, &f->world, &f->shoot.photos[0], "truth/shell", &err), err);
    f->world.shell = false;
}

static void the_shell_of_a_room_without_furniture_is_the_room(void **state)
{
    struct fixture f;
    struct err err = ERR_INIT;
    (void)state;
    setup(&f, ROOM, SHOOT, "bare");
    assert_ok(photo_make(&f.job, &f.world, &f.shoot.photos[0], &err), err);
    make_shell(&f);
    assert_same_bytes(&f, "truth/hdr/a.exr", "truth/shell/hdr/a.exr");
    assert_same_bytes(&f, "truth/depth/a.exr", "truth/shell/depth/a.exr");
    assert_same_bytes(&f, "truth/ids/a.exr", "truth/shell/ids/a.exr");
    drop(&f);
}

/* A box in the middle of the room: the shell shows the surfaces behind it, and its shadow. */
static void the_shell_shows_surfaces_behind_furniture_in_its_shadow(void **state)
{
    struct fixture f, bare;
    struct err err = ERR_INIT;
    (void)state;
    setup(&bare, ROOM, SHOOT, "empty");
    assert_ok(photo_make(&bare.job, &bare.world, &bare.shoot.photos[0], &err), err);
    setup(&f, ROOM "furniture on\nbox b 2.0 1.4 0.02 3.0 2.4 0.9 m\nfurniture off\n", SHOOT, "shell");
    assert_ok(photo_make(&f.job, &f.world, &f.shoot.photos[0], &err), err);
    make_shell(&f);
    struct exr_image room = picture(&bare, "truth/hdr/a.exr"), shell = picture(&f, "truth/shell/hdr/a.exr");
    struct exr_image ids = picture(&f, "truth/ids/a.exr"), shell_ids = picture(&f, "truth/shell/ids/a.exr");
    struct exr_image depth = picture(&bare, "truth/depth/a.exr"), shell_depth = picture(&f, "truth/shell/depth/a.exr");
    struct exr_image bare_ids = picture(&bare, "truth/ids/a.exr");
    double hidden[2] = {0, 0};
    int count = 0;
    for (int i = 0; i < 48 * 32; i++) {
        assert_int_equal(exr_find(&shell_ids, "id")->u[i], exr_find(&bare_ids, "id")->u[i]);
        assert_true(exr_find(&shell_depth, "Z")->f[i] == exr_find(&depth, "Z")->f[i]);
        if (exr_find(&ids, "id")->u[i] == exr_find(&shell_ids, "id")->u[i]) continue;
        count++;
        hidden[0] += exr_find(&room, "G")->f[i], hidden[1] += exr_find(&shell, "G")->f[i];
    }
    assert_true(count > 50);
    assert_true(hidden[1] > 0 && hidden[1] < 0.9 * hidden[0]);
    struct exr_image *const all[] = {&room, &shell, &ids, &shell_ids, &depth, &shell_depth, &bare_ids};
    for (int i = 0; i < 7; i++) exr_image_release(all[i]);
    drop(&f);
    drop(&bare);
}

static void irradiance_does_not_change_where_nothing_changes(void **state)
{
    struct fixture f;
    struct world same = {0}, edited = {0};
    struct err err = ERR_INIT;
    (void)state;
    setup(&f, ROOM "box b 2.0 1.4 0 3.0 2.4 0.9 m\n", SHOOT, "irradiance");
    scratch_write("scene-same.txt", "remodel-scene 2\nbase scene.txt\n");
    scratch_write("scene-gone.txt", "remodel-scene 2\nbase scene.txt\ndrop b\nbox b 2.0 1.4 0 3.0 2.4 0.4 m\n");
    assert_ok(path_world_read(&same, scratch, "scene-same.txt", NULL, &err), err);
    assert_ok(path_world_read(&edited, scratch, "scene-gone.txt", NULL, &err), err);
    const struct shoot_photo *a = &f.shoot.photos[0];
    assert_ok(irradiance_picture(&f.job, &f.world, NULL, a, "truth", &err), err);
    assert_ok(irradiance_picture(&f.job, &f.world, &same, a, "truth/edited-same", &err), err);
    assert_ok(irradiance_picture(&f.job, &f.world, &edited, a, "truth/edited-gone", &err), err);
    assert_same_bytes(&f, "truth/irradiance/a.exr", "truth/edited-same/irradiance/a.exr"); /* the ratio is 1 */

    struct exr_image before = picture(&f, "truth/irradiance/a.exr"),
                     after = picture(&f, "truth/edited-gone/irradiance/a.exr");
    int lit = 0, other = 0, shared = 0;
    for (int i = 0; i < 48 * 32; i++) {
        const double e = exr_find(&before, "R")->f[i], new = exr_find(&after, "R")->f[i];
        lit += e > 0;
        other += e > 0 && new == 0;
        shared += e > 0 && new > 0;
    }
    assert_true(lit > 1000 && shared > 800);
    assert_true(other > 50); /* where the taller box was seen, the edited room has another surface */
    exr_image_release(&before);
    exr_image_release(&after);
    path_world_release(&same);
    path_world_release(&edited);
    drop(&f);
}

/* A small lamp over a black floor: E = L A cos^2 / d^2. */
static void irradiance_at_given_points_is_that_of_a_small_lamp(void **state)
{
    struct fixture f;
    struct err err = ERR_INIT;
    (void)state;
    setup(&f,
          "texture t rgb 0 0 0\nmaterial m lambert t\nquad floor -4 -4 0 8 0 0 0 8 0 m\n"
          "lamp l quad -0.05 -0.05 2 0 0.1 0 0.1 0 0 100 50 25\n",
          SHOOT, "points");
    const char *points = scratch_write("points.txt", "# two points\n0 0 0.02  0 0 3\n1 0.5 0.02  0 0 1\n");
    assert_ok(irradiance_points(&f.job, &f.world, points, "truth", &err), err);
    char path[600];
    snprintf(path, sizeof path, "%s/truth/irradiance-points.txt", f.out);
    char *text = scratch_read(path), *line = strchr(text, '\n');
    for (int i = 0; i < 2; i++) {
        double x, y, z, n[3], e[3];
        assert_non_null(line);
        assert_int_equal(
            sscanf(line, "%lf %lf %lf %lf %lf %lf %lf %lf %lf", &x, &y, &z, n, n + 1, n + 2, e, e + 1, e + 2), 9);
        const double d2 = x * x + y * y + 1.98 * 1.98;
        assert_near(n[2], 1, 1e-12);
        assert_near(e[0], 100 * 0.01 * 1.98 * 1.98 / (d2 * d2), 0.002);
        assert_near(e[2], e[0] / 4, 1e-6);
        line = strchr(line + 1, '\n');
    }
    free(text);
    static const char *const bad[][2] = {
        {"0 0 0 0 0 0\n", ":1: found \"0 0 0\", wanted a normal"},
        {"0 0 0 0 0\n", ":1: found the end of the line, wanted a normal"},
        {"0 0 x 0 0 1\n", ":1: found \"x\", wanted a point"},
        {"0 0 0 0 0 1 2\n", "wanted the end of the line"},
        {"# none\n", "has no points"},
    };
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        err = (struct err)ERR_INIT;
        assert_true(irradiance_points(&f.job, &f.world, scratch_write("points.txt", bad[i][0]), "truth", &err));
        assert_err(err, ST_DATA, bad[i][1]);
    }
    drop(&f);
}

/* A sun overhead lights the floor outdoors with E = L omega sin(elevation), wherever its azimuth is. */
static void a_moved_sun_lights_with_the_sine_of_its_elevation(void **state)
{
    struct err err = ERR_INIT;
    (void)state;
    struct world w = world_from("texture t rgb 0.5 0.5 0.5\nmaterial m lambert t\nquad floor -4 -4 0 8 0 0 0 8 0 m\n"
                                "sun 0 90 1 1000 1000 1000\n");
    const struct vec3 p = {0, 0, 0.01}, up = {0, 0, 1};
    const double overhead = mean_irradiance(&w, p, up, 4096, 1).r;
    assert_ok(path_world_move_sun(&w, 120, 30, &err), err);
    assert_near(mean_irradiance(&w, p, up, 4096, 1).r, 0.5 * overhead, 0.002 * overhead);
    assert_ok(path_world_move_sun(&w, 0, -30, &err), err);
    assert_true(mean_irradiance(&w, p, up, 4096, 1).r == 0);
    path_world_release(&w);
}

/* truth_samples changes the truth and no photo. */
static void truth_has_samples_of_its_own(void **state)
{
    struct fixture f, g;
    struct err err = ERR_INIT;
    struct simulate_params more = params;
    (void)state;
    more.truth_samples = 64;
    setup(&f, ROOM, SHOOT, "few");
    setup(&g, ROOM, SHOOT, "few/many");
    g.job.params = &more;
    assert_ok(photo_make(&f.job, &f.world, &f.shoot.photos[0], &err), err);
    assert_ok(photo_make(&g.job, &g.world, &g.shoot.photos[0], &err), err);
    assert_same_bytes(&f, "photos/a_e1.jpg", "many/photos/a_e1.jpg");
    assert_same_bytes(&f, "truth/depth/a.exr", "many/truth/depth/a.exr");
    g.world.shell = true;
    assert_ok(photo_make_truth(&g.job, &g.world, &g.shoot.photos[0], "truth/shell", &err), err);
    assert_same_bytes(&g, "truth/hdr/a.exr", "truth/shell/hdr/a.exr");
    struct exr_image a = picture(&f, "truth/hdr/a.exr"), b = picture(&g, "truth/hdr/a.exr");
    int differing = 0;
    for (int i = 0; i < 48 * 32; i++) differing += exr_find(&a, "G")->f[i] != exr_find(&b, "G")->f[i];
    assert_true(differing > 48 * 32 / 2);
    exr_image_release(&a);
    exr_image_release(&b);
    drop(&f);
    drop(&g);
}

static void truth_does_not_depend_on_threads(void **state)
{
    struct fixture f;
    struct err err = ERR_INIT;
    (void)state;
    setup(&f, ROOM "furniture on\nbox b 2.0 1.4 0.02 3.0 2.4 0.9 m\n", SHOOT, "threads");
    const char *points = scratch_write("points.txt", "1 1 0.02 0 0 1\n2 1 0.02 0 0 1\n2 3 0.02 0 0 1\n");
    for (int threads = 1; threads <= 2; threads++) {
        const char *to = threads == 1 ? "one" : "two";
        parallel_set_threads(threads);
        f.world.shell = true;
        assert_ok(photo_make_truth(&f.job, &f.world, &f.shoot.photos[1], to, &err), err);
        f.world.shell = false;
        assert_ok(irradiance_picture(&f.job, &f.world, NULL, &f.shoot.photos[1], to, &err), err);
        assert_ok(irradiance_points(&f.job, &f.world, points, to, &err), err);
    }
    parallel_set_threads(0);
    assert_same_bytes(&f, "one/hdr/w.exr", "two/hdr/w.exr");
    assert_same_bytes(&f, "one/irradiance/w.exr", "two/irradiance/w.exr");
    assert_same_bytes(&f, "one/irradiance-points.txt", "two/irradiance-points.txt");
    drop(&f);
}

/* Four times the samples take four times as long, by the estimate; each kind of picture has a line. */
static void the_estimate_names_each_kind_of_picture(void **state)
{
    struct fixture f;
    struct err err = ERR_INIT;
    struct simulate_params more = params;
    char *text = NULL;
    size_t size = 0;
    (void)state;
    more.truth_samples = 64;
    setup(&f, ROOM, SHOOT, "estimate");
    f.job.params = &more;
    FILE *to = open_memstream(&text, &size);
    assert_non_null(to);
    assert_ok(estimate_print(to, &f.job, &f.world, &err), err);
    fclose(to);
    const char *const lines[] = {
        "photos: 1 of them, 16 samples: about ", "radiance of photos: 1 of them, 64 samples: about ",
        "witnesses: 1 of them, 64 samples: about ", "pictures of the shell: 2 of them, 64 samples",
        "pictures of an edited scene: 2 of them, 64 samples"};
    double minutes[2] = {0, 0};
    for (int i = 0; i < 5; i++) {
        const char *at = strstr(text, lines[i]);
        if (!at) fail_msg("no line \"%s\" in\n%s", lines[i], text);
        if (i < 2) assert_int_equal(sscanf(at + strlen(lines[i]), "%lf", &minutes[i]), 1);
    }
    assert_null(strstr(text, "reference images"));
    assert_true(minutes[0] > 0 && minutes[1] > 3.6 * minutes[0] && minutes[1] < 4.4 * minutes[0]); /* two digits */
    free(text);
    drop(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_witness_at_a_photos_camera_sees_its_radiance),
        cmocka_unit_test(the_shell_of_a_room_without_furniture_is_the_room),
        cmocka_unit_test(the_shell_shows_surfaces_behind_furniture_in_its_shadow),
        cmocka_unit_test(irradiance_does_not_change_where_nothing_changes),
        cmocka_unit_test(irradiance_at_given_points_is_that_of_a_small_lamp),
        cmocka_unit_test(a_moved_sun_lights_with_the_sine_of_its_elevation),
        cmocka_unit_test(truth_has_samples_of_its_own),
        cmocka_unit_test(truth_does_not_depend_on_threads),
        cmocka_unit_test(the_estimate_names_each_kind_of_picture),
    };
    return cmocka_run_group_tests_name("simulate kinds of truth", tests, scratch_make, scratch_remove);
}
