/* sfm_ids.h - ids of the records of a structure-from-motion model, and where these are. Not for other modules. */
#ifndef REMODEL_SFM_IDS_H
#define REMODEL_SFM_IDS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"

/* The id of a record, the index of the record in its array, and its line in the file; 0: the file has no lines. */
struct id_row {
    int64_t id;
    int idx, line;
};

struct id_list {
    struct id_row *rows; /* owned */
    int count;
    bool ascending; /* in the file */
};

enum status id_list_add(struct id_list *l, int64_t id, int line, struct err *err);

/* Sorts by id. ST_DATA: an id is there twice; what: "camera", "image", ... */
enum status id_list_sort(struct id_list *l, const char *path, const char *what, struct err *err);

/* The row with this id, or NULL; the index of its record, or -1. The list is sorted. */
struct id_row *id_list_row(const struct id_list *l, int64_t id);
int id_list_find(const struct id_list *l, int64_t id);

void id_list_release(struct id_list *l);

#endif
