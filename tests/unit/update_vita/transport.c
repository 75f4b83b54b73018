/* Rays from samples: rows that sum to the irradiance, energy in a painted room, objects, the light that is continued
 * behind furniture, the same bits for any threads. */
#include "stages/update_vita/edited_atlas.h"
#include "stages/update_vita/light_rounds.h"

#include "common/base/parallel.h"
#include "common/math/numbers.h"
#include "tests/unit/ball_thing.h"
#include "tests/unit/edit_room.h"

enum { RAYS = 1024 };

struct traced {
    struct light_change change;
    struct edited_atlas atlas;
    struct face_nets nets;
    struct transport transport;
};

/* All but the rays. The edit was written. */
static void prepare(struct traced *t, struct edit *e, double spacing)
{
    bool wanted[6 * MAX_BOXES];
    struct err err = ERR_INIT;
    *t = (struct traced){.nets = {0}};
    assert_ok(light_change_read(&t->change, &e->files, NULL, &err), err);
    const struct solid_mesh *mesh = &t->change.after.model.mesh;
    for (int i = 0; i < mesh->face_count; i++) {
        const int id = solid_face_id(mesh, i);
        wanted[i] = id >= FIRST && id < FIRST + 6;
    }
    assert_ok(edited_atlas_make(&t->atlas, &t->change, e->files.vita, &err), err);
    assert_ok(face_nets_make(&t->nets, mesh, wanted, spacing, &err), err);
    assert_ok(transport_init(&t->transport, &t->change, &t->nets, &err), err);
}

static void trace(struct traced *t, struct edit *e, double spacing)
{
    struct err err = ERR_INIT;
    edit_write(e);
    prepare(t, e, spacing);
    assert_ok(transport_trace(&t->transport, 0, t->transport.count, RAYS, NULL, NULL, &err), err);
}

static void release(struct traced *t)
{
    transport_release(&t->transport);
    face_nets_release(&t->nets);
    edited_atlas_release(&t->atlas);
    light_change_release(&t->change);
}

static struct rgb sum_of(const struct transport_row *row)
{
    struct rgb sum = row->fixed;
    for (int i = 0; i < row->count; i++)
        sum = rgb_add(sum, rgb_make((double)row->entries[i].rgb[0], (double)row->entries[i].rgb[1],
                                    (double)row->entries[i].rgb[2]));
    return sum;
}

static void rows_of_an_unchanged_room_sum_to_the_light_before(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct traced t;
    (void)state;
    e.lights = "disk a 1 0 1.99 0 0 -1 0.2 50 50 50 90 0\n";
    trace(&t, &e, 0.5);
    assert_true(t.transport.count > 200);
    for (int i = 0; i < t.transport.count; i++) {
        const struct transport_row *row = &t.transport.rows[i];
        const struct rgb sum = sum_of(row);
        assert_near(sum.r, row->before.r, 1e-5);
        assert_near(sum.g, row->before.g, 1e-5);
        assert_near(sum.b, row->before.b, 1e-5);
        for (int k = 1; k < row->count; k++) assert_true(row->entries[k - 1].from < row->entries[k].from);
    }
    release(&t);
}

/* Without lamps, a room of one radiance L has the irradiance pi L everywhere. */
static void rows_of_a_uniform_room_sum_to_pi_times_its_radiance(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct traced t;
    (void)state;
    trace(&t, &e, 0.7);
    for (int i = 0; i < t.transport.count; i++) {
        assert_near(sum_of(&t.transport.rows[i]).g, 0.3 * PI, 3e-3);
        assert_near(t.transport.rows[i].before.g, 0.3 * PI, 3e-3);
        assert_near(t.transport.rows[i].fixed.g, 0, 0);
    }
    release(&t);
}

static void assert_equal_rows(const struct transport *s, const struct transport *t)
{
    assert_int_equal(s->count, t->count);
    for (int i = 0; i < s->count; i++) {
        const struct transport_row *a = &s->rows[i], *b = &t->rows[i];
        assert_memory_equal(&a->before, &b->before, sizeof a->before);
        assert_memory_equal(&a->fixed, &b->fixed, sizeof a->fixed);
        assert_int_equal(a->count, b->count);
        for (int k = 0; k < a->count; k++) {
            assert_int_equal(a->entries[k].from, b->entries[k].from);
            assert_memory_equal(a->entries[k].rgb, b->entries[k].rgb, sizeof a->entries[k].rgb);
        }
    }
}

static void threads_do_not_change_a_bit(void **state)
{
    struct edit e = edit_of_closed_room(coloured);
    struct traced one, two;
    (void)state;
    e.lights = "disk a 1 0 1.99 0 0 -1 0.2 50 50 50 90 0\n";
    parallel_set_threads(1);
    trace(&one, &e, 0.7);
    parallel_set_threads(2);
    trace(&two, &e, 0.7);
    parallel_set_threads(0);
    assert_equal_rows(&one.transport, &two.transport);
    release(&one);
    release(&two);
}

/* The mean irradiance over the faces of the room, from the values that rounds found. */
static double mean_irradiance(const struct traced *t, const struct rgb *values)
{
    const struct solid_mesh *mesh = &t->change.after.model.mesh;
    double sum = 0;
    int count = 0;
    for (int i = 0; i < mesh->face_count; i++) {
        const struct solid_face *f = &mesh->faces[i];
        if (!t->nets.nets[i].count) continue;
        for (int y = 0; y < 64; y++)
            for (int x = 0; x < 64; x++) {
                struct net_weights w;
                const double a = -2 + 4 * (x + 0.5) / 64, b = -2 + 4 * (y + 0.5) / 64;
                const struct vec3 p = f->normal.x != 0   ? vec3_make(f->offset * f->normal.x, a, b)
                                      : f->normal.y != 0 ? vec3_make(a, f->offset * f->normal.y, b)
                                                         : vec3_make(a, b, f->offset * f->normal.z);
                assert_true(face_nets_find(&t->nets, i, p, &w));
                for (int k = 0; k < 3; k++) sum += w.weight[k] * values[2 * w.sample[k] + 1].g;
                count++;
            }
    }
    return sum / count;
}

/* What a lamp sends out is what the walls absorb, and the lamp's own front, which is black: with the same irradiance on
 * all of them, it is power / (area (1 - albedo) + front). */
static void a_painted_room_absorbs_what_its_lamp_sends_out(void **state)
{
    static const float albedos[] = {0, 0.5f, 0.95f};
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct texture_rule paint = rule_colour(albedos[k]);
        struct texture_face faces[6];
        struct edit e = edit_of_closed_room(plain);
        struct traced t;
        struct rounds r;
        struct err err = ERR_INIT;
        struct solid_mesh mesh = make_slabs(closed_room, COUNT(closed_room));
        for (int i = 0, n = 0; i < mesh.face_count; i++) {
            const int id = solid_face_id(&mesh, i);
            if (id >= FIRST && id < FIRST + 6)
                faces[n++] = (struct texture_face){.name = (char *)"face",
                                                   .normal = mesh.faces[i].normal,
                                                   .offset = mesh.faces[i].offset,
                                                   .rules = &paint,
                                                   .rule_count = 1,
                                                   .id = id};
        }
        for (int i = 0; i < 6; i++) /* the map is in order of id */
            for (int n = i + 1; n < 6; n++)
                if (faces[n].id < faces[i].id) {
                    const struct texture_face swap = faces[i];
                    faces[i] = faces[n], faces[n] = swap;
                }
        solid_mesh_release(&mesh);
        e.map = (struct texture_map){.faces = faces, .face_count = 6};
        e.lights = "disk a 0.3 0.2 0.5 0 0 -1 0.3 9 9 9 90 0\n"; /* hangs */
        trace(&t, &e, 0.4);
        assert_ok(rounds_run(&r, &t.transport, 1, 1000, 0.002, &err), err);
        assert_true(r.settled);
        const double power = PI * 9 * PI * 0.3 * 0.3, area = 6 * 16;
        const double front = PI * 0.3 * 0.3 * (albedos[k] > 0), absorbed = area * (1 - (double)albedos[k]) + front;
        const double mean = mean_irradiance(&t, r.values);
        print_message("albedo %g: mean irradiance %g, closed form %g\n", (double)albedos[k], mean, power / absorbed);
        assert_near(mean, power / absorbed, 0.015);
        rounds_release(&r);
        release(&t);
    }
}

static const char block[] = "object block mesh.obj %s 1 0 0 0.5 0 1 0 0.5 0 0 1 -2 matt 0.5 0.5 0.5\n";

/* On the floor below an object there is no light; on the floor far from it there is about as much as before. */
static void an_object_that_touches_the_floor_leaves_no_light_under_it(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct traced t;
    int under = 0;
    (void)state;
    e.objects = block;
    e.mesh = cube;
    trace(&t, &e, 0.25);
    assert_int_equal(t.transport.count, t.nets.sample_count + t.change.objects.element_count);
    const int floor = face_named(&t.change.after.model.mesh, "floor/5");
    for (int i = 0; i < t.transport.count; i++) {
        const struct rgb sum = sum_of(&t.transport.rows[i]);
        const struct vec3 p = t.transport.samples[i].after.at;
        assert_true(isfinite(sum.r) && sum.r >= 0 && sum.r < 0.31 * PI);
        if (i >= t.nets.sample_count || t.nets.samples[i].face != floor) continue;
        if (!(p.x > 0.55 && p.x < 1.45 && p.y > 0.55 && p.y < 1.45)) continue;
        under++;
        for (int k = 0; k < t.transport.rows[i].count; k++) /* the inside of the block alone */
            assert_true(t.transport.rows[i].entries[k].from >= 2 * t.nets.sample_count);
        assert_near(rgb_max(t.transport.rows[i].fixed), 0, 0);
    }
    assert_true(under >= 9);
    release(&t);
}

/* ------------------------------------------------------------------------------------------------------------ holes */

/* A black ball over the floor, which an edit clears. It hid the floor below it, which the bake filled. Beyond the hole
 * and a little more the edit may paint the floor. */
#define HOLE 0.55
#define EDGE 0.05

struct cleared {
    struct edit edit;
    struct texture_thing clear;
    struct traced traced;
    double hole; /* its radius */
    int floor;
};

static bool is_in_hole(const struct cleared *c, struct vec3 p) { return hypot(p.x, p.y) < c->hole; }

/* holes: the samples in the hole are marked as filled by the bake. painted: those beyond EDGE are of a new colour. */
static void trace_cleared(struct cleared *c, bool holes, bool painted)
{
    struct err err = ERR_INIT;
    struct transport *t = &c->traced.transport;
    *c = (struct cleared){
        .edit = edit_of_closed_room(plain), .clear = edit_ball(TEXTURE_THING_CLEAR, 0, 0, 0), .hole = HOLE};
    c->edit.map = (struct texture_map){.things = &c->clear, .thing_count = 1};
    edit_write(&c->edit);
    c->edit.files.things = write_ball(vec3_make(0, 0, -1.5), 0.4, 0);
    prepare(&c->traced, &c->edit, 0.2);
    assert_true(c->traced.change.things.changes);
    c->floor = face_named(&c->traced.change.after.model.mesh, "floor/5");
    for (int i = 0; i < c->traced.nets.sample_count; i++) {
        struct light_place *place = &t->samples[i].place;
        if (c->traced.nets.samples[i].face != c->floor) continue;
        if (holes && is_in_hole(c, t->samples[i].after.at)) place->source = LIGHT_SYNTHESISED;
        if (painted && t->samples[i].after.at.x > HOLE + EDGE) place->kind = LIGHT_PLACE_COLOUR;
    }
    assert_ok(transport_trace(t, 0, t->count, RAYS, NULL, NULL, &err), err);
}

/* The least and the most light before the edit on the floor around the hole, which the hole's is to be between. */
static void light_around(double range[2], const struct cleared *c)
{
    range[0] = INFINITY;
    range[1] = -INFINITY;
    for (int i = 0; i < c->traced.nets.sample_count; i++) {
        const struct transport_sample *s = &c->traced.transport.samples[i];
        const struct vec3 p = s->after.at;
        if (c->traced.nets.samples[i].face != c->floor || is_in_hole(c, p) || hypot(p.x, p.y) > c->hole + HOLE)
            continue;
        if (s->place.kind != LIGHT_PLACE_TEXTURE) continue;
        range[0] = fmin(range[0], c->traced.transport.rows[i].before.g);
        range[1] = fmax(range[1], c->traced.transport.rows[i].before.g);
    }
}

static void a_hole_behind_furniture_gets_the_light_around_it(void **state)
{
    static struct cleared shadow, hole;
    double range[2];
    int inside = 0;
    (void)state;
    trace_cleared(&shadow, false, false);
    trace_cleared(&hole, true, false);
    light_around(range, &hole);
    assert_true(range[0] < 0.9 * range[1]); /* the ball's shadow reaches over the rim */
    assert_int_equal(shadow.traced.nets.sample_count, hole.traced.nets.sample_count);
    for (int i = 0; i < hole.traced.nets.sample_count; i++) {
        const struct transport_row *was = &shadow.traced.transport.rows[i], *is = &hole.traced.transport.rows[i];
        const struct vec3 p = hole.traced.transport.samples[i].after.at;
        assert_memory_equal(&is->fixed, &was->fixed, sizeof is->fixed); /* after the edit nothing is continued */
        if (hole.traced.nets.samples[i].face != hole.floor || !is_in_hole(&hole, p)) {
            assert_memory_equal(&is->before, &was->before, sizeof is->before);
            continue;
        }
        inside++;
        assert_true(is->before.g >= range[0] && is->before.g <= range[1]);
        assert_near(is->before.r, is->before.g, 1e-9);
        if (hypot(p.x, p.y) < 0.25) assert_true(is->before.g > 1.5 * was->before.g); /* just below the ball */
    }
    assert_true(inside > 15);
    release(&shadow.traced);
    release(&hole.traced);
}

/* A second ball is put elsewhere, and the first one stays, 0.02 above the floor: seen from there it covers more than
 * (r / d)^2 cos(t) = 0.82 of the hemisphere up to 0.2 from its foot. The light there stays that of its shadow. Further
 * out, in sight, the light around is continued. */
static void the_light_in_a_gap_behind_furniture_that_stays_does_not_change(void **state)
{
    static struct traced t;
    struct edit e = edit_of_closed_room(plain);
    struct texture_thing copy = edit_ball(TEXTURE_THING_MOVE, 1.8, 1.8, 0);
    struct err err = ERR_INIT;
    int hidden = 0, in_sight = 0;
    (void)state;
    copy.name = (char *)"second";
    e.map = (struct texture_map){.things = &copy, .thing_count = 1};
    edit_write(&e);
    e.files.things = write_ball(vec3_make(-0.9, -0.9, -1.35), 0.63, 0);
    prepare(&t, &e, 0.1);
    assert_true(t.change.things.changes);
    const int floor = face_named(&t.change.after.model.mesh, "floor/5");
    for (int i = 0; i < t.nets.sample_count; i++) {
        const struct vec3 p = t.transport.samples[i].after.at;
        if (t.nets.samples[i].face == floor && hypot(p.x + 0.9, p.y + 0.9) < 0.8)
            t.transport.samples[i].place.source = LIGHT_SYNTHESISED;
    }
    assert_ok(transport_trace(&t.transport, 0, t.transport.count, RAYS, NULL, NULL, &err), err);
    for (int i = 0; i < t.nets.sample_count; i++) {
        const struct vec3 p = t.transport.samples[i].after.at;
        const double off = hypot(p.x + 0.9, p.y + 0.9);
        if (t.nets.samples[i].face != floor || off > 0.75) continue;
        const double was = t.transport.rows[i].before.g, is = sum_of(&t.transport.rows[i]).g;
        if (off < 0.2) assert_true(was < 0.22 * 0.3 * PI && is <= was + 1e-5 && is > 0.8 * was);
        if (off > 0.6) assert_true(is < 0.95 * was); /* 0.3 pi and a shadow after, more before */
        hidden += off < 0.2;
        in_sight += off > 0.6;
    }
    assert_true(hidden > 3 && in_sight > 10);
    release(&t);
}

/* Rows send to the block's elements, which now lie behind one more sample, what they sent before. */
static void samples_that_come_later_change_no_row_of_before(void **state)
{
    struct edit e = edit_of_closed_room(plain);
    struct traced t, whole;
    struct err err = ERR_INIT;
    (void)state;
    e.objects = block;
    e.mesh = cube;
    trace(&t, &e, 0.5);
    const int floor = face_named(&t.change.after.model.mesh, "floor/5"), old = t.nets.sample_count;
    const int elements = t.change.objects.element_count;
    struct rgb *sums = malloc((size_t)t.transport.count * sizeof *sums);
    struct rgb *values = malloc(2 * (size_t)t.transport.count * sizeof *values);
    assert_true(sums && values && elements > 0);
    for (int i = 0; i < 2 * t.transport.count; i++) values[i] = rgb_grey(i < 2 * old ? 1 + i % 7 : 50 + i - 2 * old);
    for (int i = 0; i < t.transport.count; i++) sums[i] = transport_gather(&t.transport.rows[i], values);
    assert_ok(face_nets_add(&t.nets, floor, vec3_make(0.1, 0.1, -2), &err), err);
    assert_ok(face_nets_connect(&t.nets, &err), err);
    assert_ok(transport_grow(&t.transport, &err), err);
    assert_int_equal(t.transport.count, old + 1 + elements);
    assert_int_equal(t.transport.rows[old].count, 0);
    values = realloc(values, 2 * (size_t)t.transport.count * sizeof *values);
    assert_non_null(values);
    memmove(values + 2 * old + 2, values + 2 * old, 2 * (size_t)elements * sizeof *values);
    for (int i = 0; i < t.transport.count; i++) {
        if (i == old) continue;
        const struct rgb now = transport_gather(&t.transport.rows[i], values);
        assert_memory_equal(&now, &sums[i - (i > old)], sizeof now);
    }
    prepare(&whole, &e, 0.5);
    assert_ok(face_nets_add(&whole.nets, floor, vec3_make(0.1, 0.1, -2), &err), err);
    assert_ok(face_nets_connect(&whole.nets, &err), err);
    transport_release(&whole.transport);
    assert_ok(transport_init(&whole.transport, &whole.change, &whole.nets, &err), err);
    for (struct transport *at = &t.transport; at; at = at == &t.transport ? &whole.transport : NULL)
        assert_ok(transport_trace(at, 0, at->count, RAYS, NULL, NULL, &err), err);
    assert_equal_rows(&t.transport, &whole.transport);
    free(sums);
    free(values);
    release(&t);
    release(&whole);
}

/* A hole of 40 samples across, as that of a bed: light must come in from its rim to its middle. */
static void the_middle_of_a_large_hole_gets_the_light_around_it(void **state)
{
    enum { SIDE = 60 };
    static struct cleared c;
    struct err err = ERR_INIT;
    struct transport *t = &c.traced.transport;
    bool wanted[6 * MAX_BOXES] = {false};
    double range[2];
    (void)state;
    c = (struct cleared){
        .edit = edit_of_closed_room(plain), .clear = edit_ball(TEXTURE_THING_CLEAR, 0, 0, 0), .hole = 1.3};
    c.edit.map = (struct texture_map){.things = &c.clear, .thing_count = 1};
    edit_write(&c.edit);
    c.edit.files.things = write_ball(vec3_make(0, 0, -1.05), 0.9, 0);
    assert_ok(light_change_read(&c.traced.change, &c.edit.files, NULL, &err), err);
    const struct solid_mesh *mesh = &c.traced.change.after.model.mesh;
    c.floor = face_named(mesh, "floor/5");
    wanted[c.floor] = true; /* the others are not needed here */
    assert_ok(edited_atlas_make(&c.traced.atlas, &c.traced.change, c.edit.files.vita, &err), err);
    assert_ok(face_nets_make(&c.traced.nets, mesh, wanted, 4.0 / SIDE, &err), err);
    assert_ok(transport_init(t, &c.traced.change, &c.traced.nets, &err), err);
    for (int i = 0; i < c.traced.nets.sample_count; i++)
        if (is_in_hole(&c, t->samples[i].after.at)) t->samples[i].place.source = LIGHT_SYNTHESISED;
    assert_ok(transport_trace(t, 0, t->count, RAYS / 2, NULL, NULL, &err), err);
    light_around(range, &c);
    for (int i = 0; i < c.traced.nets.sample_count; i++) {
        const double light = t->rows[i].before.g;
        if (!is_in_hole(&c, t->samples[i].after.at)) continue;
        if (!(light >= range[0] && light <= range[1]))
            fail_msg("at (%.2f, %.2f) there is %.3f, around the hole %.3f to %.3f", t->samples[i].after.at.x,
                     t->samples[i].after.at.y, light, range[0], range[1]);
    }
    release(&c.traced);
}

/* Paint has no light before the edit: the texture around the hole was not continued from there. */
static void paint_beside_a_hole_does_not_darken_it(void **state)
{
    static struct cleared c;
    double range[2];
    (void)state;
    trace_cleared(&c, true, true);
    light_around(range, &c);
    for (int i = 0; i < c.traced.nets.sample_count; i++) {
        const struct transport_sample *s = &c.traced.transport.samples[i];
        if (c.traced.nets.samples[i].face != c.floor || !is_in_hole(&c, s->after.at)) continue;
        const double light = c.traced.transport.rows[i].before.g;
        if (!(light >= range[0] && light <= range[1]))
            fail_msg("at (%.2f, %.2f) there is %.3f, around the hole %.3f to %.3f", s->after.at.x, s->after.at.y, light,
                     range[0], range[1]);
    }
    release(&c.traced);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rows_of_an_unchanged_room_sum_to_the_light_before),
        cmocka_unit_test(rows_of_a_uniform_room_sum_to_pi_times_its_radiance),
        cmocka_unit_test(threads_do_not_change_a_bit),
        cmocka_unit_test(a_painted_room_absorbs_what_its_lamp_sends_out),
        cmocka_unit_test(an_object_that_touches_the_floor_leaves_no_light_under_it),
        cmocka_unit_test(a_hole_behind_furniture_gets_the_light_around_it),
        cmocka_unit_test(the_light_in_a_gap_behind_furniture_that_stays_does_not_change),
        cmocka_unit_test(samples_that_come_later_change_no_row_of_before),
        cmocka_unit_test(the_middle_of_a_large_hole_gets_the_light_around_it),
        cmocka_unit_test(paint_beside_a_hole_does_not_darken_it),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
