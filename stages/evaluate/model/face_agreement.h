/* face_agreement.h - whether a model shows the right faces: its ids against true ids, pixel by pixel.
 *
 * Names and divisions of faces differ between a model and a truth, so faces are matched by plane and outline, over all
 * pictures together: a true face and a face of the model belong together if they are parallel within 10 degrees,
 * the true points of the pixels that they share are on average within MATCH_DISTANCE of the model's plane, and those
 * pixels are at least MATCH_SHARE of the pixels of one of the two. A face may belong to several. Pixels within
 * EDGE_DISTANCE px of an edge in either picture are not used. Id 0 is the outdoors; it belongs to id 0 only. */
#ifndef REMODEL_FACE_AGREEMENT_H
#define REMODEL_FACE_AGREEMENT_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/err.h"
#include "common/math/vec.h"

#define MATCH_DISTANCE 0.1  /* m */
#define MATCH_SHARE    0.25 /* of the pixels of the smaller face of a pair */
#define EDGE_DISTANCE  3    /* px */

struct face_pair {
    uint64_t pixels;
    double distance; /* sum over the pixels: of the true point from the model's plane */
};

struct face_counts { /* of one picture: pixels[t * model_faces + m] */
    uint64_t *pixels;
    uint64_t all; /* pixels of the picture that are far enough from edges */
};

/* Ids are 0 .. faces - 1. Everything is owned. */
struct face_agreement {
    int true_faces, model_faces;
    struct vec3 *true_normals, *model_normals; /* in one frame; 0 0 0: unknown, any direction matches */
    bool *counted;                             /* of true faces: 0: furniture, which the model need not have */
    struct face_pair *pairs;
    struct face_counts *pictures;
    int picture_count;
};

enum status face_agreement_init(struct face_agreement *a, int true_faces, int model_faces, struct err *err);

struct face_pixels { /* of one picture, width x height each */
    const uint32_t *truth, *model;
    const float *distance; /* of the true point from the plane of the model's face, m; where both ids are above 0 */
    int width, height;
};
/* Adds a picture. ST_DATA: an id out of range; ST_NOMEM. */
enum status face_agreement_add(struct face_agreement *a, const struct face_pixels *p, struct err *err);

/* Whether the two faces belong together, after all pictures were added. */
bool faces_match(const struct face_agreement *a, int true_face, int model_face);

struct face_shares {
    uint64_t counted, agreeing; /* pixels of counted true faces; of them, those whose faces belong together */
    uint64_t all;               /* pixels far enough from edges */
    int worst;                  /* true face with the most pixels that do not agree; -1: none */
};
/* picture -1: all of them. */
struct face_shares face_shares_of(const struct face_agreement *a, int picture);
void face_agreement_release(struct face_agreement *a);

#endif
