/* exr_zip.c - the ZIP codec: round trips, the format, damage. */
#include "tests/unit/scratch.h"

#include <libdeflate.h>

#include "common/base/rng.h"
#include "common/image/exr_zip.h"

#define MAX_SIZE 5000

/* Noise of a few bits on a ramp: compressible unless wide is 256. */
static void fill(uint8_t *bytes, size_t size, uint32_t wide)
{
    const struct rng rng = rng_make(7, "exr_zip", "test");
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(i / 8 + rng_u32(&rng, i, wide) % wide);
}

static void any_bytes_read_back(void **state)
{
    (void)state;
    struct exr_zip z = {0};
    uint8_t from[MAX_SIZE], to[MAX_SIZE];
    for (size_t size = 0; size <= MAX_SIZE; size = size < 70 ? size + 1 : size * 2 + 1) {
        for (uint32_t wide = 1; wide <= 256; wide *= 16) {
            size_t packed = 0;
            fill(from, size, wide);
            assert_true(exr_zip_pack(&z, from, size, &packed));
            assert_true(packed <= size);
            if (packed == size) continue;    /* stored uncompressed */
            uint8_t *exact = malloc(packed); /* exact size, so that a sanitizer detects reads past the end */
            assert_non_null(exact);
            memcpy(exact, z.bytes, packed);
            assert_int_equal(exr_zip_unpack(&z, exact, packed, to, size), EXR_ZIP_OK);
            assert_memory_equal(from, to, size);
            free(exact);
        }
    }
    exr_zip_release(&z);
    exr_zip_release(&z);
    exr_zip_release(NULL);
}

/* Decodes byte by byte as the format is described: zlib, prefix sums, halves. */
static void compressed_bytes_follow_the_format(void **state)
{
    (void)state;
    struct exr_zip z = {0};
    for (size_t size = 999; size <= 1000; size++) {
        uint8_t from[1000], sums[1000];
        size_t packed = 0;
        fill(from, size, 4);
        assert_true(exr_zip_pack(&z, from, size, &packed));
        assert_true(packed < size);
        struct libdeflate_decompressor *d = libdeflate_alloc_decompressor();
        assert_int_equal(libdeflate_zlib_decompress(d, z.bytes, packed, sums, size, NULL), LIBDEFLATE_SUCCESS);
        libdeflate_free_decompressor(d);
        for (size_t i = 1; i < size; i++) sums[i] = (uint8_t)(sums[i - 1] + sums[i] - 128);
        for (size_t i = 0; i < size; i++) assert_int_equal(sums[i % 2 ? (size + 1) / 2 + i / 2 : i / 2], from[i]);
    }
    exr_zip_release(&z);
}

static void damage_is_an_error(void **state)
{
    (void)state;
    struct exr_zip z = {0};
    uint8_t from[1000], to[1000], bytes[1000];
    size_t packed = 0;
    fill(from, sizeof from, 4);
    assert_true(exr_zip_pack(&z, from, sizeof from, &packed));
    memcpy(bytes, z.bytes, packed);
    assert_int_equal(exr_zip_unpack(&z, bytes, packed - 1, to, sizeof to), EXR_ZIP_DAMAGED);
    assert_int_equal(exr_zip_unpack(&z, bytes, packed, to, sizeof to - 1), EXR_ZIP_DAMAGED);
    assert_int_equal(exr_zip_unpack(&z, bytes, 0, to, sizeof to), EXR_ZIP_DAMAGED);
    bytes[packed / 2] ^= 0x55;
    assert_int_equal(exr_zip_unpack(&z, bytes, packed, to, sizeof to), EXR_ZIP_DAMAGED);
    exr_zip_release(&z);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(any_bytes_read_back),
        cmocka_unit_test(compressed_bytes_follow_the_format),
        cmocka_unit_test(damage_is_an_error),
    };
    return cmocka_run_group_tests_name("exr_zip", tests, scratch_make, scratch_remove);
}
