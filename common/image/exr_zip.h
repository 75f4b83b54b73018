/* exr_zip.h - the ZIP codec of OpenEXR files.
 *
 * It uses libdeflate, which takes half the time of zlib (used by OpenEXRCore 3.1) for files of the same size. The same
 * input gives the same bytes on every machine with the same version of libdeflate. */
#ifndef REMODEL_EXR_ZIP_H
#define REMODEL_EXR_ZIP_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* State of one thread. {0} is the empty state; buffers grow as needed. */
struct exr_zip {
    struct libdeflate_compressor *compressor;
    struct libdeflate_decompressor *decompressor;
    uint8_t *split, *bytes;
    size_t split_size, bytes_size;
};

/* Compresses `size` bytes into z->bytes, valid until the next call, and sets *packed to the compressed size. If that is
 * not smaller, *packed is `size`, and the chunk must be stored uncompressed. False: out of memory. */
bool exr_zip_pack(struct exr_zip *z, const uint8_t *from, size_t size, size_t *packed);

enum exr_zip_result { EXR_ZIP_OK, EXR_ZIP_DAMAGED, EXR_ZIP_NOMEM };
/* Decompresses `packed` bytes to exactly `size` bytes. */
enum exr_zip_result exr_zip_unpack(struct exr_zip *z, const uint8_t *from, size_t packed, uint8_t *to, size_t size);

void exr_zip_release(struct exr_zip *z);

#endif
