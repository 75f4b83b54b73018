/* name_list.h - lists of names: photos, views, edits, frames; and those that a product lists for Make.
 *
 * {0} is the empty list. */
#ifndef REMODEL_NAME_LIST_H
#define REMODEL_NAME_LIST_H

#include <stdbool.h>
#include <stddef.h>

#include "common/base/err.h"

struct name_list {
    char **names; /* owned, and so is each name */
    int count;
    size_t capacity;
};

enum status name_list_add(struct name_list *list, const char *name, size_t length, struct err *err);
enum status name_list_add_words(struct name_list *list, const char *words, struct err *err); /* NULL: none */

/* Adds the words of the line "VARIABLE := WORDS" of a file. Nothing where the file or the line is missing: the product
 * that lists them has not been made. */
enum status name_list_read(struct name_list *list, const char *path, const char *variable, struct err *err);

/* Adds the names between `before` and `after` of the files of a folder whose names begin and end with these, in order.
 * Names with characters other than letters, digits, `_`, `-`, `.`, `@` and `+` are left out. */
enum status name_list_add_files(struct name_list *list, const char *folder, const char *before, const char *after,
                                struct err *err);

bool name_list_has(const struct name_list *list, const char *name);
void name_list_sort(struct name_list *list); /* by bytes; each name once */
void name_list_release(struct name_list *list);

#endif
