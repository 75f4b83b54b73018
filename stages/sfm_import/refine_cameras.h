/* refine_cameras.h - refines the cameras of a structure-from-motion model, with the form of lens that it needs. */
#ifndef REMODEL_REFINE_CAMERAS_H
#define REMODEL_REFINE_CAMERAS_H

#include "stages/sfm_import/bundle.h"
#include "stages/sfm_import/choose_model.h"
#include "stages/sfm_import/import_model.h"
#include "stages/sfm_import/rig.h"

enum { MAX_FORMS = 18 };

struct form_result {
    struct lens_form form;
    struct bundle_fit fit; /* over a part of the observations */
    bool usable;           /* if not, `fit` is not set, or the form was refused */
    double *held_out;      /* owned; the cost of each point when it is held out; NULL: not computed */
};

/* The mean fall of the cost of a held-out point, with its standard error. */
struct held_out_gain {
    double mean, error;
};

/* The shift of an image's principal point from that of its lens, with its standard deviations, px; they are INFINITY if
 * unknown. */
struct principal_shift {
    double u, v, sigma_u, sigma_v;
};

/* A rig whose lenses were adjusted with the same poses in the camera's body in all captures. */
struct rig_result {
    int lenses, captures; /* 0: each image was adjusted on its own */
    double angle;         /* radians; median difference of lenses' poses from their mounts before */
};

struct refinement {
    struct form_result forms[MAX_FORMS]; /* the forms that were compared */
    int form_count, chosen;              /* chosen: -1 if the cameras are kept */
    struct held_out_gain gain;           /* of the form that was tried last, against the cameras as they were */
    struct bundle_fit before, after;     /* over all observations */
    struct principal_shift *shifts;      /* owned; of each image of the model; NULL: principal points do not differ */
    int shift_count;
    struct rig_result rig;
};

/* The name of a form's lens, as SIMPLE_RADIAL or same_model; and of its principal point: kept, shared, per_photo. */
const char *refine_form_model(const struct lens_form *form);
const char *refine_form_center(const struct lens_form *form);

/* Refines lenses, poses and points of the model as params->refine says, and logs the form chosen. split: how photos of
 * a multi-lens camera were split into the model's images; its lenses then keep their poses in the body, unless the
 * images contradict that. What cannot be improved is kept, with a note. The same model gives the same bits.
 * ST_NOMEM. */
enum status refine_cameras(struct refinement *out, struct sfm_model *m, enum given_cameras given,
                           struct split_size split, const struct sfm_import_params *params, struct err *err);

void refine_cameras_release(struct refinement *r);

/* Writes the forms compared, and the shifts of photos, "remodel-lens-forms 1" (docs/formats.md). m: the model that was
 * refined. */
enum status refine_cameras_write(const struct refinement *r, const struct sfm_model *m, const struct photo_list *photos,
                                 const char *path, const struct provenance *prov, struct err *err);

#endif
