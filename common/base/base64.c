/* base64.c - see base64.h. */
#include "common/base/base64.h"

#include <stdint.h>

void base64_write(FILE *to, const void *bytes, size_t size)
{
    static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    const unsigned char *b = bytes;
    for (size_t i = 0; i < size; i += 3) {
        size_t left = size - i;
        uint32_t word = (uint32_t)b[i] << 16 | (left > 1 ? (uint32_t)b[i + 1] << 8 : 0) | (left > 2 ? b[i + 2] : 0u);
        putc(DIGITS[word >> 18], to);
        putc(DIGITS[word >> 12 & 63], to);
        putc(left > 1 ? DIGITS[word >> 6 & 63] : '=', to);
        putc(left > 2 ? DIGITS[word & 63] : '=', to);
    }
}

enum status base64_write_file(FILE *to, const char *path, struct err *err)
{
    unsigned char part[3 * 16384]; /* a multiple of three, so that only the last part is padded */
    size_t size;
    FILE *from = fopen(path, "rb");
    if (!from) err_errno(err, "open", path);

    while (!err->status && (size = fread(part, 1, sizeof part, from)) > 0) base64_write(to, part, size);
    if (from && ferror(from)) err_errno(err, "read", path);
    if (from) fclose(from);
    return err->status;
}
