/* reveal.h - what edits reveal to a view of the surfaces that the unedited model has. */
#ifndef REMODEL_REVEAL_H
#define REMODEL_REVEAL_H

#include "stages/trace_ids/view_faces.h"

struct revealed { /* per pixel: distinct surfaces in order of depth */
    int width, height, layers;
    uint32_t **id; /* per layer and pixel, 0: none; owned */
    float **z;     /* model units; owned */
};

/* base: the unedited model, as the view shows it in `shown`. The caller releases r in each case. */
enum status reveal_find(struct revealed *r, const struct solid_mesh *base, const struct view_faces *shown,
                        const struct solid_mesh *edits, int edit_count, const struct view *camera, struct err *err);
void reveal_release(struct revealed *r);

/* Writes the layers (docs/formats.md), if they differ from those of an existing file: its provenance does not name the
 * edits, so that an edit that reveals nothing else to this view changes nothing. scale: model units per scene unit. */
enum status reveal_write(const struct revealed *r, double scale, const char *path, const struct provenance *prov,
                         struct err *err);

#endif
