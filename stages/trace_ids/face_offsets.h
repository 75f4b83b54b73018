/* face_offsets.h - by how much the photographs disagree with the faces of the model: out/SCENE/ids/offsets.txt.
 *
 *   remodel-face-offsets 1
 *   face NAME VIEWS OFFSET SPREAD      in order of |OFFSET|, largest first
 * OFFSET is the distance of the surface that the photographs show from the face, along its normal, in model units:
 * above 0 it is farther from the cameras. It is the median of what VIEWS views say, of which half differ from
 * it by at most SPREAD. A small SPREAD does not prove the offset: the same mistake may be in all views. */
#ifndef REMODEL_FACE_OFFSETS_H
#define REMODEL_FACE_OFFSETS_H

#include "common/light/model_rays.h"
#include "stages/trace_ids/view_record.h"

struct view_offset {
    int id;
    double offset; /* scene units */
};

/* {0} is the empty state. */
struct face_offsets {
    struct view_offset *items; /* owned */
    int count;
};

/* Adds what one view says. The order of the views makes no difference. */
enum status face_offsets_add(struct face_offsets *o, const struct view_record *record, struct err *err);
/* Writes the list, and warns of the largest offsets on which views agree. axes: of the model. */
enum status face_offsets_write(struct face_offsets *o, const struct model_rays *model, const struct model_axes *axes,
                               const char *path, const struct provenance *prov, struct err *err);
void face_offsets_release(struct face_offsets *o);

#endif
