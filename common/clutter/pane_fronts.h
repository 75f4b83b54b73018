/* pane_fronts.h - where a room ends before a pane of glass: at the inner face of the wall around it. */
#ifndef REMODEL_PANE_FRONTS_H
#define REMODEL_PANE_FRONTS_H

#include "common/model/solid_mesh.h"
#include "common/texture/view_ids.h"

/* A side of a pane, and the plane before it. */
struct pane_front {
    int id; /* of the pane's face */
    struct solid_face plane;
};

/* {0} is the empty state. */
struct pane_fronts {
    struct pane_front *list; /* in order of id; owned */
    int count;
};

/* mesh: the unedited model; NULL gives an empty list. */
enum status pane_fronts_find(struct pane_fronts *f, const struct solid_mesh *mesh, struct err *err);
void pane_fronts_release(struct pane_fronts *f);

/* Where a pixel shows a pane, brings its z forward to the plane before it. view: model frame; scale: model units per
 * scene unit. A camera that is beyond that plane already sees the pane itself. */
void pane_fronts_apply(struct view_ids *ids, const struct pane_fronts *f, const struct view *view, double scale);

#endif
