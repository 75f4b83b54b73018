/* hash.h - hashes of file contents: XXH3, 128 bits, as 32 hexadecimal digits. */
#ifndef REMODEL_HASH_H
#define REMODEL_HASH_H

#include <stddef.h>
#include <stdint.h>

#include "common/base/err.h"

enum { HASH_TEXT = 33 }; /* bytes of a hash as text, with the final NUL */

enum status hash_file(char hex[HASH_TEXT], const char *path, struct err *err);
void hash_bytes(char hex[HASH_TEXT], const void *bytes, size_t size); /* of such a file in memory */

/* Hash of a text for tables in memory (FNV-1a, its halves folded); never written to a file. */
uint64_t hash_text(const char *text);

#endif
