/* view_texture.h - a view of a photograph as a picture of a walk, with the depth of the furniture that it shows. */
#ifndef REMODEL_VIEW_TEXTURE_H
#define REMODEL_VIEW_TEXTURE_H

#include <stdio.h>

#include "common/clutter/pane_fronts.h"
#include "stages/walk/walk_scene.h"

/* Alpha of a pixel: 0: the photo does not show it; else SEEN, and more by how much of the pixel is furniture. */
enum { VIEW_ALPHA_SEEN = 15 };

/* Writes {picture, depth, width, height}: depth is a grid of 1 / z (model units, 16 bits, in parts of `most`), then of
 * numbers of things (8 bits), compressed by zlib; 0: no furniture is near. Without depth maps the picture alone. */
enum status view_texture_write(FILE *to, const struct walk_scene *s, int view, const struct pane_fronts *panes,
                               struct err *err);

/* Writes a JPEG of an edited or relit view. sources: PNG of what its pixels come from; where that is the photo itself,
 * the picture is transparent; elsewhere alpha is VIEW_ALPHA_MADE + VIEW_ALPHA_STEP enum picture_made. NULL: a relit
 * view, which is shown where the photo shows something. ST_DATA: the sizes differ from the view's. */
enum { VIEW_ALPHA_MADE = 100, VIEW_ALPHA_STEP = 15 };
enum status view_texture_write_change(FILE *to, const struct walk_scene *s, int view, const char *jpeg,
                                      const char *sources, struct err *err);

#endif
