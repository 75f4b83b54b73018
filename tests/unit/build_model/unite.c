/* unite.c - unions with known counts, genus, names and volume. */
#include "tests/unit/build_model/unions.h"

#include "common/base/parallel.h"

struct wanted {
    int shells, genus, vertices, faces, loops; /* genus: of all shells */
    double volume;
};

static void assert_union(const struct solid_mesh *mesh, const struct solid_report *r, struct wanted w)
{
    int genus = 0;
    for (int i = 0; i < r->count; i++) genus += r->shells[i].genus;
    assert_int_equal(r->count, w.shells);
    assert_int_equal(genus, w.genus);
    assert_int_equal(mesh->vertex_count, w.vertices);
    assert_int_equal(mesh->face_count, w.faces);
    assert_int_equal(mesh->loop_count, w.loops);
    assert_near(r->volume, w.volume, 1e-12 * fmax(1, w.volume));
    assert_near(solid_mesh_volume(mesh, -1), w.volume, 1e-12 * fmax(1, w.volume));
}

/* Unites a list and compares; the mesh stays for more checks. */
static struct solid_mesh mesh;

static void check_union(struct solid_list *list, struct wanted w)
{
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, list);
    assert_union(&mesh, &r, w);
    solid_report_release(&r);
}

static int release_mesh(void **state)
{
    (void)state;
    solid_mesh_release(&mesh);
    return 0;
}

static void a_box_is_its_own_union(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0.1, 0.2, 0.3, 2.7, 3.1, 4.3);
    check_union(&l, (struct wanted){1, 0, 8, 6, 6, 2.6 * 2.9 * 4});
    assert_int_equal(mesh.half_edge_count, 24);
    assert_string_equal(solid_face_name(&mesh, 0), "a/x0");
    assert_int_equal(solid_face_id(&mesh, 5), 6);
    for (int i = 0; i < 8; i++) { /* coordinates are exactly the given ones */
        const struct vec3 p = mesh.vertices[i].p;
        assert_true((p.x == 0.1 || p.x == 2.7) && (p.y == 0.2 || p.y == 3.1) && (p.z == 0.3 || p.z == 4.3));
    }
    assert_true(mesh.faces[1].normal.x == 1 && mesh.faces[1].normal.y == 0 && mesh.faces[1].offset == 2.7);
}

static void no_solids_make_an_empty_mesh(void **state)
{
    (void)state;
    struct solid_list l = {0};
    check_union(&l, (struct wanted){0, 0, 0, 0, 0, 0});
}

static void adjacent_boxes_become_one(void **state)
{
    (void)state;
    struct solid_list l = {0};
    struct solid_report r = {0};
    struct unite_log log = {0};
    layout_add_box(&l, "a", 0, 0, 0, 1, 1, 1);
    layout_add_box(&l, "b", 1, 0, 0, 3, 1, 1);
    solid_mesh_release(&mesh);
    unite(&mesh, &r, &log, &l);
    assert_union(&mesh, &r, (struct wanted){1, 0, 8, 6, 6, 3});
    assert_int_equal(faces_called(&mesh, "a/z1"), 1);
    assert_int_equal(faces_called(&mesh, "b/z1"), 0);
    assert_int_equal(faces_called(&mesh, "b/x1"), 1);
    assert_int_equal(log.count, 6);
    assert_int_equal(log.notes[0].event, UNITE_HIDDEN);
    assert_string_equal(log.notes[0].name, "a/x1");
    assert_string_equal(log.notes[1].name, "b/x0");
    assert_int_equal(log.notes[2].event, UNITE_MERGED);
    assert_string_equal(log.notes[2].name, "b/y0");
    assert_string_equal(log.notes[2].into, "a/y0");
    unite_log_release(&log);
    solid_report_release(&r);
    solid_list_release(&l);
}

static void planes_that_differ_by_rounding_are_one(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0, 0, 0, 0.1 + 0.2, 1, 1);
    layout_add_box(&l, "b", 0.3, 0, 0, 1, 1, 1);
    check_union(&l, (struct wanted){1, 0, 8, 6, 6, 1});
}

static void overlapping_boxes_are_united(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0, 0, 0, 2, 2, 2);
    layout_add_box(&l, "b", 1, 1, 1, 3, 3, 3);
    check_union(&l, (struct wanted){1, 0, 20, 12, 12, 15});
}

static void solids_inside_others_vanish(void **state)
{
    (void)state;
    struct solid_list l = {0};
    struct solid_report r = {0};
    struct unite_log log = {0};
    layout_add_box(&l, "in", 1, 1, 1, 2, 2, 2);
    layout_add_box(&l, "flush", 1, 1, 0, 2, 2, 1);
    layout_add_box(&l, "big", 0, 0, 0, 3, 3, 3);
    solid_mesh_release(&mesh);
    unite(&mesh, &r, &log, &l);
    assert_union(&mesh, &r, (struct wanted){1, 0, 8, 6, 6, 27});
    /* the earliest name wins, although its facet touches no border of the face */
    assert_int_equal(faces_called(&mesh, "flush/z0"), 1);
    assert_int_equal(faces_called(&mesh, "big/z0"), 0);
    int hidden = 0;
    for (int i = 0; i < log.count; i++) hidden += log.notes[i].event == UNITE_HIDDEN;
    assert_int_equal(hidden, 6 + 5);
    assert_string_equal(log.notes[log.count - 1].name, "big/z0");
    assert_string_equal(log.notes[log.count - 1].into, "flush/z0");
    unite_log_release(&log);
    solid_report_release(&r);
    solid_list_release(&l);
}

static void solids_that_touch_in_an_edge_or_a_point_stay_separate(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0, 0, 0, 1, 1, 1);
    layout_add_box(&l, "b", 1, 1, 0, 2, 2, 1);
    check_union(&l, (struct wanted){2, 0, 16, 12, 12, 2});
    layout_add_box(&l, "a", 0, 0, 0, 1, 1, 1);
    layout_add_box(&l, "b", 1, 1, 0.5, 2, 2, 1.5); /* in part of the edge */
    check_union(&l, (struct wanted){2, 0, 16, 12, 12, 2});
    layout_add_box(&l, "a", 0, 0, 0, 1, 1, 1);
    layout_add_box(&l, "b", 1, 1, 1, 2, 2, 2);
    check_union(&l, (struct wanted){2, 0, 16, 12, 12, 2});
}

/* Two cubes that touch in an edge, between two plates: each end of the edge is one vertex, so one of the two edges is
 * split in the middle. */
static void one_of_two_edges_between_the_same_vertices_is_split(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "low", 0, 0, 0, 2, 2, 1);
    layout_add_box(&l, "a", 0, 0, 1, 1, 1, 2);
    layout_add_box(&l, "b", 1, 1, 1, 2, 2, 2);
    layout_add_box(&l, "high", 0, 0, 2, 2, 2, 3);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(r.count, 1);
    assert_int_equal(r.shells[0].genus, 1);
    assert_near(r.volume, 10, 1e-12);
    int middles = 0;
    for (int i = 0; i < mesh.vertex_count; i++) {
        const struct vec3 p = mesh.vertices[i].p;
        middles += p.x == 1 && p.y == 1 && p.z == 1.5;
    }
    assert_int_equal(middles, 1);
    solid_report_release(&r);
}

static void a_face_partly_shared_gets_a_hole(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "slab", 0, 0, -1, 4, 4, 0);
    layout_add_box(&l, "column", 1, 1, 0, 2, 2, 3);
    check_union(&l, (struct wanted){1, 0, 16, 11, 12, 19});
    for (int i = 0; i < mesh.face_count; i++)
        assert_int_equal(mesh.faces[i].loops, strcmp(solid_face_name(&mesh, i), "slab/z1") ? 1 : 2);
    layout_add_box(&l, "slab", 0, 0, -1, 4, 4, 0);
    layout_add_box(&l, "column", 0, 0, 0, 2, 2, 3); /* at its corner: two sides become flush */
    check_union(&l, (struct wanted){1, 0, 14, 9, 9, 28});
}

/* Surfaces of two rooms in one plane stay two faces with a common edge, also an island; parts of one room are
 * merged. */
static void floors_of_two_rooms_are_two_faces(void **state)
{
    static const char *const a[6] = {"s", "s", "s", "s", "floor/a/bottom", "floor/a"};
    static const char *const b[6] = {"s", "s", "s", "s", "floor/b/bottom", "floor/b"};
    struct err err = ERR_INIT;
    struct solid_list l = {0};
    (void)state;
    assert_ok(add_named_box(&l, "walls", vec3_make(0, 0, -1), vec3_make(2, 3, 0), a, &err), err);
    assert_ok(add_named_box(&l, "walls", vec3_make(2, 0, -1), vec3_make(3, 3, 0), a, &err), err);
    assert_ok(add_named_box(&l, "walls", vec3_make(3, 0, -1), vec3_make(6, 3, 0), b, &err), err);
    check_union(&l, (struct wanted){1, 0, 12, 8, 8, 18}); /* the sides are merged */
    assert_int_equal(faces_called(&mesh, "floor/a"), 1);
    assert_int_equal(faces_called(&mesh, "floor/b"), 1);
    for (int i = 0; i < 9; i++) { /* an island of b in a */
        const double x = i % 3, y = i / 3;
        assert_ok(add_named_box(&l, "walls", vec3_make(x, y, -1), vec3_make(x + 1, y + 1, 0), i == 4 ? b : a, &err),
                  err);
    }
    check_union(&l, (struct wanted){1, 0, 16, 8, 10, 9});
    for (int i = 0; i < mesh.face_count; i++) {
        const char *name = solid_face_name(&mesh, i);
        assert_int_equal(mesh.faces[i].loops, !strncmp(name, "floor/a", 7) ? 2 : 1);
    }
    /* where two rooms' floors overlap, the surface is the first one's, and nothing is named twice */
    assert_ok(add_named_box(&l, "walls", vec3_make(0, 0, -1), vec3_make(3, 3, 0), a, &err), err);
    assert_ok(add_named_box(&l, "walls", vec3_make(2, 1, -1), vec3_make(5, 2, 0), b, &err), err);
    check_union(&l, (struct wanted){1, 0, 16, 12, 12, 11});
    assert_int_equal(faces_called(&mesh, "floor/a") + faces_called(&mesh, "floor/b"), 2);
}

static void four_walls_are_a_ring(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "south", 0, 0, 0, 5, 0.2, 2.6);
    layout_add_box(&l, "north", 0, 3.8, 0, 5, 4, 2.6);
    layout_add_box(&l, "west", 0, 0, 0, 0.2, 4, 2.6);
    layout_add_box(&l, "east", 4.8, 0, 0, 5, 4, 2.6);
    check_union(&l, (struct wanted){1, 1, 16, 10, 12, (20 - 4.6 * 3.6) * 2.6});
    assert_int_equal(faces_called(&mesh, "south/z1"), 1);
    assert_int_equal(faces_called(&mesh, "east/z1"), 0);
}

static void glass_in_a_window_is_a_separate_body(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "wall", 0, 0, 0, 1, 0.2, 2.6);
    layout_add_box(&l, "wall", 2, 0, 0, 4, 0.2, 2.6);
    static const char *const below[6] = {"h", "h", "wall/y0", "wall/y1", "wall/z0", "sill"};
    static const char *const above[6] = {"h", "h", "wall/y0", "wall/y1", "lintel", "wall/z1"};
    static const char *const pane[6] = {"g/0", "g/1", "g/out", "g/in", "g/4", "g/5"};
    struct err err = ERR_INIT;
    assert_ok(add_named_box(&l, "walls", vec3_make(1, 0, 0), vec3_make(2, 0.2, 0.9), below, &err), err);
    assert_ok(add_named_box(&l, "walls", vec3_make(1, 0, 2.1), vec3_make(2, 0.2, 2.6), above, &err), err);
    assert_ok(add_named_box(&l, "glass", vec3_make(1, 0, 0.9), vec3_make(2, 0.01, 2.1), pane, &err), err);
    check_union(&l, (struct wanted){2, 1, 24, 16, 18, 4 * 0.2 * 2.6 - 0.2 * 1.2 + 0.012});
    assert_int_equal(mesh.body_count, 2); /* glass remains a separate body */
    assert_int_equal(mesh.bodies[1].faces, 6);
    assert_near(solid_mesh_volume(&mesh, 1), 0.012, 1e-15);
    for (int i = 0; i < mesh.face_count; i++)
        if (!strcmp(solid_face_name(&mesh, i), "wall/y0")) {
            assert_int_equal(mesh.faces[i].loops, 2);
            assert_near(solid_mesh_area(&mesh, i), 4 * 2.6 - 1.2, 1e-12);
        }
    assert_int_equal(faces_called(&mesh, "sill"), 1);
    assert_int_equal(faces_called(&mesh, "wall/x1"), 2); /* the end, and the jamb of the same name */
}

static void walls_join_in_t_l_and_cross_junctions(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0, 0, 0, 6, 0.2, 2.5); /* T */
    layout_add_box(&l, "b", 3, 0.2, 0, 3.2, 4, 2.5);
    check_union(&l, (struct wanted){1, 0, 16, 10, 10, (1.2 + 0.76) * 2.5});
    assert_int_equal(faces_called(&mesh, "a/y1"), 2); /* on either side of the other wall */
    assert_int_equal(mesh.name_count, 9);
    layout_add_box(&l, "a", 0, 0, 0, 6, 0.2, 2.5); /* L, the corner shared */
    layout_add_box(&l, "b", 0, 0, 0, 0.2, 4, 2.5);
    check_union(&l, (struct wanted){1, 0, 12, 8, 8, (1.2 + 0.8 - 0.04) * 2.5});
    layout_add_box(&l, "a", -3, -0.1, 0, 3, 0.1, 2.5); /* a cross */
    layout_add_box(&l, "b", -0.1, -2, 0, 0.1, 2, 2.5);
    check_union(&l, (struct wanted){1, 0, 24, 14, 14, (1.2 + 0.8 - 0.04) * 2.5});
    layout_add_box(&l, "a", -3, -0.1, 0, 3, 0.1, 2.5); /* one lower than the other */
    layout_add_box(&l, "b", -0.1, -2, 0, 0.1, 2, 2);
    check_union(&l, (struct wanted){1, 0, 24, 14, 14, 1.2 * 2.5 + (0.8 - 0.04) * 2});
}

static void coincident_solids_count_once(void **state)
{
    (void)state;
    struct solid_list l = {0};
    for (int i = 0; i < 3; i++) layout_add_box(&l, i ? "again" : "a", 0, 0, 0, 1, 2, 3);
    check_union(&l, (struct wanted){1, 0, 8, 6, 6, 6});
    assert_int_equal(faces_called(&mesh, "a/x0"), 1);
}

static void a_cavity_is_a_separate_shell(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "x0", 0, 0, 0, 1, 3, 3);
    layout_add_box(&l, "x1", 2, 0, 0, 3, 3, 3);
    layout_add_box(&l, "y0", 0, 0, 0, 3, 1, 3);
    layout_add_box(&l, "y1", 0, 2, 0, 3, 3, 3);
    layout_add_box(&l, "z0", 0, 0, 0, 3, 3, 1);
    layout_add_box(&l, "z1", 0, 0, 2, 3, 3, 3);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(r.count, 2);
    assert_near(fmin(r.shells[0].volume, r.shells[1].volume), -1, 1e-12);
    assert_near(r.volume, 26, 1e-12);
    solid_report_release(&r);
}

static void pieces_under_one_slope_share_its_plane(void **state)
{
    (void)state;
    /* a gable roof in two pieces that share the slope, on walls that end under it */
    struct solid_list l = {0};
    struct err err = ERR_INIT;
    const struct vec3 slope = {0.3, 0, 1};
    for (int i = 0; i < 2; i++) {
        const struct half_space h[6] = {{{-1, 0, 0}, 0, "x0"},          {{1, 0, 0}, 4, "x1"},
                                        {{0, -1, 0}, -2.0 * i, "y0"},   {{0, 1, 0}, 2.0 * i + 2, "y1"},
                                        {{0, 0, -1}, 0, i ? "b" : "a"}, {slope, 3, i ? "slope/b" : "slope/a"}};
        assert_ok(solid_list_add(&l, "walls", h, 6, &err), err);
    }
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(mesh.vertex_count, 8);
    assert_int_equal(mesh.face_count, 6);
    assert_int_equal(faces_called(&mesh, "slope/a"), 1);
    /* heights 3 and 1.8 over 4 x 4; the normal is rounded to 2^-22 */
    assert_near(r.volume, 2.4 * 16, 1e-4);
    for (int i = 0; i < mesh.face_count; i++)
        if (!strcmp(solid_face_name(&mesh, i), "slope/a")) {
            assert_near(mesh.faces[i].normal.x, 0.3 / sqrt(1.09), 3e-7);
            assert_near(mesh.faces[i].offset, 3 / sqrt(1.09), 1e-6);
        }
    solid_report_release(&r);
}

static void angled_walls_have_the_right_volume(void **state)
{
    (void)state;
    static const double angles[] = {45, 30.3, 90.0001, 0.5};
    for (int i = 0; i < 4; i++) {
        struct solid_list l = {0};
        layout_add_box(&l, "a", -10, -0.1, 0, 10, 0.1, 2.6);
        const double a = angles[i] * M_PI / 180, length = i == 3 ? 60 : 8, t = 0.2;
        add_turned_wall(&l, "b", -length / 2 * cos(a), -length / 2 * sin(a), angles[i], length, t, 0, 2.6);
        struct solid_report r = {0};
        solid_mesh_release(&mesh);
        unite(&mesh, &r, NULL, &l);
        assert_int_equal(r.count, 1);
        assert_int_equal(r.shells[0].genus, 0);
        if (i < 3) {
            assert_int_equal(mesh.face_count, 14);
            assert_int_equal(mesh.vertex_count, 24);
            assert_near(r.volume, (20 * t + length * t - t * t / sin(a)) * 2.6, 2e-5);
        } else { /* they separate before the ends of the long wall, beyond those of the short one */
            assert_true(r.volume < (20 * t + length * t) * 2.6 && r.volume > length * t * 2.6);
        }
        solid_report_release(&r);
    }
}

static void a_wall_at_45_degrees_may_pass_through_corners(void **state)
{
    (void)state;
    /* its sides pass exactly through corners of the boxes it meets */
    struct solid_list l = {0};
    static const double strip[][2] = {{0, 0}, {1, 0}, {4, 3}, {4, 4}, {3, 4}, {0, 1}};
    layout_add_box(&l, "a", -1, -1, 0, 0, 0, 1);
    layout_add_box(&l, "b", 4, 4, 0, 5, 5, 1);
    layout_add_box(&l, "c", 1, -1, 0, 2, 0, 1);
    layout_add_box(&l, "d", 1, 1, 0, 2, 2, 1);
    add_prism(&l, "s", strip, 6, 0, 1);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(r.count, 4); /* a, b and c only touch it in edges */
    assert_near(r.volume, 3 + 7, 1e-12);
    solid_report_release(&r);
}

static void a_hole_may_touch_the_outer_edge_in_a_point(void **state)
{
    (void)state;
    struct solid_list l = {0};
    static const double t[4][3][2] = {
        {{1, 0}, {2, 0}, {1, 1}}, {{2, 0}, {3, 0}, {3, 1}}, {{1, 1}, {2, 2}, {1, 2}}, {{3, 1}, {3, 2}, {2, 2}}};
    layout_add_box(&l, "l", 0, 0, 0, 1, 3, 1);
    layout_add_box(&l, "r", 3, 0, 0, 4, 3, 1);
    layout_add_box(&l, "t", 1, 2, 0, 3, 3, 1);
    for (int i = 0; i < 4; i++) add_prism(&l, "p", t[i], 3, 0, 1);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(r.count, 1);
    assert_near(r.volume, 12 - 2, 1e-12);
    solid_report_release(&r);
    /* a column at a corner of a slab's opening: the slab's face passes that point twice */
    layout_add_box(&l, "l", 0, 0, 0, 1, 4, 1);
    layout_add_box(&l, "m", 0, 2, 0, 4, 4, 1);
    layout_add_box(&l, "n", 2, 0, 0, 4, 4, 1);
    layout_add_box(&l, "bridge", 0, -1, 0, 4, 0, 1);
    layout_add_box(&l, "column", 1, 2, 1, 2, 3, 2);
    layout_add_box(&l, "other", 0, 0, 1, 1, 2, 2);
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_near(r.volume, 20 - 2 + 1 + 2, 1e-12);
    assert_int_equal(r.count, 1);
    solid_report_release(&r);
}

static void many_solids_may_touch_in_one_edge(void **state)
{
    enum { WEDGES = 60 }; /* twice as many faces about the edge */
    struct solid_list list = {0};
    struct solid_report report;
    double area = 0;
    (void)state;
    for (int i = 0; i < WEDGES; i++) {
        const double a = (2 * i + 0.3) * M_PI / WEDGES, b = (2 * i + 1.3) * M_PI / WEDGES;
        const double p[3][2] = {{0, 0},
                                {round(3e3 * cos(a)) / 1e3, round(3e3 * sin(a)) / 1e3},
                                {round(3e3 * cos(b)) / 1e3, round(3e3 * sin(b)) / 1e3}};
        char name[16];
        snprintf(name, sizeof name, "w%d", i);
        add_prism(&list, name, p, 3, 0, 1);
        area += 0.5 * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    unite(&mesh, &report, NULL, &list);
    assert_int_equal(report.count, WEDGES);
    assert_int_equal(mesh.face_count, 5 * WEDGES);
    assert_near(report.volume, area, 1e-4);
    solid_report_release(&report);
}

static void slivers_and_small_faces_are_kept(void **state)
{
    (void)state;
    struct solid_list l = {0};
    layout_add_box(&l, "a", 0, 0, 0, 10, 0.2, 2.6);
    layout_add_box(&l, "b", 5, 0.000001, 0, 12, 0.200001, 2.6); /* a step of a millionth */
    check_union(&l, (struct wanted){1, 0, 16, 10, 10, (12 * 0.2 + 5e-6) * 2.6});
    layout_add_box(&l, "thin", 0, 0, 0, 10, 0.000001, 10);
    layout_add_box(&l, "speck", 100, 0, 0, 100.000001, 0.000001, 0.000001);
    check_union(&l, (struct wanted){2, 0, 16, 12, 12, 1e-4 + 1e-18});
    layout_add_box(&l, "floor", 0, 0, -1, 10, 10, 0);
    layout_add_box(&l, "post", 5, 5, 0, 5.001, 5.001, 1); /* a top of a millionth */
    check_union(&l, (struct wanted){1, 0, 16, 11, 12, 100 + 1e-6});
    /* turned by four units of a normal: faces that are nearly parallel */
    const double tiny = ldexp(1, -20);
    add_turned_wall(&l, "a", -500, 0, 0, 1000, 0.2, 0, 2.6);
    add_turned_wall(&l, "b", -500, 0, tiny * 180 / M_PI, 1000, 0.2, 0, 2.6);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_near(r.volume, (1000 * 0.2 + 0.5 * 1000 * 1000 * tiny) * 2.6, 0.01);
    solid_report_release(&r);
}

static void oblique_planes_that_nearly_coincide_are_one(void **state)
{
    (void)state;
    struct solid_list l = {0};
    const double a = 30.3 * M_PI / 180;
    add_turned_wall(&l, "a", 1, 2, 30.3, 3, 0.2, 0, 2.6);
    add_turned_wall(&l, "b", 1 + 3 * cos(a), 2 + 3 * sin(a), 30.3 + 1e-6, 4, 0.2, 0, 2.6);
    struct solid_report r = {0};
    solid_mesh_release(&mesh);
    unite(&mesh, &r, NULL, &l);
    assert_int_equal(mesh.face_count, 6);
    assert_int_equal(mesh.vertex_count, 8);
    assert_near(r.volume, 7 * 0.2 * 2.6, 1e-4);
    solid_report_release(&r);
}

static void the_file_is_the_same_every_time(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    for (int i = 0; i < 3; i++) {
        struct solid_list l = {0};
        struct solid_report r = {0};
        parallel_set_threads(i + 1);
        for (int k = 0; k < 30; k++) {
            layout_add_box(&l, "box", k % 5, k / 5, 0, k % 5 + 1.5, k / 5 + 0.3, 1 + k % 3);
            add_turned_wall(&l, "wall", k % 7, k % 3, 17.7 * k, 3, 0.2, 0, 2);
        }
        solid_mesh_release(&mesh);
        unite(&mesh, &r, NULL, &l);
        char name[16];
        snprintf(name, sizeof name, "%d.txt", i);
        assert_ok(solid_mesh_write(&mesh, scratch_path(name), NULL, &err), err);
        if (i) {
            char *first = scratch_read(scratch_path("0.txt"));
            assert_file_text(scratch_path(name), first);
            free(first);
        }
        solid_report_release(&r);
    }
    parallel_set_threads(0);
}

static void invalid_solids_are_refused(void **state)
{
    (void)state;
    static const struct {
        double box[6];
        const char *words;
    } cases[] = {{{0, 0, 0, 1, 1, 0}, "empty, or flat"},
                 {{0, 0, 0, 1, 1, 0.0000004}, "empty, or flat"},
                 {{2, 0, 0, 1, 1, 1}, "empty, or flat"},
                 {{0, 0, 0, 1, 1, 1001.5}, "beyond 1000 units"},
                 {{0, 0, 0, 1, 1, 1e300}, "beyond 1000 units"}};
    for (int i = 0; i < 5; i++) {
        struct solid_list l = {0};
        struct unite_log log = {0};
        struct err err = ERR_INIT;
        const double *b = cases[i].box;
        layout_add_box(&l, "good", 0, 0, 0, 1, 1, 1);
        layout_add_box(&l, "bad", b[0], b[1], b[2], b[3], b[4], b[5]);
        solid_mesh_release(&mesh);
        assert_int_equal(unite_solids(&mesh, &l, &log, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i].words);
        assert_contains(err.text, "bad/x0");
        assert_null(mesh.faces);
        assert_null(log.notes);
        solid_list_release(&l);
    }
    struct solid_list l = {0};
    struct err err = ERR_INIT;
    const struct half_space open[4] = {
        {{1, 0, 0}, 1, "a"}, {{-1, 0, 0}, 1, "b"}, {{0, 1, 0}, 1, "c"}, {{0, -1, 0}, 1, "d"}};
    assert_ok(solid_list_add(&l, "walls", open, 4, &err), err);
    unite_solids(&mesh, &l, NULL, &err);
    assert_err(err, ST_DATA, "is not bounded");
    const struct half_space wrong[] = {{{0, 0, 0}, 1, "a"}, {{NAN, 0, 0}, 1, "b"}, {{1, 0, 0}, INFINITY, "c"}};
    for (int i = 0; i < 3; i++) {
        const struct half_space four[4] = {open[0], open[1], open[2], wrong[i]};
        err = (struct err)ERR_INIT;
        solid_list_add(&l, "walls", four, 4, &err);
        assert_err(err, ST_DATA, wrong[i].name);
    }
    err = (struct err)ERR_INIT;
    solid_list_add(&l, "walls", open, 3, &err);
    assert_err(err, ST_DATA, "3 half-spaces");
    solid_list_release(&l);
    solid_list_release(&l);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(a_box_is_its_own_union, release_mesh),
        cmocka_unit_test_teardown(no_solids_make_an_empty_mesh, release_mesh),
        cmocka_unit_test_teardown(adjacent_boxes_become_one, release_mesh),
        cmocka_unit_test_teardown(planes_that_differ_by_rounding_are_one, release_mesh),
        cmocka_unit_test_teardown(overlapping_boxes_are_united, release_mesh),
        cmocka_unit_test_teardown(solids_inside_others_vanish, release_mesh),
        cmocka_unit_test_teardown(solids_that_touch_in_an_edge_or_a_point_stay_separate, release_mesh),
        cmocka_unit_test_teardown(one_of_two_edges_between_the_same_vertices_is_split, release_mesh),
        cmocka_unit_test_teardown(a_face_partly_shared_gets_a_hole, release_mesh),
        cmocka_unit_test_teardown(floors_of_two_rooms_are_two_faces, release_mesh),
        cmocka_unit_test_teardown(four_walls_are_a_ring, release_mesh),
        cmocka_unit_test_teardown(glass_in_a_window_is_a_separate_body, release_mesh),
        cmocka_unit_test_teardown(walls_join_in_t_l_and_cross_junctions, release_mesh),
        cmocka_unit_test_teardown(coincident_solids_count_once, release_mesh),
        cmocka_unit_test_teardown(a_cavity_is_a_separate_shell, release_mesh),
        cmocka_unit_test_teardown(pieces_under_one_slope_share_its_plane, release_mesh),
        cmocka_unit_test_teardown(angled_walls_have_the_right_volume, release_mesh),
        cmocka_unit_test_teardown(a_wall_at_45_degrees_may_pass_through_corners, release_mesh),
        cmocka_unit_test_teardown(a_hole_may_touch_the_outer_edge_in_a_point, release_mesh),
        cmocka_unit_test_teardown(many_solids_may_touch_in_one_edge, release_mesh),
        cmocka_unit_test_teardown(slivers_and_small_faces_are_kept, release_mesh),
        cmocka_unit_test_teardown(oblique_planes_that_nearly_coincide_are_one, release_mesh),
        cmocka_unit_test_setup_teardown(the_file_is_the_same_every_time, scratch_make, scratch_remove),
        cmocka_unit_test_teardown(invalid_solids_are_refused, release_mesh),
    };
    const int failed = cmocka_run_group_tests(tests, NULL, NULL);
    solid_mesh_release(&mesh);
    return failed;
}
