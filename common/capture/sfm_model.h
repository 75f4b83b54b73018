/* sfm_model.h - cameras, posed images and sparse points. Reads and writes COLMAP text, reads its binary files and
 * Bundler's.
 *
 * Numbers are written with %.17g, so that reading them back gives the same bits. */
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
    double error; /* px, as stated by the file */
    struct sfm_track *track;
    int track_count;
};

struct sfm_model {
    struct sfm_camera *cameras;
    struct sfm_image *images; /* in order of name */
    struct sfm_point *points; /* in order of id */
    int camera_count, image_count, point_count;
};

/* Reads cameras.txt, images.txt and points3D.txt of a folder; points3D.txt may be empty. ST_DATA with file and line:
 * unsupported camera model (the message lists the supported ones), NaN, duplicate or missing id, a track or observation
 * that refers to nothing, a quaternion of length 0 (other lengths are normalised). The files are recorded in prov, as
 * are those that readers of other products read; it may be NULL. */
enum status sfm_model_read_text(struct sfm_model *m, const char *folder, struct provenance *prov, struct err *err);

/* The same of a folder that another program exported, as text or as .bin files. The points may be missing. What refers
 * to nothing is accepted: entries of tracks without an observation of their point are left out, and *loose counts them;
 * other observations are of no point. ST_DATA, of binary files without a line: as above. */
enum status sfm_model_read_given_text(struct sfm_model *m, const char *folder, long long *loose, struct err *err);
enum status sfm_model_read_given_binary(struct sfm_model *m, const char *folder, long long *loose, struct err *err);

/* Reads cameras.txt and images.txt only: poses and lenses, no points and no observations. */
enum status sfm_model_read_cameras(struct sfm_model *m, const char *folder, struct provenance *prov, struct err *err);

/* The same from two files of any name. of_images may be NULL: the lenses only. */
enum status sfm_model_read_camera_files(struct sfm_model *m, const char *of_cameras, const char *of_images,
                                        struct provenance *prov, struct err *err);

/* Reads a Bundler v0.3 file. names[i], sizes[i]: file name and size in pixels of its camera i; count must be the number
 * of cameras in the file. Cameras that Bundler could not place (focal length 0) and those of size 0 x 0 are left out.
 * The result has this program's axes and RADIAL cameras with the principal point in the centre; point errors are -1
 * because the format has none. */
enum status sfm_model_read_bundler(struct sfm_model *m, const char *path, const char *const *names,
                                   const int (*sizes)[2], int count, struct err *err);

/* Writes the three files, each atomically, points3D.txt first and images.txt last. prov may be NULL. */
enum status sfm_model_write_text(const struct sfm_model *m, const char *folder, const struct provenance *prov,
                                 struct err *err);

void sfm_model_release(struct sfm_model *m);

#endif
