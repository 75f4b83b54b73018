/* import_model.h - from a structure-from-motion model of photographs to the rectified views of a scene.
 *
 * Errors are in pixels of the stored photo. Same input, same bytes: sums run in the order of points and tracks. */
#ifndef REMODEL_IMPORT_MODEL_H
#define REMODEL_IMPORT_MODEL_H

#include "common/base/param.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

#define IMPORT_PARAMS(X)                                                                                      \
    X(max_megapixels, double, 2, 0, 1000, "Mpx", "larger views are scaled down to this; 0: no limit")         \
    X(max_field, double, 110, 30, 160, "degrees", "a photo with a wider field of view becomes several views") \
    X(max_error, double, 4, 0.01, 1000, "px", "observations whose reprojection error is larger are dropped")

struct import_params {
    IMPORT_PARAMS(PARAM_FIELD)
};
#define IMPORT_PARAMS_DEFAULT        \
    {                                \
        IMPORT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param import_param_table[];

/* Reads SFM/models.txt and, of its models, the one with the most images that are among the photos (then the most
 * points); notes the others. name is its folder inside SFM; the caller frees it. */
enum status import_choose(struct sfm_model *model, char **name, const char *sfm, const struct photo_list *photos,
                          struct err *err);

/* Warns of photos whose content or presence has changed since SFM/photos.txt was written. */
enum status import_check_photos(const char *sfm, const struct photo_list *photos, struct err *err);

struct import_stats {
    int registered, unregistered, strangers; /* photos with and without a pose; images that are none of the photos */
    long long observations, dropped; /* of the registered photos; of these, behind the camera or beyond max_error */
    double mean_error, median_error; /* px, of all that are in front of their camera */
    double stated_error;             /* mean as the model says; -1: it does not */
    int points, points_dropped;
};

struct imported {
    struct sfm_model model;  /* the views: images "VIEW.exr" in order of VIEW, a camera each, ids from 1 */
    struct lens_list lenses; /* in the same order */
    struct import_stats stats;
};

/* ST_DATA with a sentence that says what to do: two images that are one photo, fewer than two registered photos,
 * photos of another size than the model's, no observation that fits. Notes and warnings go to the log. */
enum status import_model(struct imported *out, const struct sfm_model *model, const struct photo_list *photos,
                         const struct import_params *params, struct err *err);

/* Writes points3D, cameras, images.txt, lenses.txt and, last, views.mk. */
enum status imported_write(const struct imported *in, const char *folder, const struct provenance *prov,
                           struct err *err);

void imported_release(struct imported *in);

#endif
