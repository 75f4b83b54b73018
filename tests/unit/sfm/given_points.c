/* given_points.c - whether the points of a given model serve the photos of the scene. */
#include "tests/unit/scratch.h"

#include "stages/sfm/given_points.h"

enum { IMAGES = 4, POINTS = 20 };

static char ids[IMAGES][2] = {"a", "b", "c", "d"}, files[IMAGES][8] = {"a.jpg", "b.jpg", "c.jpg", "d.jpg"};
static struct photo_record records[IMAGES];
static struct photo_list photos = {records, IMAGES};
static char names[IMAGES][8] = {"x/a.jpg", "b.jpg", "c.jpg", "d.jpg"}, stranger[] = "e.jpg";

/* The model of all images; each of the first `shared` points is observed by two images from `from` on, twice by the
 * first one. */
struct given {
    struct sfm_image images[IMAGES];
    struct sfm_point points[POINTS];
    struct sfm_track tracks[POINTS][3];
    struct sfm_model m;
};

static void make(struct given *g, int shared, int from)
{
    *g = (struct given){.m = {.image_count = IMAGES, .point_count = POINTS}};
    g->m.images = g->images;
    g->m.points = g->points;
    for (int i = 0; i < IMAGES; i++) {
        g->images[i].name = names[i];
        records[i] = (struct photo_record){.id = ids[i], .file = files[i]};
    }
    for (int i = 0; i < shared; i++) {
        g->points[i] = (struct sfm_point){.id = i, .track = g->tracks[i], .track_count = 3};
        g->tracks[i][0].image_idx = g->tracks[i][1].image_idx = from;
        g->tracks[i][2].image_idx = from + 1;
    }
}

static struct point_support count(const struct given *g)
{
    struct point_support s;
    struct err err = ERR_INIT;
    assert_ok(given_points_count(&s, &g->m, &photos, &err), err);
    return s;
}

static void eight_shared_points_support_a_photo(void **state)
{
    (void)state;
    struct given g;
    make(&g, MIN_SHARED_POINTS, 0);
    struct point_support s = count(&g);
    assert_int_equal(s.placed, 4);
    assert_int_equal(s.supported, 2);
    assert_int_equal(s.shared, 8);
    assert_true(given_points_suffice(&s)); /* half of the photos */
    make(&g, MIN_SHARED_POINTS - 1, 0);
    s = count(&g);
    assert_int_equal(s.supported, 0);
    assert_false(given_points_suffice(&s));
}

static void points_that_one_photo_observes_do_not_count(void **state)
{
    (void)state;
    struct given g;
    make(&g, POINTS, 0);
    for (int i = 0; i < POINTS; i++) g.points[i].track_count = 2; /* twice by the same photo */
    struct point_support s = count(&g);
    assert_int_equal(s.shared, 0);
    assert_false(given_points_suffice(&s));
    for (int i = 0; i < POINTS; i++) g.points[i].track_count = 0;
    s = count(&g);
    assert_int_equal(s.shared, 0);
}

/* The points of a large model may be shared by images that are no photos of the scene only. */
static void only_photos_of_the_scene_count(void **state)
{
    (void)state;
    struct given g;
    make(&g, POINTS, 1);
    g.images[2].name = stranger;
    struct point_support s = count(&g);
    assert_int_equal(s.placed, 3);
    assert_int_equal(s.shared, 0);
    assert_false(given_points_suffice(&s));
    for (int i = 1; i < IMAGES; i++) g.images[i].name = stranger;
    s = count(&g);
    assert_int_equal(s.placed, 1);
    assert_true(given_points_suffice(&s)); /* nothing can be triangulated from one photo */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(eight_shared_points_support_a_photo),
        cmocka_unit_test(points_that_one_photo_observes_do_not_count),
        cmocka_unit_test(only_photos_of_the_scene_count),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
