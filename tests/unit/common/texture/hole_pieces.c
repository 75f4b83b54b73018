/* hole_pieces.c - which pieces beside a hole count as furniture, on walls whose every texel is known. */
#include "common/texture/hole_pieces.h"

#include <math.h>
#include <string.h>

#include "tests/unit/scratch.h"

/* A wall of one grey with a hole of 16 x 16 texels in its middle. */
enum { SIDE = 64, TEXELS = SIDE * SIDE, LOW = 24, HIGH = 40 };
#define EDGE 0.1f
#define WALL 0.7f

struct wall {
    float value[TEXELS * 3];
    uint8_t hole[TEXELS], seen[TEXELS], piece[TEXELS];
};

static void paint(struct wall *w, int x0, int y0, int x1, int y1, float colour)
{
    for (int y = y0; y < y1; y++)
        for (int x = x0; x < x1; x++)
            for (int k = 0; k < 3; k++) w->value[3 * (y * SIDE + x) + k] = colour;
}

static void make_wall(struct wall *w)
{
    memset(w, 0, sizeof *w);
    paint(w, 0, 0, SIDE, SIDE, WALL);
    memset(w->seen, 1, TEXELS);
    for (int y = LOW; y < HIGH; y++) {
        memset(w->hole + y * SIDE + LOW, 1, HIGH - LOW);
        memset(w->seen + y * SIDE + LOW, 0, HIGH - LOW);
    }
}

static void find(struct wall *w)
{
    const struct hole_picture picture = {SIDE, SIDE, w->value, w->hole, w->seen};
    struct err err = ERR_INIT;
    memset(w->piece, 7, TEXELS);
    assert_ok(hole_pieces_find(w->piece, &picture, EDGE, &err), err);
}

/* Pieces are the texels of this rectangle that are seen, and no others. */
static void assert_pieces(const struct wall *w, int x0, int y0, int x1, int y1)
{
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const bool in = x >= x0 && x < x1 && y >= y0 && y < y1 && w->seen[y * SIDE + x];
            assert_int_equal(w->piece[y * SIDE + x], in);
        }
}

static void assert_no_pieces(const struct wall *w) { assert_pieces(w, 0, 0, 0, 0); }

static void a_plain_wall_has_no_pieces(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    find(&w);
    assert_no_pieces(&w);
}

static void a_wall_without_holes_has_no_pieces(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    memset(w.hole, 0, TEXELS);
    memset(w.seen, 1, TEXELS);
    paint(&w, HIGH, LOW, HIGH + 3, HIGH, 0.2f);
    find(&w);
    assert_no_pieces(&w);
}

/* The edge of a shelf, along the hole. */
static void a_strip_along_a_hole_is_a_piece(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    paint(&w, HIGH, LOW, HIGH + 3, HIGH, 0.2f);
    find(&w);
    assert_pieces(&w, HIGH, LOW, HIGH + 3, HIGH);
}

/* What is behind the first piece touches that alone. */
static void a_piece_behind_a_piece_is_found(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    paint(&w, HIGH, LOW, HIGH + 6, HIGH, 0.4f);
    paint(&w, HIGH, LOW, HIGH + 3, HIGH, 0.2f);
    find(&w);
    assert_pieces(&w, HIGH, LOW, HIGH + 6, HIGH);
}

/* A print reaches 12 texels from the hole. */
static void what_reaches_farther_than_eight_texels_stays(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    paint(&w, HIGH, LOW, HIGH + 8, HIGH, 0.2f);
    find(&w);
    assert_pieces(&w, HIGH, LOW, HIGH + 8, HIGH);
    paint(&w, HIGH, LOW, HIGH + 12, HIGH, 0.2f);
    find(&w);
    assert_no_pieces(&w);
}

/* A socket with wall all around, two texels from the hole. */
static void what_does_not_touch_stays(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    paint(&w, HIGH + 2, 30, HIGH + 6, 34, 0.2f);
    find(&w);
    assert_no_pieces(&w);
}

/* Less than an edge parts it from the wall. */
static void a_shadow_without_an_edge_stays(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    paint(&w, HIGH, LOW, HIGH + 3, HIGH, WALL - 0.9f * EDGE);
    find(&w);
    assert_no_pieces(&w);
}

/* Bricks of 6 x 3 texels with joints of one: the hole cuts some, but of such bricks the wall is full. */
static void cut_bricks_stay(void **state)
{
    static struct wall w;
    (void)state;
    make_wall(&w);
    for (int row = 0; row < SIDE / 4; row++)
        for (int x = row % 2 ? -4 : 0; x < SIDE; x += 7)
            paint(&w, x < 0 ? 0 : x, 4 * row, x + 6 < SIDE ? x + 6 : SIDE, 4 * row + 3, 0.3f);
    find(&w);
    assert_no_pieces(&w);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_plain_wall_has_no_pieces),
        cmocka_unit_test(a_wall_without_holes_has_no_pieces),
        cmocka_unit_test(a_strip_along_a_hole_is_a_piece),
        cmocka_unit_test(a_piece_behind_a_piece_is_found),
        cmocka_unit_test(what_reaches_farther_than_eight_texels_stays),
        cmocka_unit_test(what_does_not_touch_stays),
        cmocka_unit_test(a_shadow_without_an_edge_stays),
        cmocka_unit_test(cut_bricks_stay),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
