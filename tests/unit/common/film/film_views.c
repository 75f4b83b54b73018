/* film_views.c - the choice of a film's views: reading, writing, applying. */
#include "common/film/film_views.h"

#include "tests/unit/scratch.h"

static void write_scene(void)
{
    scratch_write("cameras.txt", "1 PINHOLE 640 480 500 510 320 240\n");
    scratch_write("images.txt", "1 1 0 0 0 0 0 0 1 a.exr\n5 6 3\n"
                                "2 1 0 0 0 1 0 0 1 b@0.exr\n7 8 3 9 9 4\n"
                                "3 1 0 0 0 2 0 0 1 c.exr\n1 1 4 2 2 5\n");
    scratch_write("points3D.txt", "3 0 0 4 9 9 9 0.5 1 0 2 0\n4 1 0 4 9 9 9 0.5 2 1 3 0\n5 2 0 4 9 9 9 0.5 3 1\n");
}

static struct camera_set scene(void)
{
    struct camera_set set;
    struct err err = ERR_INIT;
    write_scene();
    assert_ok(camera_set_read(&set, scratch, NULL, &err), err);
    return set;
}

static void kept_views_are_read_back(void **state)
{
    (void)state;
    const bool keep[3] = {true, true, false};
    struct camera_set set = scene();
    struct film_views v;
    struct err err = ERR_INIT;
    const char *path = scratch_path("views.txt");
    assert_ok(film_views_write(&set, keep, path, NULL, &err), err);
    assert_ok(film_views_read(&v, path, NULL, &err), err);
    assert_false(v.all);
    assert_int_equal(v.count, 2);
    assert_string_equal(v.names[0], "a");
    assert_string_equal(v.names[1], "b@0");
    film_views_release(&v);
    assert_ok(film_views_write(&set, NULL, path, NULL, &err), err);
    assert_ok(film_views_read(&v, path, NULL, &err), err);
    assert_true(v.all && !v.count);
    film_views_release(&v);
    camera_set_release(&set);
}

static void the_set_keeps_the_views_and_what_they_see(void **state)
{
    (void)state;
    struct camera_set set = scene();
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_write("views.txt", "remodel-film-views 1\nviews 2\nview c\nview b@0\n");
    assert_ok(film_views_keep(&set, path, &prov, &err), err);
    assert_int_equal(set.view_count, 2);
    assert_int_equal(set.model.image_count, 2);
    assert_string_equal(set.views[0].name, "b@0");
    assert_string_equal(set.model.images[1].name, "c.exr");
    assert_true(set.views[1].center.x == -2);
    assert_int_equal(set.model.point_count, 3);
    assert_int_equal(set.model.points[0].track_count, 1);
    assert_int_equal(set.model.points[0].track[0].image_idx, 0);
    assert_int_equal(set.model.points[1].track_count, 2);
    assert_int_equal(set.model.points[2].track[0].image_idx, 1);
    assert_int_equal(prov.count, 1);
    provenance_release(&prov);
    camera_set_release(&set);

    set = scene();
    path = scratch_write("views.txt", "remodel-film-views 1\nviews 1\nview a\n");
    assert_ok(film_views_keep(&set, path, &prov, &err), err);
    assert_int_equal(set.model.point_count, 1); /* two points are seen by others alone */
    assert_int_equal(set.model.points[0].id, 3);
    provenance_release(&prov);
    camera_set_release(&set);
}

/* So that films of ordinary scenes have the same bytes with and without the choice. */
static void all_views_leave_set_and_provenance_alone(void **state)
{
    (void)state;
    struct camera_set set = scene();
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    assert_ok(film_views_keep(&set, scratch_write("views.txt", "remodel-film-views 1\nall\n"), &prov, &err), err);
    assert_ok(film_views_keep(&set, NULL, &prov, &err), err);
    assert_int_equal(set.view_count, 3);
    assert_int_equal(set.model.points[1].track_count, 2);
    assert_int_equal(prov.count, 0);
    provenance_release(&prov);
    camera_set_release(&set);
}

static void an_unchanged_choice_is_not_written_again(void **state)
{
    (void)state;
    struct camera_set set = scene();
    struct err err = ERR_INIT;
    struct stat before, after;
    const char *path = scratch_path("views.txt");
    assert_ok(film_views_write(&set, NULL, path, NULL, &err), err);
    assert_int_equal(stat(path, &before), 0);
    assert_ok(film_views_write(&set, NULL, path, NULL, &err), err);
    assert_int_equal(stat(path, &after), 0);
    assert_true(before.st_ino == after.st_ino);
    camera_set_release(&set);
}

static void malformed_files_are_errors_with_their_line(void **state)
{
    (void)state;
    static const char *const cases[][2] = {
        {"remodel-film-views 2\nall\n", "views.txt:1: found \"2\", wanted"},
        {"remodel-film-views 1\n", "wanted \"all\" or \"views\" and their number"},
        {"remodel-film-views 1\nnone\n", "views.txt:2: found \"none\""},
        {"remodel-film-views 1\nall views\n", "views.txt:2: found \"views\""},
        {"remodel-film-views 1\nviews 0\n", "views.txt:2: found \"0\""},
        {"remodel-film-views 1\nviews 2\nview a\n", "wanted a line \"view ...\""},
        {"remodel-film-views 1\nviews 1\nview a\nview b\n", "views.txt:4: found"},
        {"remodel-film-views 1\nviews 2\nview a\nview a\n", "found view a twice"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct film_views v;
        struct err err = ERR_INIT;
        assert_int_equal(film_views_read(&v, scratch_write("views.txt", cases[i][0]), NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, cases[i][1]);
        assert_null(v.names);
    }
}

static void a_view_that_the_scene_lacks_is_an_error(void **state)
{
    (void)state;
    struct camera_set set = scene();
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    const char *path = scratch_write("views.txt", "remodel-film-views 1\nviews 1\nview d\n");
    assert_int_equal(film_views_keep(&set, path, &prov, &err), ST_DATA);
    assert_err(err, ST_DATA, "found view d, which the scene does not have");
    provenance_release(&prov);
    camera_set_release(&set);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(kept_views_are_read_back),
        cmocka_unit_test(the_set_keeps_the_views_and_what_they_see),
        cmocka_unit_test(all_views_leave_set_and_provenance_alone),
        cmocka_unit_test(an_unchanged_choice_is_not_written_again),
        cmocka_unit_test(malformed_files_are_errors_with_their_line),
        cmocka_unit_test(a_view_that_the_scene_lacks_is_an_error),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
