/* name_lines.h - logs a list of names, on as many lines as it needs. */
#ifndef REMODEL_NAME_LINES_H
#define REMODEL_NAME_LINES_H

#include <stddef.h>

struct name_lines {
    const char *heading; /* precedes the names on each line: "HEADING: NAME, NAME" */
    char text[1024];
    size_t used;
};

void name_lines_add(struct name_lines *l, const char *name);
void name_lines_end(struct name_lines *l); /* logs the last line, if there is one */

#endif
