/* crop_move.c - a camera move as pan and zoom over one photograph.
 *
 * The 2D counterpart of a move, to compare 3D pan & scan with [Colburn 2014, 3.8]. At both ends a crop is fitted
 * (crop_fit.c) so that the view's points appear where the path's camera sees them. Between the ends the crop is
 * interpolated linearly in the fraction of the camera's path that is done; if the camera does not move, in the fraction
 * of its rotation and zoom; if it does not do that either, in time. */
#include "stages/pan_scan/crop_move.h"

#include <stdlib.h>

#define MIN_AXIS_COSINE 0.5  /* between cameras that face about the same way */
#define GRID            64   /* points along the longer side of a depth map */
#define MIN_MOTION      1e-9 /* per frame; less counts as none */

static double axis_dot(const struct view *a, const struct view *b)
{
    double sum = 0;
    for (int k = 0; k < 3; k++) sum += a->cam_from_world.m[2][k] * b->cam_from_world.m[2][k];
    return sum;
}

int crop_move_choose_view(const struct camera_set *set, const struct camera_path *path)
{
    const struct view *middle = &path->frames[path->frame_count / 2].camera;
    int best = 0;
    double nearest = HUGE_VAL, straightest = 0;
    bool same_way = false;
    for (int i = 0; i < set->view_count; i++) {
        const double far = vec3_length(vec3_sub(set->views[i].center, middle->center));
        const double straight = axis_dot(&set->views[i], middle);
        const bool same = straight >= MIN_AXIS_COSINE;
        if (same < same_way) continue;
        if (same > same_way || far < nearest * (1 - 1e-9) || (far <= nearest * (1 + 1e-9) && straight > straightest))
            best = i, nearest = far, straightest = straight, same_way = same;
    }
    return best;
}

/* ---------------------------------------------------------------------------------------------------- quarter turns */

/* Clockwise by a quarter turn: (x, y) goes to (height - y, x). */
static void turn_view(struct view *v)
{
    const struct view old = *v;
    v->width = old.height, v->height = old.width;
    v->fx = old.fy, v->fy = old.fx;
    v->cx = old.height - old.cy, v->cy = old.cx;
    for (int k = 0; k < 3; k++) {
        v->cam_from_world.m[0][k] = -old.cam_from_world.m[1][k];
        v->cam_from_world.m[1][k] = old.cam_from_world.m[0][k];
    }
    v->translation = vec3_make(-old.translation.y, old.translation.x, old.translation.z);
}

/* Clockwise quarter turns that bring the view to the camera's orientation. */
static int quarters_between(const struct view *view, const struct view *camera)
{
    double across = 0, down = 0; /* the view's x axis in the camera */
    for (int k = 0; k < 3; k++) {
        across += camera->cam_from_world.m[0][k] * view->cam_from_world.m[0][k];
        down += camera->cam_from_world.m[1][k] * view->cam_from_world.m[0][k];
    }
    return ((int)lround(atan2(down, across) / M_PI_2) + 4) % 4;
}

enum status crop_move_turn(struct image *picture, const struct crop_move *m, struct err *err)
{
    for (int q = 0; q < m->quarters; q++) {
        struct image turned = {0};
        if (image_init(&turned, picture->height, picture->width, picture->channels, err)) return err->status;
        for (int y = 0; y < picture->height; y++)
            for (int x = 0; x < picture->width; x++)
                for (int c = 0; c < picture->channels; c++)
                    image_at(&turned, picture->height - 1 - y, x)[c] = image_at(picture, x, y)[c];
        image_release(picture);
        *picture = turned;
    }
    return ST_OK;
}

struct crop crop_move_stored(const struct crop_move *m, struct crop crop)
{
    double width = m->view.width, height = m->view.height;
    for (int q = 0; q < m->quarters; q++) {
        crop = (struct crop){crop.y, width - crop.x - crop.width, crop.height, crop.width};
        const double swap = width;
        width = height, height = swap;
    }
    return crop;
}

/* ----------------------------------------------------------------------------------------------------------- points */

static void add_point(struct crop_move *m, double x, double y, struct vec3 world, int stored_width, int stored_height)
{
    double width = stored_width, height = stored_height;
    for (int q = 0; q < m->quarters; q++) {
        const double turned = height - y;
        y = x, x = turned;
        const double swap = width;
        width = height, height = swap;
    }
    m->points[m->point_count++] = (struct photo_point){x, y, world};
}

static enum status depth_points(struct crop_move *m, const struct view *view, const struct layered_depth *depth,
                                struct err *err)
{
    const int side = depth->width > depth->height ? depth->width : depth->height;
    const int step = side > GRID ? side / GRID : 1;
    const size_t max_count = (size_t)(depth->width / step + 1) * (size_t)(depth->height / step + 1);
    if (depth->width != view->width || depth->height != view->height)
        return err_set(err, ST_DATA,
                       "the depth map of view %s is %d x %d pixels, its camera %d x %d; make the depth map again.",
                       view->name, depth->width, depth->height, view->width, view->height);
    if (!(m->points = malloc(max_count * sizeof *m->points)))
        return err_nomem(err, "points", max_count * sizeof *m->points);
    for (int y = step / 2; y < depth->height; y += step)
        for (int x = step / 2; x < depth->width; x += step) {
            const double z = (double)depth->interior.z[(size_t)y * (size_t)depth->width + (size_t)x];
            if (z > 0)
                add_point(m, x + 0.5, y + 0.5, view_unproject(view, x + 0.5, y + 0.5, z), view->width, view->height);
        }
    return ST_OK;
}

static enum status sparse_points(struct crop_move *m, const struct camera_set *set, int view_idx, struct err *err)
{
    const struct sfm_image *im = &set->model.images[view_idx];
    const struct view *v = &set->views[view_idx];
    const size_t max_count = (size_t)im->observation_count + 1;
    if (!(m->points = malloc(max_count * sizeof *m->points)))
        return err_nomem(err, "points", max_count * sizeof *m->points);
    for (int i = 0; i < set->model.point_count; i++)
        for (int k = 0; k < set->model.points[i].track_count && m->point_count < max_count; k++) {
            const struct sfm_track *t = &set->model.points[i].track[k];
            if (t->image_idx != view_idx) continue;
            const struct sfm_observation *o = &im->observations[t->observation_idx];
            add_point(m, o->u, o->v, set->model.points[i].position, v->width, v->height);
        }
    return ST_OK;
}

/* Pairs the points with their pixels in a frame: the points within it or, if they are too few, all in front of its
 * camera. The caller frees task->pairs. */
static enum status make_task(struct crop_task *task, const struct crop_move *m, int frame, struct err *err)
{
    const struct view *f = &m->path->frames[frame].camera;
    struct crop_pair *pairs = malloc((m->point_count + 1) * sizeof *pairs);
    *task = (struct crop_task){.photo_width = m->view.width,
                               .photo_height = m->view.height,
                               .frame_width = f->width,
                               .frame_height = f->height,
                               .step_x = m->view.fx / f->fx,
                               .step_y = m->view.fy / f->fy,
                               .tolerance = m->tolerance,
                               .pairs = pairs};
    if (!pairs) return err_nomem(err, "points", m->point_count * sizeof *pairs);
    for (int inside = 1; inside >= 0 && task->count < MIN_CROP_POINTS; inside--) {
        task->count = 0;
        for (size_t i = 0; i < m->point_count; i++) {
            double u = -1, v = -1;
            if (!(view_project(f, m->points[i].world, &u, &v) > 0)) continue;
            if (inside && (u < 0 || v < 0 || u > f->width || v > f->height)) continue;
            pairs[task->count++] = (struct crop_pair){m->points[i].x, m->points[i].y, u, v};
        }
    }
    return ST_OK;
}

static enum status fit_end(struct crop_move *m, int end, struct err *err)
{
    struct crop_task task = {0};
    const int frame = end ? m->path->frame_count - 1 : 0;
    make_task(&task, m, frame, err);
    if (!err->status && crop_fit(&m->ends[end], &task, err))
        err_context(err, "frame %s of the path, seen from view %s", m->path->frames[frame].camera.name, m->view.name);
    if (!err->status) crop_misfit(&m->misfits[end], &task, &m->ends[end].crop, err);
    free((void *)task.pairs);
    return err->status;
}

enum status crop_move_misfit(double *misfit, const struct crop_move *m, int frame, struct err *err)
{
    struct crop_task task = {0};
    const struct crop crop = crop_move_crop(m, frame);
    if (!make_task(&task, m, frame, err)) crop_misfit(misfit, &task, &crop, err);
    free((void *)task.pairs);
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- time */

/* Angle between two cameras plus the logarithm of the ratio of their focal lengths. */
static double rotation_and_zoom(const struct view *a, const struct view *b)
{
    const struct mat3 r = mat3_multiply(a->cam_from_world, mat3_transpose(b->cam_from_world));
    const struct vec3 twice_sine = {r.m[2][1] - r.m[1][2], r.m[0][2] - r.m[2][0], r.m[1][0] - r.m[0][1]};
    return atan2(vec3_length(twice_sine), r.m[0][0] + r.m[1][1] + r.m[2][2] - 1) + fabs(log(b->fx / a->fx));
}

static enum status find_fractions(struct crop_move *m, struct err *err)
{
    const struct camera_path *p = m->path;
    const size_t n = (size_t)p->frame_count;
    double scale = MIN_MOTION;
    if (!(m->fractions = calloc(n, sizeof *m->fractions))) return err_nomem(err, "a move", n * sizeof *m->fractions);
    for (size_t i = 0; i < m->point_count; i++)
        scale = fmax(scale, vec3_length(vec3_sub(m->points[i].world, m->view.center)));
    for (int by = 0; by < 3; by++) {
        for (size_t i = 1; i < n; i++) {
            const struct view *a = &p->frames[i - 1].camera, *b = &p->frames[i].camera;
            m->fractions[i] = m->fractions[i - 1] + (by == 0   ? vec3_length(vec3_sub(b->center, a->center)) / scale
                                                     : by == 1 ? rotation_and_zoom(a, b)
                                                               : 1);
        }
        if (m->fractions[n - 1] > MIN_MOTION * (double)n) break;
    }
    const double total = m->fractions[n - 1];
    for (size_t i = 0; i < n && total > 0; i++) m->fractions[i] /= total;
    return ST_OK;
}

struct crop crop_move_crop(const struct crop_move *m, int frame)
{
    const struct crop *a = &m->ends[0].crop, *b = &m->ends[1].crop;
    const double t = m->fractions[frame];
    return (struct crop){a->x + t * (b->x - a->x), a->y + t * (b->y - a->y), a->width + t * (b->width - a->width),
                         a->height + t * (b->height - a->height)};
}

/* ------------------------------------------------------------------------------------------------------------ whole */

enum status crop_move_init(struct crop_move *m, const struct camera_set *set, int view_idx,
                           const struct layered_depth *depth, const struct camera_path *path, double tolerance,
                           struct err *err)
{
    const struct view *view = &set->views[view_idx], *first = &path->frames[0].camera;
    *m = (struct crop_move){.path = path, .view = *view};
    m->tolerance = tolerance * (first->width > first->height ? first->width : first->height);
    m->quarters = quarters_between(view, &path->frames[path->frame_count / 2].camera);
    for (int q = 0; q < m->quarters; q++) turn_view(&m->view);
    if (depth)
        depth_points(m, view, depth, err);
    else
        sparse_points(m, set, view_idx, err);
    if (!err->status) find_fractions(m, err);
    for (int end = 0; !err->status && end < 2; end++) fit_end(m, end, err);
    if (err->status) crop_move_release(m);
    return err->status;
}

void crop_move_release(struct crop_move *m)
{
    if (!m) return;
    free(m->points);
    free(m->fractions);
    *m = (struct crop_move){0};
}
