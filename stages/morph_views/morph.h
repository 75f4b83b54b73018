/* morph.h - view morphing: two pictures, the flows between them, and the pictures in between [Colburn 2014, 3.4.5].
 *
 * FOLDER/first.exr, second.exr: R G B half, scene-linear, the picture in the film's format; flow.x, flow.y float, px to
 * the matching point in the other picture; sure half, confidence of the match from 0 (occluded there, or not found) to
 * 1; near float, greater where nearer. */
#ifndef REMODEL_MORPH_H
#define REMODEL_MORPH_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/linear_photo.h"
#include "common/image/image.h"
#include "common/layers/rendered_frame.h"
#include "stages/morph_views/flow_match.h"

struct morph {
    struct image pictures[2]; /* R G B */
    struct flow flows[2];
    double gain[3]; /* colours of the second picture = gain x those of the first: exposure, white balance */
    char radiometry[RADIOMETRY_SIZE];
    bool posed; /* read from files: the first picture has a camera */
};

/* Sets the gain of each channel: the median ratio over confident matches, or 1 if there are too few. */
void morph_find_gain(struct morph *m);

/* cameras: of the two photos, for the EXRs' attributes; NULL: unknown. */
enum status morph_write(const struct morph *m, const struct view *cameras, const char *folder,
                        const struct provenance *prov, struct err *err);
/* ST_DATA: missing channels, different sizes, an invalid gain, or a flow longer than the picture. */
enum status morph_read(struct morph *m, const char *folder, struct provenance *prov, struct err *err);
void morph_release(struct morph *m);

/* The picture at t in [0, 1]: every point moves on a straight line to its match, and colours are blended; 0 and 1 give
 * the two pictures. rgba has alpha 1; z orders pixels by depth, without a unit; hole: pixels that neither picture
 * shows, filled from the far side. */
enum status morph_frame(struct rendered_frame *out, const struct morph *m, double t, struct err *err);

#endif
