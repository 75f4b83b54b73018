/* page_cache.c - pages in memory: their texels, and a bound on how many there are. */
#include "stages/render_model/page_cache.h"

#include "tests/unit/render_model/painted_room.h"

#include "common/texture/model_picture.h"

static const struct box boxes[] = {ROOM_OUTSIDE, ROOM_INSIDE};

static struct view view_of(int i) { return view_at(vec3_make(0.01 * i, 0, -0.5), 0.3 * i, 0, 32, 24, 20); }

static struct page_cache *open_cache(int memory)
{
    struct page_cache *c;
    struct err err = ERR_INIT;
    assert_ok(page_cache_open(&c, scratch_path("vdta"), scratch_path("vita"), memory, &err), err);
    page_cache_next(c, NULL);
    return c;
}

static struct texture_set *find(struct page_cache *c, const char *photo)
{
    struct texture_set *set;
    struct err err = ERR_INIT;
    assert_ok(page_cache_find(c, photo, &set, &err), err);
    return set;
}

static void load_all(struct page_cache *c, struct texture_set *set)
{
    struct err err = ERR_INIT;
    for (int i = 0; i < set->atlas.page_count; i++) assert_ok(page_cache_load(c, set, i, &err), err);
}

static void texels_are_those_of_the_file_in_a_frame_of_nothing(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(boxes, 2);
    const struct view view = view_of(1);
    struct atlas_page page;
    struct err err = ERR_INIT;
    paint_viewpoint(&mesh, &view, "one", NOISE, 0);
    struct page_cache *c = open_cache(100);
    struct texture_set *set = find(c, "one");
    load_all(c, set);
    int texels = 0;
    for (int i = 0; i < set->atlas.tile_count; i++) {
        const struct atlas_tile *t = &set->atlas.tiles[i];
        const struct texture_page *got = &set->pages[t->page];
        assert_ok(atlas_page_read(&page, &set->atlas, t->page, set->folder, NULL, &err), err);
        for (int y = -1; y <= t->height; y++)
            for (int x = -1; x <= t->width; x++) {
                const size_t at = set->first[i] + (size_t)((y + 1) * texture_stride(t) + x + 1);
                const bool inside = x >= 0 && y >= 0 && x < t->width && y < t->height;
                const size_t from = inside ? (size_t)((t->y + y) * page.width + t->x + x) : 0;
                const bool there = inside && page.source[from];
                texels += there;
                assert_int_equal(got->made[at], there ? MADE_ORIGINAL : MADE_NOTHING);
                assert_true(float_from_half(got->texels[4 * at + 3]) == (there ? 1 : 0));
                for (int k = 0; k < 3; k++)
                    assert_true(float_from_half(got->texels[4 * at + (size_t)k]) ==
                                (there ? page.rgb[3 * from + (size_t)k] : 0));
            }
        atlas_page_release(&page);
    }
    assert_true(texels > 32 * 24);
    page_cache_close(c);
    solid_mesh_release(&mesh);
}

/* Each source of a texel has its mark; views of other photos are warped. */
static void what_a_texel_comes_from_is_kept(void **state)
{
    (void)state;
    static const uint32_t sources[] = {ATLAS_NONE,  ATLAS_SYNTHESISED, ATLAS_DEFAULT,
                                       ATLAS_VIEWS, ATLAS_VIEWS + 1,   ATLAS_VIEWS + 2};
    static const enum picture_made wanted[] = {MADE_NOTHING, MADE_SYNTHESISED, MADE_COLOUR,
                                               MADE_WARPED,  MADE_ORIGINAL,    MADE_WARPED};
    char photo[] = "p", first[] = "a", own[] = "b", last[] = "c", *views[] = {own}, *names[] = {first, own, last};
    struct atlas_tile tile = {.face = 1, .width = 6, .height = 1, .matrix = {{1}, {0, 1}, {0, 0, 1}}};
    struct atlas a = {.viewpoint = photo,
                      .views = views,
                      .view_count = 1,
                      .sources = names,
                      .source_count = 3,
                      .tiles = &tile,
                      .tile_count = 1};
    const struct provenance prov = {.stage = "test", .version = "1"};
    struct atlas_page page;
    struct err err = ERR_INIT;
    char folder[512];
    mkdir(scratch_path("vdta"), 0777);
    snprintf(folder, sizeof folder, "%s/p", scratch_path("vdta"));
    mkdir(folder, 0777);
    assert_ok(atlas_pack(&a, &err), err);
    assert_ok(atlas_page_init(&page, 6, 1, &err), err);
    for (int i = 0; i < 6; i++) page.source[i] = sources[i];
    assert_ok(atlas_write(&a, &page, folder, &prov, &err), err);
    struct page_cache *c = open_cache(1);
    struct texture_set *set = find(c, "p");
    load_all(c, set);
    for (int i = 0; i < 6; i++) assert_int_equal(set->pages[0].made[8 + 1 + i], wanted[i]);
    page_cache_close(c);
    atlas_page_release(&page);
    free(a.page_sizes);
}

enum { VIEWPOINTS = 500 };

static void five_hundred_viewpoints_stay_within_the_memory(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(boxes, 1);
    size_t largest = 0;
    char photo[16];
    for (int i = 0; i < VIEWPOINTS; i++) {
        const struct view view = view_of(i);
        snprintf(photo, sizeof photo, "v%03d", i);
        paint_viewpoint(&mesh, &view, photo, FLAT, 1);
    }
    struct page_cache *c = open_cache(1);
    for (int i = 0; i + 1 < VIEWPOINTS; i++) { /* a tour: each picture shows two neighbours */
        const size_t before = page_cache_stats(c).bytes;
        page_cache_next(c, NULL);
        for (int k = 0; k < 2; k++) {
            snprintf(photo, sizeof photo, "v%03d", i + k);
            load_all(c, find(c, photo));
        }
        const size_t now = page_cache_stats(c).bytes;
        if (now > before && now - before > largest) largest = now - before;
        assert_true(now <= (1 << 20));
    }
    const struct page_cache_stats stats = page_cache_stats(c);
    print_message("%d atlases of %zu bytes: at most %zu bytes in memory\n", stats.atlases_read, largest, stats.most);
    assert_int_equal(stats.atlases_read, VIEWPOINTS); /* none twice: the present two are kept */
    assert_int_equal(stats.pages_read, VIEWPOINTS);
    assert_true(stats.most <= (1 << 20) && stats.most > (1 << 19));
    assert_true(largest * VIEWPOINTS > 20 * stats.most);
    page_cache_close(c);
    solid_mesh_release(&mesh);
}

static void what_was_not_used_longest_goes_first_and_the_picture_keeps_all_it_uses(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(boxes, 2);
    static const char *const photos[] = {"a", "b", "c"};
    for (int i = 0; i < 3; i++) {
        const struct view view = view_at(vec3_make(0, 0, 0), i, 0, 96, 72, 60); /* about 0.7 MiB */
        paint_viewpoint(&mesh, &view, photos[i], FLAT, 1);
    }
    struct page_cache *c = open_cache(2);
    load_all(c, find(c, "a"));
    page_cache_next(c, NULL);
    load_all(c, find(c, "b"));
    page_cache_next(c, NULL);
    load_all(c, find(c, "a"));
    page_cache_next(c, NULL);
    load_all(c, find(c, "c")); /* in place of b */
    page_cache_next(c, NULL);
    load_all(c, find(c, "a"));
    assert_int_equal(page_cache_stats(c).pages_read, 3);
    page_cache_next(c, NULL);
    for (int i = 0; i < 3; i++) load_all(c, find(c, photos[i])); /* one picture needs more than the memory */
    assert_int_equal(page_cache_stats(c).pages_read, 5);         /* b in place of c, then c beyond the memory */
    assert_true(page_cache_stats(c).bytes > (2 << 20));
    for (int i = 0; i < 3; i++) assert_non_null(find(c, photos[i])->pages[0].texels);
    page_cache_next(c, NULL);
    const struct view view = view_of(0);
    paint_viewpoint(&mesh, &view, "d", FLAT, 1);
    load_all(c, find(c, "d"));
    assert_true(page_cache_stats(c).bytes <= (2 << 20));
    page_cache_close(c);
    solid_mesh_release(&mesh);
}

static void a_viewpoint_without_an_atlas_is_named(void **state)
{
    (void)state;
    struct texture_set *set;
    struct err err = ERR_INIT;
    mkdir(scratch_path("vdta"), 0777);
    struct page_cache *c = open_cache(1);
    assert_int_not_equal(page_cache_find(c, "nowhere", &set, &err), ST_OK);
    assert_err(err, ST_DATA, "viewpoint nowhere has no atlas: there is no ");
    assert_contains(err.text, "make vdta");
    assert_null(set);
    page_cache_close(c);
}

static void an_atlas_of_another_viewpoint_is_refused(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(boxes, 2);
    const struct view view = view_of(1);
    struct texture_set *set;
    struct err err = ERR_INIT;
    char from[512], to[512];
    paint_viewpoint(&mesh, &view, "right", FLAT, 1);
    snprintf(from, sizeof from, "%s/right", scratch_path("vdta"));
    snprintf(to, sizeof to, "%s/wrong", scratch_path("vdta"));
    assert_int_equal(rename(from, to), 0);
    struct page_cache *c = open_cache(1);
    assert_int_not_equal(page_cache_find(c, "wrong", &set, &err), ST_OK);
    assert_err(err, ST_DATA, "is the atlas of right, wanted that of wrong");
    page_cache_close(c);
    solid_mesh_release(&mesh);
}

static void a_picture_records_the_files_that_it_uses(void **state)
{
    (void)state;
    struct solid_mesh mesh = make_boxes(boxes, 2);
    const struct view view = view_of(1);
    struct provenance first = {.stage = "test", .version = "1"}, second = first;
    paint_viewpoint(&mesh, &view, "noted", FLAT, 1);
    struct page_cache *c = open_cache(10);
    page_cache_next(c, &first);
    load_all(c, find(c, "noted"));
    page_cache_next(c, &second); /* they are in memory already */
    load_all(c, find(c, "noted"));
    assert_int_equal(first.count, 2);
    assert_int_equal(second.count, 2);
    assert_string_equal(second.inputs[0].name, "vdta/noted/atlas.txt");
    assert_string_equal(second.inputs[1].name, "vdta/noted/page0.exr");
    assert_string_equal(first.inputs[1].hash, second.inputs[1].hash);
    page_cache_close(c);
    provenance_release(&first);
    provenance_release(&second);
    solid_mesh_release(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(texels_are_those_of_the_file_in_a_frame_of_nothing),
        cmocka_unit_test(what_a_texel_comes_from_is_kept),
        cmocka_unit_test(five_hundred_viewpoints_stay_within_the_memory),
        cmocka_unit_test(what_was_not_used_longest_goes_first_and_the_picture_keeps_all_it_uses),
        cmocka_unit_test(a_viewpoint_without_an_atlas_is_named),
        cmocka_unit_test(an_atlas_of_another_viewpoint_is_refused),
        cmocka_unit_test(a_picture_records_the_files_that_it_uses),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
