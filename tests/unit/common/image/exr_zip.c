/* The ZIP codec: any bytes come back; what it makes is what the format says; damage. */
#include "tests/unit/scratch.h"

#include <libdeflate.h>

#include "common/base/rng.h"
#include "common/image/exr_zip.h"

#define MOST 5000

/* Noise of a few bits on a slope: compressible, but for wide == 256. */
static void fill(uint8_t *bytes, size_t size, uint32_t wide)
{
    const struct rng rng = rng_make(7, "exr_zip", "test");
    for (size_t i = 0; i < size; i++) bytes[i] = (uint8_t)(i / 8 + rng_u32(&rng, i, wide) % wide);
}

static void any_bytes_come_back(void **state)
{
    (void)state;
    struct exr_zip z = {0};
    uint8_t from[MOST], to[MOST];
    for (size_t size = 0; size <= MOST; size = size < 70 ? size + 1 : size * 2 + 1) {
        for (uint32_t wide = 1; wide <= 256; wide *= 16) {
            size_t packed = 0;
            fill(from, size, wide);
            assert_true(exr_zip_pack(&z, from, size, &packed));
            assert_true(packed <= size);
            if (packed == size) continue;    /* stored as it is */
            uint8_t *exact = malloc(packed); /* so that a sanitizer sees what is read behind it */
            assert_non_null(exact);
            memcpy(exact, z.bytes, packed);
            assert_int_equal(exr_zip_unpack(&z, exact, packed, to, size), EXR_ZIP_GOOD);
            assert_memory_equal(from, to, size);
            free(exact);
        }
    }
    exr_zip_release(&z);
    exr_zip_release(&z);
    exr_zip_release(NULL);
}

/* zlib's format, running sums, halves: byte by byte as the format's description has it */
static void the_bytes_are_the_formats(void **state)
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

static void damage_is_told(void **state)
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
        cmocka_unit_test(any_bytes_come_back),
        cmocka_unit_test(the_bytes_are_the_formats),
        cmocka_unit_test(damage_is_told),
    };
    return cmocka_run_group_tests_name("exr_zip", tests, scratch_make, scratch_remove);
}
