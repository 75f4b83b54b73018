/* surfaces.c - faces of a model and of its edits as surfaces, and their areas on a raster. */
#include "common/texture/surfaces.h"

#include "tests/unit/scratch.h"

struct box_mesh {
    struct vec3 vertices[8];
    int corners[6][4], sizes[6];
    struct solid_polygon polygons[6];
};

/* A box whose top, at z = height, is called "top" and reaches to x = length. */
static void make_box(struct solid_mesh *mesh, double length, double height, const char *top)
{
    static const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    const char *const names[6] = {"x0", "x1", "y0", "y1", "z0", top};
    const double offsets[6] = {0, length, 0, 2, 0, height};
    struct box_mesh b;
    struct err err = ERR_INIT;
    for (int i = 0; i < 8; i++) b.vertices[i] = vec3_make(i & 1 ? length : 0, i & 2 ? 2 : 0, i & 4 ? height : 0);
    for (int i = 0; i < 6; i++) {
        const double s = i % 2 ? 1 : -1;
        memcpy(b.corners[i], quads[i], sizeof b.corners[i]);
        b.sizes[i] = 4;
        b.polygons[i] = (struct solid_polygon){.name = names[i],
                                               .body = "walls",
                                               .normal = {i / 2 == 0 ? s : 0, i / 2 == 1 ? s : 0, i / 2 == 2 ? s : 0},
                                               .offset = offsets[i],
                                               .corners = b.corners[i],
                                               .sizes = &b.sizes[i],
                                               .loops = 1};
    }
    assert_ok(solid_mesh_make(mesh, b.vertices, 8, b.polygons, 6, NULL, &err), err);
}

/* The top of the first model, looked at from above: a pixel a tenth wide, x to the right, y down. */
static int count_filled(const struct surfaces *s, int surface, uint8_t filled[40 * 40])
{
    const struct surface *of = &s->list[surface];
    struct surface_raster r = {40, 40, {{0.1, 0, 0}, {0, 0.1, 0}, {0, 0, of->offset}, {0, 0, 1}}};
    int count = 0;
    memset(filled, 0, 40 * 40);
    surface_fill(filled, s, surface, &r);
    for (int i = 0; i < 40 * 40; i++) count += filled[i];
    return count;
}

static void the_area_is_the_union_of_the_model_and_its_edits(void **state)
{
    (void)state;
    struct solid_mesh m[2] = {{0}};
    struct surfaces s = {0};
    struct err err = ERR_INIT;
    uint8_t filled[40 * 40];
    make_box(&m[0], 1, 3, "top");
    make_box(&m[1], 3, 3, "top");
    assert_ok(solid_mesh_carry_ids(&m[1], &m[0], &err), err);
    assert_ok(surfaces_make(&s, m, 1, &err), err);
    const int id = s.list[5].id;
    assert_int_equal(count_filled(&s, surfaces_find(&s, id), filled), 10 * 20);
    surfaces_release(&s);
    assert_ok(surfaces_make(&s, m, 2, &err), err);
    assert_int_equal(s.count, 6);
    assert_int_equal(count_filled(&s, surfaces_find(&s, id), filled), 30 * 20);
    assert_int_equal(filled[19 * 40 + 29], 1);
    assert_int_equal(filled[20 * 40 + 29], 0);
    assert_int_equal(filled[19 * 40 + 30], 0);
    surfaces_release(&s);
    solid_mesh_release(&m[0]);
    solid_mesh_release(&m[1]);
}

static void a_face_that_an_edit_moved_adds_nothing(void **state)
{
    (void)state;
    struct solid_mesh m[2] = {{0}};
    struct surfaces s = {0};
    struct err err = ERR_INIT;
    uint8_t filled[40 * 40];
    make_box(&m[0], 1, 3, "top");
    make_box(&m[1], 3, 2.5, "top");
    assert_ok(solid_mesh_carry_ids(&m[1], &m[0], &err), err);
    assert_ok(surfaces_make(&s, m, 2, &err), err);
    assert_int_equal(count_filled(&s, 5, filled), 10 * 20);
    surfaces_release(&s);
    solid_mesh_release(&m[0]);
    solid_mesh_release(&m[1]);
}

static void a_face_that_only_an_edit_has_is_left_out(void **state)
{
    (void)state;
    struct solid_mesh m[2] = {{0}};
    struct surfaces s = {0};
    struct err err = ERR_INIT;
    make_box(&m[0], 1, 3, "top");
    make_box(&m[1], 1, 3, "another");
    assert_ok(solid_mesh_carry_ids(&m[1], &m[0], &err), err);
    assert_ok(surfaces_make(&s, m, 2, &err), err);
    assert_int_equal(s.count, 6);
    for (int i = 0; i < m[1].name_count; i++)
        if (!strcmp(m[1].names[i].name, "another")) assert_int_equal(surfaces_find(&s, m[1].names[i].id), -1);
    surfaces_release(&s);
    solid_mesh_release(&m[0]);
    solid_mesh_release(&m[1]);
}

/* A camera above the floor's edge looks along it: the horizon is inside the picture. */
static void only_pixels_in_front_of_the_camera_are_filled(void **state)
{
    (void)state;
    struct solid_mesh m = {0};
    struct surfaces s = {0};
    struct err err = ERR_INIT;
    uint8_t filled[64 * 64] = {0};
    make_box(&m, 3, 3, "top");
    assert_ok(surfaces_make(&s, &m, 1, &err), err);
    /* at (1.5, 1, 4), 1 above the top, looking along x: the ray of (x, y) is (64, 32 - x, 32 - y); W = y - 32 > 0
     * below */
    const struct surface_raster r = {
        64, 64, {{0, 1.5, -1.5 * 32 + 64}, {-1, 1, 32 - 32}, {0, 3, -3 * 32}, {0, 1, -32}}};
    surface_fill(filled, &s, 5, &r);
    for (int y = 0; y < 64; y++)
        for (int x = 0; x < 64; x++) {
            const double w = y + 0.5 - 32, px = (1.5 * (y + 0.5) - 1.5 * 32 + 64) / w,
                         py = (-(x + 0.5) + (y + 0.5)) / w;
            const bool inside = w > 0 && px >= 0 && px <= 3 && py >= 0 && py <= 2;
            assert_int_equal(filled[y * 64 + x], inside);
        }
    surfaces_release(&s);
    solid_mesh_release(&m);
}

static void the_surface_of_an_id_is_the_one_that_holds_the_point(void **state)
{
    (void)state;
    struct surface list[] = {{.id = 2, .normal = {0, 0, 1}, .offset = 1},
                             {.id = 7, .normal = {0, 0, 1}, .offset = 1},
                             {.id = 7, .normal = {0, 0, 1}, .offset = 2}};
    const struct surfaces s = {.list = list, .count = 3};
    assert_int_equal(surfaces_find(&s, 7), 1);
    assert_int_equal(surfaces_find(&s, 3), -1);
    assert_int_equal(surfaces_find_at(&s, 7, vec3_make(5, 5, 1.9), 0.2), 2);
    assert_int_equal(surfaces_find_at(&s, 7, vec3_make(5, 5, 1.5), 0.2), -1);
    assert_int_equal(surfaces_find_at(&s, 2, vec3_make(5, 5, 1.1), 0.2), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_area_is_the_union_of_the_model_and_its_edits),
        cmocka_unit_test(a_face_that_an_edit_moved_adds_nothing),
        cmocka_unit_test(a_face_that_only_an_edit_has_is_left_out),
        cmocka_unit_test(only_pixels_in_front_of_the_camera_are_filled),
        cmocka_unit_test(the_surface_of_an_id_is_the_one_that_holds_the_point),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
