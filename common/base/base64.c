/* base64.c - see base64.h. */
#include "common/base/base64.h"

#include <stdint.h>
#include <string.h>

static const char DIGITS[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

void base64_write(FILE *to, const void *bytes, size_t size)
{
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

bool base64_read(unsigned char *bytes, size_t *size, const char *text)
{
    signed char value[256];
    const size_t length = strlen(text);
    const size_t padding = length && text[length - 1] == '=' ? 1 + (length > 1 && text[length - 2] == '=') : 0;
    uint32_t word = 0;
    memset(value, -1, sizeof value);
    for (int i = 0; i < 64; i++) value[(unsigned char)DIGITS[i]] = (signed char)i;
    *size = 0;
    if (length % 4) return false;
    for (size_t i = 0; i < length; i++) {
        const int digit = i < length - padding ? value[(unsigned char)text[i]] : 0;
        if (digit < 0) return false;
        word = word << 6 | (uint32_t)digit;
        if (i % 4 < 3) continue;
        for (int k = 0; k < 3; k++)
            if (i + 1 < length || k < 3 - (int)padding) bytes[(*size)++] = (unsigned char)(word >> (16 - 8 * k) & 255);
        word = 0;
    }
    return true;
}
