/* import_model.h - from a structure-from-motion model of photographs to the rectified views of a scene.
 *
 * Errors are in pixels of the stored photo. The same input gives the same bytes: sums run in the order of points and
 * tracks. */
#ifndef REMODEL_IMPORT_MODEL_H
#define REMODEL_IMPORT_MODEL_H

#include "common/base/param.h"
#include "common/capture/lens_list.h"
#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"
#include "stages/sfm_import/lens_fit.h"
#include "stages/sfm_import/residual_table.h"

#define SFM_IMPORT_PARAMS(X)                                                                                        \
    X(max_megapixels, double, 2, 0, 1000, "Mpx", "size to which larger views are scaled down; 0: no limit")         \
    X(max_field, double, 110, 30, 160, "degrees", "field of view above which a photo is split into several views")  \
    X(max_error, double, 4, 0.01, 1000, "px", "reprojection error above which observations are dropped")            \
    X(refine, choice, "auto", 0, 0, "auto|yes|no",                                                                  \
      "bundle adjustment of the cameras, with the form of lens that the photos need; auto: not of a lens or model"  \
      " that was given")                                                                                            \
    X(principal_shift, double, 0.005, 0, 0.1, "",                                                                   \
      "expected shift of the principal point from photo to photo, as by a stabiliser, in parts of the longer side;" \
      " 0: none")

struct sfm_import_params {
    SFM_IMPORT_PARAMS(PARAM_FIELD)
};
#define SFM_IMPORT_PARAMS_DEFAULT        \
    {                                    \
        SFM_IMPORT_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param sfm_import_param_table[];

struct import_stats {
    int registered, unregistered;    /* photos with and without a pose */
    int unknown;                     /* images that are not photos of the scene */
    long long observations;          /* in registered photos */
    long long dropped;               /* of these: behind the camera, outside the lens or beyond max_error */
    double mean_error, median_error; /* px, of all observations with a reprojected pixel */
    double stated_error;             /* mean as stated by the model; -1: not stated */
    struct lens_fit lens;
    int points, points_dropped;
};

struct imported {
    struct sfm_model model;  /* the views: images "VIEW.exr" in order of VIEW, one camera each, ids from 1 */
    struct lens_list lenses; /* in the same order */
    struct import_stats stats;
    struct residual_table residuals; /* of all views together; empty in parts of a split */
};

/* Notes and warnings go to the log. ST_DATA: two images of one photo, fewer than two registered photos, photos whose
 * aspect ratio differs from the model's, no observation that fits. */
enum status import_model(struct imported *out, const struct sfm_model *model, const struct photo_list *photos,
                         const struct sfm_import_params *params, struct err *err);

/* Writes points3D, cameras, images.txt, lenses.txt and, last, views.mk. */
enum status import_write(const struct imported *in, const char *folder, const struct provenance *prov, struct err *err);

void import_release(struct imported *in);

#endif
