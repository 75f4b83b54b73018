/* bright_ceilings.c - lamps in a ceiling as photographs show them: saturated, cut off by their frames, or hanging. */
#include "stages/fit_lights/bright_ceilings.h"

#include "common/capture/view_image.h"
#include "tests/unit/atlas_room.h"

enum { VIEWS = 3, SIDE = 200 };

/* A rectangle that shines, at a height. */
struct bright {
    struct vec3 at;
    double x, y;
    bool saturates;
};

static struct view views[VIEWS];

static void shade(const void *ctx, float rgb[3], int tile, int x, int y, struct vec3 p)
{
    (void)ctx, (void)tile, (void)x, (void)y, (void)p;
    rgb[0] = rgb[1] = rgb[2] = 0.2f;
}

/* Whether a ray from a camera below meets the rectangle. */
static bool meets(const struct bright *b, struct vec3 from, struct vec3 way)
{
    const double t = (b->at.z - from.z) / way.z;
    return t > 0 && fabs(from.x + t * way.x - b->at.x) < b->x && fabs(from.y + t * way.y - b->at.y) < b->y;
}

static void write_view(const struct view *v, const struct bright *b)
{
    const struct provenance prov = {.stage = "test", .version = "0"};
    struct image im = {0};
    struct photo_quality quality = {0};
    struct err err = ERR_INIT;
    char path[300];
    assert_ok(image_init(&im, SIDE, SIDE, 4, &err), err);
    assert_ok(photo_quality_init(&quality, SIDE, SIDE, &err), err);
    for (int i = 0; i < SIDE * SIDE; i++) {
        const struct vec3 way = vec3_sub(view_unproject(v, i % SIDE + 0.5, i / SIDE + 0.5, 1), v->center);
        const bool shines = meets(b, v->center, way);
        for (int c = 0; c < 3; c++) im.data[4 * i + c] = shines && !b->saturates ? 5 : 0.2f;
        im.data[4 * i + 3] = 1;
        quality.marks[i] = shines && b->saturates ? PHOTO_BRIGHT : 0;
    }
    snprintf(path, sizeof path, "%s.exr", v->name);
    assert_ok(view_image_write(&im, &quality, scratch_path(path), v, &prov, "exact", &err), err);
    photo_quality_release(&quality);
    image_release(&im);
}

/* Three photos, two of which do not show all of what is at (1.5, 1.5). */
static void find(struct bright_places *places, const struct bright *b)
{
    static char names[VIEWS][2] = {"a", "b", "c"};
    static const struct vec3 at[VIEWS] = {{0.4, 1.5, 0.8}, {2.7, 0.9, 1.0}, {1.2, 3.2, 0.6}};
    struct provenance prov = {0};
    struct field_atlas atlas = {0};
    struct err err = ERR_INIT;
    struct lit_model lit = {.rays = model};
    make_atlas(&atlas, 10, shade, NULL);
    for (int i = 0; i < VIEWS; i++) {
        views[i] = view_at(at[i], 0, 0, SIDE, SIDE, 130);
        views[i].name = names[i];
        write_view(&views[i], b);
    }
    lit.in.axes = (struct model_axes){.rotation = {1, 0, 0, 0}, .scale = 1};
    lit.in.set = (struct camera_set){.views = views, .view_count = VIEWS};
    const struct model_field field = {.atlas = atlas, .planes = planes};
    assert_ok(bright_ceilings_find(places, &field, &lit, scratch, 2, &prov, &err), err);
    field_atlas_release(&atlas);
    provenance_release(&prov);
}

static void a_lamp_in_a_ceiling_has_its_place_and_outline(void **state)
{
    (void)state;
    for (int saturates = 0; saturates < 2; saturates++) {
        const struct bright b = {{1.5, 1.5, 2.7}, 0.5, 0.35, saturates};
        struct bright_places found = {0};
        find(&found, &b);
        assert_int_equal(found.count, 1);
        const struct bright_place *p = &found.list[0];
        assert_true(fabs(p->at.x - b.at.x) < 0.06 && fabs(p->at.y - b.at.y) < 0.06 && fabs(p->at.z - 2.7) < 0.01);
        assert_true(fabs(p->x - b.x) < 0.06 && fabs(p->y - b.y) < 0.06);
        bright_ceilings_release(&found);
    }
}

static void what_hangs_and_what_is_small_is_no_place_of_a_ceiling(void **state)
{
    static const struct bright others[] = {{{1.5, 1.5, 1.9}, 0.15, 0.15, true}, {{1.5, 1.5, 2.7}, 0.04, 0.04, true}};
    (void)state;
    for (size_t k = 0; k < sizeof others / sizeof *others; k++) {
        struct bright_places found = {0};
        find(&found, &others[k]);
        assert_int_equal(found.count, 0);
        bright_ceilings_release(&found);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_lamp_in_a_ceiling_has_its_place_and_outline),
        cmocka_unit_test(what_hangs_and_what_is_small_is_no_place_of_a_ceiling),
    };
    return cmocka_run_group_tests(tests, make_walls, release_room);
}
