/* pairs.txt: what is written is read back; errors name file and line. */
#include "tests/unit/scratch.h"

#include "common/texture/viewpoint_pairs.h"

static void what_is_written_is_read_back(void **state)
{
    (void)state;
    const char *path = scratch_path("pairs.txt");
    struct viewpoint_pairs made = {0}, read = {0};
    struct err err = ERR_INIT;
    assert_ok(viewpoint_pairs_add(&made, "0001", "v01", "two words", 0, &err), err);
    assert_ok(viewpoint_pairs_add(&made, "0002", "v01", "a \"quoted\" one", 1.0 / 3, &err), err);
    assert_ok(viewpoint_pairs_add(&made, "0003", "v02", "v02", 1, &err), err);
    assert_ok(viewpoint_pairs_write(&made, path, NULL, &err), err);
    assert_ok(viewpoint_pairs_read(&read, path, NULL, &err), err);
    assert_int_equal(read.count, 3);
    for (int i = 0; i < 3; i++) {
        assert_string_equal(read.list[i].frame, made.list[i].frame);
        assert_string_equal(read.list[i].photos[0], made.list[i].photos[0]);
        assert_string_equal(read.list[i].photos[1], made.list[i].photos[1]);
        assert_true(read.list[i].t == made.list[i].t);
    }
    assert_ptr_equal(viewpoint_pairs_find(&read, "0002"), &read.list[1]);
    assert_null(viewpoint_pairs_find(&read, "0004"));
    viewpoint_pairs_release(&made);
    viewpoint_pairs_release(&read);
}

static void a_damaged_line_is_named(void **state)
{
    (void)state;
    static const struct {
        const char *text, *part;
    } wrong[] = {
        {"", "pairs.txt:"},
        {"remodel-pair 1\n", "pairs.txt:1: found \"remodel-pair\""},
        {"remodel-pairs 2\n", "pairs.txt:1: found \"2\""},
        {"remodel-pairs 1\nframes 0001 a b 0\n", "pairs.txt:2: found \"frames\""},
        {"remodel-pairs 1\nframe 0001 a b\n", "pairs.txt:2: "},
        {"remodel-pairs 1\nframe 0001 a b 0 c\n", "pairs.txt:2: found \"c\""},
        {"remodel-pairs 1\nframe 0001 a b 1.01\n", "pairs.txt:2: found \"1.01\", wanted a share, a number from 0 to 1"},
        {"remodel-pairs 1\nframe 0001 a b -0.1\n", "pairs.txt:2: found \"-0.1\""},
        {"remodel-pairs 1\nframe 0001 a b nan\n", "pairs.txt:2: found \"nan\""},
        {"remodel-pairs 1\nframe 0001 a b 0\nframe 0001 a b 1\n",
         "pairs.txt:3: found \"0001\", wanted each frame once"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct viewpoint_pairs pairs = {0};
        struct err err = ERR_INIT;
        viewpoint_pairs_read(&pairs, scratch_write("pairs.txt", wrong[i].text), NULL, &err);
        assert_err(err, ST_DATA, wrong[i].part);
        assert_true(!pairs.list && !pairs.count);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(what_is_written_is_read_back),
        cmocka_unit_test(a_damaged_line_is_named),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
