/* feature_list.c - files of features and of matches. */
#include "tests/unit/scratch.h"

#include <stdlib.h>

#include "common/capture/feature_list.h"
#include "common/capture/match_list.h"

static struct feature_list made(int count)
{
    struct feature_list list = {calloc((size_t)count + 1, sizeof(struct feature)), count, ""};
    assert_non_null(list.features);
    for (int i = 0; i < count; i++) {
        list.features[i] = (struct feature){(float)i + 0.1f, 1e3f / (float)(i + 1), 1.6f, -3.1f, {0}};
        for (int k = 0; k < DESCRIPTOR_SIZE; k++) list.features[i].descriptor[k] = (uint8_t)(7 * i + 3 * k);
    }
    return list;
}

static void features_are_read_as_they_were_written(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct feature_list list = made(3), read, head;
    const char *path = scratch_path("a.txt");
    assert_ok(feature_list_write(&list, path, NULL, &err), err);
    assert_ok(feature_list_read(&read, path, NULL, &err), err);
    assert_int_equal(read.count, 3);
    assert_memory_equal(read.features, list.features, 3 * sizeof *list.features);
    assert_ok(feature_list_read_head(&head, path, &err), err);
    assert_string_equal(head.hash, list.hash);
    assert_string_equal(read.hash, list.hash);
    assert_int_equal(head.count, 3);
    feature_list_release(&read);
    feature_list_release(&list);
    feature_list_release(NULL);
}

static void another_feature_gives_another_hash(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct feature_list list = made(2);
    char before[HASH_TEXT];
    assert_ok(feature_list_write(&list, scratch_path("a.txt"), NULL, &err), err);
    memcpy(before, list.hash, sizeof before);
    list.features[1].descriptor[127]++;
    assert_ok(feature_list_write(&list, scratch_path("a.txt"), NULL, &err), err);
    assert_string_not_equal(list.hash, before);
    feature_list_release(&list);
}

static void damaged_features_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"remodel-features 1\nfeatures 1 ab\n", "feature"},
        {"remodel-features 1\nfeatures 100001 ab\n", "100001"},
        {"remodel-features 1\nfeatures 0 ab\nfeature 1 2 3 4 00\n", ":3"},
        {"remodel-features 1\nfeatures 1 ab\nfeature 1 2 3 4 00\n", "256 hexadecimal digits"},
        {"remodel-features 1\nfeatures 1 ab\nfeature 1 nan 3 4 00\n", "nan"},
        {"remodel-matches 1\n", "remodel-matches"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        struct feature_list list;
        assert_int_equal(feature_list_read(&list, scratch_write("bad.txt", cases[i].text), NULL, &err), ST_DATA);
        assert_contains(err.text, cases[i].says);
        assert_null(list.features);
    }
}

static void matches_are_read_as_they_were_written(void **state)
{
    (void)state;
    struct err err = ERR_INIT;
    struct match_list list = {0.8, 0.7, "0123", NULL, 0}, read;
    struct matched_pair *pair = match_list_add(&list, "b", "4567", &err);
    assert_non_null(pair);
    pair->matches = calloc(2, sizeof *pair->matches);
    pair->matches[pair->count++] = (struct index_match){0, 5};
    pair->matches[pair->count++] = (struct index_match){7, 2};
    pair = match_list_add(&list, "c", "89ab", &err);
    assert_non_null(pair);
    pair->matches = calloc(1, sizeof *pair->matches);
    assert_ok(match_list_write(&list, scratch_path("m.txt"), NULL, &err), err);
    assert_ok(match_list_read(&read, scratch_path("m.txt"), NULL, &err), err);
    assert_int_equal(read.count, 2);
    assert_string_equal(read.hash, "0123");
    assert_true(read.max_ratio == 0.8 && read.max_angle == 0.7);
    const struct matched_pair *found = match_list_find(&read, "b");
    assert_non_null(found);
    assert_int_equal(found->count, 2);
    assert_string_equal(found->hash, "4567");
    assert_int_equal(found->matches[1].first, 7);
    assert_int_equal(found->matches[1].second, 2);
    assert_int_equal(match_list_find(&read, "c")->count, 0);
    assert_null(match_list_find(&read, "d"));
    match_list_release(&read);
    match_list_release(&list);
    match_list_release(NULL);
}

static void damaged_matches_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *says;
    } cases[] = {
        {"remodel-matches 1\nlimits 0.8 0.7\nphoto a\npair b c 2\nmatch 1 1\n", "match"},
        {"remodel-matches 1\nlimits 0.8 0.7\nphoto a\npair b c 2\nmatch 1 1\nmatch 1 2\n", ":6"},
        {"remodel-matches 1\nlimits 0.8 0.7\nphoto a\npair b c -1\n", "-1"},
        {"remodel-matches 1\nlimits 0.8 0.7\nphoto a\npairs b c 1\n", "pairs"},
        {"remodel-matches 1\nphoto a\n", "limits"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct err err = ERR_INIT;
        struct match_list list;
        assert_int_equal(match_list_read(&list, scratch_write("bad.txt", cases[i].text), NULL, &err), ST_DATA);
        assert_contains(err.text, cases[i].says);
        assert_null(list.pairs);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(features_are_read_as_they_were_written),
        cmocka_unit_test(another_feature_gives_another_hash),
        cmocka_unit_test(damaged_features_are_refused),
        cmocka_unit_test(matches_are_read_as_they_were_written),
        cmocka_unit_test(damaged_matches_are_refused),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
