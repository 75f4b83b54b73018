/* shot.c - the cameras of a move.
 *
 * Rules of [Colburn 2014, 3.4.2]: establishing moves and the wide end of a dolly in or out point at the scene's
 * centroid at the views' mean focal length f; a close end points at the subject's lower half at 1.5 f; a dolly zoom
 * keeps its subject's size.
 *
 * What differs. For two subjects the thesis sets the second end's focal length by the ratio of the subjects' sizes.
 * Here both ends keep the size that the first subject has at the origin at 1.5 f (less if the subject is large): the
 * second subject ends at exactly the size at which the first began, and the validity of one end does not depend on the
 * position of the other. A dolly zoom likewise keeps the size that its subject has at the origin at f. The close end of
 * a dolly limits the subject to half of the frame's height by zooming and to MAX_SUBJECT_GAIN by moving. */
#include "common/film/shot.h"

#include <string.h>

struct vec3 world_from_shot(const struct shot_setup *shot, double x, double y, double z)
{
    struct vec3 p = vec3_add(shot->origin, vec3_scale(shot->axis_x, x));
    p = vec3_add(p, vec3_scale(shot->axis_y, y));
    return vec3_add(p, vec3_scale(shot->axis_z, z));
}

struct vec3 shot_from_world(const struct shot_setup *shot, struct vec3 world)
{
    const struct vec3 d = vec3_sub(world, shot->origin);
    return vec3_make(vec3_dot(d, shot->axis_x), vec3_dot(d, shot->axis_y), vec3_dot(d, shot->axis_z));
}

struct view shot_aim(const struct shot_setup *shot, struct vec3 at, struct vec3 target, double focal)
{
    struct view v = shot->lens;
    struct vec3 z = vec3_sub(target, at);
    if (!(vec3_length(z) > 0)) z = shot->axis_z;
    z = vec3_normalize(z);
    struct vec3 x = vec3_cross(z, shot->up);
    if (vec3_length(x) < 0.01) x = shot->axis_x; /* straight up or down */
    struct vec3 y = vec3_normalize(vec3_cross(z, x));
    x = vec3_cross(y, z);
    v.fx = v.fy = focal;
    v.cam_from_world = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}};
    v.center = at;
    v.translation = vec3_scale(mat3_apply(v.cam_from_world, at), -1);
    return v;
}

/* Height of the quadrilateral in the picture at a focal length of 1 px; 0 if it is not in front of the camera. */
static double unit_size(const struct shot_setup *shot, const struct shot_end *end, struct vec3 at, struct vec3 target)
{
    const struct view camera = shot_aim(shot, at, target, 1);
    struct subject s = {0};
    memcpy(s.corner, end->corner, sizeof s.corner);
    return subject_size_in(&s, &camera);
}

static double focal_at(const struct shot_setup *shot, const struct shot_end *end, struct vec3 at, struct vec3 target)
{
    if (end->focal > 0) return end->focal;
    const double size = unit_size(shot, end, at, target);
    return size > 0 ? end->size / size : 0;
}

struct view shot_end_camera(const struct shot_setup *shot, const struct shot_end *end, struct vec3 at)
{
    double focal = focal_at(shot, end, at, end->target);
    if (end->focal > 0 && end->size > 0) {
        const double size = focal * unit_size(shot, end, at, end->target);
        if (!(size > 0 && size <= end->size)) focal = 0;
    }
    return shot_aim(shot, at, end->target, focal);
}

static struct vec3 between(struct vec3 a, struct vec3 b, double t)
{
    return vec3_add(vec3_scale(a, 1 - t), vec3_scale(b, t));
}

struct view shot_camera(const struct shot_setup *shot, const struct shot_move *m, const struct vec3 at[2], double t)
{
    const struct shot_end *a = &m->end[0], *b = &m->end[1];
    const struct vec3 position = between(at[0], at[1], t), target = between(a->target, b->target, t);
    double focal;
    if (!(a->focal > 0) && !(b->focal > 0) && a->size == b->size && !memcmp(a->corner, b->corner, sizeof a->corner))
        focal = focal_at(shot, a, position, target);
    else
        focal = (1 - t) * focal_at(shot, a, at[0], a->target) + t * focal_at(shot, b, at[1], b->target);
    return shot_aim(shot, position, target, focal);
}

static struct shot_end keep_size(const struct subject *s, struct vec3 target, double size)
{
    struct shot_end end = {.target = target, .size = size};
    memcpy(end.corner, s->corner, sizeof end.corner);
    return end;
}

/* Focal length of a close end: 1.5 f, reduced to as little as f if the subject would fill more than half of the frame.
 * size: the subject's at f, px. */
static double close_focal(const struct shot_setup *shot, double size)
{
    const double f = shot->lens.fx;
    return fmax(f, fmin(CLOSE_FOCAL * f, f * MAX_SUBJECT_PART * shot->lens.height / size));
}

/* Size of a subject seen from the origin by a camera that points at the target. */
static enum status origin_size(double *size, const struct shot_setup *shot, const struct subject *s, struct vec3 target,
                               double focal, struct err *err)
{
    const struct view camera = shot_aim(shot, shot->origin, target, focal);
    *size = subject_size_in(s, &camera);
    if (*size > 0) return ST_OK;
    return err_set(
        err, ST_DATA,
        "the subject in view %s is not in front of the centremost view's camera, so no move can be planned to it; "
        "choose another subject.",
        s->view);
}

enum status shot_move_make(struct shot_move *m, const struct shot_setup *shot, enum camera_move move,
                           const struct subject_list *subjects, struct err *err)
{
    const double f = shot->lens.fx;
    const struct subject *first = subjects && subjects->count > 0 ? &subjects->subjects[0] : NULL;
    const struct subject *second = subjects && subjects->count > 1 ? &subjects->subjects[1] : NULL;
    const struct shot_end whole = {.target = shot->centroid, .focal = f},
                          close = {.target = shot->centroid, .focal = CLOSE_FOCAL * f};
    double size = 0;

    *m = (struct shot_move){.move = move};
    if (film_move_subjects(move) > (first != NULL) + (second != NULL))
        return err_set(err, ST_DATA,
                       "the move needs %d subjects, the list has %d; add regions of interest or choose another move.",
                       film_move_subjects(move), (first != NULL) + (second != NULL));
    switch (move) {
    case MOVE_ESTABLISHING_DOLLY:
        m->end[0] = m->end[1] = whole;
        return ST_OK;
    case MOVE_ESTABLISHING_DOLLY_OUT:
        m->on_axis = true;
        m->end[0] = close;
        m->end[1] = whole;
        return ST_OK;
    case MOVE_DOLLY_IN:
    case MOVE_DOLLY_OUT: {
        const int near = move == MOVE_DOLLY_IN;
        if (origin_size(&size, shot, first, subject_lower_center(first), f, err)) return err->status;
        m->end[!near] = whole;
        m->end[near] = keep_size(first, subject_lower_center(first), 0);
        m->end[near].focal = close_focal(shot, size);
        m->end[near].size = MAX_SUBJECT_GAIN * size * m->end[near].focal / f;
        return ST_OK;
    }
    case MOVE_DOLLY_ZOOM:
    case MOVE_DOLLY_ZOOM_IN:
        if (origin_size(&size, shot, first, shot->centroid, f, err)) return err->status;
        m->on_axis = true;
        m->end[0] = m->end[1] = keep_size(first, shot->centroid, size);
        return ST_OK;
    case MOVE_DOLLY:
    default: {
        const struct vec3 a = subject_center(first), b = subject_center(second);
        double other;
        if (origin_size(&size, shot, first, a, f, err) || origin_size(&other, shot, second, b, f, err))
            return err->status;
        size *= close_focal(shot, size) / f;
        m->end[0] = keep_size(first, a, size);
        m->end[1] = keep_size(second, b, size);
        return ST_OK;
    }
    }
}
