/* solid_mesh.c - small meshes: invalid input, checks, ids, triangles, files. */
#include "common/model/solid_mesh.h"

#include "tests/unit/scratch.h"

/* One or two boxes of 8 vertices and 6 quadrilaterals each. */
struct box {
    struct vec3 vertices[16];
    int corners[12][4], sizes[12];
    struct solid_polygon polygons[12];
    int vertex_count, count;
};

static void add_box(struct box *b, const char *body, struct vec3 low, struct vec3 high, bool inside_out)
{
    static const int quads[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    static const char *const names[6] = {"x0", "x1", "y0", "y1", "z0", "z1"};
    const double offsets[6] = {-low.x, high.x, -low.y, high.y, -low.z, high.z};
    const int first = b->vertex_count;
    for (int i = 0; i < 8; i++)
        b->vertices[b->vertex_count++] =
            vec3_make(i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (int i = 0; i < 6; i++) {
        const int n = b->count++;
        const double s = (i % 2 ? 1 : -1) * (inside_out ? -1 : 1);
        for (int k = 0; k < 4; k++) b->corners[n][k] = first + quads[i][inside_out ? 3 - k : k];
        b->sizes[n] = 4;
        b->polygons[n] = (struct solid_polygon){.name = names[i],
                                                .body = body,
                                                .normal = {i / 2 == 0 ? s : 0, i / 2 == 1 ? s : 0, i / 2 == 2 ? s : 0},
                                                .offset = inside_out ? -offsets[i] : offsets[i],
                                                .corners = b->corners[n],
                                                .sizes = &b->sizes[n],
                                                .loops = 1};
    }
}

static enum status make(struct solid_mesh *mesh, const struct box *b, struct err *err)
{
    *err = (struct err)ERR_INIT;
    return solid_mesh_make(mesh, b->vertices, b->vertex_count, b->polygons, b->count, NULL, err);
}

static void unit_box(struct box *b)
{
    *b = (struct box){.count = 0};
    add_box(b, "body", vec3_make(0, 0, 0), vec3_make(1, 2, 3), false);
}

static void a_box_is_a_valid_mesh(void **state)
{
    (void)state;
    struct box b;
    struct solid_mesh m = {0};
    struct solid_report r = {0};
    struct err err;
    unit_box(&b);
    assert_ok(make(&m, &b, &err), err);
    assert_ok(solid_mesh_check(&m, 0, &r, &err), err);
    assert_int_equal(r.count, 1);
    assert_int_equal(r.shells[0].euler, 2);
    assert_int_equal(r.shells[0].edges, 12);
    assert_float_equal(r.volume, 6, 1e-12);
    assert_float_equal(r.area, 22, 1e-12);
    assert_float_equal(r.shortest_edge, 1, 0);
    assert_true(r.planarity == 0);
    for (int h = 0; h < m.half_edge_count; h++)
        assert_int_equal(m.half_edges[m.half_edges[h].twin].origin, m.half_edges[m.half_edges[h].next].origin);
    solid_report_release(&r);
    solid_mesh_release(&m);
    solid_mesh_release(&m);
    solid_mesh_release(NULL);
}

#define refused(words)                                      \
    do {                                                    \
        struct solid_mesh mesh_ = {0};                      \
        struct err err_;                                    \
        assert_int_equal(make(&mesh_, &b, &err_), ST_DATA); \
        assert_err(err_, ST_DATA, words);                   \
        assert_null(mesh_.faces);                           \
        unit_box(&b);                                       \
    } while (0)

static void meshes_that_are_not_closed_are_refused(void **state)
{
    (void)state;
    struct box b;
    unit_box(&b);
    b.count = 5;
    refused("no face has its opposite");
    b.corners[2][1] = 8;
    refused("face 3, y0: found vertex 8, wanted one from 0 to 7");
    b.corners[2][1] = 0;
    refused("found vertex 0 twice in a row");
    b.sizes[1] = 2;
    refused("a loop of 2 corners");
    b.polygons[1].loops = 0;
    refused("found no loop");
    for (int k = 0; k < 2; k++) { /* one face reversed */
        const int c = b.corners[0][k];
        b.corners[0][k] = b.corners[0][3 - k];
        b.corners[0][3 - k] = c;
    }
    refused("a second time");
    b.vertices[b.vertex_count++] = vec3_make(9, 9, 9);
    refused("vertex 8 belongs to no face");
    b.polygons[3].normal.y = 2;
    refused("a normal of length 2");
    b.polygons[3].offset = NAN;
    refused("a plane that is not finite");
    b.vertices[3].x = INFINITY;
    refused("vertex 3 is not finite");
    b.polygons[4].name = "";
    refused("an empty name");
    b.polygons[2].body = "other";
    refused("wanted a vertex of body other alone");
    add_box(&b, "other", vec3_make(5, 5, 5), vec3_make(6, 6, 6), false);
    b.polygons[11].body = "body";
    refused("found body body a second time");
    add_box(&b, "body", vec3_make(1, 2, 3), vec3_make(2, 3, 4), false); /* one vertex for two fans */
    for (int i = 6; i < 12; i++)
        for (int k = 0; k < 4; k++)
            if (b.corners[i][k] == 8)
                b.corners[i][k] = 7;
            else
                b.corners[i][k]--;
    for (int i = 8; i < 15; i++) b.vertices[i] = b.vertices[i + 1];
    b.vertex_count = 15;
    for (int i = 6; i < 12; i++) /* vertex 8 became 7 */
        for (int k = 0; k < 4; k++) assert_true(b.corners[i][k] >= 7);
    refused("that touch there");
}

#define faulty(words)                                                        \
    do {                                                                     \
        struct solid_mesh mesh_ = {0};                                       \
        struct err err_;                                                     \
        assert_ok(make(&mesh_, &b, &err_), err_);                            \
        assert_int_equal(solid_mesh_check(&mesh_, 0, NULL, &err_), ST_DATA); \
        assert_err(err_, ST_DATA, words);                                    \
        solid_mesh_release(&mesh_);                                          \
        unit_box(&b);                                                        \
    } while (0)

static void checks_find_faults(void **state)
{
    (void)state;
    struct box b;
    unit_box(&b);
    b.vertices[7].z += 0.001;
    faulty("a vertex is not in its plane");
    b.vertices[1] = b.vertices[0];
    faulty("a vertex is not in its plane");
    b.count = b.vertex_count = 0;
    add_box(&b, "body", vec3_make(0, 0, 0), vec3_make(1, 1, 1), true);
    faulty("inside out");
    add_box(&b, "body", vec3_make(0.5, 0.5, -0.5), vec3_make(1.5, 1.5, 0.5), false);
    faulty("passes through");
    add_box(&b, "body", vec3_make(0.25, 0.25, 0.25), vec3_make(0.75, 0.75, 0.75), false);
    faulty("its shell is inside another one");
    add_box(&b, "body", vec3_make(5, 5, 5), vec3_make(5.5, 5.5, 5.5), true);
    faulty("inside out and not inside another one");
    add_box(&b, "body", vec3_make(1, 0.5, 0.5), vec3_make(2, 1, 1), false);
    faulty("overlap");
    add_box(&b, "body", vec3_make(0, 0, 0), vec3_make(1, 2, 3), false);
    faulty("overlap");

    /* bodies that only touch are valid; so are other bodies anywhere, and cavities */
    static const struct {
        struct vec3 low, high;
        const char *body;
        bool inside_out;
    } valid[] = {{{1, 2, 0}, {2, 3, 1}, "body", false},
                 {{1, 2, 3}, {2, 3, 4}, "body", false},
                 {{0.5, 0.5, 0.5}, {2, 3, 4}, "glass", false},
                 {{0.25, 0.25, 0.25}, {0.75, 0.75, 0.75}, "body", true}};
    for (int i = 0; i < 4; i++) {
        struct solid_mesh m = {0};
        struct solid_report r = {0};
        struct err err;
        unit_box(&b);
        add_box(&b, valid[i].body, valid[i].low, valid[i].high, valid[i].inside_out);
        assert_ok(make(&m, &b, &err), err);
        assert_ok(solid_mesh_check(&m, 0, &r, &err), err);
        assert_int_equal(r.count, 2);
        solid_report_release(&r);
        solid_mesh_release(&m);
    }
}

static void inconsistent_indices_are_found(void **state)
{
    (void)state;
    for (int i = 0; i < 8; i++) {
        struct box b;
        struct solid_mesh m = {0};
        struct err err;
        unit_box(&b);
        assert_ok(make(&m, &b, &err), err);
        if (i == 0) m.half_edges[3].twin = 99;
        if (i == 1) m.half_edges[3].twin = 4;
        if (i == 2) m.half_edges[3].next = 7;
        if (i == 3) m.loops[2].face = 1;
        if (i == 4) m.faces[2].loop = 1;
        if (i == 5) m.bodies[0].faces = 5;
        if (i == 6) m.vertices[2].half_edge = m.vertices[3].half_edge;
        if (i == 7) m.names[2].id = m.names[1].id;
        assert_int_equal(solid_mesh_check(&m, 0, NULL, &err), ST_DATA);
        m.bodies[0].faces = 6;
        solid_mesh_release(&m);
    }
}

static void ids_are_carried_by_name(void **state)
{
    (void)state;
    struct box b;
    struct solid_mesh base = {0}, edited = {0};
    struct err err;
    unit_box(&b);
    assert_ok(make(&base, &b, &err), err);
    b.polygons[0].name = "new/b"; /* removes x0 */
    b.polygons[3].name = "new/a";
    b.polygons[1].name = "z0"; /* in another order */
    b.polygons[4].name = "x1";
    assert_ok(make(&edited, &b, &err), err);
    assert_ok(solid_mesh_carry_ids(&edited, &base, &err), err);
    static const struct {
        const char *name;
        int id;
    } wanted[] = {{"x1", 2}, {"y0", 3}, {"z0", 5}, {"z1", 6}, {"new/b", 7}, {"new/a", 8}};
    assert_int_equal(edited.name_count, 6);
    for (int i = 0; i < 6; i++) {
        assert_string_equal(edited.names[i].name, wanted[i].name);
        assert_int_equal(edited.names[i].id, wanted[i].id);
    }
    assert_string_equal(solid_face_name(&edited, 0), "new/b");
    assert_int_equal(solid_face_id(&edited, 0), 7);
    assert_ok(solid_mesh_check(&edited, 0, NULL, &err), err);
    solid_mesh_release(&base);
    solid_mesh_release(&edited);
}

/* ---------------------------------------------------------------------------------------------------------- plates */

/* A plate of thickness 1 with rows x rows triangular or square holes; with corners in the middle of its sides too. */
static void make_plate(struct solid_mesh *m, int rows, int sides)
{
    const int holes = rows * rows, rim = 8, n = rim + holes * sides;
    struct vec3 *v = calloc(2 * (size_t)n, sizeof *v);
    struct solid_polygon *p = calloc((size_t)n + 2, sizeof *p);
    int *corners = calloc(6 * (size_t)n, sizeof *corners), *sizes = calloc(2 * (size_t)holes + 2, sizeof *sizes);
    int four[1] = {4}, used = 0, count = 0;
    struct err err = ERR_INIT;
    assert_true(v && p && corners && sizes);
    static const double around[8][2] = {{0, 0}, {0.5, 0}, {1, 0}, {1, 0.5}, {1, 1}, {0.5, 1}, {0, 1}, {0, 0.5}};
    for (int i = 0; i < rim; i++) v[i] = vec3_make((rows + 1) * around[i][0], (rows + 1) * around[i][1], 0);
    for (int h = 0; h < holes; h++)
        for (int k = 0; k < sides; k++) { /* clockwise */
            const double a = -2 * M_PI * k / sides + (sides == 4 ? M_PI / 4 : 0.3 * h),
                         r = sides == 4 ? sqrt(0.125) : 0.4;
            v[rim + h * sides + k] = vec3_make(h % rows + 1 + r * cos(a), h / rows + 1 + r * sin(a), 0);
        }
    for (int i = 0; i < n; i++) v[n + i] = vec3_make(v[i].x, v[i].y, 1);
    for (int side = 0; side < 2; side++) {
        p[count++] = (struct solid_polygon){.name = side ? "top" : "bottom",
                                            .body = "plate",
                                            .normal = {0, 0, side ? 1 : -1},
                                            .offset = side,
                                            .corners = corners + used,
                                            .sizes = sizes + side * (holes + 1),
                                            .loops = holes + 1};
        for (int l = 0, first = 0; l <= holes; l++) {
            const int size = l ? sides : rim;
            sizes[side * (holes + 1) + l] = size;
            for (int k = 0; k < size; k++) corners[used++] = side ? n + first + k : first + size - 1 - k;
            first += size;
        }
    }
    for (int l = 0, first = 0; l <= holes; first += l ? sides : rim, l++)
        for (int k = 0, size = l ? sides : rim; k < size; k++) {
            const int a = first + k, b = first + (k + 1) % size;
            const struct vec3 d = vec3_sub(v[b], v[a]), normal = vec3_normalize(vec3_make(d.y, -d.x, 0));
            p[count++] = (struct solid_polygon){.name = l ? "inside" : "rim",
                                                .body = "plate",
                                                .normal = normal,
                                                .offset = vec3_dot(normal, v[a]),
                                                .corners = corners + used,
                                                .sizes = four,
                                                .loops = 1};
            const int quad[4] = {a, b, n + b, n + a};
            for (int c = 0; c < 4; c++) corners[used++] = quad[c];
        }
    assert_ok(solid_mesh_make(m, v, 2 * n, p, count, NULL, &err), err);
    free(v);
    free(p);
    free(corners);
    free(sizes);
}

static void faces_with_holes_become_triangles(void **state)
{
    (void)state;
    for (int sides = 3; sides <= 4; sides++)
        for (int rows = 0; rows <= 12; rows += rows < 3 ? 1 : 9) {
            struct solid_mesh m = {0};
            struct solid_report r = {0};
            struct solid_triangles t = {0};
            struct err err = ERR_INIT;
            make_plate(&m, rows, sides);
            assert_ok(solid_mesh_check(&m, 0, &r, &err), err);
            assert_int_equal(r.shells[0].genus, rows * rows);
            const double hole = sides == 4 ? 0.25 : 3 * sqrt(3) / 4 * 0.16;
            assert_float_equal(r.volume, (rows + 1) * (rows + 1) - rows * rows * hole, 1e-9);
            assert_ok(solid_mesh_triangulate(&t, &m, &err), err);
            assert_int_equal(t.first[1], 8 + rows * rows * (sides + 2) - 2);
            double area = 0;
            for (int i = 0; i < t.first[1]; i++) {
                const int *v = t.triangles[i].v;
                const struct vec3 a = m.vertices[v[0]].p,
                                  n = vec3_cross(vec3_sub(m.vertices[v[1]].p, a), vec3_sub(m.vertices[v[2]].p, a));
                assert_true(n.z < 0);
                area -= 0.5 * n.z;
            }
            assert_float_equal(area, r.volume, 1e-9);
            solid_triangles_release(&t);
            solid_report_release(&r);
            solid_mesh_release(&m);
        }
}

static void a_face_that_crosses_itself_is_refused(void **state)
{
    (void)state;
    struct solid_mesh m = {0};
    struct solid_triangles t = {0};
    struct err err = ERR_INIT;
    make_plate(&m, 0, 4);
    for (int i = 0; i < m.vertex_count; i++) /* move the middle of one side beyond the other side */
        if (m.vertices[i].p.x == 0.5 && m.vertices[i].p.y == 0) m.vertices[i].p.y = 3;
    assert_int_equal(solid_mesh_triangulate(&t, &m, &err), ST_DATA);
    assert_err(err, ST_DATA, "its loops cross");
    assert_null(t.triangles);
    solid_mesh_release(&m);
}

/* ----------------------------------------------------------------------------------------------------------- files */

static void a_written_mesh_is_read_back_exactly(void **state)
{
    (void)state;
    struct solid_mesh m = {0}, again = {0};
    struct err err = ERR_INIT;
    make_plate(&m, 2, 3);
    const int ids[4] = {7, 3, 20, 4};
    assert_ok(solid_mesh_set_ids(&m, ids, &err), err);
    assert_ok(solid_mesh_write(&m, scratch_path("a.txt"), NULL, &err), err);
    assert_ok(solid_mesh_read(&again, scratch_path("a.txt"), NULL, &err), err);
    assert_int_equal(again.face_count, m.face_count);
    assert_int_equal(again.names[0].id, 3);
    assert_int_equal(again.names[3].id, 20);
    for (int i = 0; i < m.vertex_count; i++)
        assert_memory_equal(&again.vertices[i].p, &m.vertices[i].p, sizeof m.vertices[i].p);
    for (int i = 0; i < m.face_count; i++) {
        assert_string_equal(solid_face_name(&again, i), solid_face_name(&m, i));
        assert_int_equal(solid_face_id(&again, i), solid_face_id(&m, i));
        assert_memory_equal(&again.faces[i].normal, &m.faces[i].normal, sizeof m.faces[i].normal);
    }
    for (int h = 0; h < m.half_edge_count; h++) assert_int_equal(again.half_edges[h].twin, m.half_edges[h].twin);
    assert_ok(solid_mesh_write(&again, scratch_path("b.txt"), NULL, &err), err);
    char *first = scratch_read(scratch_path("a.txt"));
    assert_file_text(scratch_path("b.txt"), first);
    free(first);
    solid_mesh_release(&m);
    solid_mesh_release(&again);
}

static void an_empty_mesh_is_valid(void **state)
{
    (void)state;
    struct solid_mesh m = {0};
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_write(&m, scratch_path("e.txt"), NULL, &err), err);
    assert_ok(solid_mesh_read(&m, scratch_path("e.txt"), NULL, &err), err);
    assert_ok(solid_mesh_check(&m, 0, NULL, &err), err);
    solid_mesh_release(&m);
}

#define TETRA                                                                                                   \
    "remodel-model 1\nvertices 4\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 0 0 1\nbodies 1\nbody t 4\n" \
    "face 1 z -0 -0 -1 0 1\nloop 3 0 2 1\nface 2 y 0 -1 0 0 1\nloop 3 0 1 3\nface 3 x -1 0 0 0 1\nloop 3 0 3 2\n"

static void errors_in_files_name_the_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *words;
    } cases[] = {
        {"", ""},
        {"remodel-model 2\n", ":1: "},
        {"remodel-model 1\nvertices -1\n", ":2: "},
        {"remodel-model 1\nvertices 1\nvertex 0 0 nan\n", ":3: "},
        {"remodel-model 1\nvertices 1\nvertex 0 0\n", ":3: "},
        {TETRA, ""},
        {TETRA "face 4 s 0.6 0.6 0.6 0.57 1\nloop 3 1 2 3\n", ":15: face 4, s: found a normal of length"},
        {TETRA "face 4 s 1 0 0 0.57 1\nloop 3 1 2 4\n", ":16: "},
        {TETRA "face 4 s 1 0 0 0.57 1\nloop 2 1 2\n", ":16: "},
        {TETRA "face 4 s 1 0 0 0.57 1\nloop 3 3 2 1\n", ":15: face 4, s: found the edge"},
        {TETRA "face 3 s 1 0 0 0.57 1\nloop 3 1 2 3\n", ":15: found id 3 for \"s\""},
        {TETRA "face 4 x 1 0 0 0.57 1\nloop 3 1 2 3\n", ":15: found id 4 for \"x\", wanted 3"},
        {TETRA "face 0 s 1 0 0 0.57 1\nloop 3 1 2 3\n", ":15: "},
        {TETRA "face 4 s 1 0 0 0.57 1\nloop 3 1 2 3\nmore\n", ":17: "},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct solid_mesh m = {0};
        struct err err = ERR_INIT;
        const char *path = scratch_write("bad.txt", cases[i].text);
        if (solid_mesh_read(&m, path, NULL, &err) == ST_OK) fail_msg("case %zu was read", i);
        assert_err(err, ST_DATA, cases[i].words);
        assert_contains(err.text, "bad.txt");
        assert_null(m.vertices);
    }
    struct solid_mesh m = {0};
    struct err err = ERR_INIT;
    assert_ok(solid_mesh_read(&m, scratch_write("good.txt", TETRA "face 4 s 1 0 0 0 1\nloop 3 1 2 3\n"), NULL, &err),
              err);
    assert_int_equal(m.face_count, 4);
    solid_mesh_release(&m);
    assert_int_equal(solid_mesh_read(&m, scratch_path("none.txt"), NULL, &err), ST_IO);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_box_is_a_valid_mesh),
        cmocka_unit_test(meshes_that_are_not_closed_are_refused),
        cmocka_unit_test(checks_find_faults),
        cmocka_unit_test(inconsistent_indices_are_found),
        cmocka_unit_test(ids_are_carried_by_name),
        cmocka_unit_test(faces_with_holes_become_triangles),
        cmocka_unit_test(a_face_that_crosses_itself_is_refused),
        cmocka_unit_test(a_written_mesh_is_read_back_exactly),
        cmocka_unit_test(an_empty_mesh_is_valid),
        cmocka_unit_test(errors_in_files_name_the_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
