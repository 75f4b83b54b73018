/* exr_zip.h - the ZIP codec of OpenEXR files: a chunk's bytes split into even and odd ones, differences, zlib's format.
 *
 * By libdeflate, which takes half the time of zlib (which OpenEXRCore 3.1 calls) for files of the same size. The same
 * input gives the same bytes on every machine with the same version of the library. */
#ifndef REMODEL_EXR_ZIP_H
#define REMODEL_EXR_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One thread's; {0} is the empty state, and what it needs grows with the chunks. */
struct exr_zip {
    struct libdeflate_compressor *compressor;
    struct libdeflate_decompressor *decompressor;
    uint8_t *split, *bytes;
    size_t split_size, bytes_size;
};

/* Compresses `size` bytes into z->bytes, good until the next call, and sets *packed to their count; where they would
 * not become fewer, *packed is `size`, and the chunk is to be stored as it is. False: no memory. */
bool exr_zip_pack(struct exr_zip *z, const uint8_t *from, size_t size, size_t *packed);

enum exr_zip_result { EXR_ZIP_GOOD, EXR_ZIP_DAMAGED, EXR_ZIP_NOMEM };
/* Fills exactly `size` bytes from `packed` ones. */
enum exr_zip_result exr_zip_unpack(struct exr_zip *z, const uint8_t *from, size_t packed, uint8_t *to, size_t size);

void exr_zip_release(struct exr_zip *z);

#endif
