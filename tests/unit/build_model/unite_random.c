/* unite_random.c - unions of random solids against independent results: counted lattice cells, inclusion-exclusion of
 * convex solids; and of random edits, which keep the identity of faces.
 *
 * REMODEL_EDIT_SEQUENCES=N: number of sequences of edits (200); REMODEL_SEED=N: seed of the random numbers. */
#include "tests/unit/build_model/unions.h"

#include "common/base/rng.h"

enum { SIDE = 6, MAX_BOXES = 12 };

struct stream {
    struct rng rng;
    uint64_t at;
};

static struct stream stream_of(const char *what, int index)
{
    const char *seed = getenv("REMODEL_SEED");
    return (struct stream){rng_make(seed ? (uint64_t)atoll(seed) : 1, "unite", what), (uint64_t)index << 32};
}

static int draw(struct stream *s, int below)
{
    const uint64_t at = s->at++;
    return (int)(rng_u32(&s->rng, at >> 32, at) % (unsigned)below);
}

static double real(struct stream *s, double low, double high)
{
    const uint64_t at = s->at++;
    return low + (high - low) * rng_uniform(&s->rng, at >> 32, at);
}

/* A box of lattice cells. */
struct cells {
    int low[3], high[3];
};

static struct cells random_cells(struct stream *s, int side, int longest)
{
    struct cells c;
    for (int i = 0; i < 3; i++) {
        c.low[i] = draw(s, side);
        const int room = side - c.low[i];
        c.high[i] = c.low[i] + 1 + draw(s, room < longest ? room : longest);
    }
    return c;
}

static int count_cells(const struct cells *boxes, int count)
{
    int n = 0;
    for (int x = 0; x < SIDE; x++)
        for (int y = 0; y < SIDE; y++)
            for (int z = 0; z < SIDE; z++) {
                bool in = false;
                for (int i = 0; i < count && !in; i++)
                    in = x >= boxes[i].low[0] && x < boxes[i].high[0] && y >= boxes[i].low[1] && y < boxes[i].high[1] &&
                         z >= boxes[i].low[2] && z < boxes[i].high[2];
                n += in;
            }
    return n;
}

static void boxes_on_a_coarse_lattice_have_the_volume_of_their_cells(void **state)
{
    (void)state;
    for (int i = 0; i < 1000; i++) {
        struct stream s = stream_of("lattice", i);
        struct cells boxes[16];
        struct solid_list l = {0};
        struct solid_mesh mesh = {0};
        struct solid_report r = {0};
        const int count = 1 + draw(&s, 16), side = 3 + draw(&s, SIDE - 2), longest = 1 + draw(&s, side);
        const double unit = i % 2 ? 0.1 : 1;
        for (int k = 0; k < count; k++) {
            const struct cells c = boxes[k] = random_cells(&s, side, longest);
            layout_add_box(&l, "b", unit * c.low[0], unit * c.low[1], unit * c.low[2], unit * c.high[0],
                           unit * c.high[1], unit * c.high[2]);
        }
        unite(&mesh, &r, NULL, &l);
        assert_near(r.volume / (unit * unit * unit), count_cells(boxes, count), 1e-9);
        solid_report_release(&r);
        solid_mesh_release(&mesh);
    }
}

/* Solids in reverse order give the same surface. */
static void the_order_of_solids_changes_only_names(void **state)
{
    (void)state;
    for (int i = 0; i < 100; i++) {
        struct stream s = stream_of("order", i);
        struct cells boxes[MAX_BOXES];
        struct solid_mesh meshes[2] = {{0}};
        struct solid_report reports[2] = {{0}};
        for (int k = 0; k < MAX_BOXES; k++) boxes[k] = random_cells(&s, SIDE, 3);
        for (int o = 0; o < 2; o++) {
            struct solid_list l = {0};
            for (int k = 0; k < MAX_BOXES; k++) {
                const int b = o ? MAX_BOXES - 1 - k : k;
                const struct cells *c = &boxes[b];
                layout_add_box(&l, "b", c->low[0], c->low[1], c->low[2], c->high[0], c->high[1], c->high[2]);
                const double a = 25.0 * b;
                add_turned_wall(&l, "w", c->low[0], c->low[1], a, 2, 0.5, c->low[2], c->high[2]);
            }
            unite(&meshes[o], &reports[o], NULL, &l);
        }
        assert_int_equal(meshes[0].vertex_count, meshes[1].vertex_count);
        assert_int_equal(meshes[0].half_edge_count, meshes[1].half_edge_count);
        assert_int_equal(meshes[0].face_count, meshes[1].face_count);
        assert_int_equal(meshes[0].loop_count, meshes[1].loop_count);
        assert_int_equal(reports[0].count, reports[1].count);
        assert_near(reports[0].volume, reports[1].volume, 1e-9);
        for (int o = 0; o < 2; o++) {
            solid_mesh_release(&meshes[o]);
            solid_report_release(&reports[o]);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ convex polyhedra */

enum { MAX_PLANES = 14 };

struct polyhedron {
    struct half_space h[MAX_PLANES];
    int count;
};

/* A rotated box, a prism or a clipped ball, near the middle. */
static struct polyhedron random_polyhedron(struct stream *s, double scale)
{
    struct polyhedron p = {.count = 6};
    const struct vec3 at = {real(s, -1, 1), real(s, -1, 1), real(s, -1, 1)};
    const int kind = draw(s, 3);
    const double a = real(s, 0, M_PI);
    const struct vec3 axes[3] = {{cos(a), sin(a), 0}, {-sin(a), cos(a), 0}, {0, 0, 1}};
    if (kind == 2) p.count = 8 + draw(s, MAX_PLANES - 7);
    for (int i = 0; i < p.count; i++) {
        struct vec3 n = vec3_scale(axes[i / 2 % 3], i % 2 ? 1 : -1);
        if (kind && i > 3)
            n = vec3_normalize(vec3_add(n, vec3_make(real(s, -0.4, 0.4), real(s, -0.4, 0.4), real(s, -0.4, 0.4))));
        p.h[i] = (struct half_space){n, scale * (vec3_dot(n, at) + real(s, 0.2, 1.2)), "face"};
    }
    return p;
}

/* Volume of the intersection of several polyhedra, one convex solid. */
static double common_volume(const struct polyhedron *p, int count, unsigned members)
{
    struct half_space h[4 * MAX_PLANES];
    struct solid_list l = {0};
    struct solid_mesh mesh = {0};
    struct err err = ERR_INIT;
    int n = 0;
    for (int i = 0; i < count; i++)
        if (members >> i & 1)
            for (int k = 0; k < p[i].count; k++) h[n++] = p[i].h[k];
    assert_ok(solid_list_add(&l, "walls", h, n, &err), err);
    const enum status st = unite_solids(&mesh, &l, NULL, &err);
    if (st) assert_contains(err.text, "empty, or flat");
    const double v = st ? 0 : solid_mesh_volume(&mesh, -1);
    solid_mesh_release(&mesh);
    solid_list_release(&l);
    return v;
}

static void polyhedra_agree_with_inclusion_and_exclusion(void **state)
{
    (void)state;
    for (int i = 0; i < 300; i++) {
        struct stream s = stream_of("polyhedra", i);
        struct polyhedron p[4];
        struct solid_list l = {0};
        struct solid_mesh mesh = {0};
        struct solid_report r = {0};
        struct err err = ERR_INIT;
        const int count = 2 + draw(&s, 3);
        const double scale = i % 3 ? 1 : 100; /* large numbers come near their bounds */
        double volume = 0;
        for (int k = 0; k < count; k++) {
            p[k] = random_polyhedron(&s, scale);
            /* some share a plane with the one before, with the same or the opposite normal */
            if (k && draw(&s, 2)) {
                const struct half_space *from = &p[k - 1].h[draw(&s, p[k - 1].count)];
                struct half_space *to = &p[k].h[p[k].count < MAX_PLANES ? p[k].count++ : 0];
                *to = *from;
                if (draw(&s, 2)) {
                    to->normal = vec3_scale(from->normal, -1);
                    to->offset = -from->offset;
                }
            }
            if (common_volume(&p[k], 1, 1) == 0) p[k] = p[0]; /* nothing is left: take the first one again */
            assert_ok(solid_list_add(&l, "walls", p[k].h, p[k].count, &err), err);
        }
        for (unsigned m = 1; m < 1u << count; m++)
            volume += (__builtin_popcount(m) % 2 ? 1 : -1) * common_volume(p, count, m);
        unite(&mesh, &r, NULL, &l);
        assert_near(r.volume, volume, 1e-9 * fmax(1, volume));
        solid_report_release(&r);
        solid_mesh_release(&mesh);
    }
}

/* Prisms over polygons with corners on a lattice, so that oblique planes also meet in points, edges and planes. */
static void prisms_on_a_lattice_have_the_volume_of_their_slices(void **state)
{
    (void)state;
    for (int i = 0; i < 300; i++) {
        struct stream s = stream_of("prisms", i);
        struct solid_list l = {0}, reversed = {0};
        struct solid_mesh mesh = {0}, other = {0};
        struct solid_report r = {0}, r2 = {0};
        double t[8][3][2];
        int z[8];
        const int count = 2 + draw(&s, 7);
        for (int k = 0; k < count; k++) {
            double turn;
            do {
                for (int c = 0; c < 3; c++)
                    for (int a = 0; a < 2; a++) t[k][c][a] = draw(&s, 5);
                turn = (t[k][1][0] - t[k][0][0]) * (t[k][2][1] - t[k][0][1]) -
                       (t[k][1][1] - t[k][0][1]) * (t[k][2][0] - t[k][0][0]);
            } while (!(turn > 0));
            z[k] = draw(&s, 3);
        }
        for (int k = 0; k < count; k++) {
            add_prism(&l, "p", t[k], 3, z[k], z[k] + 1);
            add_prism(&reversed, "p", t[count - 1 - k], 3, z[count - 1 - k], z[count - 1 - k] + 1);
        }
        unite(&mesh, &r, NULL, &l);
        unite(&other, &r2, NULL, &reversed);
        assert_near(r.volume, r2.volume, 1e-9);
        assert_int_equal(mesh.vertex_count, other.vertex_count);
        assert_int_equal(mesh.face_count, other.face_count);
        /* each layer separately, its area from slices off the lattice */
        double volume = 0;
        enum { SLICES = 2000 };
        for (int layer = 0; layer < 4; layer++)
            for (int y = 0; y < SLICES; y++) {
                double from[8], to[8];
                const double at = 4 * (y + 0.5) / SLICES;
                int n = 0;
                for (int k = 0; k < count; k++) {
                    double low = INFINITY, high = -INFINITY;
                    if (z[k] != layer) continue;
                    for (int c = 0; c < 3; c++) {
                        const double *a = t[k][c], *b = t[k][(c + 1) % 3];
                        if ((a[1] > at) == (b[1] > at)) continue;
                        const double x = a[0] + (at - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
                        low = fmin(low, x);
                        high = fmax(high, x);
                    }
                    if (low < high) {
                        int m = n++;
                        for (; m > 0 && from[m - 1] > low; m--) {
                            from[m] = from[m - 1];
                            to[m] = to[m - 1];
                        }
                        from[m] = low;
                        to[m] = high;
                    }
                }
                double reached = -INFINITY;
                for (int k = 0; k < n; k++) {
                    volume += fmax(0, to[k] - fmax(from[k], reached)) * 4 / SLICES;
                    reached = fmax(reached, to[k]);
                }
            }
        assert_near(r.volume, volume, 0.01);
        solid_report_release(&r);
        solid_report_release(&r2);
        solid_mesh_release(&mesh);
        solid_mesh_release(&other);
    }
}

/* ----------------------------------------------------------------------------------------------------------- edits */

struct piece {
    struct cells cells;
    int name; /* 0: absent */
};

static void unite_pieces(struct solid_mesh *mesh, const struct piece *pieces)
{
    struct solid_list l = {0};
    struct solid_report r = {0};
    struct cells boxes[MAX_BOXES];
    int count = 0;
    for (int i = 0; i < MAX_BOXES; i++) {
        char name[16];
        if (!pieces[i].name) continue;
        const struct cells *c = &pieces[i].cells;
        snprintf(name, sizeof name, "box%d", pieces[i].name);
        layout_add_box(&l, name, 0.3 * c->low[0], 0.3 * c->low[1], 0.3 * c->low[2], 0.3 * c->high[0], 0.3 * c->high[1],
                       0.3 * c->high[2]);
        boxes[count++] = *c;
    }
    unite(mesh, &r, NULL, &l);
    assert_near(r.volume / 0.027, count_cells(boxes, count), 1e-9);
    solid_report_release(&r);
}

/* Names in both meshes have the same id; names in the edited mesh alone have ids that the base never used. */
static void assert_identity(const struct solid_mesh *base, const struct solid_mesh *edited)
{
    const int last = base->name_count ? base->names[base->name_count - 1].id : 0;
    for (int i = 0; i < edited->name_count; i++) {
        const int id = id_of(base, edited->names[i].name);
        if (id)
            assert_int_equal(edited->names[i].id, id);
        else
            assert_true(edited->names[i].id > last);
        if (i) assert_true(edited->names[i].id > edited->names[i - 1].id);
    }
}

static void edit(struct piece *pieces, int *names, struct stream *s)
{
    const int i = draw(s, MAX_BOXES);
    struct piece *p = &pieces[i];
    struct cells *c = &p->cells;
    switch (p->name ? 1 + draw(s, 4) : 0) {
    case 0: /* add */
        *p = (struct piece){random_cells(s, SIDE, 4), ++*names};
        break;
    case 1: /* remove */
        p->name = 0;
        break;
    case 2: { /* move */
        const int a = draw(s, 3), by = draw(s, 2) ? 1 : -1;
        if (c->low[a] + by < 0 || c->high[a] + by > SIDE) break;
        c->low[a] += by;
        c->high[a] += by;
        break;
    }
    default: { /* resize */
        const int a = draw(s, 3), by = draw(s, 2) ? 1 : -1;
        int *end = draw(s, 2) ? &c->high[a] : &c->low[a];
        *end += by;
        if (c->low[a] < 0 || c->high[a] > SIDE || c->low[a] >= c->high[a]) *end -= by;
    }
    }
}

static void any_sequence_of_edits_gives_a_closed_solid(void **state)
{
    (void)state;
    const char *text = getenv("REMODEL_EDIT_SEQUENCES");
    const int sequences = text ? atoi(text) : 200;
    long unions = 0;
    for (int i = 0; i < sequences; i++) {
        struct stream s = stream_of("edits", i);
        struct piece pieces[MAX_BOXES] = {{{{0}, {0}}, 0}};
        struct solid_mesh base = {0};
        struct err err = ERR_INIT;
        int names = 0;
        const int begun = 3 + draw(&s, 5), edits = 4 + draw(&s, 9);
        for (int k = 0; k < begun; k++) pieces[k] = (struct piece){random_cells(&s, SIDE, 4), ++names};
        unite_pieces(&base, pieces);
        for (int k = 0; k < edits; k++, unions++) {
            struct solid_mesh edited = {0};
            edit(pieces, &names, &s);
            unite_pieces(&edited, pieces);
            assert_ok(solid_mesh_carry_ids(&edited, &base, &err), err);
            assert_identity(&base, &edited);
            solid_mesh_release(&base);
            base = edited;
        }
        solid_mesh_release(&base);
    }
    if (text) print_message("%d sequences, %ld edits\n", sequences, unions);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_on_a_coarse_lattice_have_the_volume_of_their_cells),
        cmocka_unit_test(the_order_of_solids_changes_only_names),
        cmocka_unit_test(polyhedra_agree_with_inclusion_and_exclusion),
        cmocka_unit_test(prisms_on_a_lattice_have_the_volume_of_their_slices),
        cmocka_unit_test(any_sequence_of_edits_gives_a_closed_solid),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
