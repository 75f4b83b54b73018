/* stage_list.h - the names of the pipeline's stages, in data-flow order: the order in which the page lists them. */
#ifndef REMODEL_STAGE_LIST_H
#define REMODEL_STAGE_LIST_H

#include <stdbool.h>

#include "common/base/err.h"

enum { STAGE_NAME = 64 }; /* bytes of a stage's name, with its end */

struct stage_list {
    char (*names)[STAGE_NAME]; /* owned */
    int count;
};

/* From names separated by spaces. list is empty on entry, and after an error. ST_USAGE: no name, a name with other
 * characters than letters, digits, _ and -, a name that is too long or occurs twice. */
enum status stage_list_parse(struct stage_list *list, const char *text, struct err *err);
bool stage_list_has(const struct stage_list *list, const char *name);
void stage_list_release(struct stage_list *list);

#endif
