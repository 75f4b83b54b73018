/* own_view.h - one of the viewpoint's own views, and what of the model it shows or can be made to show. */
#ifndef REMODEL_OWN_VIEW_H
#define REMODEL_OWN_VIEW_H

#include "common/texture/bake.h"

struct own_view {
    struct source_view view;
    struct view_ids ids;       /* without id, which the view has; z in model units */
    struct view_reveal reveal; /* what the edits reveal; z in model units */
};

/* Reads the files of a source (source_view.h) and REVEAL/VIEW.exr. camera: in the model's frame; scale: model units per
 * scene unit. v is overwritten; the caller releases it in each case. */
enum status own_view_read(struct own_view *v, const struct source_files *files, const char *reveal,
                          const struct view *camera, double scale, const struct texture_params *params,
                          struct provenance *prov, struct err *err);
void own_view_release(struct own_view *v);

#endif
