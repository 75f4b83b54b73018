/* transforms_file.h - transforms.json, as NeRF's first data sets, instant-ngp and nerfstudio write it: cameras.
 *
 * Lengths are in the world's units, lenses in px, of a picture whose top left corner is (0, 0). */
#ifndef REMODEL_TRANSFORMS_FILE_H
#define REMODEL_TRANSFORMS_FILE_H

#include <jansson.h>
#include <stdbool.h>

#include "common/base/err.h"
#include "common/base/file_path.h"
#include "common/math/vec.h"

/* A lens of the Brown-Conrady model, or a fisheye: the radius is the angle from the axis times 1 + k1 angle^2 + ...
 * Coefficients in OpenCV's order and signs. */
struct given_lens {
    int width, height; /* px */
    double fx, fy, cx, cy;
    double k[4], p[2];
    bool fisheye;
};

struct transforms_file {
    char path[FILE_PATH];
    json_t *root;         /* owned */
    const json_t *frames; /* a list, not empty */
};

/* {0} may be closed. ST_DATA names the file, and the line: no JSON, no frames. */
enum status transforms_file_open(struct transforms_file *t, const char *path, struct err *err);
void transforms_file_close(struct transforms_file *t);

/* A frame, and what holds for all frames. */
struct transforms_frame {
    const json_t *own, *all;
    char where[FILE_PATH + 64]; /* for messages: "PATH: frame 3 (NAME)" */
};

/* Frame i. *name: of its file; it lasts as long as t; NULL if it has none. */
void transforms_file_frame(struct transforms_frame *f, const char **name, const struct transforms_file *t, size_t i);

/* The number of a frame, or of all frames; *value is unchanged if neither has it. */
enum status transforms_file_number(const struct transforms_frame *f, const char *key, double *value, struct err *err);
bool transforms_file_is_panorama(const struct transforms_frame *f);

/* width, height: of the picture where the file does not say; 0: unknown. *known: false if the size is unknown, and the
 * lens with it. ST_DATA: a model that OpenCV does not have, a missing focal length, a value that is not a number. */
enum status transforms_file_lens(struct given_lens *lens, bool *known, const struct transforms_frame *f, double width,
                                 double height, struct err *err);
/* axes[k] is the direction of the camera's x (right), y (down), z (forward) axis in the world. ST_DATA: missing. */
enum status transforms_file_pose(struct vec3 axes[3], struct vec3 *center, const struct transforms_frame *f,
                                 struct err *err);

#endif
