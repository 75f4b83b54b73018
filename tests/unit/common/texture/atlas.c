/* atlas.c - packing of tiles, look-ups, and atlases on disk. */
#include "common/texture/atlas.h"

#include "tests/unit/scratch.h"

#include <errno.h>

#include "common/base/clock.h"
#include "common/base/rng.h"
#include "common/image/exr.h"

/* ---------------------------------------------------------------------------------------------------------- packing */

/* An atlas of `count` tiles of sides from `least` to `most`; the caller releases it. */
static void make_tiles(struct atlas *a, int count, int least, int most)
{
    const struct rng rng = rng_make(1, "atlas", "tiles");
    *a = (struct atlas){.tiles = calloc((size_t)count, sizeof *a->tiles), .tile_count = count};
    assert_non_null(a->tiles);
    for (int i = 0; i < count; i++) {
        const uint32_t span = (uint32_t)(most - least + 1);
        a->tiles[i].face = i + 1;
        a->tiles[i].width = least + (int)(rng_u32(&rng, (uint64_t)i, 0) % span);
        a->tiles[i].height = least + (int)(rng_u32(&rng, (uint64_t)i, 1) % span);
    }
}

static void pack(struct atlas *a)
{
    struct err err = ERR_INIT;
    assert_ok(atlas_pack(a, &err), err);
}

/* Marks the texels of each tile on its page; fails if one is marked already. Returns the share of the pages' area. */
static double mark_tiles(const struct atlas *a)
{
    const size_t side = ATLAS_PAGE;
    unsigned char *taken = calloc((size_t)a->page_count, side * side);
    double used = 0, area = 0;
    assert_non_null(taken);
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *t = &a->tiles[i];
        assert_in_range(t->page, 0, a->page_count - 1);
        assert_true(t->x >= 0 && t->y >= 0 && t->x + t->width <= a->page_sizes[t->page][0] &&
                    t->y + t->height <= a->page_sizes[t->page][1]);
        for (int y = t->y; y < t->y + t->height; y++)
            for (int x = t->x; x < t->x + t->width; x++) {
                unsigned char *at = taken + ((size_t)t->page * side + (size_t)y) * side + (size_t)x;
                if (*at) fail_msg("texel (%d, %d) of page %d is taken twice", x, y, t->page);
                *at = 1;
            }
        used += (double)t->width * t->height;
    }
    for (int i = 0; i < a->page_count; i++) area += (double)a->page_sizes[i][0] * a->page_sizes[i][1];
    free(taken);
    return used / area;
}

static void tiles_do_not_overlap_and_fill_their_pages(void **state)
{
    (void)state;
    static const struct {
        int count, least, most;
        double fill;
    } sets[] = {
        {2000, 4, 60, 0.99}, {300, 10, 300, 0.95}, {40, 200, 700, 0.89}, {1, 1, 1, 1}, {3000, 3, 3, 3000.0 / 3069}};
    for (size_t i = 0; i < sizeof sets / sizeof *sets; i++) {
        struct atlas a;
        make_tiles(&a, sets[i].count, sets[i].least, sets[i].most);
        pack(&a);
        const double fill = mark_tiles(&a);
        print_message("%d tiles of %d to %d: %d pages, %.1f %% filled\n", sets[i].count, sets[i].least, sets[i].most,
                      a.page_count, 100 * fill);
        if (!(fill >= sets[i].fill - 1e-12)) fail_msg("filled %.3f, wanted %.3f", fill, sets[i].fill);
        atlas_release(&a);
    }
}

/* Whether a tile could stand at (x, y): no tile that was placed before it overlaps. */
static bool is_free(const struct atlas *a, const struct atlas_tile *t, const bool *placed, int page, int x, int y)
{
    if (x + t->width > ATLAS_PAGE || y + t->height > ATLAS_PAGE) return false;
    for (int i = 0; i < a->tile_count; i++) {
        const struct atlas_tile *o = &a->tiles[i];
        if (placed[i] && o->page == page && x < o->x + o->width && o->x < x + t->width && y < o->y + o->height &&
            o->y < y + t->height)
            return false;
    }
    return true;
}

/* The first place by its definition: every page, row and column in turn. */
static void assert_first_place(const struct atlas *a, const struct atlas_tile *t, const bool *placed)
{
    for (int page = 0; page <= t->page; page++)
        for (int y = 0; y < ATLAS_PAGE; y++)
            for (int x = 0; x < ATLAS_PAGE; x++) {
                if (page == t->page && (y > t->y || (y == t->y && x >= t->x))) return;
                if (is_free(a, t, placed, page, x, y))
                    fail_msg("a tile of %d x %d is at page %d (%d, %d), but fits at page %d (%d, %d)", t->width,
                             t->height, t->page, t->x, t->y, page, x, y);
            }
}

static void each_tile_takes_the_first_place_in_which_it_fits(void **state)
{
    (void)state;
    enum { COUNT = 24 };
    struct atlas a;
    bool placed[COUNT] = {false};
    make_tiles(&a, COUNT, 40, 520);
    a.tiles[7].height = a.tiles[9].height = a.tiles[3].height; /* ties in height, and one in both */
    a.tiles[7].width = a.tiles[9].width;
    pack(&a);
    assert_true(a.page_count > 1);
    for (int n = 0; n < COUNT; n++) {
        int next = -1;
        for (int i = 0; i < COUNT; i++) {
            const struct atlas_tile *t = &a.tiles[i], *best = next < 0 ? NULL : &a.tiles[next];
            if (!placed[i] &&
                (!best || t->height > best->height || (t->height == best->height && t->width > best->width)))
                next = i;
        }
        assert_first_place(&a, &a.tiles[next], placed);
        placed[next] = true;
    }
    atlas_release(&a);
}

static void pages_are_as_small_as_their_tiles(void **state)
{
    (void)state;
    struct atlas a;
    make_tiles(&a, 1, 1, 1);
    pack(&a);
    assert_int_equal(a.page_count, 1);
    assert_int_equal(a.page_sizes[0][0], 1);
    assert_int_equal(a.page_sizes[0][1], 1);
    atlas_release(&a);

    make_tiles(&a, 2, ATLAS_PAGE, ATLAS_PAGE);
    a.tiles[1].width = 3;
    pack(&a);
    assert_int_equal(a.page_count, 2);
    assert_int_equal(a.tiles[0].page, 0);
    assert_int_equal(a.page_sizes[0][0], ATLAS_PAGE);
    assert_int_equal(a.page_sizes[1][0], 3);
    assert_int_equal(a.page_sizes[1][1], ATLAS_PAGE);
    pack(&a); /* again: the same */
    assert_int_equal(a.page_count, 2);
    atlas_release(&a);

    a = (struct atlas){0};
    pack(&a);
    assert_int_equal(a.page_count, 0);
    atlas_release(&a);
    atlas_release(NULL);
    atlas_page_release(NULL);
}

static void a_tile_larger_than_a_page_is_refused(void **state)
{
    (void)state;
    struct atlas a;
    struct err err = ERR_INIT;
    make_tiles(&a, 2, 8, 8);
    a.tiles[1].width = ATLAS_PAGE + 1;
    assert_int_equal(atlas_pack(&a, &err), ST_DATA);
    assert_err(err, ST_DATA, "tile 1 of face 2 has 1025 x 8 texels");
    atlas_release(&a);
}

static void two_thousand_tiles_are_packed_in_50_ms(void **state)
{
    (void)state;
    double best = 1e9;
    for (int i = 0; i < 5; i++) {
        struct atlas a;
        make_tiles(&a, 2000, 1, 200);
        const double began = clock_cpu_seconds();
        pack(&a);
        const double took = clock_cpu_seconds() - began;
        if (took < best) best = took;
        atlas_release(&a);
    }
    print_message("2000 tiles: %.1f ms\n", 1e3 * best);
#if !defined(__SANITIZE_ADDRESS__)
    if (best > 0.05) fail_msg("packing took %.1f ms, wanted 50", 1e3 * best);
#endif
}

/* --------------------------------------------------------------------------------------------------------- look-ups */

/* A tile that shows the plane z = 0 from above: page pixel = (10 X + x, 10 Y + y). */
static struct atlas_tile flat_tile(int x, int y, int width, int height)
{
    return (struct atlas_tile){.face = 1,
                               .view = -1,
                               .x = x,
                               .y = y,
                               .width = width,
                               .height = height,
                               .matrix = {{10, 0, 0, x}, {0, 10, 0, y}, {0, 0, 0, 1}}};
}

static void a_point_counts_inside_the_rectangle_and_in_front_of_the_camera(void **state)
{
    (void)state;
    struct atlas_tile t = flat_tile(3, 5, 20, 10);
    double x, y;
    assert_true(atlas_tile_project(&t, vec3_make(0.25, 0.35, 7), &x, &y));
    assert_float_equal(x, 5.5, 1e-12);
    assert_float_equal(y, 8.5, 1e-12);
    assert_true(atlas_tile_project(&t, vec3_make(0, 0, 0), &x, &y));
    assert_true(atlas_tile_project(&t, vec3_make(2, 1, 0), &x, &y));
    assert_false(atlas_tile_project(&t, vec3_make(2.001, 0.5, 0), &x, &y));
    assert_false(atlas_tile_project(&t, vec3_make(-0.001, 0.5, 0), &x, &y));
    assert_false(atlas_tile_project(&t, vec3_make(1, 1.001, 0), &x, &y));
    assert_false(atlas_tile_project(&t, vec3_make(1, -0.001, 0), &x, &y));

    /* a pinhole that looks along z: behind it, a point has the pixel of its mirror image, and does not count */
    const struct atlas_tile camera = {
        .width = 100, .height = 100, .matrix = {{50, 0, 50, 0}, {0, 50, 50, 0}, {0, 0, 1, 0}}};
    assert_true(atlas_tile_project(&camera, vec3_make(1, 2, 4), &x, &y));
    assert_float_equal(x, 62.5, 1e-12);
    assert_float_equal(y, 75, 1e-12);
    assert_false(atlas_tile_project(&camera, vec3_make(-1, -2, -4), &x, &y));
    assert_false(atlas_tile_project(&camera, vec3_make(0, 0, 0), &x, &y));
}

static void make_page(struct atlas_page *p, int width, int height)
{
    struct err err = ERR_INIT;
    assert_ok(atlas_page_init(p, width, height, &err), err);
}

static void set_texel(struct atlas_page *p, int x, int y, uint32_t source, float red)
{
    const size_t at = (size_t)y * (size_t)p->width + (size_t)x;
    p->source[at] = source;
    p->rgb[3 * at] = red;
    p->rgb[3 * at + 1] = 2 * red;
    p->rgb[3 * at + 2] = 0.5f;
}

static void samples_are_bilinear_over_the_texels_that_exist(void **state)
{
    (void)state;
    const struct atlas_tile t = flat_tile(1, 1, 3, 2);
    struct atlas_page p;
    float rgb[3];
    uint32_t nearest = 99;
    make_page(&p, 5, 4);
    set_texel(&p, 1, 1, ATLAS_VIEWS, 1);
    set_texel(&p, 2, 1, ATLAS_VIEWS + 1, 3);
    set_texel(&p, 1, 2, ATLAS_SYNTHESISED, 5);
    set_texel(&p, 4, 1, ATLAS_VIEWS + 7, 100); /* of another tile */

    assert_true(atlas_sample(rgb, &nearest, &p, &t, 1.5, 1.5)); /* a centre */
    assert_float_equal(rgb[0], 1, 0);
    assert_float_equal(rgb[1], 2, 0);
    assert_int_equal(nearest, ATLAS_VIEWS);
    assert_true(atlas_sample(rgb, &nearest, &p, &t, 2.25, 1.5)); /* between two */
    assert_float_equal(rgb[0], 2.5, 1e-6);
    assert_int_equal(nearest, ATLAS_VIEWS + 1);
    assert_true(atlas_sample(rgb, NULL, &p, &t, 2, 2)); /* three of four exist, with equal weights */
    assert_float_equal(rgb[0], 3, 1e-6);
    assert_float_equal(rgb[2], 0.5, 1e-6);
    assert_true(atlas_sample(rgb, &nearest, &p, &t, 1, 2.9)); /* the rectangle's edge repeats its texels */
    assert_float_equal(rgb[0], 5, 1e-6);
    assert_int_equal(nearest, ATLAS_SYNTHESISED);
    assert_false(atlas_sample(rgb, &nearest, &p, &t, 3.9, 1.5)); /* the neighbour's texel does not count */
    assert_true(atlas_sample(rgb, &nearest, &p, &t, 3.4, 1.5));  /* of the two only the left one exists */
    assert_float_equal(rgb[0], 3, 1e-6);
    atlas_page_release(&p);
}

/* A face of 19 x 4 texels, cut into tiles of 10 texels that share the tenth: columns 0 to 9 and 9 to 18. */
static void a_seam_of_tiles_with_a_shared_texel_is_continuous(void **state)
{
    (void)state;
    struct atlas_tile tiles[4] = {flat_tile(0, 0, 2, 2), flat_tile(0, 4, 10, 4), flat_tile(0, 8, 10, 4),
                                  flat_tile(10, 8, 2, 2)};
    const struct atlas a = {.tiles = tiles, .tile_count = 4};
    struct atlas_page p;
    double x, y, last = -1;
    int changes = 0;
    const struct atlas_tile *before = NULL;
    tiles[1].face = tiles[2].face = 5;
    tiles[3].face = 6;
    tiles[2].matrix[0][3] -= 9; /* its first column is the face's column 9 */
    make_page(&p, 20, 12);
    for (int i = 0; i < 19; i++)
        for (int k = 0; k < 4; k++) {
            const float value = (float)((i * 7) % 5); /* steps of up to 3 between neighbours */
            if (i < 10) set_texel(&p, i, 4 + k, ATLAS_VIEWS, value);
            if (i >= 9) set_texel(&p, i - 9, 8 + k, ATLAS_VIEWS, value);
        }
    for (int i = 0; i <= 19000; i++) { /* steps of a thousandth of a texel */
        float rgb[3];
        const struct atlas_tile *t = atlas_find(&a, 5, vec3_make(1e-4 * i, 0.2, 0), &x, &y);
        assert_non_null(t);
        assert_true(atlas_sample(rgb, NULL, &p, t, x, y));
        if (last >= 0 && fabs(rgb[0] - last) > 0.005)
            fail_msg("a step from %g to %g at %g", last, (double)rgb[0], 1e-3 * i);
        last = rgb[0];
        changes += before && t != before;
        before = t;
    }
    assert_int_equal(changes, 1);
    assert_null(atlas_find(&a, 4, vec3_make(0.1, 0.1, 0), &x, &y));
    assert_null(atlas_find(&a, 7, vec3_make(0.1, 0.1, 0), &x, &y));
    assert_null(atlas_find(&a, 5, vec3_make(0.1, 9, 0), &x, &y));
    assert_ptr_equal(atlas_find(&a, 6, vec3_make(0.1, 0.1, 0), &x, &y), &tiles[3]);
    atlas_page_release(&p);
}

/* ------------------------------------------------------------------------------------------------------------ files */

static const struct provenance prov = {.stage = "test", .version = "0"};

/* A viewpoint of two views with three sources and some tiles of all kinds of texels. */
static void make_atlas(struct atlas *a, struct atlas_page **pages)
{
    make_tiles(a, 30, 30, 500);
    a->viewpoint = strdup("IMG_1");
    a->centre = vec3_make(0.1, -1.0 / 3, 1.6);
    a->views = calloc(2, sizeof *a->views);
    a->sources = calloc(3, sizeof *a->sources);
    assert_true(a->views && a->sources);
    a->views[a->view_count++] = strdup("IMG_1@0");
    a->views[a->view_count++] = strdup("IMG_1@1");
    a->sources[a->source_count++] = strdup("IMG_1@0");
    a->sources[a->source_count++] = strdup("IMG_1@1");
    a->sources[a->source_count++] = strdup("a name with spaces");
    pack(a);
    *pages = calloc((size_t)a->page_count, sizeof **pages);
    assert_non_null(*pages);
    for (int i = 0; i < a->page_count; i++) make_page(&(*pages)[i], a->page_sizes[i][0], a->page_sizes[i][1]);
    for (int i = 0; i < a->tile_count; i++) {
        struct atlas_tile *t = &a->tiles[i];
        t->face = 1 + i / 3;
        t->view = i % 3 / 2;
        for (int k = 0; k < 12; k++) t->matrix[k / 4][k % 4] = (i - 10) / (k + 3.0);
        for (int k = 0; k < t->width; k++)
            set_texel(&(*pages)[t->page], t->x + k, t->y + k % t->height, 1 + (uint32_t)(i + k) % 5, (float)k / 64);
    }
}

static void release_all(struct atlas *a, struct atlas_page *pages)
{
    for (int i = 0; i < a->page_count; i++) atlas_page_release(&pages[i]);
    free(pages);
    atlas_release(a);
}

static void an_atlas_that_is_read_and_written_again_has_the_same_bytes(void **state)
{
    (void)state;
    struct atlas a, b;
    struct atlas_page *pages;
    struct err err = ERR_INIT;
    make_atlas(&a, &pages);
    assert_true(a.page_count > 1);
    assert_ok(atlas_write(&a, pages, scratch_path("one"), &prov, &err), err);
    assert_ok(atlas_read(&b, scratch_path("one"), NULL, &err), err);
    assert_int_equal(b.tile_count, a.tile_count);
    assert_memory_equal(b.tiles, a.tiles, (size_t)a.tile_count * sizeof *a.tiles);
    assert_memory_equal(&b.centre, &a.centre, sizeof a.centre);
    assert_string_equal(b.sources[2], "a name with spaces");
    assert_int_equal(b.view_count, 2);
    for (int i = 0; i < a.page_count; i++) {
        struct atlas_page p;
        assert_ok(atlas_page_read(&p, &b, i, scratch_path("one"), NULL, &err), err);
        const size_t texels = (size_t)p.width * (size_t)p.height;
        assert_memory_equal(p.rgb, pages[i].rgb, 3 * texels * sizeof *p.rgb);
        assert_memory_equal(p.source, pages[i].source, texels * sizeof *p.source);
        assert_ok(atlas_write_page(&p, scratch_path("two"), i, &prov, &err), err);
        atlas_page_release(&p);
        char one[32], two[32];
        snprintf(one, sizeof one, "one/page%d.exr", i);
        snprintf(two, sizeof two, "two/page%d.exr", i);
        char *first = scratch_read(scratch_path(one)), *second = scratch_read(scratch_path(two));
        assert_string_equal(first, second);
        free(first);
        free(second);
    }
    assert_ok(atlas_write_list(&b, scratch_path("two"), &prov, &err), err);
    char *text = scratch_read(scratch_path("one/atlas.txt"));
    assert_file_text(scratch_path("two/atlas.txt"), text);
    free(text);
    atlas_release(&b);
    release_all(&a, pages);
}

static void tiles_are_written_in_order(void **state)
{
    (void)state;
    struct atlas a, b;
    struct atlas_page *pages;
    struct err err = ERR_INIT;
    make_atlas(&a, &pages);
    const struct atlas_tile last = a.tiles[a.tile_count - 1];
    a.tiles[a.tile_count - 1] = a.tiles[0];
    a.tiles[0] = last;
    assert_ok(atlas_write_list(&a, scratch_path("order"), NULL, &err), err);
    assert_ok(atlas_read(&b, scratch_path("order"), NULL, &err), err);
    for (int i = 1; i < b.tile_count; i++) assert_true(b.tiles[i - 1].face <= b.tiles[i].face);
    assert_memory_equal(&b.tiles[b.tile_count - 1], &last, sizeof last);
    atlas_release(&b);
    release_all(&a, pages);
}

static void pages_of_an_earlier_atlas_are_removed(void **state)
{
    (void)state;
    struct atlas a;
    struct atlas_page *pages;
    struct err err = ERR_INIT;
    make_atlas(&a, &pages);
    assert_ok(atlas_write(&a, pages, scratch_path("fewer"), &prov, &err), err);
    assert_int_equal(count_entries(scratch_path("fewer")), 1 + a.page_count);
    const int count = a.page_count;
    a.page_count = a.tile_count = 0;
    assert_ok(atlas_write(&a, pages, scratch_path("fewer"), &prov, &err), err);
    assert_int_equal(count_entries(scratch_path("fewer")), 1);
    a.page_count = count;
    release_all(&a, pages);
}

#define HEAD   "remodel-atlas 1\nviewpoint P 0 0 1\nview P\nsource P\nsource Q\npage 40 30\npage 5 5\n"
#define MATRIX "1 0 0 0 0 1 0 0 0 0 0 1\n"

/* Reads `text` as atlas.txt: it is refused in that line with these words. */
static void assert_refused(const char *text, int line, const char *words)
{
    struct atlas a = {0};
    struct err err = ERR_INIT;
    char where[64];
    if (mkdir(scratch_path("bad"), 0777) && errno != EEXIST) fail_msg("no folder");
    scratch_write("bad/atlas.txt", text);
    assert_int_equal(atlas_read(&a, scratch_path("bad"), NULL, &err), ST_DATA);
    assert_null(a.tiles);
    snprintf(where, sizeof where, "bad/atlas.txt:%d:", line);
    assert_err(err, ST_DATA, where);
    assert_err(err, ST_DATA, words);
}

static void a_damaged_list_is_refused_with_its_line(void **state)
{
    (void)state;
    struct atlas a;
    struct err err = ERR_INIT;
    assert_refused("remodel-atlas 2\n", 1, "version");
    assert_refused("remodel-lenses 1\n", 1, "remodel-atlas");
    assert_refused(HEAD "tile 1 0 0 0 0 40 31 " MATRIX, 8, "height inside the page");
    assert_refused(HEAD "tile 1 0 0 39 0 2 1 " MATRIX, 8, "width inside the page");
    assert_refused(HEAD "tile 1 0 1 5 0 1 1 " MATRIX, 8, "x");
    assert_refused(HEAD "tile 1 0 2 0 0 1 1 " MATRIX, 8, "page");
    assert_refused(HEAD "tile 1 1 0 0 0 1 1 " MATRIX, 8, "view");
    assert_refused(HEAD "tile 1 -1 0 0 0 1 1 " MATRIX, 8, "view");
    assert_refused(HEAD "tile 0 0 0 0 0 1 1 " MATRIX, 8, "face");
    assert_refused(HEAD "tile 1 0 0 0 0 1 1 1 0 0 0 0 nan 0 0 0 0 0 1\n", 8, "matrix");
    assert_refused(HEAD "tile 1 0 0 0 0 1 1 1 0 0 0 0 1 0 0 0 0 0\n", 8, "matrix");
    assert_refused(HEAD "tile 1 0 0 0 0 1 1 1 " MATRIX, 8, "end of the line");
    assert_refused(HEAD "tile 2 0 0 0 0 1 1 " MATRIX "tile 1 0 0 0 0 1 1 " MATRIX, 9, "in order of face");
    assert_refused(HEAD "source R\n", 8, "in order");
    assert_refused(HEAD "line 1\n", 8, "tile");
    assert_refused("remodel-atlas 1\nsource Q\nsource P\n", 3, "a name after Q");
    assert_refused("remodel-atlas 1\nsource Q\nsource Q\n", 3, "a name after Q");
    assert_refused("remodel-atlas 1\npage 1025 1\n", 2, "width");
    assert_refused("remodel-atlas 1\npage 1 0\n", 2, "height");
    assert_refused("remodel-atlas 1\npage 4 4\ntile 1 0 0 0 0 1 1 " MATRIX, 3, "view");
    assert_refused("remodel-atlas 1\nview P\nsource P\n", 3, "a viewpoint before its views");
    assert_refused("remodel-atlas 1\nviewpoint P 0 0 inf\nview P\n", 2, "Z");
    scratch_write("bad/atlas.txt", HEAD "tile 1 0 0 0 0 40 30 " MATRIX "tile 1 0 1 4 4 1 1 " MATRIX);
    assert_ok(atlas_read(&a, scratch_path("bad"), NULL, &err), err);
    assert_int_equal(a.tile_count, 2);
    atlas_release(&a);
}

/* Writes page 0 of a small atlas with one texel as given, and reads it. */
static void assert_page_refused(float red, float alpha, uint32_t source, const char *words)
{
    int size[1][2] = {{2, 1}};
    char *names[1] = {(char *)"P"};
    const struct atlas a = {.sources = names, .source_count = 1, .page_sizes = size, .page_count = 1};
    static const char *const channels[] = {"R", "G", "B", "A", "source"};
    struct exr_image im = {0};
    struct atlas_page p;
    struct err err = ERR_INIT;
    assert_ok(exr_image_init(&im, 2, 1, &err), err);
    for (int k = 0; k < 5; k++)
        assert_ok(exr_add_plane(&im, channels[k], k < 4 ? EXR_HALF : EXR_UINT, NULL, &err), err);
    im.planes[0].f[1] = red;
    im.planes[3].f[1] = alpha;
    im.planes[4].u[1] = source;
    if (mkdir(scratch_path("page"), 0777) && errno != EEXIST) fail_msg("no folder");
    assert_ok(exr_write(&im, scratch_path("page/page0.exr"), &prov, &err), err);
    exr_image_release(&im);
    const enum status st = atlas_page_read(&p, &a, 0, scratch_path("page"), NULL, &err);
    if (!words) {
        assert_ok(st, err);
        size[0][1] = 2;
        atlas_page_release(&p);
        assert_int_equal(atlas_page_read(&p, &a, 0, scratch_path("page"), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, "atlas.txt says 2 x 2");
        return;
    }
    assert_int_equal(st, ST_DATA);
    assert_err(err, ST_DATA, words);
    assert_null(p.rgb);
}

static void a_page_that_is_not_its_atlas_s_is_refused(void **state)
{
    (void)state;
    assert_page_refused(0.5f, 1, ATLAS_VIEWS, NULL);
    assert_page_refused(0.5f, 1, ATLAS_VIEWS + 1, "source 4");
    assert_page_refused(-0.5f, 1, ATLAS_VIEWS, "texel (1, 0) has R G B -0.5");
    assert_page_refused(0.5f, 0, ATLAS_NONE, "R G B 0.5");
    assert_page_refused(0, 1, ATLAS_NONE, "A 1");
    assert_page_refused(0, 0.5f, ATLAS_DEFAULT, "A 0.5");
}

static void negative_colours_are_written_as_0(void **state)
{
    (void)state;
    int size[1][2] = {{1, 1}};
    const struct atlas a = {.page_sizes = size, .page_count = 1};
    struct atlas_page p;
    struct err err = ERR_INIT;
    make_page(&p, 1, 1);
    set_texel(&p, 0, 0, ATLAS_SYNTHESISED, -0.001f);
    assert_ok(atlas_write_page(&p, scratch_path("negative"), 0, &prov, &err), err);
    atlas_page_release(&p);
    assert_ok(atlas_page_read(&p, &a, 0, scratch_path("negative"), NULL, &err), err);
    assert_float_equal(p.rgb[0], 0, 0);
    assert_float_equal(p.rgb[2], 0.5, 0);
    atlas_page_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(tiles_do_not_overlap_and_fill_their_pages),
        cmocka_unit_test(each_tile_takes_the_first_place_in_which_it_fits),
        cmocka_unit_test(pages_are_as_small_as_their_tiles),
        cmocka_unit_test(a_tile_larger_than_a_page_is_refused),
        cmocka_unit_test(two_thousand_tiles_are_packed_in_50_ms),
        cmocka_unit_test(a_point_counts_inside_the_rectangle_and_in_front_of_the_camera),
        cmocka_unit_test(samples_are_bilinear_over_the_texels_that_exist),
        cmocka_unit_test(a_seam_of_tiles_with_a_shared_texel_is_continuous),
        cmocka_unit_test(an_atlas_that_is_read_and_written_again_has_the_same_bytes),
        cmocka_unit_test(tiles_are_written_in_order),
        cmocka_unit_test(pages_of_an_earlier_atlas_are_removed),
        cmocka_unit_test(a_damaged_list_is_refused_with_its_line),
        cmocka_unit_test(a_page_that_is_not_its_atlas_s_is_refused),
        cmocka_unit_test(negative_colours_are_written_as_0),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
