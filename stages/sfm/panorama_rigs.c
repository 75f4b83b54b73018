/* panorama_rigs.c - views of a panorama have one centre.
 *
 * COLMAP 3.8 has rigs only for a last adjustment, which holds no centre. It places views as photos of a known lens;
 * each then says where its panorama is and how it is turned. The view whose turn agrees best with those of the others,
 * weighted by the points they see, decides which others count: those within MAX_TURN of it. Their mean, with the same
 * weights, is the panorama's pose. Each point goes to where the rays of its track come nearest to each other; it would
 * be off by as much as the poses otherwise. */
#include "stages/sfm/panorama_rigs.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/capture/panorama_name.h"
#include "common/math/inverse.h"
#include "common/math/numbers.h"

static const double MAX_TURN = 2 * DEGREE;

struct rig_view {
    int image;
    struct quat turn; /* view_from_panorama */
    struct quat says; /* panorama_from_world, by this view */
    struct vec3 centre;
    double weight;
};

static struct rig_view view_of(const struct sfm_image *image, int at)
{
    int yaw = 0;
    panorama_name_read(&yaw, image->name);
    struct rig_view v = {
        .image = at, .turn = panorama_name_turn(yaw), .centre = pose_center(&image->cam_from_world), .weight = 1};
    v.says = quat_multiply(quat_conjugate(v.turn), image->cam_from_world.rotation);
    for (int k = 0; k < image->observation_count; k++) v.weight += image->observations[k].point_id >= 0;
    return v;
}

/* The view with which the others agree best. */
static int find_middle(const struct rig_view *views, int count)
{
    double least = INFINITY;
    int best = 0;
    for (int i = 0; i < count; i++) {
        double cost = 0;
        for (int k = 0; k < count; k++)
            cost += views[k].weight * fmin(quat_angle(views[i].says, views[k].says), MAX_TURN);
        if (cost < least) {
            least = cost;
            best = i;
        }
    }
    return best;
}

/* Sets the poses of a panorama's views; returns how many agreed. */
static int join_views(struct sfm_model *m, const struct rig_view *views, int count)
{
    const struct quat middle = views[find_middle(views, count)].says;
    struct quat sum = {0, 0, 0, 0};
    struct vec3 centre = {0, 0, 0};
    double weight = 0;
    int agreed = 0;
    for (int i = 0; i < count; i++) {
        const struct rig_view *v = &views[i];
        if (quat_angle(v->says, middle) > MAX_TURN) continue;
        const double dot = v->says.w * middle.w + v->says.x * middle.x + v->says.y * middle.y + v->says.z * middle.z;
        const double w = dot < 0 ? -v->weight : v->weight;
        sum = (struct quat){sum.w + w * v->says.w, sum.x + w * v->says.x, sum.y + w * v->says.y, sum.z + w * v->says.z};
        centre = vec3_add(centre, vec3_scale(v->centre, v->weight));
        weight += v->weight;
        agreed++;
    }
    sum = quat_normalize(sum);
    centre = vec3_scale(centre, 1 / weight);
    for (int i = 0; i < count; i++) {
        struct pose *pose = &m->images[views[i].image].cam_from_world;
        pose->rotation = quat_normalize(quat_multiply(views[i].turn, sum));
        pose->translation = vec3_scale(mat3_apply(mat3_from_quat(pose->rotation), centre), -1);
    }
    return agreed;
}

/* The point nearest to the rays of its track, in the sense of least squares; unchanged if they are parallel. */
static void move_point(struct sfm_point *p, const struct sfm_model *m)
{
    double a[9] = {0}, b[3] = {0}, x[3] = {0};
    for (int k = 0; k < p->track_count; k++) {
        const struct sfm_image *image = &m->images[p->track[k].image_idx];
        const struct sfm_observation *o = &image->observations[p->track[k].observation_idx];
        const struct mat3 world_from_cam = mat3_transpose(mat3_from_quat(image->cam_from_world.rotation));
        const struct vec3 centre = pose_center(&image->cam_from_world);
        struct vec3 ray;
        if (!camera_unproject(&m->cameras[image->camera_idx].camera, o->u, o->v, &ray)) continue;
        ray = vec3_normalize(mat3_apply(world_from_cam, ray));
        const double d[3] = {ray.x, ray.y, ray.z}, c[3] = {centre.x, centre.y, centre.z};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++) {
                const double e = (i == j) - d[i] * d[j];
                a[3 * i + j] += e;
                b[i] += e * c[j];
            }
    }
    if (!inverse_of_symmetric(a, 3, 1e-9)) return;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) x[i] += a[3 * i + j] * b[j];
    p->position = vec3_make(x[0], x[1], x[2]);
}

enum status panorama_rigs_join(struct sfm_model *m, struct err *err)
{
    struct rig_view *views = calloc((size_t)m->image_count + 1, sizeof *views);
    bool *done = calloc((size_t)m->image_count + 1, sizeof *done);
    int panoramas = 0, joined = 0, agreed = 0;
    if (!views || !done) err_nomem(err, "views of panoramas", (size_t)m->image_count * sizeof *views);
    for (int i = 0; !err->status && i < m->image_count; i++) {
        int yaw, count = 0;
        if (done[i] || !panorama_name_read(&yaw, m->images[i].name)) continue;
        for (int k = i; k < m->image_count; k++)
            if (k == i || panorama_name_same(m->images[i].name, m->images[k].name)) {
                views[count++] = view_of(&m->images[k], k);
                done[k] = true;
            }
        panoramas++;
        joined += count;
        agreed += join_views(m, views, count);
    }
    for (int i = 0; !err->status && panoramas && i < m->point_count; i++) move_point(&m->points[i], m);
    if (!err->status && panoramas)
        log_note("%d views of %d panoramas have one centre each; %d of them had been placed otherwise", joined,
                 panoramas, joined - agreed);
    free(views);
    free(done);
    return err->status;
}
