/* morph.h - two pictures, the flows between them, and every picture in between (thesis 3.4.5).
 *
 * FOLDER/first.exr, second.exr: R G B half, scene-linear, the picture as the film shows it; flow.x, flow.y float, px to
 * the same thing in the other picture; sure half, 0 (hidden there, or not found) to 1; near float, greater where
 * nearer. */
#ifndef REMODEL_MORPH_H
#define REMODEL_MORPH_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/linear_photo.h"
#include "common/image/image.h"
#include "common/layers/rendered_frame.h"
#include "stages/morph_views/match.h"

struct morph {
    struct image pictures[2]; /* R G B */
    struct flow flows[2];
    double gain[3]; /* the first picture's colours times these are the second one's: exposure, white balance */
    char radiometry[RADIOMETRY_SIZE];
};

/* The medians of what sure matches say; 1 where they say nothing. */
void morph_find_gain(struct morph *m);

/* cameras: the photos', NULL if not known. */
enum status morph_write(const struct morph *m, const struct view *cameras, const char *folder,
                        const struct provenance *prov, struct err *err);
/* ST_DATA: the two do not fit each other, or are no flows. Flows that are not finite are refused, those that are longer
 * than the picture is large, too. */
enum status morph_read(struct morph *m, const char *folder, struct err *err);
void morph_release(struct morph *m);

/* The picture at t in [0, 1]: things on straight ways from their place in one picture to that in the other, at even
 * speed, colours blended on the way. 0 and 1 give the pictures themselves. rgba: alpha 1; z: rank of depth alone, no
 * length; hole: what neither picture shows, filled from what is farther. */
enum status morph_frame(struct rendered_frame *out, const struct morph *m, double t, struct err *err);

#endif
