/* unite.h - the union of convex solids as closed half-edge meshes, with exact topology.
 *
 * Each body is united separately. Inner faces vanish; coplanar faces that meet along an edge become one face, with
 * holes as loops, except that floors and ceilings, floor/R... and ceiling/R..., are merged only with faces of the same
 * room R: two rooms' floors may be of two materials. Solids that touch in an edge or a point stay separate there. The
 * same input gives the same bytes. */
#ifndef REMODEL_BUILD_MODEL_UNITE_H
#define REMODEL_BUILD_MODEL_UNITE_H

#include "common/model/solid_mesh.h"
#include "stages/build_model/solid/solid.h"

enum unite_event {
    UNITE_MERGED, /* a part of `name` became part of the face `into` */
    UNITE_HIDDEN, /* no part of `name` is on the surface */
};

struct unite_note {
    enum unite_event event;
    const char *name, *into; /* owned by the list of solids; into is NULL for UNITE_HIDDEN */
};

struct unite_log {
    struct unite_note *notes; /* owned; in the order of names in the list, each pair once */
    int count;
};

/* mesh and log are empty on entry (log may be NULL) and after a failure; the caller releases both. Bodies come in the
 * order of their first occurrence, faces of a body in the order of their names in the list; ids are 1, 2, ... in the
 * same order. ST_DATA: a solid is empty, flat after rounding to the lattice, unbounded, or beyond SOLID_REACH; the
 * message names its body and first face. No solids make an empty mesh. */
enum status unite_solids(struct solid_mesh *mesh, const struct solid_list *solids, struct unite_log *log,
                         struct err *err);

void unite_log_release(struct unite_log *log);

#endif
