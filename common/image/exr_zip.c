/* exr_zip.c - the ZIP codec of OpenEXR files, by libdeflate.
 *
 * A chunk's bytes are reordered, even offsets first, then odd ones, so that bytes of equal significance in half samples
 * are adjacent; each byte is replaced by its difference from the one before, plus 128; the result is compressed in
 * zlib's format. */
#include "common/image/exr_zip.h"

#include <libdeflate.h>
#include <stdlib.h>

#include "common/math/lanes.h"

#define LEVEL 4 /* libdeflate's compression level; determines the bytes */

static bool grow(uint8_t **bytes, size_t *size, size_t wanted)
{
    if (*bytes && *size >= wanted) return true;
    free(*bytes);
    *bytes = malloc(wanted ? wanted : 1);
    *size = *bytes ? wanted : 0;
    return *bytes;
}

/* Moves even bytes before odd ones, then takes differences plus 128. */
static void split(uint8_t *restrict to, uint8_t *restrict halves, const uint8_t *restrict from, size_t size)
{
    const size_t odd = size / 2, even = size - odd;
    for (size_t i = 0; i < odd; i++) {
        halves[i] = from[2 * i];
        halves[even + i] = from[2 * i + 1];
    }
    if (even > odd) halves[odd] = from[size - 1];
    if (size) to[0] = halves[0];
    for (size_t i = 1; i < size; i++) to[i] = (uint8_t)(halves[i] - halves[i - 1] + 128);
}

/* The inverse of split(): prefix sums in place, then interleaves the halves. */
static void join(uint8_t *restrict to, uint8_t *restrict halves, size_t size)
{
    uint8_t last = 0;
    size_t i = 0;
    if (size) last = halves[i++];
    for (u8x16 carry = (u8x16){0} + last; i + 16 <= size; i += 16) {
        const u8x16 sums = u8x16_running_sums(u8x16_load(halves + i) + 128) + carry;
        u8x16_store(halves + i, sums);
        carry = __builtin_shufflevector(sums, sums, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15, 15);
    }
    if (i > 1) last = halves[i - 1];
    for (; i < size; i++) halves[i] = last = (uint8_t)(last + halves[i] - 128);

    const size_t odd = size / 2, even = size - odd;
    for (size_t k = 0; k < odd; k++) {
        to[2 * k] = halves[k];
        to[2 * k + 1] = halves[even + k];
    }
    if (even > odd) to[size - 1] = halves[odd];
}

bool exr_zip_pack(struct exr_zip *z, const uint8_t *from, size_t size, size_t *packed)
{
    if (!z->compressor) z->compressor = libdeflate_alloc_compressor(LEVEL);
    if (!z->compressor || !grow(&z->split, &z->split_size, 2 * size) || !grow(&z->bytes, &z->bytes_size, size))
        return false;
    split(z->split, z->split + size, from, size);
    *packed = size ? libdeflate_zlib_compress(z->compressor, z->split, size, z->bytes, size - 1) : 0;
    if (!*packed) *packed = size; /* not smaller */
    return true;
}

enum exr_zip_result exr_zip_unpack(struct exr_zip *z, const uint8_t *from, size_t packed, uint8_t *to, size_t size)
{
    if (!z->decompressor) z->decompressor = libdeflate_alloc_decompressor();
    if (!z->decompressor || !grow(&z->split, &z->split_size, size)) return EXR_ZIP_NOMEM;
    if (libdeflate_zlib_decompress(z->decompressor, from, packed, z->split, size, NULL) != LIBDEFLATE_SUCCESS)
        return EXR_ZIP_DAMAGED;
    join(to, z->split, size);
    return EXR_ZIP_OK;
}

void exr_zip_release(struct exr_zip *z)
{
    if (!z) return;
    libdeflate_free_compressor(z->compressor);
    libdeflate_free_decompressor(z->decompressor);
    free(z->split);
    free(z->bytes);
    *z = (struct exr_zip){0};
}
