/* things.c - a table that stands in a room: it is found, filled below where no view looks through, and described; and
 * a rug whose outline a user drew. */
#include "stages/find_things/things.h"

#include "common/capture/view_image.h"
#include "common/image/image.h"
#include "common/layers/layered_depth.h"
#include "common/model/thing_mask.h"
#include "common/model/thing_mesh.h"
#include "common/product/product.h"
#include "common/texture/view_ids.h"
#include "tests/unit/box_solids.h"

enum { W = 120, H = 90, VIEWS = 4, ROOM_FACES = 12 };

/* Its legs are too thin to be seen. */
static const struct box scene[] = {{"walls", "in", {-2, -2, 0}, {2, 2, 2.5}, true},
                                   {"walls", "slab", {-2, -2, -0.15}, {2, 2, -0.01}, false},
                                   {"walls", "table", {-0.5, -0.4, 0.5}, {0.5, 0.4, 0.6}, false}};
static const struct model_axes same_frame = {.rotation = {1, 0, 0, 0}, .scale = 1};
static const struct provenance no_inputs = {.stage = "test", .version = "1"};
static const float wood[3] = {0.5f, 0.25f, 0.125f}, plaster[3] = {0.75f, 0.75f, 0.875f};

static struct view looking_from(double x, double y)
{
    struct view v = {.width = W, .height = H, .fx = 80, .fy = 80, .cx = W / 2.0, .cy = H / 2.0};
    v.center = vec3_make(x, y, 1.6);
    const struct vec3 ahead = vec3_normalize(vec3_sub(vec3_make(0, 0, 0.4), v.center)),
                      right = vec3_normalize(vec3_cross(vec3_make(0, 0, -1), ahead)), down = vec3_cross(ahead, right);
    v.cam_from_world =
        (struct mat3){{{right.x, right.y, right.z}, {down.x, down.y, down.z}, {ahead.x, ahead.y, ahead.z}}};
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, v.center), -1);
    return v;
}

static struct ray_hit look(const struct model_rays *m, const struct view *v, int i)
{
    struct ray_hit hit = {.t = 0};
    const struct vec3 at = view_unproject(v, i % W + 0.5, i / W + 0.5, 1);
    assert_true(ray_scene_hit(&m->rays, v->center, vec3_sub(at, v->center), &hit));
    return hit;
}

static const char *file_of(const char *folder, const struct view *v)
{
    char name[64];
    snprintf(name, sizeof name, "%s/%s.exr", folder, v->name);
    return scratch_path(name);
}

static void write_depth(const struct view *v, const struct model_rays *whole)
{
    struct layered_depth d = {0};
    struct err err = ERR_INIT;
    assert_ok(layered_depth_init(&d, W, H, &err), err);
    d.segment_count = whole->mesh.face_count;
    d.segments = calloc((size_t)d.segment_count, sizeof *d.segments);
    assert_non_null(d.segments);
    for (int i = 0; i < d.segment_count; i++) {
        d.segments[i] = (struct depth_segment){.id = (uint32_t)i + 1, .sigma = 0.004, .confidence = 1};
        model_face_inverse_depth(d.segments[i].plane, &whole->mesh.faces[i], v);
    }
    for (int i = 0; i < W * H; i++) {
        const struct ray_hit h = look(whole, v, i);
        d.interior.id[i] = h.id + 1;
        d.interior.z[i] = (float)h.t;
        d.interior.rgba[4 * i + 3] = 1;
        d.segments[h.id].pixels++;
    }
    assert_ok(layered_depth_write(&d, v, file_of("depth", v), &no_inputs, &err), err);
    layered_depth_release(&d);
}

static void write_view(const struct view *v, const struct model_rays *room, const struct model_rays *whole)
{
    struct view_ids ids = {0};
    struct image photo = {0};
    struct err err = ERR_INIT;
    assert_ok(view_ids_init(&ids, W, H, &err), err);
    assert_ok(image_init(&photo, W, H, 4, &err), err);
    for (int i = 0; i < W * H; i++) {
        const struct ray_hit h = look(room, v, i);
        const bool is_table = look(whole, v, i).id >= ROOM_FACES;
        ids.id[i] = h.id + 1;
        ids.z[i] = (float)h.t;
        ids.jump[i] = VIEW_IDS_FAR;
        ids.clutter[i] = is_table;
        memcpy(photo.data + 4 * i, is_table ? wood : plaster, sizeof wood);
        photo.data[4 * i + 3] = 1;
    }
    assert_ok(view_ids_write(&ids, v, file_of("ids", v), &no_inputs, &err), err);
    assert_ok(view_image_write(&photo, NULL, file_of("views", v), v, &no_inputs, "relative", &err), err);
    view_ids_release(&ids);
    image_release(&photo);
}

enum { TABLE = 1, RUG, CORNERS = 4 };
static const double rug[CORNERS][2] = {{0.8, -0.6}, {1.5, -0.6}, {1.5, 0.6}, {0.8, 0.6}};

/* The corners, seen from below the ceiling. */
static struct thing_marks rug_marks(void)
{
    static char name[] = "rug", view[] = "a", *names[] = {name};
    static int lines[] = {2};
    static bool flat[] = {true};
    static struct thing_mark corners[CORNERS];
    for (int k = 0; k < CORNERS; k++)
        corners[k] = (struct thing_mark){
            0, 2, view, 0, 0, {1.2, 0, 2}, vec3_sub(vec3_make(rug[k][0], rug[k][1], 0), vec3_make(1.2, 0, 2))};
    return (struct thing_marks){names, lines, corners, flat, 1, CORNERS};
}

static struct thing_list list;
static struct thing_volume volume;
static struct thing_mask mask;                         /* of view a, which sees both */
static struct view seeing = {.width = W, .height = H}; /* that view */

/* Four views from above, one from each side. */
static int find(void **state)
{
    static const char *const names[VIEWS] = {"a", "b", "c", "d"}, *const folders[] = {"views", "depth", "ids"};
    struct view views[VIEWS] = {looking_from(0, -1.5), looking_from(0, 1.5), looking_from(-1.6, 0),
                                looking_from(1.6, 0)};
    const struct scene_inputs in = {.set = {.views = views, .view_count = VIEWS}, .axes = same_frame};
    const struct thing_marks marks = rug_marks();
    struct things_params params = THINGS_PARAMS_DEFAULT;
    struct model_rays room = make_rays(scene, 2), whole = make_rays(scene, 3);
    struct provenance prov = {.stage = "find_things", .version = "1"};
    struct err err = ERR_INIT;
    if (scratch_make(state)) return -1;
    for (int k = 0; k < 3; k++) mkdir(scratch_path(folders[k]), 0777);
    for (int i = 0; i < VIEWS; i++) {
        views[i].name = names[i];
        write_depth(&views[i], &whole);
        write_view(&views[i], &room, &whole);
    }
    params.voxel = 0.02;
    const struct things_job job = {.views = scratch_path("views"),
                                   .depth = scratch_path("depth"),
                                   .ids = scratch_path("ids"),
                                   .out = scratch_path("things"),
                                   .in = &in,
                                   .model = &room,
                                   .marks = &marks,
                                   .params = &params,
                                   .prov = &prov};
    assert_ok(things_find(&job, &err), err);
    assert_ok(thing_list_read(&list, scratch_path("things/things.txt"), NULL, &err), err);
    assert_ok(thing_volume_read(&volume, scratch_path("things/volume.exr"), (uint32_t)list.count, NULL, &err), err);
    seeing = views[0];
    assert_ok(thing_mask_read(&mask, &seeing, scratch_path("things/masks/a.exr"), (uint32_t)list.count, NULL, &err),
              err);
    provenance_release(&prov);
    model_rays_release(&room);
    model_rays_release(&whole);
    return 0;
}

static int release(void **state)
{
    thing_list_release(&list);
    thing_volume_release(&volume);
    thing_mask_release(&mask);
    return scratch_remove(state);
}

static float distance_at(double x, double y, double z)
{
    const int64_t at = thing_voxel_at(&volume.grid, vec3_make(x, y, z));
    assert_true(at >= 0);
    return volume.distance[at];
}

static void the_table_stands_on_the_floor(void **state)
{
    (void)state;
    assert_int_equal(list.count, 2);
    const struct thing *t = &list.things[0];
    assert_int_equal(t->support, THING_ON_FLOOR);
    assert_int_equal(t->views, VIEWS);
    assert_float_equal(t->low.x, -0.5, 0.15);
    assert_float_equal(t->high.y, 0.4, 0.15);
    assert_float_equal(t->high.z, 0.6, 0.15);
}

/* Pixels at its outlines are of the table, too, as segments are. */
static void its_radiance_is_that_of_its_pixels(void **state)
{
    (void)state;
    for (int c = 0; c < 3; c++) assert_float_equal(list.things[0].radiance[c], wood[c], 0.02);
}

static void what_no_view_looks_through_below_it_is_solid(void **state)
{
    (void)state;
    for (double z = 0.12; z < 0.45; z += 0.05) {
        assert_int_equal(thing_volume_at(&volume, vec3_make(0.01, 0.01, z)), 1);
        assert_float_equal(distance_at(0.01, 0.01, z), -1, 0);
    }
    assert_true(distance_at(0.01, 0.01, 0.66) > 0); /* above its top */
}

/* A view sees the floor below the table's edge. The place is the table's, but not solid. */
static void what_a_view_looks_through_below_it_is_not_solid(void **state)
{
    (void)state;
    for (int k = 0; k < 4; k++) {
        const double x = k == 2 ? -0.43 : k == 3 ? 0.43 : 0.01, y = k == 0 ? -0.33 : k == 1 ? 0.33 : 0.01;
        assert_int_equal(thing_volume_at(&volume, vec3_make(x, y, 0.2)), 1);
        assert_true(distance_at(x, y, 0.2) > 0 && distance_at(x, y, 0.2) <= 1);
    }
}

/* The area of its surface between two heights that looks up. */
static double area_that_looks_up(const struct thing_mesh *m, double low, double high)
{
    double area = 0;
    for (int i = 0; i < m->triangle_count; i++) {
        const struct vec3 a = m->vertices[m->triangles[i][0]], b = m->vertices[m->triangles[i][1]],
                          c = m->vertices[m->triangles[i][2]];
        const struct vec3 normal = vec3_cross(vec3_sub(b, a), vec3_sub(c, a));
        if (a.z > low && a.z < high && normal.z > 0.7 * vec3_length(normal)) area += vec3_length(normal) / 2;
    }
    return area;
}

/* It would send out the light of the table's top. */
static void the_floor_that_views_show_below_it_is_not_its_surface(void **state)
{
    struct thing_mesh m;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(thing_mesh_make(&m, &volume, 1, &err), err);
    const double top = area_that_looks_up(&m, 0.5, 0.7), floor = area_that_looks_up(&m, -0.1, 0.1);
    if (!(fabs(top - 0.8) < 0.1 && floor < 1e-3)) fail_msg("%.4f m2 of the top look up, %.4f at the floor", top, floor);
    thing_mesh_release(&m);
}

static void beside_it_and_above_it_there_is_nothing(void **state)
{
    (void)state;
    static const double places[][3] = {{0, -0.9, 0.2}, {1, 0, 0.2}, {0, 0, 1.2}, {1.5, 1.5, 0.1}, {0, 0.9, 0.55}};
    for (size_t k = 0; k < sizeof places / sizeof *places; k++) {
        const double *p = places[k];
        assert_int_equal(thing_volume_at(&volume, vec3_make(p[0], p[1], p[2])), 0);
        assert_true(distance_at(p[0], p[1], p[2]) > 0); /* free, or no view shows it */
    }
}

static size_t pixel_of(double x, double y, double z)
{
    double u, v;
    assert_true(view_project(&seeing, vec3_make(x, y, z), &u, &v) > 0);
    assert_true(u >= 0 && v >= 0 && u < W && v < H);
    return (size_t)v * W + (size_t)u;
}

static void a_rug_lies_where_its_outline_was_drawn(void **state)
{
    (void)state;
    const struct thing *t = &list.things[RUG - 1];
    assert_string_equal(t->name, "rug");
    assert_int_equal(t->support, THING_ON_FLOOR);
    assert_float_equal(t->low.x, 0.8, 1e-9);
    assert_float_equal(t->high.y, 0.6, 1e-9);
    assert_true(t->high.z > 0 && t->high.z < 0.06);
    assert_true(t->views > 0);
    assert_int_equal(thing_volume_at(&volume, vec3_make(1.2, 0.3, 0.01)), RUG);
    assert_int_equal(thing_volume_at(&volume, vec3_make(1.2, 0.3, 0.16)), 0);
    assert_int_equal(thing_volume_at(&volume, vec3_make(1.2, 0.7, 0.01)), 0);
    assert_true(distance_at(1.2, 0.3, 0.03) > 0 && distance_at(1.2, 0.3, 0.03) < 0.2f);
}

static void a_view_shows_the_rug_where_nothing_is_before_it(void **state)
{
    (void)state;
    const size_t free = pixel_of(0.9, -0.3, 0), beside = pixel_of(0.6, -0.7, 0), table = pixel_of(0, 0, 0.6);
    assert_int_equal(mask.shows[free], RUG);
    assert_int_equal(mask.meets[free], RUG);
    assert_int_equal(mask.shows[beside], 0);
    assert_int_equal(mask.shows[table], TABLE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_table_stands_on_the_floor),
        cmocka_unit_test(its_radiance_is_that_of_its_pixels),
        cmocka_unit_test(what_no_view_looks_through_below_it_is_solid),
        cmocka_unit_test(what_a_view_looks_through_below_it_is_not_solid),
        cmocka_unit_test(the_floor_that_views_show_below_it_is_not_its_surface),
        cmocka_unit_test(beside_it_and_above_it_there_is_nothing),
        cmocka_unit_test(a_rug_lies_where_its_outline_was_drawn),
        cmocka_unit_test(a_view_shows_the_rug_where_nothing_is_before_it),
    };
    return cmocka_run_group_tests_name("things", tests, find, release);
}
