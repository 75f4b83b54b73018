/* bracket_list.h - brackets.txt: which photographs are exposures of one view.
 *
 *   VIEW FILE FILE ...
 * One line per view: its name (letters, digits, _ and -) and its photos in any order. */
#ifndef REMODEL_BRACKET_LIST_H
#define REMODEL_BRACKET_LIST_H

#include "common/base/err.h"

struct bracket_line {
    char *view;   /* owned */
    char **files; /* owned */
    int count;
    int line; /* in the file, from 1 */
};

struct bracket_list {
    char *path; /* owned */
    struct bracket_line *lines;
    int count;
};

/* ST_DATA with file and line: no views, a duplicate view or an unsafe name, a view without photos, a duplicate photo.
 * {0} is the empty list. */
enum status bracket_list_read(struct bracket_list *list, const char *path, struct err *err);
void bracket_list_release(struct bracket_list *list);

#endif
