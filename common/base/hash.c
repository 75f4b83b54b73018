/* hash.c - hashes files. */
#include "common/base/hash.h"

#include <stdio.h>
#include <stdlib.h>
#include <xxhash.h>

static void hex_from_hash(char hex[HASH_TEXT], XXH128_hash_t hash)
{
    snprintf(hex, HASH_TEXT, "%016llx%016llx", (unsigned long long)hash.high64, (unsigned long long)hash.low64);
}

enum status hash_file(char hex[HASH_TEXT], const char *path, struct err *err)
{
    enum { BLOCK = 1 << 20 };
    FILE *fp = fopen(path, "rbe");
    XXH3_state_t *state = XXH3_createState();
    unsigned char *block = malloc(BLOCK);
    size_t n = 0;

    if (!fp)
        err_errno(err, "open", path);
    else if (!state || !block || XXH3_128bits_reset(state) == XXH_ERROR)
        err_nomem(err, "hashing a file", BLOCK);
    while (!err->status && (n = fread(block, 1, BLOCK, fp)) > 0) XXH3_128bits_update(state, block, n);
    if (!err->status && ferror(fp)) err_errno(err, "read", path);
    if (!err->status) hex_from_hash(hex, XXH3_128bits_digest(state));

    free(block);
    XXH3_freeState(state);
    if (fp) fclose(fp);
    return err->status;
}

void hash_bytes(char hex[HASH_TEXT], const void *bytes, size_t size) { hex_from_hash(hex, XXH3_128bits(bytes, size)); }

uint64_t hash_text(const char *text)
{
    uint64_t h = 1469598103934665603u;
    for (; *text; text++) h = (h ^ (unsigned char)*text) * 1099511628211u;
    return h ^ (h >> 32);
}
