/* product_inputs.c - finds the lines "NAME HASH" of a product. */
#include "stages/verify/product_inputs.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

/* The name as textfile_quote() printed it, without its quotes. */
static char *unquoted(const char *name, size_t length)
{
    char *out = malloc(length + 1), *to = out;
    if (!out) return NULL;
    if (length < 2 || name[0] != '"' || name[length - 1] != '"') {
        memcpy(out, name, length);
        out[length] = '\0';
        return out;
    }
    for (size_t i = 1; i + 1 < length; i++) {
        if (name[i] == '\\' && i + 2 < length) i++;
        *to++ = name[i];
    }
    *to = '\0';
    return out;
}

/* A line "NAME HASH"; any other is left alone. */
static enum status add_line(struct product_inputs *inputs, const char *line, size_t length, struct err *err)
{
    const size_t digits = HASH_TEXT - 1;
    struct product_input input = {0};
    if (length < digits + 2 || line[length - digits - 1] != ' ') return ST_OK;
    memcpy(input.hash, line + length - digits, digits);
    if (strspn(input.hash, "0123456789abcdef") != digits) return ST_OK;
    if (array_append(&inputs->items, (size_t)inputs->count, sizeof input, "inputs", err)) return err->status;
    if (!(input.name = unquoted(line, length - digits - 1))) return err_nomem(err, "the name of an input", length);
    inputs->items[inputs->count++] = input;
    return ST_OK;
}

/* Lines of a text with `prefix` in front. */
static enum status add_lines(struct product_inputs *inputs, const char *text, size_t size, const char *prefix,
                             const char *comment, struct err *err)
{
    const size_t skip = strlen(prefix);
    for (size_t at = 0; !err->status && at < size;) {
        const char *line = text + at, *end = memchr(line, '\n', size - at);
        const size_t length = end ? (size_t)(end - line) : size - at;
        if (length < strlen(comment) || strncmp(line, comment, strlen(comment)) != 0) break;
        if (length > skip && !strncmp(line, prefix, skip)) add_line(inputs, line + skip, length - skip, err);
        at += length + 1;
    }
    return err->status;
}

enum status product_inputs_read(struct product_inputs *inputs, const char *bytes, size_t size, struct err *err)
{
    static const char exr[] = {0x76, 0x2f, 0x31, 0x01}, attribute[] = "remodel:inputs\0string"; /* and its NUL */
    *inputs = (struct product_inputs){0};
    if (size < sizeof exr || memcmp(bytes, exr, sizeof exr) != 0)
        return add_lines(inputs, bytes, size, "# input ", "#", err);
    /* a string attribute: name, type, its length in four bytes, the lowest first, its letters */
    const char *found = memmem(bytes, size, attribute, sizeof attribute);
    if (!found) return ST_OK;
    const unsigned char *length = (const unsigned char *)found + sizeof attribute;
    const size_t left = size - (size_t)(found - bytes) - sizeof attribute;
    if (left < 4) return ST_OK;
    const size_t count = length[0] | (size_t)length[1] << 8 | (size_t)length[2] << 16 | (size_t)length[3] << 24;
    if (count > left - 4) return ST_OK;
    return add_lines(inputs, (const char *)length + 4, count, "", "", err);
}

void product_inputs_release(struct product_inputs *inputs)
{
    for (int i = 0; i < inputs->count; i++) free(inputs->items[i].name);
    free(inputs->items);
    *inputs = (struct product_inputs){0};
}
