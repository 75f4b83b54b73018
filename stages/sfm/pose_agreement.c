/* pose_agreement.c - whether given cameras agree with what their photos show.
 *
 * Rays. With the directions d0, d1 of the two rays in the world and the way b from the first centre to the second, the
 * rays meet if d1 lies in the plane of b and d0; the angle from d1 to that plane is compared with the room. Where the
 * plane is not determined (no baseline, or d0 along it) the angle between the rays is. The depths follow from the
 * nearest points of both lines; rays that are nearly parallel meet far away, and have no sign worth a test.
 *
 * Readings. Each changes cam_from_world (R, t). It is written as what must be done to the given pose to get the right
 * one. */
#include "stages/sfm/pose_agreement.h"

#include <math.h>
#include <stdbool.h>
#include <stdlib.h>

struct rigid {
    struct mat3 r; /* cam_from_world */
    struct vec3 t;
};

static struct mat3 diagonal(double x, double y, double z) { return (struct mat3){{{x, 0, 0}, {0, y, 0}, {0, 0, z}}}; }

static struct rigid as_given(struct rigid p) { return p; }

static struct rigid inverse(struct rigid p)
{
    const struct mat3 back = mat3_transpose(p.r);
    return (struct rigid){back, vec3_scale(mat3_apply(back, p.t), -1)};
}

static struct rigid opengl(struct rigid p)
{
    const struct mat3 d = diagonal(1, -1, -1);
    return (struct rigid){mat3_multiply(d, p.r), mat3_apply(d, p.t)};
}

static struct rigid opengl_inverse(struct rigid p) { return opengl(inverse(p)); }

static struct rigid mirrored(struct rigid p, struct mat3 s)
{
    return (struct rigid){mat3_multiply(s, mat3_multiply(p.r, s)), mat3_apply(s, p.t)};
}
static struct rigid mirrored_x(struct rigid p) { return mirrored(p, diagonal(-1, 1, 1)); }
static struct rigid mirrored_y(struct rigid p) { return mirrored(p, diagonal(1, -1, 1)); }
static struct rigid mirrored_z(struct rigid p) { return mirrored(p, diagonal(1, 1, -1)); }

static struct rigid centre(struct rigid p) { return (struct rigid){p.r, vec3_scale(mat3_apply(p.r, p.t), -1)}; }

static struct rigid turned_back(struct rigid p) { return (struct rigid){mat3_transpose(p.r), p.t}; }

static const struct {
    struct rigid (*read)(struct rigid given);
    const char *words;
} readings[] = {
    {as_given, ""},
    {inverse, "as poses from camera to world (COLMAP's are from world to camera)"},
    {opengl, "with camera axes of OpenGL, y up and z backward (COLMAP's are y down and z forward)"},
    {opengl_inverse, "as poses from camera to world with camera axes of OpenGL, y up and z backward"},
    {centre, "with the camera's centre in place of the translation"},
    {turned_back, "with rotations from camera to world beside COLMAP's translations"},
    {mirrored_x, "in left-handed axes, as mirrored in x"},
    {mirrored_y, "in left-handed axes, as mirrored in y"},
    {mirrored_z, "in left-handed axes, as mirrored in z"},
};

static bool agrees(const struct rigid *a, const struct rigid *b, const struct pose_match *m)
{
    const struct vec3 d0 = mat3_apply(mat3_transpose(a->r), m->rays[0]);
    const struct vec3 d1 = mat3_apply(mat3_transpose(b->r), m->rays[1]);
    const struct vec3 way = vec3_sub(inverse(*b).t, inverse(*a).t);
    const struct vec3 normal = vec3_cross(way, d0), across = vec3_cross(d0, d1);
    const double size = vec3_length(normal), turn = vec3_dot(across, across);
    const bool together = vec3_dot(d0, d1) > 0 && turn < m->room * m->room;
    if (together || size <= m->room * vec3_length(way)) return together;
    if (fabs(vec3_dot(d1, normal)) > m->room * size) return false;
    /* depths along both rays: way = s d0 - u d1 across the rays */
    return vec3_dot(vec3_cross(way, d1), across) > 0 && vec3_dot(vec3_cross(way, d0), across) > 0;
}

static double share_of(struct rigid *read, int reading, const struct pose *poses, int pose_count,
                       const struct pose_match *matches, int match_count)
{
    long long agree = 0;
    for (int i = 0; i < pose_count; i++)
        read[i] = readings[reading].read((struct rigid){mat3_from_quat(poses[i].rotation), poses[i].translation});
    for (int i = 0; i < match_count; i++)
        agree += agrees(&read[matches[i].first], &read[matches[i].second], &matches[i]);
    return match_count ? (double)agree / match_count : 0;
}

enum status pose_agreement_measure(struct pose_agreement *a, const struct pose *poses, int pose_count,
                                   const struct pose_match *matches, int match_count, struct err *err)
{
    struct rigid *read = malloc(((size_t)pose_count + 1) * sizeof *read);
    if (!read) return err_nomem(err, "poses", (size_t)pose_count * sizeof *read);
    *a = (struct pose_agreement){.share = share_of(read, 0, poses, pose_count, matches, match_count)};
    for (int k = 1; a->share < AGREE_LEAST && k < (int)(sizeof readings / sizeof *readings); k++) {
        const double share = share_of(read, k, poses, pose_count, matches, match_count);
        if (share <= a->best) continue;
        a->best = share;
        a->reading = readings[k].words;
    }
    free(read);
    return ST_OK;
}
