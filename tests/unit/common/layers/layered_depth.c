/* layered_depth.c - layered depth maps: round trip of TXT and EXR, invalid files, and failed writes. */
#include "tests/unit/scratch.h"

#include <math.h>
#include <signal.h>
#include <sys/resource.h>

#include "common/base/parallel.h"
#include "common/image/exr.h"
#include "common/layers/layered_depth.h"

enum { WIDTH = 21, HEIGHT = 37, SEGMENTS = 5 };

static const struct view view = {.name = "IMG_1",
                                 .width = WIDTH,
                                 .height = HEIGHT,
                                 .fx = 50,
                                 .fy = 50,
                                 .cx = 10,
                                 .cy = 18,
                                 .cam_from_world = {{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}},
                                 .translation = {0.5, -2, 4}};

static void fill_layer(struct layer *l, int pixels, int seed)
{
    for (int i = 0; i < pixels; i++) {
        int k = i * 7 + seed;
        l->rgba[4 * i] = (float)(k % 2048) / 1024; /* exact in half */
        l->rgba[4 * i + 1] = (float)(k % 300) * 16;
        l->rgba[4 * i + 2] = 0.25F;
        l->rgba[4 * i + 3] = (float)(k % 9) / 8;
        l->z[i] = k % 5 ? (float)k / 3 : 0;
        l->id[i] = (uint32_t)k % (SEGMENTS + 1);
    }
}

static struct layered_depth sample(int width, int height)
{
    struct layered_depth d;
    struct err err = ERR_INIT;
    assert_ok(layered_depth_init(&d, width, height, &err), err);
    fill_layer(&d.interior, width * height, 0);
    fill_layer(&d.boundary, width * height, 3);
    d.segments = calloc(SEGMENTS, sizeof *d.segments);
    assert_non_null(d.segments);
    d.segment_count = SEGMENTS;
    for (int i = 0; i < SEGMENTS; i++)
        d.segments[i] = (struct depth_segment){.id = (uint32_t)i + 1,
                                               .pixels = i * i < width * height ? i * i : 0,
                                               .plane = {1.0 / (i + 3), -1e-300 * i, 0.1 + i * 1e200},
                                               .sigma = 1.0 / (7 + i),
                                               .confidence = i / (double)(SEGMENTS - 1),
                                               .deviation = i / 30.0}; /* the first states none */
    return d;
}

static void assert_same_layer(const struct layer *a, const struct layer *b, size_t pixels)
{
    assert_memory_equal(a->rgba, b->rgba, pixels * 4 * sizeof *a->rgba);
    assert_memory_equal(a->z, b->z, pixels * sizeof *a->z);
    assert_memory_equal(a->id, b->id, pixels * sizeof *a->id);
}

static void assert_same_segments(const struct layered_depth *a, const struct layered_depth *b)
{
    assert_int_equal(a->segment_count, b->segment_count);
    for (int i = 0; i < a->segment_count; i++) {
        const struct depth_segment *s = &a->segments[i], *t = &b->segments[i];
        assert_true(s->id == t->id && s->pixels == t->pixels);
        assert_memory_equal(s->plane, t->plane, sizeof s->plane);
        assert_true(fabs(s->sigma - t->sigma) <= 1e-9 * s->sigma);
        assert_true(fabs(s->deviation - t->deviation) <= 1e-8 * s->deviation);
        assert_true(fabs(s->confidence - t->confidence) <= 1e-9);
    }
}

static bool is_empty(const struct layered_depth *d)
{
    static const struct layered_depth empty;
    return !memcmp(d, &empty, sizeof empty);
}

static void a_depth_map_round_trips(void **state)
{
    static const int sizes[][2] = {{WIDTH, HEIGHT}, {1, 1}, {300, 1}, {1, 40}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct layered_depth d = sample(sizes[i][0], sizes[i][1]), back, listed;
        struct err err = ERR_INIT;
        const char *path = scratch_path("made/deeper/IMG_1.exr");
        assert_ok(layered_depth_write(&d, &view, path, NULL, &err), err);
        assert_ok(layered_depth_read(&back, path, NULL, &err), err);
        assert_true(back.width == d.width && back.height == d.height);
        assert_same_layer(&back.interior, &d.interior, (size_t)d.width * (size_t)d.height);
        assert_same_layer(&back.boundary, &d.boundary, (size_t)d.width * (size_t)d.height);
        assert_same_segments(&d, &back);

        assert_ok(layered_depth_read_segments(&listed, scratch_path("made/deeper/IMG_1.txt"), NULL, &err), err);
        assert_true(listed.width == d.width && listed.height == d.height);
        assert_true(!listed.interior.z && !listed.boundary.rgba);
        assert_same_segments(&d, &listed);
        layered_depth_release(&listed);
        layered_depth_release(&back);
        layered_depth_release(&d);
    }
}

static void a_view_without_segments_is_a_valid_depth_map(void **state)
{
    struct layered_depth d, back;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(layered_depth_init(&d, 3, 2, &err), err);
    assert_ok(layered_depth_write(&d, NULL, scratch_path("none.exr"), NULL, &err), err);
    assert_file_text(scratch_path("none.txt"), "remodel-segments 1\nsize 3 2\nsegments 0\n");
    assert_ok(layered_depth_read(&back, scratch_path("none.exr"), NULL, &err), err);
    assert_int_equal(back.segment_count, 0);
    for (int i = 0; i < 6; i++) assert_true(back.interior.id[i] == 0 && back.boundary.z[i] == 0);
    layered_depth_release(&back);
    layered_depth_release(&d);
}

/* Two of four pixels have a segment; one of them has confidence. */
static void shares_of_unknown_pixels_are_attributes(void **state)
{
    struct layered_depth d;
    struct exr_image im = {0};
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(layered_depth_init(&d, 4, 1, &err), err);
    d.segments = calloc(2, sizeof *d.segments);
    assert_non_null(d.segments);
    d.segment_count = 2;
    for (int i = 0; i < 2; i++) {
        d.segments[i] = (struct depth_segment){(uint32_t)i + 1, 1, {0, 0, 0.5}, 0.1, i ? DEPTH_INHERITED : 0.05, 0};
        d.interior.id[2 * i] = (uint32_t)i + 1;
        d.interior.z[2 * i] = 2;
        d.interior.rgba[4 * (2 * i) + 3] = 1;
    }
    assert_true(fabs(layered_depth_shares(&d).unknown - 0.5) <= 0);
    assert_true(fabs(layered_depth_shares(&d).inherited - 0.25) <= 0);
    assert_ok(layered_depth_write(&d, &view, scratch_path("shares.exr"), NULL, &err), err);
    assert_ok(exr_read(&im, scratch_path("shares.exr"), (const char *const[]){"interior.Z"}, 1, &err), err);
    assert_string_equal(exr_attribute(&im, "remodel:unknown"), "0.5");
    assert_string_equal(exr_attribute(&im, "remodel:inherited"), "0.25");
    exr_image_release(&im);
    layered_depth_release(&d);
}

static void release_may_be_called_twice(void **state)
{
    struct layered_depth d = sample(2, 2);
    struct err err = ERR_INIT;
    (void)state;
    layered_depth_release(&d);
    assert_true(is_empty(&d));
    layered_depth_release(&d);
    layered_depth_release(NULL);
    static const int sizes[][2] = {{0, 5}, {5, 0}, {-1, 5}, {65536, 65536}};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        err = (struct err)ERR_INIT;
        assert_int_equal(layered_depth_init(&d, sizes[i][0], sizes[i][1], &err), ST_DATA);
        assert_err(err, ST_DATA, "a depth map cannot have");
        assert_true(is_empty(&d));
    }
}

static void the_same_depth_gives_the_same_bytes(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    char first[HASH_TEXT], again[HASH_TEXT];
    (void)state;
    for (int threads = 1; threads < 4; threads++) {
        parallel_set_threads(threads);
        assert_ok(layered_depth_write(&d, &view, scratch_path("same.exr"), NULL, &err), err);
        assert_ok(hash_file(threads > 1 ? again : first, scratch_path("same.exr"), &err), err);
        if (threads > 1) assert_string_equal(first, again);
    }
    parallel_set_threads(0);
    layered_depth_release(&d);
}

static void provenance_and_camera_are_in_both_files(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT), back;
    struct provenance prov = {.stage = "segment_depth", .version = "1.2.3"};
    struct exr_image im;
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(provenance_add_file(&prov, "views/IMG_1.exr", scratch_write("input", "words"), &err), err);
    assert_ok(layered_depth_write(&d, &view, scratch_path("p.exr"), &prov, &err), err);
    char *text = scratch_read(scratch_path("p.txt"));
    assert_int_equal(strncmp(text, "# remodel segment_depth 1.2.3\n", 30), 0);
    assert_contains(text, "# input views/IMG_1.exr ");
    assert_contains(text, "\nremodel-segments 1\nsize 21 37\nsegments 5\n1 0 0.33333333333333331 -0 0.1");
    assert_lacks(text, scratch); /* no absolute path */
    free(text);

    assert_ok(exr_read(&im, scratch_path("p.exr"), NULL, 0, &err), err);
    assert_int_equal(im.count, 12);
    assert_int_equal(exr_find(&im, "interior.R")->type, EXR_HALF);
    assert_int_equal(exr_find(&im, "boundary.A")->type, EXR_HALF);
    assert_int_equal(exr_find(&im, "boundary.Z")->type, EXR_FLOAT);
    assert_int_equal(exr_find(&im, "interior.id")->type, EXR_UINT);
    assert_true(im.has_world_to_camera && im.world_to_camera[12] == 0.5F && im.world_to_camera[13] == 2 &&
                im.world_to_camera[14] == 4);
    exr_image_release(&im);
    size_t size = 0;
    FILE *fp = fopen(scratch_path("p.exr"), "rb");
    char bytes[4096];
    assert_non_null(fp);
    size = fread(bytes, 1, sizeof bytes, fp);
    fclose(fp);
    assert_non_null(memmem(bytes, size, "segment_depth", 13));
    assert_non_null(memmem(bytes, size, "views/IMG_1.exr", 15));

    assert_ok(layered_depth_read(&back, scratch_path("p.exr"), NULL, &err), err); /* the reader skips comments */
    layered_depth_release(&back);
    layered_depth_release(&d);
    provenance_release(&prov);
}

/* --------------------------------------------------------------------------------------------------- invalid lists */

#define HEAD "remodel-segments 1\nsize 2 1\n"
#define ONE  "1 2 0.5 0 0.25 0.01 1\n"
#define TWO  "2 0 0.5 0 0.25 0.01 0\n"

static void errors_of_a_list_name_the_line(void **state)
{
    static const struct {
        const char *text, *words;
    } bad[] = {
        {"", "d.txt: found an empty file, wanted a line \"remodel-segments ...\""},
        {"remodel-lenses 1\n", "d.txt:1: found \"remodel-lenses\", wanted a line \"remodel-segments ...\""},
        {"remodel-segments 2\n", "d.txt:1: found \"2\", wanted the version"},
        {"remodel-segments 1 x\n", "d.txt:1: found \"x\", wanted the end of the line"},
        {"remodel-segments 1\n", "d.txt:1: found the end of the file, wanted a line 'size ...'"},
        {"remodel-segments 1\nsegments 0\n", "d.txt:2: found \"segments\", wanted 'size'"},
        {"remodel-segments 1\nsize 0 1\n", "d.txt:2: found \"0\", wanted width"},
        {"remodel-segments 1\nsize 2 0\n", "d.txt:2: found \"0\", wanted height"},
        {"remodel-segments 1\nsize 65536 65536\n", "d.txt:2: found \"65536\", wanted height"},
        {"remodel-segments 1\nsize 2 1 4\n", "d.txt:2: found \"4\", wanted the end of the line"},
        {HEAD, "d.txt:2: found the end of the file, wanted a line 'segments ...'"},
        {HEAD "segments -1\n", "d.txt:3: found \"-1\", wanted number of segments"},
        {HEAD "segments 2000000000\n", "d.txt:3: found \"2000000000\", wanted number of segments"},
        {HEAD "segments 1\n", "d.txt:3: found the end of the file, wanted a line of segment 1"},
        {HEAD "segments 2\n" ONE, "d.txt:4: found the end of the file, wanted a line of segment 2"},
        {HEAD "segments 1\n" ONE TWO, "d.txt:5: found \"2 0 0.5 0 0.25 0.01 0\", wanted the end of the file"},
        {HEAD "segments 2\n" TWO ONE, "d.txt:4: found \"2\", wanted segment id"},
        {HEAD "segments 2\n" ONE ONE, "d.txt:5: found \"1\", wanted segment id"},
        {HEAD "segments 1\n1 3 0.5 0 0.25 0.01 1\n", "d.txt:4: found \"3\", wanted pixels, an integer from 0 to 2"},
        {HEAD "segments 1\n1 -1 0.5 0 0.25 0.01 1\n", "d.txt:4: found \"-1\", wanted pixels"},
        {HEAD "segments 1\n1 2 nan 0 0.25 0.01 1\n", "d.txt:4: found \"nan\", wanted plane a"},
        {HEAD "segments 1\n1 2 0.5 inf 0.25 0.01 1\n", "d.txt:4: found \"inf\", wanted plane b"},
        {HEAD "segments 1\n1 2 0.5 0 1e999 0.01 1\n", "d.txt:4: found \"1e999\", wanted plane c"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 -0.01 1\n", "d.txt:4: found \"-0.01\", wanted sigma, 0 or more"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01 1.5\n", "d.txt:4: found \"1.5\", wanted confidence, from 0 to 1"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01 -0.5\n", "d.txt:4: found \"-0.5\", wanted confidence"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01\n", "d.txt:4: found the end of the line, wanted confidence"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01 1 -0.1\n", "d.txt:4: found \"-0.1\", wanted deviation"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01 1 inf\n", "d.txt:4: found \"inf\", wanted deviation"},
        {HEAD "segments 1\n1 2 0.5 0 0.25 0.01 1 0.1 0\n", "d.txt:4: found \"0\", wanted the end of the line"},
        {"# a comment\n\n" HEAD "segments 1\n# another\n1 2 0.5 0 0.25 oops 1\n",
         "d.txt:7: found \"oops\", wanted sigma"},
    };
    struct layered_depth d = sample(2, 1);
    struct err err = ERR_INIT;
    const char *path = scratch_path("d.txt");
    char picture[300];
    (void)state;
    snprintf(picture, sizeof picture, "%s", scratch_path("d.exr"));
    assert_ok(layered_depth_write(&d, &view, picture, NULL, &err), err);
    layered_depth_release(&d);
    for (size_t i = 0; i < sizeof bad / sizeof *bad; i++) {
        char words[400];
        scratch_write("d.txt", bad[i].text);
        snprintf(words, sizeof words, "%s/%s", scratch, bad[i].words);
        err = (struct err)ERR_INIT;
        assert_int_equal(layered_depth_read_segments(&d, path, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, words);
        assert_true(is_empty(&d));
        err = (struct err)ERR_INIT;
        assert_int_equal(layered_depth_read(&d, picture, NULL, &err), ST_DATA);
        assert_err(err, ST_DATA, words);
        assert_true(is_empty(&d));
    }
    scratch_write_bytes("d.txt", HEAD "segments 1\n1 2 0.5\0 0 0.25 0.01 1\n", 60);
    err = (struct err)ERR_INIT;
    assert_int_equal(layered_depth_read_segments(&d, path, NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "d.txt:4: found");
    /* the last line may lack its line end, even if its numbers are short */
    err = (struct err)ERR_INIT;
    assert_ok(layered_depth_read_segments(&d, scratch_write("d.txt", HEAD "segments 1\n1 0 0 0 0 0 0"), NULL, &err),
              err);
    assert_int_equal(d.segment_count, 1);
    layered_depth_release(&d);
}

/* ------------------------------------------------------------------------------------------------- invalid pictures */

static char *file_bytes(const char *path, size_t *size)
{
    FILE *fp = fopen(path, "rb");
    assert_non_null(fp);
    assert_int_equal(fseek(fp, 0, SEEK_END), 0);
    *size = (size_t)ftell(fp);
    rewind(fp);
    char *bytes = malloc(*size);
    assert_non_null(bytes);
    assert_int_equal(fread(bytes, 1, *size, fp), *size);
    fclose(fp);
    return bytes;
}

static void assert_refused(const char *path, enum status status, const char *words)
{
    struct layered_depth d;
    struct err err = ERR_INIT;
    assert_int_equal(layered_depth_read(&d, path, NULL, &err), status);
    assert_err(err, status, words);
    assert_true(is_empty(&d));
}

static void a_missing_file_of_the_pair_is_an_error(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    (void)state;
    assert_refused(scratch_path("absent.exr"), ST_IO, "absent.txt");
    assert_ok(layered_depth_write(&d, &view, scratch_path("half.exr"), NULL, &err), err);
    assert_int_equal(unlink(scratch_path("half.exr")), 0);
    assert_refused(scratch_path("half.exr"), ST_IO, "half.exr");
    assert_ok(layered_depth_write(&d, &view, scratch_path("half.exr"), NULL, &err), err);
    assert_int_equal(unlink(scratch_path("half.txt")), 0);
    assert_refused(scratch_path("half.exr"), ST_IO, "half.txt");
    assert_refused(scratch_path("half.txt"), ST_USAGE, "half.txt: the name of a depth map must end in .exr");
    assert_refused(".exr", ST_USAGE, ".exr: the name of a depth map must end");
    assert_int_equal(layered_depth_write(&d, &view, scratch_path("half.png"), NULL, &err), ST_USAGE);
    assert_err(err, ST_USAGE, "half.png: the name of a depth map must end in .exr");
    layered_depth_release(&d);
}

static void lists_of_another_size_are_rejected(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    (void)state;
    assert_ok(layered_depth_write(&d, &view, scratch_path("size.exr"), NULL, &err), err);
    scratch_write("size.txt", "remodel-segments 1\nsize 37 21\nsegments 0\n");
    assert_refused(scratch_path("size.exr"), ST_DATA, "size.exr has 21 x 37 pixels, but ");
    assert_refused(scratch_path("size.exr"), ST_DATA, "size.txt says 37 x 21; make the depth map again.");
    /* and with fewer segments than the picture's ids */
    scratch_write("size.txt", "remodel-segments 1\nsize 21 37\nsegments 1\n1 2 0.5 0 0.25 0.01 1\n");
    assert_refused(scratch_path("size.exr"), ST_DATA, "pixel (2, 0) of interior has segment 2,");
    layered_depth_release(&d);
}

static void errors_of_samples_name_the_pixel(void **state)
{
    (void)state;
    for (int boundary = 0; boundary < 2; boundary++)
        for (int what = 0; what < 5; what++) {
            static const char *const words[] = {"segment 6,", "segment 4294967295,", "alpha 1.5,", "alpha -0.125,",
                                                "z -2;"};
            struct layered_depth d = sample(WIDTH, HEIGHT);
            struct layer *l = boundary ? &d.boundary : &d.interior;
            struct err err = ERR_INIT;
            const int at = 30 * WIDTH + 11;
            char pixel[64];
            if (what < 2) l->id[at] = what ? UINT32_MAX : SEGMENTS + 1;
            if (what == 2 || what == 3) l->rgba[4 * at + 3] = what == 2 ? 1.5F : -0.125F;
            if (what == 4) l->z[at] = -2;
            assert_ok(layered_depth_write(&d, &view, scratch_path("range.exr"), NULL, &err), err);
            snprintf(pixel, sizeof pixel, "pixel (11, 30) of %s has segment", boundary ? "boundary" : "interior");
            assert_refused(scratch_path("range.exr"), ST_DATA, pixel);
            assert_refused(scratch_path("range.exr"), ST_DATA, words[what]);
            assert_refused(scratch_path("range.exr"), ST_DATA, "wanted a segment up to 5");
            layered_depth_release(&d);
        }
}

static void missing_channels_and_channels_of_another_type_are_rejected(void **state)
{
    static const struct {
        const char *name;
        enum exr_type type;
        const char *words;
    } cases[] = {
        {"interior.Z", EXR_UINT, "channel interior.Z has the wrong type; make the depth map again."},
        {"boundary.id", EXR_HALF, "channel boundary.id has the wrong type"},
        {"boundary.A", EXR_UINT, "channel boundary.A has the wrong type"},
        {"interior.G", EXR_HALF, NULL}, /* left out */
    };
    static const char *const colours[] = {"R", "G", "B", "A", "Z", "id"};
    (void)state;
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct exr_image im = {0};
        struct err err = ERR_INIT;
        assert_ok(exr_image_init(&im, 2, 1, &err), err);
        for (int k = 0; k < 12; k++) {
            char name[EXR_NAME_SIZE];
            snprintf(name, sizeof name, "%s.%s", k < 6 ? "interior" : "boundary", colours[k % 6]);
            enum exr_type type = k % 6 == 5 ? EXR_UINT : EXR_HALF;
            bool this = !strcmp(name, cases[i].name);
            if (this && !cases[i].words) continue;
            assert_ok(exr_add_plane(&im, name, this ? cases[i].type : type, NULL, &err), err);
        }
        assert_ok(exr_write(&im, scratch_path("type.exr"), NULL, &err), err);
        scratch_write("type.txt", HEAD "segments 0\n");
        assert_refused(scratch_path("type.exr"), ST_DATA, cases[i].words ? cases[i].words : "no channel interior.G");
        exr_image_release(&im);
    }
}

static void a_truncated_picture_is_rejected(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    size_t size;
    (void)state;
    assert_ok(layered_depth_write(&d, &view, scratch_path("cut.exr"), NULL, &err), err);
    char *bytes = file_bytes(scratch_path("cut.exr"), &size);
    for (size_t cut = 0; cut < size; cut += cut < 40 ? 7 : size / 23) {
        scratch_write_bytes("cut.exr", bytes, cut);
        assert_refused(scratch_path("cut.exr"), ST_DATA, "cut.exr");
    }
    free(bytes);
    layered_depth_release(&d);
}

/* ------------------------------------------------------------------------------------------------------- ids only */

static void ids_can_be_read_without_the_other_channels(void **state)
{
    static const int sizes[][2] = {{WIDTH, HEIGHT}, {1, 1}, {300, 1}};
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        struct layered_depth d = sample(sizes[i][0], sizes[i][1]), back = {0};
        struct err err = ERR_INIT;
        const char *path = scratch_path("ids.exr");
        assert_ok(layered_depth_write(&d, &view, path, NULL, &err), err);
        assert_ok(layered_depth_read_ids(&back, path, NULL, &err), err);
        assert_true(back.width == d.width && back.height == d.height);
        assert_memory_equal(back.interior.id, d.interior.id,
                            (size_t)d.width * (size_t)d.height * sizeof *d.interior.id);
        assert_true(!back.interior.rgba && !back.interior.z && !back.boundary.rgba && !back.boundary.z &&
                    !back.boundary.id);
        assert_same_segments(&d, &back);
        layered_depth_release(&back);
        assert_true(is_empty(&back));
        layered_depth_release(&d);
    }
}

static void assert_ids_refused(const char *path, enum status status, const char *words)
{
    struct layered_depth d = {0};
    struct err err = ERR_INIT;
    assert_int_equal(layered_depth_read_ids(&d, path, NULL, &err), status);
    assert_err(err, status, words);
    assert_true(is_empty(&d));
}

static void invalid_ids_are_rejected(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    size_t size;
    (void)state;
    assert_ids_refused(scratch_path("no-ids.exr"), ST_IO, "no-ids.txt");
    assert_ids_refused(scratch_path("no-ids.txt"), ST_USAGE, "no-ids.txt: the name of a depth map must end in .exr");

    assert_ok(layered_depth_write(&d, &view, scratch_path("ids.exr"), NULL, &err), err);
    assert_int_equal(unlink(scratch_path("ids.exr")), 0);
    assert_ids_refused(scratch_path("ids.exr"), ST_IO, "ids.exr");

    /* a list of another size, or with fewer segments than the picture's ids */
    assert_ok(layered_depth_write(&d, &view, scratch_path("ids.exr"), NULL, &err), err);
    scratch_write("ids.txt", "remodel-segments 1\nsize 37 21\nsegments 0\n");
    assert_ids_refused(scratch_path("ids.exr"), ST_DATA,
                       "ids.exr: interior.id is not the plane of 37 x 21 integers that ");
    scratch_write("ids.txt", "remodel-segments 1\nsize 21 37\nsegments 1\n1 2 0.5 0 0.25 0.01 1\n");
    assert_ids_refused(scratch_path("ids.exr"), ST_DATA, "ids.exr: pixel (2, 0) has segment 2, wanted one up to 1;");
    scratch_write("ids.txt", "remodel-segments 1\nsize 21 37\nsegments oops\n");
    assert_ids_refused(scratch_path("ids.exr"), ST_DATA, "ids.txt:3: found \"oops\"");

    d.interior.id[30 * WIDTH + 11] = UINT32_MAX;
    assert_ok(layered_depth_write(&d, &view, scratch_path("ids.exr"), NULL, &err), err);
    assert_ids_refused(scratch_path("ids.exr"), ST_DATA, "pixel (11, 30) has segment 4294967295, wanted one up to 5;");
    d.interior.id[30 * WIDTH + 11] = 1;
    d.boundary.id[0] = 77; /* not read */
    assert_ok(layered_depth_write(&d, &view, scratch_path("ids.exr"), NULL, &err), err);
    struct layered_depth back = {0};
    assert_ok(layered_depth_read_ids(&back, scratch_path("ids.exr"), NULL, &err), err);
    layered_depth_release(&back);

    char *bytes = file_bytes(scratch_path("ids.exr"), &size);
    for (size_t cut = 0; cut < size; cut += cut < 40 ? 7 : size / 7) {
        scratch_write_bytes("ids.exr", bytes, cut);
        assert_ids_refused(scratch_path("ids.exr"), ST_DATA, "ids.exr");
    }
    free(bytes);
    layered_depth_release(&d);
}

static void missing_or_non_integer_ids_are_rejected(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        struct exr_image im = {0};
        struct err err = ERR_INIT;
        assert_ok(exr_image_init(&im, 2, 1, &err), err);
        assert_ok(exr_add_plane(&im, k ? "interior.Z" : "interior.id", EXR_HALF, NULL, &err), err);
        assert_ok(exr_write(&im, scratch_path("half-ids.exr"), NULL, &err), err);
        scratch_write("half-ids.txt", HEAD "segments 0\n");
        assert_ids_refused(scratch_path("half-ids.exr"), ST_DATA,
                           k ? "no channel interior.id" : "not the plane of 2 x 1 integers");
        exr_image_release(&im);
    }
}

/* ---------------------------------------------------------------------------------------------------- failed writes */

static void a_failed_write_keeps_the_old_files(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    size_t size, again_size;
    (void)state;
    d.boundary.z[17 * WIDTH + 4] = NAN;
    assert_int_equal(layered_depth_write(&d, &view, scratch_path("keep/a.exr"), NULL, &err), ST_DATA);
    assert_err(err, ST_DATA, "channel boundary.Z holds NaN or infinity at pixel (4, 17)");
    assert_int_equal(access(scratch_path("keep/a.exr"), F_OK), -1);
    d.boundary.z[17 * WIDTH + 4] = 1;
    err = (struct err)ERR_INIT;
    assert_ok(layered_depth_write(&d, &view, scratch_path("keep/a.exr"), NULL, &err), err);
    char *before = file_bytes(scratch_path("keep/a.exr"), &size);
    d.interior.rgba[0] = NAN;
    assert_int_equal(layered_depth_write(&d, &view, scratch_path("keep/a.exr"), NULL, &err), ST_DATA);
    char *after = file_bytes(scratch_path("keep/a.exr"), &again_size);
    assert_int_equal(size, again_size);
    assert_memory_equal(before, after, size);
    assert_int_equal(count_entries(scratch_path("keep")), 2); /* no temporary file */
    free(before);
    free(after);
    layered_depth_release(&d);
}

static void invalid_segments_are_not_written(void **state)
{
    (void)state;
    for (int what = 0; what < 4; what++) {
        struct layered_depth d = sample(WIDTH, HEIGHT);
        struct err err = ERR_INIT;
        if (what == 0) d.segments[3].plane[1] = NAN;
        if (what == 1) d.segments[3].sigma = INFINITY;
        if (what == 2) d.segments[3].confidence = NAN;
        if (what == 3) d.segments[3].id = 7;
        assert_int_equal(layered_depth_write(&d, &view, scratch_path("bad/a.exr"), NULL, &err), ST_INTERNAL);
        assert_err(err, ST_INTERNAL, "segment 4");
        assert_int_equal(access(scratch_path("bad"), F_OK), -1);
        layered_depth_release(&d);
    }
}

/* Writes in a child process whose files are limited to `limit` bytes. */
static int write_with_little_room(void *ctx)
{
    const rlim_t limit = *(const rlim_t *)ctx;
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    signal(SIGXFSZ, SIG_IGN);
    parallel_set_threads(1); /* the child has none of the parent's threads */
    if (setrlimit(RLIMIT_FSIZE, &(struct rlimit){limit, limit})) return 98;
    enum status st = layered_depth_write(&d, &view, scratch_path("full/a.exr"), NULL, &err);
    layered_depth_release(&d);
    return st == err.status ? (int)st : 97;
}

static void a_full_disk_leaves_no_partial_file(void **state)
{
    struct layered_depth d = sample(WIDTH, HEIGHT);
    struct err err = ERR_INIT;
    size_t text_size, size;
    (void)state;
    assert_ok(layered_depth_write(&d, &view, scratch_path("whole/a.exr"), NULL, &err), err);
    free(file_bytes(scratch_path("whole/a.txt"), &text_size));
    free(file_bytes(scratch_path("whole/a.exr"), &size));
    assert_true(text_size + 100 < size);
    rlim_t limits[] = {10, text_size - 1, text_size, size - 1};
    for (int i = 0; i < 4; i++) {
        assert_int_equal(child_wait(child_start(write_with_little_room, &limits[i])), ST_IO);
        /* the list is complete or missing; no picture, no temporary file */
        assert_int_equal(count_entries(scratch_path("full")), i < 2 ? 0 : 1);
        if (i >= 2) assert_int_equal(access(scratch_path("full/a.txt"), F_OK), 0);
    }
    layered_depth_release(&d);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_depth_map_round_trips),
        cmocka_unit_test(a_view_without_segments_is_a_valid_depth_map),
        cmocka_unit_test(shares_of_unknown_pixels_are_attributes),
        cmocka_unit_test(release_may_be_called_twice),
        cmocka_unit_test(the_same_depth_gives_the_same_bytes),
        cmocka_unit_test(provenance_and_camera_are_in_both_files),
        cmocka_unit_test(errors_of_a_list_name_the_line),
        cmocka_unit_test(a_missing_file_of_the_pair_is_an_error),
        cmocka_unit_test(lists_of_another_size_are_rejected),
        cmocka_unit_test(errors_of_samples_name_the_pixel),
        cmocka_unit_test(missing_channels_and_channels_of_another_type_are_rejected),
        cmocka_unit_test(a_truncated_picture_is_rejected),
        cmocka_unit_test(ids_can_be_read_without_the_other_channels),
        cmocka_unit_test(invalid_ids_are_rejected),
        cmocka_unit_test(missing_or_non_integer_ids_are_rejected),
        cmocka_unit_test(a_failed_write_keeps_the_old_files),
        cmocka_unit_test(invalid_segments_are_not_written),
        cmocka_unit_test(a_full_disk_leaves_no_partial_file),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
