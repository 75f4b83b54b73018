/* choose_pair.c - the viewpoints whose textures a free camera takes [Buehler 2001].
 *
 * Rays through a grid of pixels meet the model in points. A viewpoint's penalty at a point is the angle at the point
 * between the directions to the camera and to the viewpoint, plus a share of how much farther the viewpoint is than the
 * camera, which is how much coarser its texels are; a point that it does not see costs as much as an angle of 90
 * degrees. The viewpoint's penalty p is the mean over the points.
 *
 * With p1 <= p2 <= p3 the three least penalties, the weights of the best two are (1 - pk / p3) / pk. So the share of a
 * viewpoint is 0 when another takes its place, and 1 where the camera stands in it. */
#include "stages/render_model/choose_pair.h"

#include <float.h>
#include <math.h>

enum { COLUMNS = 16, ROWS = 12 };

static const double unseen = M_PI / 2, coarser = 0.2;

struct samples {
    struct vec3 points[COLUMNS * ROWS];
    double distances[COLUMNS * ROWS]; /* from the camera */
    int count;
};

static void find_samples(struct samples *s, const struct room *room, const struct room_camera *camera)
{
    const struct mat3 world_from_cam = mat3_transpose(mat3_from_quat(camera->pose.rotation));
    const struct vec3 from = pose_center(&camera->pose);
    s->count = 0;
    for (int j = 0; j < ROWS; j++)
        for (int i = 0; i < COLUMNS; i++) {
            const double u = (i + 0.5) * camera->lens.width / COLUMNS, v = (j + 0.5) * camera->lens.height / ROWS;
            struct vec3 ray;
            struct ray_hit hit;
            if (!camera_unproject(&camera->lens, u, v, &ray)) continue;
            if (!ray_scene_hit(&room->model.rays, from, mat3_apply(world_from_cam, ray), &hit)) continue;
            s->points[s->count] = hit.point;
            s->distances[s->count++] = hit.t;
        }
}

/* Whether a view of the viewpoint shows the point in the unedited model, or the edited one without it. */
static bool sees(const struct room *room, const struct viewpoint *v, struct vec3 point)
{
    const struct model_rays *model = room->files.base ? &room->base : &room->model;
    const struct vec3 to = vec3_sub(point, v->centre);
    for (int i = v->first; i < v->first + v->count; i++) {
        const struct view *camera = &room->cameras[i];
        double x, y;
        if (view_project(camera, point, &x, &y) <= 0) continue;
        if (x < 0 || y < 0 || x >= camera->width || y >= camera->height) continue;
        return !ray_scene_blocked(&model->rays, v->centre, to, 1 - 1e-4);
    }
    return false;
}

static double penalty(const struct room *room, const struct viewpoint *v, const struct samples *s, struct vec3 camera)
{
    double sum = 0;
    int seen = 0;
    for (int i = 0; i < s->count; i++) {
        if (!sees(room, v, s->points[i])) {
            sum += unseen;
            continue;
        }
        const struct vec3 a = vec3_sub(camera, s->points[i]), b = vec3_sub(v->centre, s->points[i]);
        const double angle = atan2(vec3_length(vec3_cross(a, b)), vec3_dot(a, b));
        const double farther = vec3_length(b) / s->distances[i] - 1;
        sum += fmin(unseen, angle + coarser * fmax(0, farther));
        seen++;
    }
    return seen ? sum / s->count : DBL_MAX;
}

struct texture_pair choose_pair(const struct room *room, const struct room_camera *camera)
{
    const struct vec3 from = pose_center(&camera->pose);
    struct samples s;
    int best[3] = {-1, -1, -1};
    double least[3] = {DBL_MAX, DBL_MAX, DBL_MAX};
    find_samples(&s, room, camera);
    for (int i = 0; i < room->viewpoint_count; i++) {
        double p = penalty(room, &room->viewpoints[i], &s, from);
        int viewpoint = i;
        for (int k = 0; k < 3; k++) {
            if (p >= least[k]) continue;
            const double old = least[k];
            const int of = best[k];
            least[k] = p;
            best[k] = viewpoint;
            p = old;
            viewpoint = of;
        }
    }
    struct texture_pair pair = {{best[0], best[1]}, 0};
    if (best[1] < 0) return pair;
    const double last = best[2] < 0 ? unseen : least[2];
    double weights[2];
    for (int k = 0; k < 2; k++) weights[k] = fmax(0, 1 - least[k] / last) / fmax(least[k], 1e-9);
    if (weights[0] + weights[1] > 0) pair.t = weights[1] / (weights[0] + weights[1]);
    return pair;
}
