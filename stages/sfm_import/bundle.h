/* bundle.h - bundle adjustment of a structure-from-motion model with a given form of its lenses. */
#ifndef REMODEL_BUNDLE_H
#define REMODEL_BUNDLE_H

#include "common/capture/sfm_model.h"
#include "stages/sfm_import/ceres_bundle.h"

enum principal_point {
    CENTER_KEPT,      /* as the model has it */
    CENTER_SHARED,    /* adjusted, one for all photos of a lens */
    CENTER_PER_PHOTO, /* the same, and each photo's is shifted */
};

struct lens_form {
    bool lens_kept;          /* nothing of the lens is adjusted; the other members are not used */
    bool model_kept;         /* of all lenses; `model` is not used */
    bool focal_only;         /* the distortion is not adjusted */
    enum camera_model model; /* of perspective lenses; other lenses keep theirs */
    enum principal_point center;
};

/* Robust statistics of a fit. */
struct bundle_fit {
    double median;  /* of the residuals' lengths, px */
    double noise;   /* sigma of a pixel coordinate, px: the scale of the residuals' Student t distribution */
    int parameters; /* of lenses and shifts */
    double bic;     /* Bayesian information criterion [Schwarz 1978]; lower is better */
};

/* What is known of the poses. Given ones: photos at one place are cut from one picture and keep one centre; images and
 * centres with few observations are not adjusted, the others have priors. */
enum bundle_poses { POSES_FOUND, POSES_GIVEN };

/* A bundle of the model's observations whose points are in front of their camera. At most max_observations are taken
 * (0: all), by the points with the longest tracks, about equally many from each image. The caller frees it with
 * bundle_release(). points[k] of the bundle is m->points[point_of[k]]. ST_NOMEM. */
enum status bundle_make(struct bundle *b, int **point_of, const struct sfm_model *m, enum bundle_poses poses,
                        size_t max_observations, struct err *err);
/* Sets the priors of given poses from the noise of the residuals with them, px: the angle that it is, and the length
 * that this angle is at the points' median distance. ST_NOMEM. */
enum status bundle_trust_poses(struct bundle *b, double noise, struct err *err);
/* Ties the images of a rig to the frames of their captures and mounts: sets how far a lens's pose in the body differs
 * from capture to capture, from the noise of the residuals, px. ST_NOMEM. */
enum status bundle_trust_rig(struct bundle *b, double noise, struct err *err);
enum status bundle_copy(struct bundle *to, const struct bundle *from, struct err *err);
void bundle_release(struct bundle *b);

/* Whether some lens of the bundle can take another model: those with two radial coefficients at most. */
bool bundle_can_convert(const struct bundle *b);

/* Adjusts the bundle with its lenses in this form, at the scale b->noise of the residuals. shift_sigma: prior of a
 * photo's shift, px. ST_DATA: the solver failed, a lens folds inside the picture, or something left its prior. */
enum status bundle_adjust(struct bundle_fit *fit, struct bundle *b, const struct lens_form *form, double shift_sigma,
                          struct err *err);

/* Takes the lenses, poses, shifts and rig of a bundle of the same images; what is held stays held. */
void bundle_take_cameras(struct bundle *b, const struct bundle *from);

/* Adjusts the points alone, to the cameras as they are. ST_DATA: the solver failed. */
enum status bundle_adjust_points(struct bundle *b, struct err *err);

/* Leaves the observations of every `folds`th point, from the point `fold` on, or those of all others. */
void bundle_keep_fold(struct bundle *b, int fold, int folds, bool others);

/* Adds to cost[point_count] what each point's observations cost: twice their negative log likelihood, but for a
 * constant, at the scale b->noise. */
void bundle_add_costs(double *cost, const struct bundle *b);

/* Drops the observations whose point is behind their camera or outside its lens. */
void bundle_prune(struct bundle *b);

/* Drops the observations of evenly spaced points, so that at most about max_observations stay. */
void bundle_thin(struct bundle *b, size_t max_observations);

/* The statistics of the bundle as it is; fit->parameters is read. */
enum status bundle_measure(struct bundle_fit *fit, const struct bundle *b, struct err *err);

/* Writes lenses, poses and points back. With shifts each image gets a camera of its own. ST_NOMEM. */
enum status bundle_store(struct sfm_model *m, const struct bundle *b, const int *point_of, struct err *err);

#endif
