/* sfm_model.h - cameras, posed images and sparse points, in COLMAP's text format; Bundler's is read too.
 *
 * Written by this program so that reading back gives the same bits (%.17g). */
#ifndef REMODEL_SFM_MODEL_H
#define REMODEL_SFM_MODEL_H

#include <stdint.h>

#include "common/base/provenance.h"
#include "common/capture/camera.h"

struct sfm_camera {
    int64_t id;
    struct camera camera;
};

struct sfm_observation {
    double u, v;
    int64_t point_id; /* -1: none */
};

struct sfm_image {
    int64_t id;
    struct pose cam_from_world;
    int camera_idx; /* into sfm_model.cameras */
    char *name;
    struct sfm_observation *observations;
    int observation_count;
};

struct sfm_track {
    int image_idx, observation_idx;
};

struct sfm_point {
    int64_t id;
    struct vec3 position;
    uint8_t rgb[3];
    double error; /* px, as the file says */
    struct sfm_track *track;
    int track_count;
};

struct sfm_model {
    struct sfm_camera *cameras;
    struct sfm_image *images; /* in order of name */
    struct sfm_point *points; /* in order of id */
    int camera_count, image_count, point_count;
};

/* Reads cameras.txt, images.txt, points3D.txt of a folder. ST_DATA with file and line for: unknown camera model (the
 * models that can be used are listed), NaN, an id twice or missing, a track or observation that points nowhere, a
 * quaternion of length 0 (others are normalised). Empty points3D.txt is fine. */
enum status sfm_model_read_text(struct sfm_model *m, const char *folder, struct err *err);

/* cameras.txt and images.txt alone: poses and lenses, no points and no observations. */
enum status sfm_model_read_cameras(struct sfm_model *m, const char *folder, struct err *err);

/* Reads a Bundler v0.3 file. names[i], sizes[i]: the file name and size in pixels of its camera i; count must be the
 * file's. Cameras with focal length 0 are those Bundler could not place: left out, like those of size 0 x 0. The axes
 * are turned to this program's; RADIAL cameras, principal point in the middle. Point errors are -1: it states none. */
enum status sfm_model_read_bundler(struct sfm_model *m, const char *path, const char *const *names,
                                   const int (*sizes)[2], int count, struct err *err);

/* Writes the three files, each atomically, points3D.txt first and images.txt last. */
enum status sfm_model_write_text(const struct sfm_model *m, const char *folder, const struct provenance *prov,
                                 struct err *err);

void sfm_model_release(struct sfm_model *m);

#endif
