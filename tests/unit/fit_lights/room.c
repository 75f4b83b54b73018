/* solve.c, lit_scene.c, observe_lights.c - from marks on noisy pictures of a room to its lamp: a spot in the ceiling of
 * a cube lights the floor. Its light on the floor is a sum over its area, by distance from its axis. */
#include "common/image/luminance.h"
#include "stages/fit_lights/mark_candidates.h"
#include "stages/fit_lights/solve.h"

#include <math.h>

#include "common/base/rng.h"
#include "common/capture/view_image.h"
#include "common/math/numbers.h"
#include "common/texture/view_ids.h"
#include "tests/unit/box_solids.h"

enum { SIDE = 480, RADII = 600, VIEWS = 3 };

static const double k_d[3] = {0.22, 0.2, 0.15}, true_s[3] = {260, 235, 195};
static const double lamp_radius = 0.15, true_beta = 20 * DEGREE, noise = 0.02;

static struct room {
    struct lit_model model;
    struct view views[VIEWS];
    struct lens lenses[VIEWS];
    double direct[RADII]; /* on the floor, from radiance 1, by distance from the axis in steps of 5 mm */
    struct annotation_list notes;
    struct lit_scene scene;
    struct observations seen;
    struct direct_light direct_light;
    struct solved_lights solved;
    double (*indirect)[3];
} room;
static int places;                              /* rays of a lamp without marks */
static const struct model_rays *furnished_rays; /* NULL: without furniture */
static bool lamp_is_off;

static double indirect_at(struct vec3 at) { return 1 + 0.15 * at.x - 0.1 * at.y; }

/* A number of the normal distribution [Box 1958]. */
static double gauss(const char *view, uint64_t index)
{
    const struct rng rng = rng_make(5, "fit_lights", view);
    return sqrt(-2 * log(1 - rng_uniform(&rng, index, 0))) * cos(2 * PI * rng_uniform(&rng, index, 1));
}

static void sum_direct(void)
{
    const int n = 120;
    for (int r = 0; r < RADII; r++) {
        double sum = 0;
        for (int i = 0; i < n * n; i++) {
            const double u = lamp_radius * ((2 * (i % n) + 1.0) / n - 1),
                         v = lamp_radius * ((2 * (i / n) + 1.0) / n - 1);
            const double d2 = (u - 0.005 * r) * (u - 0.005 * r) + v * v + 16, cosine = 4 / sqrt(d2);
            if (u * u + v * v <= lamp_radius * lamp_radius && cosine >= cos(true_beta))
                sum += cosine * cosine * cosine / d2; /* exponent 1 */
        }
        room.direct[r] = sum * 4 * lamp_radius * lamp_radius / n / n;
    }
}

/* The radiance of the floor; the ceiling and the walls are grey. */
static void paint(float rgb[3], struct vec3 at, const char *view, uint64_t pixel)
{
    const double r = hypot(at.x, at.y) / 0.005;
    const int k = clamp_int((int)r, 0, RADII - 2);
    const double d = at.z > -1.99 || lamp_is_off ? 0 : room.direct[k] + (r - k) * (room.direct[k + 1] - room.direct[k]);
    for (int c = 0; c < 3; c++)
        rgb[c] =
            (float)(k_d[c] * (indirect_at(at) + true_s[c] * d) * (1 + noise * gauss(view, 3 * pixel + (uint64_t)c)));
}

static void write_view(const struct view *v, float clipped)
{
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct image im = {0};
    struct photo_quality quality = {0};
    struct view_ids ids = {0};
    struct err err = ERR_INIT;
    char path[300];
    assert_ok(image_init(&im, SIDE, SIDE, 4, &err), err);
    assert_ok(photo_quality_init(&quality, SIDE, SIDE, &err), err);
    assert_ok(view_ids_init(&ids, SIDE, SIDE, &err), err);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const struct vec3 ray = vec3_sub(view_unproject(v, i % SIDE + 0.5, i / SIDE + 0.5, 1), v->center);
        struct ray_hit hit;
        float *rgba = im.data + 4 * (ptrdiff_t)i;
        assert_true(ray_scene_hit(&room.model.rays.rays, v->center, ray, &hit));
        paint(rgba, hit.point, v->name, (uint64_t)i);
        rgba[3] = 1;
        const double sigma = noise * luminance_of(rgba);
        quality.variance[i] = (float)(sigma * sigma);
        quality.marks[i] = (uint8_t)clipped;
        ids.id[i] = (uint32_t)solid_face_id(&room.model.rays.mesh, (int)hit.id);
        ids.z[i] = (float)hit.t;
        ids.jump[i] = VIEW_IDS_FAR;
    }
    snprintf(path, sizeof path, "%s.exr", v->name);
    assert_ok(view_image_write(&im, &quality, scratch_path(path), v, &prov, "exact", &err), err);
    snprintf(path, sizeof path, "ids/%s.exr", v->name);
    assert_ok(view_ids_write(&ids, v, scratch_path(path), &prov, &err), err);
    view_ids_release(&ids);
    photo_quality_release(&quality);
    image_release(&im);
}

/* Two photos of the floor and one of the ceiling. */
static int build(void **state)
{
    static const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};
    static char names[VIEWS][2] = {"a", "b", "c"};
    struct err err = ERR_INIT;
    if (scratch_make(state)) return -1;
    sum_direct();
    room.views[0] = view_at(vec3_make(0.3, -0.2, 1.5), PI, 0, SIDE, SIDE, 300);
    room.views[1] = view_at(vec3_make(-0.5, 0.4, 1.7), PI, 0.1, SIDE, SIDE, 300);
    room.views[2] = view_at(vec3_make(0.2, 0.1, -1.5), 0, 0, SIDE, SIDE, 300);
    room.model.rays.mesh = make_boxes(boxes, 2);
    assert_ok(model_rays_build(&room.model.rays, MODEL_WITHOUT_GLASS, &err), err);
    room.model.in.axes = (struct model_axes){.rotation = {1, 0, 0, 0}, .scale = 1};
    for (int i = 0; i < VIEWS; i++) {
        struct view *v = &room.views[i];
        v->name = names[i];
        room.lenses[i] =
            (struct lens){names[i], names[i], {CAMERA_PINHOLE, SIDE, SIDE, {v->fx, v->fy, v->cx, v->cy}}, {1, 0, 0, 0}};
        write_view(v, 0);
    }
    room.model.in.set = (struct camera_set){.views = room.views, .view_count = VIEWS};
    room.model.in.lenses = (struct lens_list){room.lenses, VIEWS};
    return 0;
}

static void release(void)
{
    solve_release(&room.solved);
    direct_light_release(&room.direct_light);
    observe_release(&room.seen);
    lit_scene_release(&room.scene);
    annotation_list_release(&room.notes);
    free(room.indirect);
    room.indirect = NULL;
}

static int clean(void **state)
{
    release();
    model_rays_release(&room.model.rays);
    return scratch_remove(state);
}

/* "X Y" of a point in a view. */
static const char *pixel(int view, double x, double y, double z)
{
    static char texts[16][64];
    static int next;
    double u = 0, v = 0;
    assert_true(view_project(&room.views[view], vec3_make(x, y, z), &u, &v) > 0);
    snprintf(texts[++next % 16], sizeof *texts, "%.3f %.3f", u, v);
    return texts[next % 16];
}

static enum status solve(const char *lamp, const char *points, struct err *err)
{
    char text[4096];
    static const struct fit_lights_params params = FIT_LIGHTS_PARAMS_DEFAULT;
    struct provenance prov = {0};
    release();
    snprintf(text, sizeof text, "remodel-lamps 1\ndisk spot in c %s rim %s %s\n%s", pixel(2, 0, 0, 2),
             pixel(2, lamp_radius, 0, 2), lamp, points);
    if (!annotation_list_read(&room.notes, scratch_write("lights.txt", text), NULL, err))
        lit_scene_resolve(&room.scene, &room.notes, &room.model, 5, places, err);
    if (!err->status)
        observe(&room.seen, &room.scene, &room.notes, &room.model, furnished_rays ? furnished_rays : &room.model.rays,
                scratch, scratch_path("ids"), &params, &prov, err);
    if (!err->status) direct_light_make(&room.direct_light, &room.scene, &room.model.rays, err);
    room.indirect = calloc((size_t)room.scene.point_count + 1, sizeof *room.indirect);
    for (int i = 0; i < room.scene.point_count; i++)
        for (int c = 0; c < 3; c++) room.indirect[i][c] = indirect_at(room.scene.points[i].at);
    const struct solve_inputs in = {
        &room.scene, &room.notes, &room.seen, &room.direct_light, (const double(*)[3])room.indirect, &room.model.rays,
        &params,     NULL,        false};
    if (!err->status) solve_lights(&room.solved, &in, err);
    provenance_release(&prov);
    return err->status;
}

/* Marks on the floor: points under the lamp, points aside, lines across the edge at 1.456 m. */
static const char *marks(void)
{
    static char text[2048];
    int n = 0;
    for (int i = 0; i < 12; i++) {
        const double x = cos(2.4 * i), y = sin(2.4 * i), r = 0.1 + 0.1 * i;
        n += snprintf(text + n, sizeof text - (size_t)n, "lit spot in a %s\n", pixel(0, r * x, r * y, -2));
        n += snprintf(text + n, sizeof text - (size_t)n, "unlit spot in b %s\n", pixel(1, 1.75 * x, 1.75 * y, -2));
    }
    for (int i = 0; i < 3; i++)
        n += snprintf(text + n, sizeof text - (size_t)n, "line spot in a %s %s\n", pixel(0, cos(i), sin(i), -2),
                      pixel(0, 1.8 * cos(i), 1.8 * sin(i), -2));
    return text;
}

static void noisy_photos_give_radiance_within_three_percent_and_beta_within_half_a_degree(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    assert_ok(solve("beta fit exponent 1", marks(), &err), err);
    const struct lamp *l = &room.scene.lights.lamps[0];
    const double s[3] = {l->radiance.r, l->radiance.g, l->radiance.b};
    assert_true(fabs(l->radius - lamp_radius) < 1e-4 && vec3_length(vec3_sub(l->centre, vec3_make(0, 0, 2))) < 1e-4);
    if (fabs(l->beta - true_beta) > 0.5 * DEGREE) fail_msg("beta is %.3f degrees", l->beta / DEGREE);
    for (int c = 0; c < 3; c++) {
        if (fabs(s[c] / true_s[c] - 1) > 0.03) fail_msg("colour %d: %.4g, wanted %.4g", c, s[c], true_s[c]);
        assert_true(fabs(s[c] - true_s[c]) < 2 * room.solved.lamps[0].radiance_error[c]);
        assert_true(fabs(room.solved.materials[0].k_d[c] / k_d[c] - 1) < 0.02);
    }
    assert_true(room.solved.lamps[0].source == LAMP_FITTED && !l->bound);
    /* the ceiling's picture is grey where the lamp is */
    assert_true(room.solved.lamps[0].disagrees);
}

/* A beam's or a ceiling's face may come out a little below the lamp. */
static void a_lamp_a_little_behind_a_surface_is_not_hidden(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    assert_ok(solve("beta fit exponent 1", marks(), &err), err);
    struct lamp *l = &room.scene.lights.lamps[0];
    const double reach = LAMP_REACH * model_rays_size(&room.model.rays);
    for (int step = 0; step < 2; step++) {
        l->centre.z = 2 + (step ? 1.1 : 0.9) * reach;
        direct_light_release(&room.direct_light);
        assert_ok(direct_light_make(&room.direct_light, &room.scene, &room.model.rays, &err), err);
        for (int i = 0; i < room.scene.point_count; i++)
            assert_true(room.direct_light.seen[i] == (step ? 0 : UINT64_MAX));
    }
}

static void marks_that_no_photo_measures_do_not_stop_the_others(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    char text[4096];
    write_view(&room.views[0], PHOTO_BRIGHT); /* the lit points of the first photo */
    snprintf(text, sizeof text, "lit spot in a 1 1\nlit spot in b 900 900\nlit spot in none 1 1\n%s", marks());
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    assert_true(room.solved.lamps[0].source == LAMP_FITTED);
    assert_true(room.solved.lamps[0].low[1] < true_s[1] && true_s[1] < room.solved.lamps[0].high[1]);
    write_view(&room.views[1], PHOTO_BRIGHT);
    assert_ok(solve("beta 20 exponent 1", "lit spot in a 240 240\nunlit spot in a 20 20\n", &err), err);
    assert_true(room.solved.lamps[0].source == LAMP_UNKNOWN || room.solved.lamps[0].source == LAMP_MEASURED);
    write_view(&room.views[0], 0);
    write_view(&room.views[1], 0);
}

static void a_lamp_that_saturates_is_a_lower_bound(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    write_view(&room.views[2], PHOTO_BRIGHT);
    assert_ok(solve("beta 90", "", &err), err);
    assert_true(room.scene.lights.lamps[0].bound && room.solved.lamps[0].source == LAMP_BOUND);
    write_view(&room.views[2], 0);
    assert_ok(solve("beta 90", "", &err), err);
    assert_true(!room.scene.lights.lamps[0].bound && room.solved.lamps[0].source == LAMP_MEASURED);
    assert_true(fabs(room.scene.lights.lamps[0].radiance.g / k_d[1] - 1) < 0.05); /* its picture is grey ceiling here */
}

/* It has no marks: the floor and the walls tell. */
static void a_saturated_lamp_is_told_by_the_light_that_it_casts(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    write_view(&room.views[2], PHOTO_BRIGHT);
    places = 160;
    assert_ok(solve("beta 20 exponent 1", "", &err), err);
    const struct lamp_result *r = &room.solved.lamps[0];
    assert_true(r->source == LAMP_FITTED && !room.scene.lights.lamps[0].bound);
    for (int c = 0; c < 3; c++) {
        const double s[3] = {room.scene.lights.lamps[0].radiance.r, room.scene.lights.lamps[0].radiance.g,
                             room.scene.lights.lamps[0].radiance.b};
        if (!(r->low[c] < true_s[c] && true_s[c] < r->high[c]))
            fail_msg("colour %d: %.4g to %.4g, wanted %.4g", c, r->low[c], r->high[c], true_s[c]);
        if (!(fabs(s[c] / true_s[c] - 1) < 0.1)) fail_msg("colour %d: %.4g, wanted %.4g", c, s[c], true_s[c]);
    }
    places = 0;
    write_view(&room.views[2], 0);
}

/* Two marks near the lamp's axis tell little; the rest of the floor that they are on tells the most. */
static void a_marked_face_tells_beside_its_marks(void **state)
{
    char text[500];
    double spans[2];
    struct err err = ERR_INIT;
    (void)state;
    snprintf(text, sizeof text, "lit spot in a %s of floor\nlit spot in a %s of floor\n", pixel(0, 0.1, 0, -2),
             pixel(0, -0.4, 0.3, -2));
    write_view(&room.views[2], PHOTO_BRIGHT);
    for (int with = 0; with < 2; with++) {
        places = with ? 400 : 0;
        assert_ok(solve("beta 20 exponent 1", text, &err), err);
        const struct lamp_result *r = &room.solved.lamps[0];
        spans[with] = r->high[1] / r->low[1];
        assert_int_equal(room.solved.material_count, 1);
        assert_true(r->low[1] < true_s[1] && true_s[1] < r->high[1]);
    }
    if (fabs(room.scene.lights.lamps[0].radiance.g / true_s[1] - 1) > 0.05)
        fail_msg("radiance %.4g, wanted %.4g", room.scene.lights.lamps[0].radiance.g, true_s[1]);
    if (!(spans[1] < 0.7 * spans[0])) fail_msg("intervals span %.3g and %.3g", spans[0], spans[1]);
    assert_true(room.scene.point_count > 40);
    for (int k = 0; k < room.scene.point_count; k++) assert_true(fabs(room.scene.points[k].at.z + 2) < 1e-4);
    places = 0;
    write_view(&room.views[2], 0);
}

static const struct fit_mark *mark_of_line(int line)
{
    for (int k = 0; k < room.solved.mark_count; k++)
        if (room.notes.items[room.scene.marks[k].note].line == line) return &room.solved.marks[k];
    return NULL;
}

/* The wall is grey, the floor under the lamp is not. */
static void marks_on_two_materials_leave_the_lamp_as_bright(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    char text[4096];
    snprintf(text, sizeof text, "lit spot in a %s\n%s", pixel(0, 0, 0, -2), marks());
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    for (int line = 3; line < 28; line++) assert_true(fabs(mark_of_line(line)->off) < 0.1);
    snprintf(text, sizeof text, "%sunlit spot in a %s of wall\n", marks(), pixel(0, 2, 0, -1));
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    assert_int_equal(room.solved.material_count, 2 + 3); /* each of the three lines might be on either */
    assert_true(fabs(room.scene.lights.lamps[0].radiance.g / true_s[1] - 1) < 0.05);
}

static void a_line_over_a_corner_does_not_count(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    char text[4096];
    snprintf(text, sizeof text, "line spot in a %s %s\n%s", pixel(0, 1.5, 0, -2), pixel(0, 2, 0, -1), marks());
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    assert_true(fabs(room.scene.lights.lamps[0].beta - true_beta) < 0.5 * DEGREE);
}

static void lines_without_an_edge_leave_the_cone_to_the_marks(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    char text[4096];
    snprintf(text, sizeof text, "line spot in a %s %s\nlit spot in a %s\nunlit spot in a %s\n", pixel(0, -1, 0, -2),
             pixel(0, 1, 0, -2), pixel(0, 1.2, 0, -2), pixel(0, 1.7, 0, -2));
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    const double between = 0.5 * (atan(1.2 / 4) + atan(1.7 / 4));
    assert_true(fabs(room.scene.lights.lamps[0].beta - between) < 0.1 * DEGREE);
    assert_true(room.solved.lamps[0].beta_error > 0);
}

/* The statements that are proposed for the lamp, marked without any. */
static const char *candidates(void)
{
    static const struct fit_lights_params params = FIT_LIGHTS_PARAMS_DEFAULT;
    static char text[4096];
    struct provenance prov = {0};
    struct textfile t = {0};
    struct err err = ERR_INIT;
    int n = 0;
    places = 160;
    assert_ok(solve("beta fit exponent 1", "", &err), err);
    places = 0;
    assert_ok(mark_candidates_write(&room.scene, &room.notes, &room.model, &room.model.rays, scratch,
                                    scratch_path("ids"), &params, scratch_path("candidates.txt"), &prov, &err),
              err);
    provenance_release(&prov);
    text[0] = 0;
    assert_ok(product_open(&t, NULL, PRODUCT_MARK_CANDIDATES, scratch_path("candidates.txt"), NULL, &err), err);
    while (textfile_next(&t)) {
        char *rest;
        assert_ok(textfile_rest(&t, "a mark", &rest, &err), err);
        n += snprintf(text + n, sizeof text - (size_t)n, "%s\n", rest);
    }
    textfile_release(&t);
    return text;
}

static void proposed_marks_lie_across_the_edge_and_beside_it(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    int found[NOTE_KINDS] = {0};
    assert_ok(solve("beta fit exponent 1", candidates(), &err), err);
    for (int i = 0; i < room.scene.point_count; i++) {
        const struct lit_point *p = &room.scene.points[i];
        const double angle = atan(hypot(p->at.x, p->at.y) / 4) / DEGREE;
        found[p->kind]++;
        assert_true(p->at.z < -1.99);
        if (p->kind == NOTE_LIT) assert_true(angle < 19);
        if (p->kind == NOTE_UNLIT) assert_true(angle > 21);
        if (p->kind == NOTE_LINE && p->along == 0) assert_true(angle < 19);
        if (p->kind == NOTE_LINE && p->along == 1) assert_true(angle > 21);
    }
    assert_true(found[NOTE_LIT] >= 50 && found[NOTE_UNLIT] >= 50 && found[NOTE_LINE] >= 3 * 161);
    const struct lamp *l = &room.scene.lights.lamps[0];
    if (fabs(l->beta - true_beta) > 0.5 * DEGREE) fail_msg("beta is %.3f degrees", l->beta / DEGREE);
    if (fabs(l->radiance.g / true_s[1] - 1) > 0.05) fail_msg("radiance is %.4g", l->radiance.g);
}

static void photos_without_an_edge_give_no_marks(void **state)
{
    (void)state;
    lamp_is_off = true;
    for (int i = 0; i < VIEWS; i++) write_view(&room.views[i], 0);
    assert_string_equal(candidates(), "");
    lamp_is_off = false;
    for (int i = 0; i < VIEWS; i++) write_view(&room.views[i], 0);
}

static void a_lamp_that_no_photo_can_place_is_left_out(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    char text[4096];
    snprintf(text, sizeof text, "disk other in none 1 1 rim 2 2\ndisk flat in c 9 9 rim 9 9\nlit other in a 9 9\n%s",
             marks());
    assert_ok(solve("beta fit exponent 1", text, &err), err);
    assert_int_equal(room.scene.lights.lamp_count, 1);
    assert_true(fabs(room.scene.lights.lamps[0].radiance.g / true_s[1] - 1) < 0.05);
}

static void a_lamp_of_which_nothing_is_known_stays_as_photographed(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    assert_ok(solve("beta 1", "", &err), err);
    assert_true(room.solved.lamps[0].source == LAMP_UNKNOWN && room.scene.lights.lamps[0].bound);
    assert_true(room.scene.lights.lamps[0].radiance.g == 0);
}

/* Of points on the floor, those with x in this range. */
static int observations_of(double from, double to)
{
    int count = 0;
    for (int i = 0; i < room.seen.count; i++) {
        const struct vec3 at = room.scene.points[room.seen.items[i].point].at;
        count += at.z < -1.99 && at.x > from && at.x < to;
    }
    return count;
}

/* A board over x > 0.3, half a metre above the floor. What the pictures show behind it does not count as the floor,
 * but at a place that a person marked. */
static void furniture_hides_places_from_the_photos(void **state)
{
    static const struct vec3 board[2][3] = {{{0.3, -2, -1.5}, {2, -2, -1.5}, {2, 2, -1.5}},
                                            {{0.3, -2, -1.5}, {2, 2, -1.5}, {0.3, 2, -1.5}}};
    const struct model_extra furniture = {board, 2};
    struct model_rays furnished = {0};
    struct err err = ERR_INIT;
    char text[200];
    (void)state;
    assert_ok(solid_mesh_write(&room.model.rays.mesh, scratch_path("model.txt"), NULL, &err), err);
    assert_ok(model_rays_read_with(&furnished, scratch_path("model.txt"), MODEL_WITHOUT_GLASS, &furniture, NULL, &err),
              err);
    places = 160;
    assert_ok(solve("beta 20 exponent 1", "", &err), err);
    const int open = observations_of(-2, 0.2);
    assert_true(open > 20 && observations_of(0.6, 2) > 10);
    furnished_rays = &furnished;
    assert_ok(solve("beta 20 exponent 1", "", &err), err);
    assert_int_equal(observations_of(-2, 0.2), open);
    assert_int_equal(observations_of(0.6, 2), 0);
    places = 0;
    snprintf(text, sizeof text, "lit spot in a %s of floor\n", pixel(0, 0.9, 0, -2));
    assert_ok(solve("beta 20 exponent 1", text, &err), err);
    assert_int_equal(observations_of(0.8, 1), 1);
    furnished_rays = NULL;
    assert_ok(solve("beta 20 exponent 1", text, &err), err);
    assert_int_equal(observations_of(0.8, 1), 2);
    model_rays_release(&furnished);
}

/* Two views show the lamp saturated, one the wardrobe before it: the lamp is at least as bright as the two say. */
static void a_view_in_which_a_lamp_is_hidden_does_not_measure_it(void **state)
{
    static struct lamp_sight sights[] = {
        {0, 0, 0, {4, 4, 4}, true}, {0, 1, 0, {3, 3, 3}, true}, {0, 2, 0, {0.3, 0.2, 0.1}, false}};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(solve("beta 90", "", &err), err);
    const struct observations seen = {.sights = sights, .sight_count = 3};
    struct solve_inputs in = {&room.scene,
                              &room.notes,
                              &seen,
                              &room.direct_light,
                              (const double(*)[3])room.indirect,
                              &room.model.rays,
                              &(struct fit_lights_params)FIT_LIGHTS_PARAMS_DEFAULT,
                              NULL,
                              false};
    for (int step = 0; step < 2; step++) {
        struct solved_lights found = {0};
        assert_ok(solve_lights(&found, &in, &err), err);
        assert_true(found.lamps[0].source == (step ? LAMP_MEASURED : LAMP_BOUND));
        assert_true(fabs(room.scene.lights.lamps[0].radiance.r - (step ? 3.5 : 4)) < 1e-6);
        solve_release(&found);
        sights[2].radiance[0] = 3.5; /* brighter than half: it shows the lamp */
    }
}

/* A board half way to the floor, over x > 0. A point of the floor sees the whole lamp if it is at x < -radius, and none
 * of it at x > radius. */
static void furniture_hides_a_lamp(void **state)
{
    static const struct vec3 board[2][3] = {{{0, -2, 0}, {2, -2, 0}, {2, 2, 0}}, {{0, -2, 0}, {2, 2, 0}, {0, 2, 0}}};
    const struct model_extra furniture = {board, 2};
    struct model_rays furnished = {0};
    struct err err = ERR_INIT;
    int seen = 0, hidden = 0;
    (void)state;
    assert_ok(solve("beta fit exponent 1", marks(), &err), err);
    assert_ok(solid_mesh_write(&room.model.rays.mesh, scratch_path("model.txt"), NULL, &err), err);
    assert_ok(model_rays_read_with(&furnished, scratch_path("model.txt"), MODEL_WITHOUT_GLASS, &furniture, NULL, &err),
              err);
    direct_light_release(&room.direct_light);
    assert_ok(direct_light_make(&room.direct_light, &room.scene, &furnished, &err), err);
    for (int i = 0; i < room.scene.point_count; i++) {
        const double x = room.scene.points[i].at.x;
        if (x > lamp_radius) assert_true(room.direct_light.seen[i] == 0);
        if (x < -lamp_radius) assert_true(room.direct_light.seen[i] == UINT64_MAX);
        hidden += x > lamp_radius;
        seen += x < -lamp_radius;
    }
    assert_true(seen > 20 && hidden > 20);
    model_rays_release(&furnished);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(noisy_photos_give_radiance_within_three_percent_and_beta_within_half_a_degree),
        cmocka_unit_test(a_lamp_a_little_behind_a_surface_is_not_hidden),
        cmocka_unit_test(marks_that_no_photo_measures_do_not_stop_the_others),
        cmocka_unit_test(a_lamp_that_saturates_is_a_lower_bound),
        cmocka_unit_test(a_saturated_lamp_is_told_by_the_light_that_it_casts),
        cmocka_unit_test(marks_on_two_materials_leave_the_lamp_as_bright),
        cmocka_unit_test(a_line_over_a_corner_does_not_count),
        cmocka_unit_test(lines_without_an_edge_leave_the_cone_to_the_marks),
        cmocka_unit_test(proposed_marks_lie_across_the_edge_and_beside_it),
        cmocka_unit_test(photos_without_an_edge_give_no_marks),
        cmocka_unit_test(a_lamp_that_no_photo_can_place_is_left_out),
        cmocka_unit_test(furniture_hides_a_lamp),
        cmocka_unit_test(furniture_hides_places_from_the_photos),
        cmocka_unit_test(a_view_in_which_a_lamp_is_hidden_does_not_measure_it),
        cmocka_unit_test(a_marked_face_tells_beside_its_marks),
        cmocka_unit_test(a_lamp_of_which_nothing_is_known_stays_as_photographed),
    };
    return cmocka_run_group_tests(tests, build, clean);
}
