/* The index from faces to views: ranks, bounds, order, and what reading a face costs. */
#include "stages/trace_ids/view_ranks.h"
#include "tests/unit/scratch.h"

enum { VIEWS = 500, FACES = 10000 };

static char names[VIEWS][16];

/* View v sees every third face, with numbers that vary. */
static struct view_record record_of(int v)
{
    struct view_record r = {calloc(FACES, sizeof *r.faces), 0};
    for (int id = 1 + v % 3; id <= FACES; id += 3) {
        const int pixels = 1 + (int)((unsigned)(id * 7919 + v * 104729) % 9973u);
        r.faces[r.count++] =
            (struct seen_face){id, pixels, pixels / (1 + v % 4), 1 + 0.25 * v, (1 + v % 7) / 8.0, 0, 0};
    }
    return r;
}

static void write_index(const char *path, int views, int max_views, int first, int step)
{
    struct view_ranks ranks = {.max_views = max_views};
    struct err err = ERR_INIT;
    for (int i = 0; i < views; i++) {
        const int v = (first + i * step) % views;
        struct view_record r = record_of(v);
        snprintf(names[v], sizeof names[v], "v%04d", v);
        assert_ok(view_ranks_add(&ranks, names[v], &r, &err), err);
        view_record_release(&r);
    }
    assert_ok(view_ranks_write(&ranks, path, NULL, &err), err);
    view_ranks_release(&ranks);
}

static void best_views_come_first(void **state)
{
    (void)state;
    const char *path = scratch_path("index.txt");
    struct face_index index;
    struct face_views list;
    struct err err = ERR_INIT;
    write_index(path, 100, 1000, 0, 1);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    assert_int_equal(index.faces, FACES);
    for (int face = 1; face <= FACES; face += 997) {
        assert_ok(face_index_load(&list, &index, face, &err), err);
        assert_int_equal(list.count, (face - 1) % 3 == 0 ? 34 : 33);
        for (int i = 1; i < list.count; i++)
            assert_true(list.views[i - 1].clean * list.views[i - 1].cosine >=
                        list.views[i].clean * list.views[i].cosine);
        face_views_release(&list);
    }
    face_index_close(&index);
}

static void a_bounded_list_is_the_begin_of_the_whole(void **state)
{
    (void)state;
    const char *path = scratch_path("index.txt");
    struct face_index index;
    struct face_views whole, part;
    struct err err = ERR_INIT;
    write_index(path, 100, 1000, 0, 1);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    assert_ok(face_index_load(&whole, &index, 77, &err), err);
    face_index_close(&index);
    write_index(path, 100, 10, 0, 1);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    assert_ok(face_index_load(&part, &index, 77, &err), err);
    face_index_close(&index);
    assert_int_equal(part.count, 10);
    for (int i = 0; i < part.count; i++) {
        assert_string_equal(part.views[i].name, whole.views[i].name);
        assert_int_equal(part.views[i].clean, whole.views[i].clean);
    }
    face_views_release(&whole);
    face_views_release(&part);
}

static void the_order_of_the_views_changes_no_byte(void **state)
{
    (void)state;
    write_index(scratch_path("a.txt"), 100, 10, 0, 1);
    write_index(scratch_path("b.txt"), 100, 10, 41, 37);
    char *a = scratch_read(scratch_path("a.txt"));
    assert_file_text(scratch_path("b.txt"), a);
    free(a);
}

static void thirty_faces_of_ten_thousand_take_kilobytes(void **state)
{
    (void)state;
    const char *path = scratch_path("index.txt");
    struct face_index index;
    struct face_views list;
    struct err err = ERR_INIT;
    write_index(path, VIEWS, 256, 0, 1);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    assert_true(index.size > 30000000);
    for (int i = 0; i < 30; i++) {
        assert_ok(face_index_load(&list, &index, 1 + 331 * i, &err), err);
        assert_true(list.count > 100);
        face_views_release(&list);
    }
    /* the head, 14 rows of the table a face, 167 views of about 30 bytes */
    assert_true(index.bytes_read < 8192 + 30 * (14 * FACE_INDEX_ROW + 167 * 40));
    face_index_close(&index);
}

static void a_face_that_no_view_shows_has_no_views(void **state)
{
    (void)state;
    const char *path = scratch_path("index.txt");
    struct face_index index;
    struct face_views list;
    struct err err = ERR_INIT;
    struct view_ranks ranks = {.max_views = 3};
    struct seen_face seen[] = {{5, 10, 0, 1, 0.5, 0, 0}, {9, 1, 1, 2, 1, 0, 0}};
    const struct view_record r = {seen, 2};
    assert_ok(view_ranks_add(&ranks, "with space", &r, &err), err);
    assert_ok(view_ranks_write(&ranks, path, NULL, &err), err);
    view_ranks_release(&ranks);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    for (int face = 0; face < 12; face++) {
        assert_ok(face_index_load(&list, &index, face, &err), err);
        assert_int_equal(list.count, face == 5 || face == 9);
        if (list.count) assert_string_equal(list.views[0].name, "with space");
        face_views_release(&list);
    }
    face_index_close(&index);
}

static void an_index_of_no_views_is_empty(void **state)
{
    (void)state;
    const char *path = scratch_path("index.txt");
    struct face_index index;
    struct face_views list;
    struct err err = ERR_INIT;
    struct view_ranks ranks = {.max_views = 3};
    assert_ok(view_ranks_write(&ranks, path, NULL, &err), err);
    assert_ok(face_index_open(&index, path, NULL, &err), err);
    assert_int_equal(index.faces, 0);
    assert_ok(face_index_load(&list, &index, 1, &err), err);
    assert_int_equal(list.count, 0);
    face_index_close(&index);
}

static void a_damaged_index_is_refused_with_its_line(void **state)
{
    (void)state;
    static const struct {
        const char *text, *error;
    } cases[] = {
        {"", "remodel-face-index"},
        {"remodel-face-index 2\n", "index.txt:1"},
        {"remodel-face-index 1\nfaces 3\n", "index.txt:2"},
        {"remodel-face-index 1\nfaces 1\nat          1             50        15       1              4  \nview a 1 0 1 "
         "1\n",
         "offset"},
        {"remodel-face-index 1\nfaces 1\nat          1             93        15       1              4  \nview a 1 2 1 "
         "1\n",
         "index.txt:4"},
        {"remodel-face-index 1\nfaces 1\nat          1             93        15       2              4  \nview a 1 1 1 "
         "1\n",
         "index.txt:4"},
        {"remodel-face-index 1\nfaces 1\nat          1             93        15       1              4  \nview a 1 1 1 "
         "2\n",
         "cosine"},
    };
    for (size_t k = 0; k < sizeof cases / sizeof *cases; k++) {
        const char *path = scratch_write("index.txt", cases[k].text);
        struct face_index index;
        struct face_views list = {0};
        struct err err = ERR_INIT;
        if (!face_index_open(&index, path, NULL, &err) && !face_index_load(&list, &index, 1, &err))
            fail_msg("case %zu was read", k);
        assert_err(err, ST_DATA, cases[k].error);
        assert_null(list.views);
        face_index_close(&index);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(best_views_come_first),
        cmocka_unit_test(a_bounded_list_is_the_begin_of_the_whole),
        cmocka_unit_test(the_order_of_the_views_changes_no_byte),
        cmocka_unit_test(thirty_faces_of_ten_thousand_take_kilobytes),
        cmocka_unit_test(a_face_that_no_view_shows_has_no_views),
        cmocka_unit_test(an_index_of_no_views_is_empty),
        cmocka_unit_test(a_damaged_index_is_refused_with_its_line),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
