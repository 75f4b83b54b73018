/* photo_id.c - see photo_id.h. */
#include "common/capture/photo_id.h"

#include <stdbool.h>
#include <string.h>

static bool id_char(char c)
{
    return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') || c == '_' || c == '-';
}

void photo_id_from_stem(char id[MAX_PHOTO_ID + 1], const char *stem, size_t length)
{
    size_t n = 0;
    bool begun = false, named = false, run = false; /* run: within a run of replaced characters */
    for (size_t i = 0; i < length && n < MAX_PHOTO_ID; i++) {
        bool plain = id_char(stem[i]) && (begun || stem[i] != '-');
        if (plain || !run) id[n++] = plain ? stem[i] : '_';
        begun |= plain;
        named |= plain && stem[i] != '_' && stem[i] != '-';
        run = !plain;
    }
    id[n] = 0;
    if (!named) strcpy(id, "photo");
}
