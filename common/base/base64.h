/* base64.h - bytes as text, for pictures inside of pages and drawings: RFC 4648, no line breaks. */
#ifndef REMODEL_BASE64_H
#define REMODEL_BASE64_H

#include <stdbool.h>
#include <stddef.h>
#include <stdio.h>

#include "common/base/err.h"

void base64_write(FILE *to, const void *bytes, size_t size);
/* The bytes of a file. ST_IO. */
enum status base64_write_file(FILE *to, const char *path, struct err *err);
/* The reverse: bytes of a text, of which there are at most 3 / 4 of its characters. False: it is not base64. */
bool base64_read(unsigned char *bytes, size_t *size, const char *text);

#endif
