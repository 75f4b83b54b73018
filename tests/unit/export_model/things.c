/* things.c - exported furniture: what an edit clears, moves and copies, by name and place; its colour. */
#include "stages/export_model/export_things.h"

#include <math.h>

#include "common/model/thing_list.h"
#include "tests/unit/box_solids.h"

/* The room is from -2 to 2 in each direction. */
static const struct box room[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static const struct provenance no_inputs = {.stage = "test", .version = "1"};

enum { SIDE = 32, SOFA = 1, LAMP, BIRD, GHOST };
#define VOXEL (4.0 / SIDE)

/* A block of voxels whose distance is -0.5 within it and 0.5 in the layer around it: a box whose sides are midway. */
static void put_thing(struct thing_volume *v, uint32_t id, const int low[3], const int high[3])
{
    for (int z = low[2] - 1; z <= high[2]; z++)
        for (int y = low[1] - 1; y <= high[1]; y++)
            for (int x = low[0] - 1; x <= high[0]; x++) {
                const size_t at = (size_t)((z * SIDE + y) * SIDE + x);
                const bool inside =
                    x >= low[0] && x < high[0] && y >= low[1] && y < high[1] && z >= low[2] && z < high[2];
                v->id[at] = id;
                v->distance[at] = inside ? -0.5f : 0.5f;
            }
}

static void write_volume(void)
{
    static uint32_t id[SIDE * SIDE * SIDE];
    static float distance[SIDE * SIDE * SIDE];
    struct thing_volume v = {{{-2, -2, -2}, VOXEL, {SIDE, SIDE, SIDE}}, id, distance};
    struct err err = ERR_INIT;
    for (int i = 0; i < SIDE * SIDE * SIDE; i++) distance[i] = THING_UNSEEN;
    put_thing(&v, SOFA, (int[]){18, 12, 1}, (int[]){26, 16, 5});
    put_thing(&v, LAMP, (int[]){4, 4, 24}, (int[]){8, 8, 31});
    put_thing(&v, BIRD, (int[]){12, 24, 14}, (int[]){16, 26, 16});
    id[(10 * SIDE + 10) * SIDE + 10] = GHOST; /* without a surface */
    assert_ok(thing_volume_write(&v, scratch_path("things/volume.exr"), &no_inputs, &err), err);
}

/* Voxels and views, which no test here looks at. */
#define SEEN \
    9, 1, (char *)"a", { 0 }

static int write_things(void **state)
{
    static const struct thing things[] = {
        {(char *)"sofa",
         THING_ON_FLOOR,
         {0.25, -0.5, -2},
         {1.25, 0, -1.375},
         SEEN,
         {0.25, 0.5, 4},
         {{0}},
         {.count = 0}},
        {(char *)"lamp", THING_ON_CEILING, {-1.5, -1.5, 1}, {-1, -1, 2}, SEEN, {1, 1, 1}, {{0}}, {.count = 0}},
        {(char *)"thing1", THING_ON_NONE, {-0.5, 1, -0.25}, {0, 1.25, 0}, SEEN, {0, 0, 0}, {{0}}, {.count = 0}},
        {(char *)"ghost", THING_ON_NONE, {-0.75, -0.75, -0.75}, {-0.5, -0.5, -0.5}, SEEN, {0}, {{0}}, {.count = 0}},
    };
    struct thing_list list = {(struct thing *)things, 4};
    struct err err = ERR_INIT;
    if (scratch_make(state)) return -1;
    mkdir(scratch_path("things"), 0777);
    assert_ok(thing_list_write(&list, scratch_path("things/things.txt"), &no_inputs, &err), err);
    write_volume();
    struct solid_mesh mesh = make_boxes(room, 2);
    assert_ok(solid_mesh_write(&mesh, scratch_path("model.txt"), &no_inputs, &err), err);
    solid_mesh_release(&mesh);
    return 0;
}

static enum status try_read(struct export_things *t, const struct texture_map *map, struct err *err)
{
    const char *model = scratch_path("model.txt");
    const struct export_thing_files files = {scratch_path("things"), model, model, map ? "texture.txt" : NULL};
    return export_things_read(t, &files, map, NULL, err);
}

static struct export_things read_in(struct texture_thing *edits, int count)
{
    const struct texture_map map = {.things = edits, .thing_count = count};
    struct export_things t;
    struct err err = ERR_INIT;
    assert_ok(try_read(&t, edits ? &map : NULL, &err), err);
    return t;
}

/* The names in order, with blanks between them. */
static void assert_names(const struct export_things *t, const char *names)
{
    char text[200] = "";
    for (int i = 0; i < t->count; i++)
        snprintf(text + strlen(text), sizeof text - strlen(text), "%s%s", i ? " " : "", t->things[i].name);
    assert_string_equal(text, names);
}

/* The box around a thing's triangles, which face outwards. */
static void assert_box(const struct export_things *all, const char *name, struct vec3 low, struct vec3 high)
{
    const struct export_thing *t = all->things;
    while (t < all->things + all->count && strcmp(t->name, name)) t++;
    assert_true(t < all->things + all->count && t->mesh.triangle_count > 11);
    struct vec3 least = t->mesh.vertices[0], most = least;
    double volume = 0;
    for (int i = 0; i < t->mesh.vertex_count; i++) {
        const struct vec3 p = t->mesh.vertices[i];
        least = vec3_make(fmin(least.x, p.x), fmin(least.y, p.y), fmin(least.z, p.z));
        most = vec3_make(fmax(most.x, p.x), fmax(most.y, p.y), fmax(most.z, p.z));
    }
    for (int i = 0; i < t->mesh.triangle_count; i++) {
        const int *c = t->mesh.triangles[i];
        const struct vec3 *v = t->mesh.vertices;
        volume += vec3_dot(v[c[0]], vec3_cross(v[c[1]], v[c[2]])) / 6;
    }
    if (vec3_length(vec3_sub(least, low)) > 1e-6 || vec3_length(vec3_sub(most, high)) > 1e-6)
        fail_msg("%s is from %g %g %g to %g %g %g", name, least.x, least.y, least.z, most.x, most.y, most.z);
    assert_true(volume > 0.5 * (high.x - low.x) * (high.y - low.y) * (high.z - low.z));
}

static void without_an_edit_all_things_are_where_they_were(void **state)
{
    struct export_things t = read_in(NULL, 0);
    (void)state;
    assert_names(&t, "sofa lamp thing1");
    assert_box(&t, "sofa", vec3_make(0.25, -0.5, -1.875), vec3_make(1.25, 0, -1.375));
    assert_box(&t, "lamp", vec3_make(-1.5, -1.5, 1), vec3_make(-1, -1, 1.875));
    export_things_release(&t);
    export_things_release(&t);
    struct texture_thing none;
    t = read_in(&none, 0);
    assert_names(&t, "sofa lamp thing1");
    export_things_release(&t);
}

static void cleared_moved_and_copied_things(void **state)
{
    struct texture_thing edits[] = {
        {TEXTURE_THING_MOVE, (char *)"sofa", (char *)"sofa", {-0.5, 1, 0}, 90, (char *)"e.txt", 2},
        {TEXTURE_THING_MOVE, (char *)"second", (char *)"lamp", {2, 0.25, 0}, 0, (char *)"e.txt", 2},
        {TEXTURE_THING_CLEAR, (char *)"thing1", (char *)"thing1", {0}, 0, (char *)"e.txt", 2},
    };
    struct export_things t = read_in(edits, 3);
    (void)state;
    assert_names(&t, "lamp sofa second");
    /* about the middle of its footprint, (0.75, -0.25), which goes to (0.25, 0.75) */
    assert_box(&t, "sofa", vec3_make(0, 0.25, -1.875), vec3_make(0.5, 1.25, -1.375));
    assert_box(&t, "second", vec3_make(0.5, -1.25, 1), vec3_make(1, -0.75, 1.875));
    assert_box(&t, "lamp", vec3_make(-1.5, -1.5, 1), vec3_make(-1, -1, 1.875));
    assert_float_equal(t.things[1].radiance[2], 4, 1e-6);
    assert_float_equal(t.things[2].radiance[2], 1, 1e-6);
    export_things_release(&t);
}

static void a_cleared_room_keeps_its_lamp(void **state)
{
    double square[4][2] = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    struct texture_zone zone = {.low = -3, .high = 3, .corners = square, .corner_count = 4};
    const struct texture_map map = {.zones = &zone, .zone_count = 1};
    const struct export_thing_files files = {scratch_path("things"), "no/model.txt", NULL, "texture.txt"};
    struct export_things t;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(export_things_read(&t, &files, &map, NULL, &err), err); /* needs neither model */
    assert_names(&t, "lamp");
    export_things_release(&t);
}

static void colours_are_radiance_times_exposure_up_to_white(void **state)
{
    struct export_things t = read_in(NULL, 0);
    double c[3];
    (void)state;
    export_thing_colour(c, &t.things[0], 0.5);
    assert_true(c[0] == 0.125 && c[1] == 0.25 && c[2] == 1);
    export_things_release(&t);
}

static void without_a_folder_there_are_none(void **state)
{
    struct texture_thing edit = {TEXTURE_THING_CLEAR, (char *)"sofa", (char *)"sofa", {0}, 0, (char *)"e.txt", 2};
    const struct texture_map map = {.things = &edit, .thing_count = 1};
    const struct export_thing_files files = {NULL, "no/model.txt", NULL, "texture.txt"};
    struct export_things t;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(export_things_read(&t, &files, &map, NULL, &err), err);
    assert_int_equal(t.count, 0);
}

static void errors_say_what_is_wrong(void **state)
{
    struct texture_thing edit = {TEXTURE_THING_MOVE, (char *)"sofa", (char *)"sofa", {1, 0, 0}, 0, (char *)"e.txt", 2};
    const struct texture_map map = {.things = &edit, .thing_count = 1};
    struct export_thing_files files = {scratch_path("things"), scratch_path("model.txt"), NULL, "texture.txt"};
    struct export_things t;
    struct err err = ERR_INIT;
    (void)state;
    export_things_read(&t, &files, &map, NULL, &err);
    assert_err(err, ST_USAGE, "texture.txt: the edit changes the thing sofa, but --base is missing; see --help");
    export_things_release(&t);
    err = (struct err)ERR_INIT;
    try_read(&t, &map, &err);
    assert_err(err, ST_DATA, "e.txt:2: sofa would stand at least");
    export_things_release(&t);
    err = (struct err)ERR_INIT;
    edit = (struct texture_thing){
        TEXTURE_THING_MOVE, (char *)"thing1", (char *)"sofa", {-1.25, 0, 0}, 0, (char *)"e.txt", 2};
    try_read(&t, &map, &err);
    assert_err(err, ST_DATA, "texture.txt: a copy of sofa has the name thing1, which another thing has, too. Give");
    export_things_release(&t);
    err = (struct err)ERR_INIT;
    edit = (struct texture_thing){TEXTURE_THING_CLEAR, (char *)"sofaa", (char *)"sofaa", {0}, 0, (char *)"e.txt", 2};
    try_read(&t, &map, &err);
    assert_err(err, ST_DATA, "the edit changes sofaa, but no thing of that name was found; the nearest is sofa");
    export_things_release(&t);
    err = (struct err)ERR_INIT;
    files.folder = scratch_path("nowhere");
    export_things_read(&t, &files, NULL, NULL, &err);
    assert_int_not_equal(err.status, ST_OK);
    assert_contains(err.text, "nowhere/things.txt");
    export_things_release(&t);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_an_edit_all_things_are_where_they_were),
        cmocka_unit_test(cleared_moved_and_copied_things),
        cmocka_unit_test(a_cleared_room_keeps_its_lamp),
        cmocka_unit_test(colours_are_radiance_times_exposure_up_to_white),
        cmocka_unit_test(without_a_folder_there_are_none),
        cmocka_unit_test(errors_say_what_is_wrong),
    };
    return cmocka_run_group_tests(tests, write_things, scratch_remove);
}
