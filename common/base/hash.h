/* hash.h - content hashes (XXH3, 128 bits, as 32 hexadecimal digits). */
#ifndef REMODEL_HASH_H
#define REMODEL_HASH_H

#include "common/base/err.h"

#define HASH_TEXT 33

void hash_bytes(char hex[HASH_TEXT], const void *bytes, size_t size);
enum status hash_file(char hex[HASH_TEXT], const char *path, struct err *err);

#endif
