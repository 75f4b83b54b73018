/* opencv_sift.c - features of made pictures. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <stdlib.h>

#include "common/capture/opencv_sift.h"

enum { SIDE = 200 };
static const struct sift_limits LIMITS = {.longest = 3200, .contrast = 0.02, .edge = 10};

/* A grey picture with round spots, blurred with `sigma`, at these places (pixels; first pixel's centre at 0.5, 0.5). */
static unsigned char *spots(const double (*at)[2], int count, double sigma)
{
    unsigned char *grey = malloc(SIDE * SIDE);
    assert_non_null(grey);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            double value = 60;
            for (int i = 0; i < count; i++) {
                const double dx = x + 0.5 - at[i][0], dy = y + 0.5 - at[i][1];
                value += 150 * exp(-(dx * dx + dy * dy) / (2 * sigma * sigma));
            }
            grey[y * SIDE + x] = (unsigned char)lround(fmin(value, 255));
        }
    return grey;
}

static void features_lie_where_spots_are(void **state)
{
    (void)state;
    static const double at[][2] = {{50.5, 60.5}, {120.25, 40.75}, {151, 149}};
    for (double sigma = 2; sigma <= 6; sigma += 2) {
        struct err err = ERR_INIT;
        struct feature_list list;
        unsigned char *grey = spots(at, 3, sigma);
        assert_ok(sift_find(&list, grey, SIDE, SIDE, &LIMITS, &err), err);
        for (int i = 0; i < 3; i++) {
            double nearest = INFINITY;
            for (int k = 0; k < list.count; k++)
                nearest =
                    fmin(nearest, hypot((double)list.features[k].x - at[i][0], (double)list.features[k].y - at[i][1]));
            assert_true(nearest < 0.06);
        }
        for (int k = 1; k < list.count; k++) assert_true(list.features[k].scale <= list.features[k - 1].scale);
        feature_list_release(&list);
        free(grey);
    }
}

static void features_of_a_scaled_picture_are_in_its_own_pixels(void **state)
{
    (void)state;
    static const double at[][2] = {{80, 121}};
    struct err err = ERR_INIT;
    struct feature_list list;
    unsigned char *grey = spots(at, 1, 6);
    assert_ok(sift_find(&list, grey, SIDE, SIDE, &(struct sift_limits){100, 0.02, 10}, &err), err);
    assert_true(list.count > 0);
    assert_true(hypot((double)list.features[0].x - 80, (double)list.features[0].y - 121) < 0.1);
    feature_list_release(&list);
    free(grey);
}

static void the_same_picture_gives_the_same_features(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct feature_list first, again;
    unsigned char *grey = malloc(SIDE * SIDE);
    assert_non_null(grey);
    for (int i = 0; i < SIDE * SIDE; i++)
        grey[i] = (unsigned char)(((unsigned)(i % SIDE / 6 + i / SIDE / 6 * 97) * 2654435761u) >> 24);
    assert_ok(sift_find(&first, grey, SIDE, SIDE, &LIMITS, &err), err);
    assert_true(first.count > 100);
    for (int k = 0; k < 5; k++) {
        assert_ok(sift_find(&again, grey, SIDE, SIDE, &LIMITS, &err), err);
        assert_int_equal(again.count, first.count);
        assert_memory_equal(again.features, first.features, (size_t)first.count * sizeof *first.features);
        feature_list_release(&again);
    }
    for (int i = 0; i < first.count; i++) {
        double length = 0;
        for (int k = 0; k < DESCRIPTOR_SIZE; k++) length += pow(first.features[i].descriptor[k], 2);
        assert_true(fabs(sqrt(length) - DESCRIPTOR_LENGTH) < 8);
    }
    feature_list_release(&first);
    free(grey);
}

/* A long ridge whose ends are round. */
static void features_on_edges_need_a_higher_limit(void **state)
{
    (void)state;
    double at[40][2];
    int counts[2];
    for (int i = 0; i < 40; i++) at[i][0] = 60 + 2 * i, at[i][1] = 100 + 0.7 * i;
    unsigned char *grey = spots(at, 40, 3);
    for (int k = 0; k < 2; k++) {
        const struct sift_limits limits = {.longest = 3200, .contrast = 0.002, .edge = k ? 300 : 3};
        struct err err = ERR_INIT;
        struct feature_list list;
        assert_ok(sift_find(&list, grey, SIDE, SIDE, &limits, &err), err);
        counts[k] = list.count;
        feature_list_release(&list);
    }
    assert_true(counts[1] > counts[0]);
    free(grey);
}

static void a_blank_picture_has_no_features(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct feature_list list;
    unsigned char *grey = calloc(SIDE, SIDE);
    assert_non_null(grey);
    assert_ok(sift_find(&list, grey, SIDE, SIDE, &LIMITS, &err), err);
    assert_int_equal(list.count, 0);
    feature_list_release(&list);
    free(grey);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(features_lie_where_spots_are),
        cmocka_unit_test(features_of_a_scaled_picture_are_in_its_own_pixels),
        cmocka_unit_test(the_same_picture_gives_the_same_features),
        cmocka_unit_test(features_on_edges_need_a_higher_limit),
        cmocka_unit_test(a_blank_picture_has_no_features),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
