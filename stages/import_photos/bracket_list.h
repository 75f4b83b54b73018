/* bracket_list.h - brackets.txt: which photographs are exposures of one view.
 *
 *   VIEW FILE FILE ...
 * a line a view: its name, and its photos in any order. Names are made of letters, digits, _ and -. */
#ifndef REMODEL_BRACKET_LIST_H
#define REMODEL_BRACKET_LIST_H

#include "common/base/err.h"

struct bracket_line {
    char *view;   /* owned */
    char **files; /* owned */
    int count;
    int line; /* of the file, from 1 */
};

struct bracket_list {
    char *path; /* owned */
    struct bracket_line *lines;
    int count;
};

/* ST_DATA with file and line: no view at all, a view twice or with a name that is not safe, a view without photos, a
 * photo twice. {0} is the empty list. */
enum status bracket_list_read(struct bracket_list *list, const char *path, struct err *err);
void bracket_list_release(struct bracket_list *list);

#endif
