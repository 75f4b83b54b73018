/* contents.c - notes of what is missing, for the readers of the parts. */
#include "stages/report/contents.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/report/contents_parts.h"
#include "stages/report/passing.h"

enum status contents_note(struct contents *c, struct err *err, const char *fmt, ...)
{
    va_list args;
    if (array_append(&c->notes, (size_t)c->note_count, sizeof *c->notes, "notes", err)) return err->status;
    va_start(args, fmt);
    vsnprintf(c->notes[c->note_count++], NOTE_SIZE, fmt, args);
    va_end(args);
    return passing_refuse(c->notes[c->note_count - 1], err);
}

bool contents_product(char path[FILE_PATH], const char *folder, enum product_id id, const struct product_key *key)
{
    struct err none = ERR_INIT; /* no file has a path that is too long */
    return !product_path_below(path, folder, id, key, &none) && path_is_file(path);
}

char *contents_product_name(const char *folder, enum product_id id, const struct product_key *key)
{
    char path[FILE_PATH];
    return contents_product(path, folder, id, key) ? strdup(path) : NULL;
}

double share_from_text(const char *text)
{
    double value;
    return text && scan_double(text, &value) && value >= 0 && value <= 1 ? value : -1;
}
