/* sun_search.c - the sun from the patch that it throws on a floor, of which everything is known. */
#include "stages/bake_outdoors/sun_search.h"

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "common/texture/atlas.h"
#include "stages/bake_outdoors/sun_light.h"
#include "tests/unit/box_solids.h"

/* A room of 5 x 4 x 2.7 m with a window of 2 x 1.4 m in the wall y = 0, which is 0.3 m thick. */
static const struct vec3 window_low = {1.5, -0.3, 0.8}, window_high = {3.5, 0, 2.2};
static const struct box boxes[] = {
    {"walls", "floor", {-0.3, -0.3, -0.3}, {5.3, 4.3, 0}, false},
    {"walls", "ceiling", {-0.3, -0.3, 2.7}, {5.3, 4.3, 3}, false},
    {"walls", "west", {-0.3, -0.3, 0}, {0, 4.3, 2.7}, false},
    {"walls", "east", {5, -0.3, 0}, {5.3, 4.3, 2.7}, false},
    {"walls", "north", {0, 4, 0}, {5, 4.3, 2.7}, false},
    {"walls", "below", {0, -0.3, 0}, {5, 0, 0.8}, false},
    {"walls", "above", {0, -0.3, 2.2}, {5, 0, 2.7}, false},
    {"walls", "left", {0, -0.3, 0.8}, {1.5, 0, 2.2}, false},
    {"walls", "right", {3.5, -0.3, 0.8}, {5, 0, 2.2}, false},
};
enum { BOXES = sizeof boxes / sizeof *boxes, TILES = 6, SCALE = 50 };

/* The faces indoors: corner, side along x, side along y of the tile, metres. */
static const struct inside {
    const char *face;
    struct vec3 corner, right, down;
} insides[TILES] = {
    {"floor/5", {0, 0, 0}, {5, 0, 0}, {0, 4, 0}},   {"ceiling/4", {0, 0, 2.7}, {5, 0, 0}, {0, 4, 0}},
    {"west/1", {0, 0, 0}, {0, 4, 0}, {0, 0, 2.7}},  {"east/0", {5, 0, 0}, {0, 4, 0}, {0, 0, 2.7}},
    {"north/2", {0, 4, 0}, {5, 0, 0}, {0, 0, 2.7}}, {"below/3", {0, 0, 0}, {5, 0, 0}, {0, 0, 0.8}},
};

struct shine {
    struct vec3 to_sun;
    double radius; /* degrees */
    double light;  /* irradiance of what faces the sun; 0: there is none */
    bool carpet;   /* a bright carpet with a red border in the middle of the floor */
};

static double noise_at(int tile, int x, int y)
{
    uint32_t h = (uint32_t)(tile * 7919 + (y / 3) * 104729 + (x / 20) * 1299709);
    h ^= h >> 15;
    h *= 2246822519u;
    h ^= h >> 13;
    return (h & 0xffff) / 65535.0;
}

/* Whether a ray from a point passes the window: through its rectangle on both faces of the wall. */
static bool passes(struct vec3 p, struct vec3 d)
{
    if (!(d.y < 0)) return false;
    for (int k = 0; k < 2; k++) {
        const double t = ((k ? window_low.y : window_high.y) - p.y) / d.y;
        const struct vec3 q = vec3_add(p, vec3_scale(d, t));
        if (q.x < window_low.x || q.x > window_high.x || q.z < window_low.z || q.z > window_high.z) return false;
    }
    return true;
}

/* The part of the sun that a point sees: a grid of directions over its disk. */
static double share_of(struct vec3 p, const struct shine *s)
{
    enum { SIDE = 16 };
    const struct vec3 side = vec3_normalize(vec3_make(-s->to_sun.y, s->to_sun.x, 0)), up = vec3_cross(s->to_sun, side);
    const double r = tan(s->radius * DEGREE);
    int inside = 0, seen = 0;
    for (int k = 0; k < SIDE * SIDE; k++) {
        const double u = 2 * (k % SIDE + 0.5) / SIDE - 1, v = 2 * (k / SIDE + 0.5) / SIDE - 1;
        if (u * u + v * v > 1) continue;
        inside++;
        seen += passes(p, vec3_add(s->to_sun, vec3_add(vec3_scale(side, r * u), vec3_scale(up, r * v))));
    }
    return (double)seen / inside;
}

/* Every place receives the irradiance pi, as if walls and sky had the radiance 1 all around; albedo varies. */
static void shade(float rgb[3], int tile, int x, int y, struct vec3 p, const struct shine *s)
{
    const struct vec3 normal = tile == 0   ? vec3_make(0, 0, 1)
                               : tile == 4 ? vec3_make(0, -1, 0)
                               : tile == 2 ? vec3_make(1, 0, 0)
                               : tile == 3 ? vec3_make(-1, 0, 0)
                                           : vec3_make(0, 0, -1);
    const double cosine = fmax(0, vec3_dot(normal, s->to_sun));
    const double lit = 1 + s->light * cosine / PI * (s->light > 0 && cosine > 0 ? share_of(p, s) : 0);
    const double paint = tile == 0 ? 0.6 + 0.8 * noise_at(tile, x, y) : 1;
    for (int c = 0; c < 3; c++) rgb[c] = (float)(paint * lit);
    if (!s->carpet || tile || p.x < 1.6 || p.x > 3.6 || p.y < 1.2 || p.y > 2.8) return;
    const bool border = p.x < 1.7 || p.x > 3.5 || p.y < 1.3 || p.y > 2.7;
    const double colour[3] = {2.2, border ? 0.4 : 2.2, border ? 0.3 : 2.1};
    for (int c = 0; c < 3; c++) rgb[c] = (float)(colour[c] * lit);
}

static struct model_rays model;
static struct face_plane *planes;

static int make_room(void **state)
{
    (void)state;
    model = make_rays(boxes, BOXES);
    planes = calloc((size_t)model.ids + 256, sizeof *planes);
    for (int i = 0; i < model.mesh.face_count; i++)
        planes[solid_face_id(&model.mesh, i)] =
            (struct face_plane){model.mesh.faces[i].normal, model.mesh.faces[i].offset};
    return scratch_make(state);
}

static int release_room(void **state)
{
    model_rays_release(&model);
    free(planes);
    return scratch_remove(state);
}

static int face_id(const char *name)
{
    for (int i = 0; i < model.mesh.face_count; i++)
        if (!strcmp(solid_face_name(&model.mesh, i), name)) return solid_face_id(&model.mesh, i);
    fail_msg("no face %s", name);
    return 0;
}

static int by_face(const void *a, const void *b)
{
    return ((const struct atlas_tile *)a)->face - ((const struct atlas_tile *)b)->face;
}

/* Writes the atlas of the room under a sun, and reads it as gathers do. */
static void make_atlas(struct field_atlas *to, const struct shine *s)
{
    struct atlas a = {0};
    struct atlas_tile tiles[TILES] = {0};
    struct atlas_page page = {0};
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    char view[] = "v0", *sources[] = {view};
    a.tiles = tiles;
    a.tile_count = TILES;
    a.sources = sources;
    a.source_count = 1;
    for (int i = 0; i < TILES; i++) {
        const struct vec3 axes[2] = {vec3_normalize(insides[i].right), vec3_normalize(insides[i].down)};
        tiles[i].face = face_id(insides[i].face);
        tiles[i].view = -1;
        tiles[i].width = (int)lround(SCALE * vec3_length(insides[i].right));
        tiles[i].height = (int)lround(SCALE * vec3_length(insides[i].down));
        for (int k = 0; k < 2; k++) {
            tiles[i].matrix[k][0] = axes[k].x * SCALE;
            tiles[i].matrix[k][1] = axes[k].y * SCALE;
            tiles[i].matrix[k][2] = axes[k].z * SCALE;
        }
        tiles[i].matrix[2][3] = 1;
    }
    qsort(tiles, TILES, sizeof *tiles, by_face);
    assert_ok(atlas_pack(&a, &err), err);
    assert_int_equal(a.page_count, 1);
    assert_ok(atlas_page_init(&page, a.page_sizes[0][0], a.page_sizes[0][1], &err), err);
    for (int i = 0; i < TILES; i++) {
        int k = 0;
        while (face_id(insides[k].face) != tiles[i].face) k++;
        tiles[i].matrix[0][3] += tiles[i].x;
        tiles[i].matrix[1][3] += tiles[i].y;
        for (int y = 0; y < tiles[i].height; y++)
            for (int x = 0; x < tiles[i].width; x++) {
                const size_t at = (size_t)(tiles[i].y + y) * (size_t)page.width + (size_t)(tiles[i].x + x);
                const struct vec3 p =
                    vec3_add(insides[k].corner, vec3_add(vec3_scale(insides[k].right, (x + 0.5) / tiles[i].width),
                                                         vec3_scale(insides[k].down, (y + 0.5) / tiles[i].height)));
                shade(page.rgb + 3 * at, k, x, y, p, s);
                page.source[at] = ATLAS_VIEWS;
            }
    }
    const char *folder = scratch_path("vita");
    assert_ok(atlas_write(&a, &page, folder, &prov, &err), err);
    atlas_page_release(&page);
    free(a.page_sizes);
    assert_ok(field_atlas_read(to, folder, model.ids, &prov, &err), err);
    provenance_release(&prov);
}

static struct vec3 from_angles(double azimuth, double elevation)
{
    const double a = azimuth * DEGREE, e = elevation * DEGREE;
    return vec3_make(cos(e) * cos(a), cos(e) * sin(a), sin(e));
}

static void search_under(struct sun_search *found, struct sun_light *light, const struct shine *s)
{
    struct field_atlas atlas = {0};
    struct outdoors o = {0};
    struct err err = ERR_INIT;
    make_atlas(&atlas, s);
    const struct sun_scene scene = {&model, &atlas, planes};
    *found = (struct sun_search){0};
    assert_ok(sun_search(found, &scene, &err), err);
    assert_ok(outdoors_init(&o, 32, &err), err);
    for (int i = 0; i < 3 * o.width * o.height; i++) o.rgb[i] = 1;
    if (light)
        assert_ok(sun_light_measure(light, &scene, &o, &found->edges, found->fit.direction, found->fit.radius, &err),
                  err);
    outdoors_release(&o);
    field_atlas_release(&atlas);
}

static double degrees_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b)) / DEGREE;
}

static void a_patch_on_the_floor_tells_direction_size_and_light(void **state)
{
    (void)state;
    static const double suns[3][3] = {{-100, 40, 1}, {-60, 30, 1.5}, {-120, 52, 0.5}};
    double mean = 0;
    for (int k = 0; k < 3; k++) {
        const struct shine s = {from_angles(suns[k][0], suns[k][1]), suns[k][2], 8, false};
        struct sun_search found;
        struct sun_light light;
        search_under(&found, &light, &s);
        assert_true(found.found);
        assert_true(degrees_between(found.fit.direction, s.to_sun) < 0.3);
        assert_true(found.fit.error < 0.5);
        assert_true(fabs(found.fit.radius - suns[k][2]) < 0.3);
        /* paint differs by a factor of two from plank to plank */
        assert_true(fabs(light.irradiance.g / 8 - 1) < 0.2);
        mean += light.irradiance.g / 3;
        sun_search_release(&found);
    }
    assert_true(fabs(mean / 8 - 1) < 0.05);
}

static void a_room_without_sun_has_none(void **state)
{
    (void)state;
    struct sun_search found;
    search_under(&found, NULL, &(struct shine){from_angles(-100, 40), 1, 0, false});
    assert_false(found.found);
    sun_search_release(&found);
}

static void a_carpet_is_no_sun_and_hides_none(void **state)
{
    (void)state;
    struct sun_search found;
    const struct shine none = {from_angles(-100, 40), 1, 0, true}, sun = {from_angles(-100, 40), 1, 8, true};
    search_under(&found, NULL, &none);
    assert_false(found.found);
    sun_search_release(&found);
    search_under(&found, NULL, &sun);
    assert_true(found.found);
    assert_true(degrees_between(found.fit.direction, sun.to_sun) < 0.3);
    sun_search_release(&found);
}

static void the_same_sun_for_any_number_of_threads(void **state)
{
    (void)state;
    struct sun_search found[2];
    const struct shine s = {from_angles(-80, 35), 1, 3, false};
    for (int k = 0; k < 2; k++) {
        parallel_set_threads(1 + 2 * k);
        search_under(&found[k], NULL, &s);
        sun_search_release(&found[k]);
    }
    parallel_set_threads(0);
    assert_memory_equal(&found[0].fit, &found[1].fit, sizeof found[0].fit);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_patch_on_the_floor_tells_direction_size_and_light),
        cmocka_unit_test(a_room_without_sun_has_none),
        cmocka_unit_test(a_carpet_is_no_sun_and_hides_none),
        cmocka_unit_test(the_same_sun_for_any_number_of_threads),
    };
    return cmocka_run_group_tests(tests, make_room, release_room);
}
