/* photo_exposure.h - how much brighter some photos of a scene are than others: exposure, white balance, vignetting.
 *
 * A camera that chooses its exposure for each photo makes the same wall brighter in one photo than in the next;
 * blended, such photos show patches and borders. Photos are brought to one exposure before they are blended
 * (layer_scene.h), and a frame gets the exposure of the photos around its camera afterwards. */
#ifndef REMODEL_PHOTO_EXPOSURE_H
#define REMODEL_PHOTO_EXPOSURE_H

#include "common/layers/layer_view.h"
#include "common/layers/rendered_frame.h"
#include "common/layers/view_mesh.h"

/* Photo i shows, at the tangent r of the angle to its optical axis, exp(gain[i][c] + vignetting r^2) times what photos
 * of the mean exposure show in their middle. */
struct photo_exposures {
    double (*gain)[3]; /* of each view, for R, G, B; owned; NULL: photos are as they were taken */
    double vignetting; /* below 0: corners are darker */
};

/* Compares the views' photos at the sparse points that several of them observe. All exposures are equal (gain is NULL)
 * if nothing differs by a hundredth, which is what photos of one known exposure look like, and beyond 1000 views.
 * ST_NOMEM. */
enum status photo_exposures_fit(struct photo_exposures *e, const struct camera_set *set, const struct layer_view *views,
                                struct err *err);
void photo_exposures_release(struct photo_exposures *e);

/* Brings the photo of view i to the mean exposure, without vignetting. ST_NOMEM. */
enum status photo_exposures_remove(const struct photo_exposures *e, int i, const struct view *view,
                                   struct layer_view *lv, struct err *err);

/* Gives a frame of photos of the mean exposure the one of the photos around its camera, and vignetting. It is the same
 * for any size and crop of the frame. */
void photo_exposures_apply(const struct photo_exposures *e, const struct view_mesh *mesh, const struct view *camera,
                           struct rendered_frame *frame);

#endif
