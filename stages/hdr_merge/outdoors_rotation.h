/* outdoors_rotation.h - how a camera in a window is turned, from what photographs of the room show outside.
 *
 * All vectors are in the frame of the room's model, but for rays of the camera. */
#ifndef REMODEL_OUTDOORS_ROTATION_H
#define REMODEL_OUTDOORS_ROTATION_H

#include "common/base/err.h"
#include "common/math/vec.h"

/* Something outdoors that the camera and a photo show. */
struct outdoors_sight {
    int point;             /* sights of one point have the same ray; ascending */
    int photo;             /* sights of one photo have the same number, from 0 */
    struct vec3 ray;       /* in the camera's frame, of length 1 */
    struct vec3 from;      /* the photo's centre, from that of the camera */
    struct vec3 direction; /* where the photo shows it, of length 1 */
};

struct outdoors_rules {
    double nearest;     /* distance from the camera below which nothing is outdoors, > 0 */
    double place_error; /* standard error of the camera's place along each axis */
    int min_sights;     /* that must agree */
    double max_error;   /* largest accepted standard error, degrees */
};

enum outdoors_verdict {
    OUTDOORS_TURNED,
    OUTDOORS_FEW,      /* too few sights, or too few of them agree */
    OUTDOORS_UNCERTAIN /* they agree with rotations that differ too much */
};

struct outdoors_rotation {
    enum outdoors_verdict verdict;
    struct mat3 cam_from_model; /* as given unless the verdict is OUTDOORS_TURNED */
    int sights, agree, wanted;  /* how many there are, agree with the rotation, had to agree */
    int photos;                 /* whose sights agree */
    double turned;              /* angle to the rotation that was given, degrees */
    double error;               /* standard error of the rotation, degrees: root of the sum over three axes */
    double spread;              /* standard deviation of a sight that agrees, along each axis, degrees */
};

/* Finds the rotation of a camera of known place, at most OUTDOORS_MAX_TURN degrees from cam_from_model. name: of the
 * image, for its random numbers. ST_NOMEM. */
#define OUTDOORS_MAX_TURN 30
enum status outdoors_rotation_find(struct outdoors_rotation *r, struct mat3 cam_from_model,
                                   const struct outdoors_sight *sights, int count, const struct outdoors_rules *rules,
                                   const char *name, struct err *err);

#endif
