/* pair_list.h - the pairs of photographs that are compared: out/SCENE/pairs.txt.
 *
 *   remodel-pairs 1
 *   pair FIRST SECOND            ids, FIRST before SECOND in the list of photos; in the order of this list */
#ifndef REMODEL_PAIR_LIST_H
#define REMODEL_PAIR_LIST_H

#include "common/base/provenance.h"

struct id_pair {
    char *first, *second; /* owned */
};

struct pair_list {
    struct id_pair *pairs; /* owned */
    int count;
};

enum status pair_list_add(struct pair_list *list, const char *first, const char *second, struct err *err);
/* On failure the list is empty. */
enum status pair_list_read(struct pair_list *list, const char *path, struct provenance *prov, struct err *err);
enum status pair_list_write(const struct pair_list *list, const char *path, const struct provenance *prov,
                            struct err *err);
void pair_list_release(struct pair_list *list);

#endif
