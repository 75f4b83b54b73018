/* scene_planes.h - the dominant planes of a scene, as a view sees them: walls, floors, ceilings. */
#ifndef REMODEL_SCENE_PLANES_H
#define REMODEL_SCENE_PLANES_H

#include <stdint.h>
#include <string.h>

#include "stages/segment_depth/plane_match.h"

#define SCENE_PLANES 36
#define SCENE_GAIN   0.05 /* by which the data cost of a segment is less on one of them, in the first round */

struct scene_planes {
    struct plane planes[SCENE_PLANES]; /* the most supported first */
    int count;
    int known;        /* how many of the first come from elsewhere, and are not fitted to the view (plane_prior.h) */
    uint64_t filter;  /* of scene_planes_key() of the planes: a plane whose bit is 0 is none of them */
    bool has_ground;  /* the last plane is the ground (gravity.h) */
    int voted_ground; /* 1 + index of the plane of votes that is about the ground; 0: none */
};

static inline unsigned scene_planes_key(struct plane p)
{
    uint64_t bits;
    memcpy(&bits, &p.c, sizeof bits);
    return (unsigned)((bits ^ bits >> 29) * 0x9e3779b97f4a7c15u >> 58);
}

/* Whether a plane is one of them, to the last bit. s may be NULL. */
static inline bool scene_planes_have(const struct scene_planes *s, struct plane p)
{
    if (!s || !(s->filter >> scene_planes_key(p) & 1)) return false;
    for (int k = 0; k < s->count; k++)
        if (memcmp(&s->planes[k], &p, sizeof p) == 0) return true;
    return false;
}

/* Sets plane k, which is below `count`. */
static inline void scene_planes_set(struct scene_planes *s, int k, struct plane p)
{
    s->planes[k] = p;
    s->filter = 0;
    for (int j = 0; j < s->count; j++) s->filter |= (uint64_t)1 << scene_planes_key(s->planes[j]);
}

/* The ground; NULL: unknown, or as well known as any other plane. s may be NULL. */
static inline const struct plane *scene_planes_ground(const struct scene_planes *s)
{
    return s && s->has_ground ? &s->planes[s->count - 1] : NULL;
}

#define SCENE_REACH  3.0
#define GROUND_REACH 30.0
#define KNOWN_REACH  30.0

/* The factor by which a plane may leave the range of depths: more for the ground, whoever found it. s may be NULL. */
static inline double scene_planes_reach(const struct scene_planes *s, struct plane p)
{
    if (!scene_planes_have(s, p)) return 1;
    for (int k = 0; k < s->known; k++)
        if (memcmp(&s->planes[k], &p, sizeof p) == 0) return KNOWN_REACH;
    const int ground = s->has_ground ? s->count : s->voted_ground;
    return ground && memcmp(&s->planes[ground - 1], &p, sizeof p) == 0 ? GROUND_REACH : SCENE_REACH;
}

/* A plane that a part of the view, or of a neighbour, lies on, as far as known. */
struct plane_vote {
    struct plane plane;
    double u, v;   /* where, in the view's pixels */
    double weight; /* pixels */
};

/* Adds the planes that most votes lie on to the known ones of s, in place of all others. step: of inverse depth; least:
 * weight that a plane must have. Planes of constant depth stand for unknown slants, and do not count. ST_NOMEM. */
enum status scene_planes_find(struct scene_planes *s, const struct plane_vote *votes, int count, double step,
                              double least, struct err *err);

#endif
