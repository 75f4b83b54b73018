/* unite_names.h - names of a union's faces. */
#ifndef REMODEL_BUILD_MODEL_UNITE_NAMES_H
#define REMODEL_BUILD_MODEL_UNITE_NAMES_H

#include "stages/build_model/solid/unite.h"

struct name_table {
    const char **texts; /* by rank: in the order of first occurrence in the list */
    int *rank;          /* of each half-space's name */
    int *room;          /* by rank: of the name's faces; -1: none */
    char *present;      /* by rank: is on the surface */
    int count;
};

struct merge {
    int name, into;
};

struct merges {
    struct merge *merges;
    int count, capacity;
};

/* Ranks the names and bodies of a list in the order of their first occurrence. body: of each solid. The caller frees
 * the table's arrays, also after a failure. ST_NOMEM. */
enum status unite_rank_names(struct name_table *names, int *body, int *body_count, const struct solid_list *list,
                             struct err *err);

/* Sorts the merges and writes what happened to each name. log is empty on entry. ST_NOMEM. */
enum status unite_write_log(struct unite_log *log, struct merges *merges, const struct name_table *names,
                            struct err *err);

#endif
