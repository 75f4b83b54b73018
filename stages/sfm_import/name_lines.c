/* name_lines.c - logs a list of names, on as many lines as it needs. */
#include "stages/sfm_import/name_lines.h"

#include <stdio.h>
#include <string.h>

#include "common/base/log.h"

void name_lines_end(struct name_lines *l)
{
    if (l->used) log_note("%s: %s", l->heading, l->text);
    l->used = 0;
}

void name_lines_add(struct name_lines *l, const char *name)
{
    if (l->used && l->used + strlen(name) + 3 > sizeof l->text) name_lines_end(l);
    int n = snprintf(l->text + l->used, sizeof l->text - l->used, "%s%s", l->used ? ", " : "", name);
    l->used += (size_t)n < sizeof l->text - l->used ? (size_t)n : sizeof l->text - l->used - 1;
}
