/* view_ids.h - what a rectified view shows of the solid model: out/SCENE/ids/VIEW.exr, and what edits would reveal:
 * out/SCENE/reveal/VIEW.exr. Both are made by trace_ids; one pixel for each of the view. */
#ifndef REMODEL_VIEW_IDS_H
#define REMODEL_VIEW_IDS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/capture/camera_set.h"

#define VIEW_IDS_FAR   32   /* px: larger distances from jumps are not told apart */
#define CLUTTER_UNSURE 0.5f /* the depth is not confident enough to say */

/* {0} is the empty state; everything is owned. */
struct view_ids {
    int width, height;
    uint32_t *id;   /* of the face's name in model.txt, panes of glass included; 0: nothing is hit */
    float *z;       /* depth of that face along the view's axis, scene units; 0: none */
    float *jump;    /* px to the nearest pixel across a depth jump or where the view ends, at most VIEW_IDS_FAR; 0 where
                       the view has no pixel, or id is 0 */
    float *clutter; /* 0: the view shows the face here; 1: something that the model does not hold stands in front, or
                       the view has no pixel; CLUTTER_UNSURE: nothing is known; between: rather the one or the other */
};

/* Makes empty planes. ST_DATA: no pixels, or too many. */
enum status view_ids_init(struct view_ids *v, int width, int height, struct err *err);
void view_ids_release(struct view_ids *v);
enum status view_ids_write(const struct view_ids *v, const struct view *view, const char *path,
                           const struct provenance *prov, struct err *err);
/* Afterwards z is >= 0 and is 0 exactly where id is 0, jump in [0, VIEW_IDS_FAR], clutter in [0, 1]; otherwise ST_DATA
 * with the pixel. view (may be NULL): whose size the file must have. */
enum status view_ids_read(struct view_ids *v, const struct view *view, const char *path, struct provenance *prov,
                          struct err *err);

/* Surfaces that some declared edit reveals and the unedited model does not show there, nearest first. A pixel has as
 * many as the first layer in which its id is 0. */
struct view_reveal {
    int width, height, layers;
    uint32_t **id; /* [layer][pixel] */
    float **z;
};

enum status view_reveal_init(struct view_reveal *v, int width, int height, int layers, struct err *err);
void view_reveal_release(struct view_reveal *v);
/* The file is replaced only if its bytes change. *changed (may be NULL): it was. */
enum status view_reveal_write(const struct view_reveal *v, const struct view *view, const char *path,
                              const struct provenance *prov, bool *changed, struct err *err);
/* Afterwards, in each pixel, layers are filled from the first and z > 0 ascends where there is an id. */
enum status view_reveal_read(struct view_reveal *v, const struct view *view, const char *path, struct provenance *prov,
                             struct err *err);

#endif
