/* view_ranks.h - the best views of each face, gathered view by view. */
#ifndef REMODEL_VIEW_RANKS_H
#define REMODEL_VIEW_RANKS_H

#include "common/texture/face_index.h"
#include "stages/trace_ids/view_record.h"

struct face_rank;

/* {0} is the empty state. */
struct view_ranks {
    struct face_rank *faces; /* by id; owned */
    size_t ids;              /* of faces */
    int max_views;           /* kept of a face */
};

/* Adds what one view shows. The order of the views makes no difference. `name` must outlive the ranks. */
enum status view_ranks_add(struct view_ranks *r, const char *name, const struct view_record *record, struct err *err);
enum status view_ranks_write(struct view_ranks *r, const char *path, const struct provenance *prov, struct err *err);
void view_ranks_release(struct view_ranks *r);

#endif
