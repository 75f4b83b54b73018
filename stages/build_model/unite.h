/* unite.h - the union of convex solids as closed half-edge meshes, exact in its topology.
 *
 * Each body is united by itself. Inner faces vanish, coplanar faces that meet along an edge become one face, with holes
 * as loops; solids that touch in an edge or a point stay apart there. The same input gives the same bytes. */
#ifndef REMODEL_BUILD_MODEL_UNITE_H
#define REMODEL_BUILD_MODEL_UNITE_H

#include "common/model/solid_mesh.h"
#include "stages/build_model/solid.h"

enum unite_event {
    UNITE_MERGED, /* some of `name` became part of a face called `into` */
    UNITE_HIDDEN, /* nothing of `name` is on the surface */
};

struct unite_note {
    enum unite_event event;
    const char *name, *into; /* of the solids' names: live as long as the list; into NULL where nothing is left */
};

struct unite_log {
    struct unite_note *notes; /* owned; in the order of names in the list, each pair once */
    int count;
};

/* mesh and log are empty on entry (log may be NULL); the caller releases both. Bodies come in the order in which they
 * first occur, faces of a body in the order of their names in the list; ids are 1, 2, ... likewise.
 * ST_DATA: a solid that is empty, flat after rounding to the lattice, or not bounded, or beyond SOLID_REACH; the
 * sentence names its body and first face. No solids make an empty mesh. */
enum status solids_unite(struct solid_mesh *mesh, const struct solid_list *solids, struct unite_log *log,
                         struct err *err);

void unite_log_release(struct unite_log *log);

#endif
