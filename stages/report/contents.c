/* contents.c - notes of what is missing, for the readers of the parts. */
#include "stages/report/contents.h"

#include <stdarg.h>
#include <stdio.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "stages/report/contents_parts.h"

enum status contents_note(struct contents *c, struct err *err, const char *fmt, ...)
{
    va_list args;
    if (array_append(&c->notes, (size_t)c->note_count, sizeof *c->notes, "notes", err)) return err->status;
    va_start(args, fmt);
    vsnprintf(c->notes[c->note_count++], NOTE_SIZE, fmt, args);
    va_end(args);
    return ST_OK;
}

double share_from_text(const char *text)
{
    double value;
    return text && scan_double(text, &value) && value >= 0 && value <= 1 ? value : -1;
}
