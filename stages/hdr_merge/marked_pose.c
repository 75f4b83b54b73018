/* marked_pose.c - places a lighting reference image by its marks: collects them, chooses the pose, checks the fit.
 *
 * Marks give the pose in the model's frame (resection.c). Where several poses explain them equally well, a line "near"
 * decides; otherwise the best fit does, if there are more than three marks. Three marks fit all their poses exactly, so
 * that without "near" nothing tells which is right. A line "in" places an image without marks (window_pose.c). The pose
 * then moves to the scene's frame by axes.txt. */
#include "stages/hdr_merge/marked_pose.h"

#include <stdio.h>
#include <string.h>

#include "common/model/model_axes.h"
#include "stages/hdr_merge/window_pose.h"

struct marked_image {
    const struct photo_record *image;
    const struct reference_marks *list;
    struct resection_mark marks[RESECTION_MAX];
    int lines[RESECTION_MAX];
    int count;
    const struct reference_mark *lens, *near, *window, *horizon; /* NULL: none */
    const struct model_wall *wall;                               /* of the first corner; NULL: none */
};

/* -------------------------------------------------------------------------------------------------------- the marks */

static enum status add_mark(struct marked_image *m, const struct reference_mark *mark, const struct model_plan *plan,
                            struct err *err)
{
    const struct photo_info *info = &m->image->info;
    if (m->count == RESECTION_MAX)
        return err_set(err, ST_DATA, "%s:%d: found more than %d marks of image %s; delete some.", m->list->path,
                       mark->line, (int)RESECTION_MAX, m->image->id);
    if (!(mark->x >= 0 && mark->x <= info->width && mark->y >= 0 && mark->y <= info->height))
        return err_set(err, ST_DATA, "%s:%d: found a mark at %.9g, %.9g, off image %s of %d x %d pixels.",
                       m->list->path, mark->line, mark->x, mark->y, m->image->id, info->width, info->height);
    struct resection_mark *to = &m->marks[m->count];
    const struct model_wall *wall;
    m->lines[m->count++] = mark->line;
    to->x = mark->x;
    to->y = mark->y;
    if (reference_mark_locate(&to->point, &wall, mark, m->list, plan, err)) return err->status;
    if (!m->wall) m->wall = wall;
    return ST_OK;
}

static enum status check_window(const struct marked_image *m, struct err *err)
{
    if (m->window && m->count)
        return err_set(err, ST_DATA, "%s:%d: found a window for image %s, which also has marks (line %d); delete one.",
                       m->list->path, m->window->line, m->image->id, m->lines[0]);
    if (m->horizon && !m->window)
        return err_set(err, ST_DATA, "%s:%d: found a horizon of image %s, which has no line \"in\"; add one.",
                       m->list->path, m->horizon->line, m->image->id);
    return ST_OK;
}

static enum status collect(struct marked_image *m, const struct model_plan *plan, struct err *err)
{
    for (int i = 0; !err->status && i < m->list->count; i++) {
        const struct reference_mark *mark = &m->list->marks[i];
        if (mark->kind == REFERENCE_LENS && !m->lens && !strcmp(mark->image, "*")) m->lens = mark;
        if (!reference_mark_is_of(mark, m->image)) continue;
        if (mark->kind == REFERENCE_LENS)
            m->lens = mark;
        else if (mark->kind == REFERENCE_NEAR)
            m->near = mark;
        else if (mark->kind == REFERENCE_WINDOW)
            m->window = mark;
        else if (mark->kind == REFERENCE_HORIZON)
            m->horizon = mark;
        else
            add_mark(m, mark, plan, err);
    }
    if (!err->status) check_window(m, err);
    if (!err->status && m->count && m->count < RESECTION_MIN)
        err_set(err, ST_DATA, "%s has %d mark%s of image %s, wanted at least %d, better four or more.", m->list->path,
                m->count, m->count == 1 ? "" : "s", m->image->id, (int)RESECTION_MIN);
    return err->status;
}

/* --------------------------------------------------------------------------------------------------------- the lens */

static bool has_size(const struct camera *c, const struct photo_info *info)
{
    return c->width == info->width && c->height == info->height;
}

/* The only camera of the image's size in FOLDER/cameras.txt. */
static enum status read_lens(struct camera *lens, const struct marked_image *m, const char *folder,
                             struct provenance *prov, struct err *err)
{
    const struct photo_info *info = &m->image->info;
    struct sfm_model model = {0};
    char path[FILE_PATH];
    int found = 0;
    if (!provenance_add_in(prov, "cameras", folder, "cameras", ".txt", path, err))
        sfm_model_read_camera_files(&model, path, NULL, NULL, err);
    for (int i = 0; !err->status && i < model.camera_count; i++)
        if (has_size(&model.cameras[i].camera, info) && !found++) *lens = model.cameras[i].camera;
    if (!err->status && found != 1)
        err_set(err, ST_DATA,
                "%s has %d cameras of %d x %d pixels, the size of image %s, wanted one; add a line \"lens %s MODEL "
                "WIDTH HEIGHT PARAMS\" to %s.",
                path, found, info->width, info->height, m->image->id, m->image->id, m->list->path);
    sfm_model_release(&model);
    return err->status;
}

static enum status find_lens(struct camera *lens, const struct marked_image *m, const char *folder,
                             struct provenance *prov, struct err *err)
{
    const char *id = m->image->id;
    if (!m->lens && folder) return read_lens(lens, m, folder, prov, err);
    if (!m->lens)
        return err_set(
            err, ST_DATA,
            "%s does not give the lens of image %s; add a line \"lens %s MODEL WIDTH HEIGHT PARAMS\", or set "
            "LRI_SFM to a folder with its cameras.txt.",
            m->list->path, id, id);
    *lens = m->lens->lens;
    if (has_size(lens, &m->image->info)) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: found a lens of %d x %d pixels, but image %s has %d x %d; give its own lens.",
                   m->list->path, m->lens->line, lens->width, lens->height, id, m->image->info.width,
                   m->image->info.height);
}

/* --------------------------------------------------------------------------------------------------------- the pose */

static struct vec3 place_of(const struct resection *r, int i) { return pose_center(&r->poses[i].cam_from_world); }

static int nearest_to(const struct resection *r, struct vec3 at)
{
    int nearest = 0;
    for (int i = 1; i < r->count; i++)
        if (vec3_length(vec3_sub(place_of(r, i), at)) < vec3_length(vec3_sub(place_of(r, nearest), at))) nearest = i;
    return nearest;
}

static enum status refuse_choice(const struct marked_image *m, const struct resection *r, struct err *err)
{
    char places[RESECTION_POSES * 48] = "";
    int used = 0;
    for (int i = 0; i < r->count; i++) {
        const struct vec3 p = place_of(r, i);
        used += snprintf(places + used, sizeof places - (size_t)used, "%s%.3g %.3g %.3g",
                         !i                  ? ""
                         : i + 1 == r->count ? " or "
                                             : ", ",
                         p.x, p.y, p.z);
    }
    return err_set(
        err, ST_DATA,
        "%s: three marks of image %s leave %d poses, with the camera at %s in the model; mark a fourth point, "
        "or add a line \"near %s X Y Z\".",
        m->list->path, m->image->id, r->count, places, m->image->id);
}

static enum status choose(struct marked_pose *to, const struct marked_image *m, const struct merge_params *params,
                          struct err *err)
{
    const struct resection *r = &to->found;
    if (!m->near && m->count == RESECTION_MIN && r->count > 1) return refuse_choice(m, r, err);
    to->marks = m->count;
    to->by_hand = m->near;
    to->chosen = m->near ? nearest_to(r, m->near->point) : 0;
    const struct resection_pose *p = &r->poses[to->chosen];
    to->worst_line = m->lines[p->worst];
    if (m->wall) {
        const struct vec3 at = place_of(r, to->chosen);
        snprintf(to->wall, sizeof to->wall, "%s", m->wall->name);
        to->before_wall = m->wall->normal[0] * at.x + m->wall->normal[1] * at.y - m->wall->offset;
    }
    if (p->degrees <= params->max_mark_misfit) return ST_OK;
    return err_set(
        err, ST_DATA,
        "%s: from the pose that fits best, the marks of image %s are %.3g degrees (%.3g px) off the model's "
        "points (root mean square), wanted at most %.3g degrees; the mark of line %d is farthest off, by %.3g "
        "px. Check that left and right are as seen from the wall's inside, that the lens is that of the "
        "image, and the model's openings; or raise [hdr_merge] max_mark_misfit.",
        m->list->path, m->image->id, p->degrees, p->rms, params->max_mark_misfit, to->worst_line, p->max);
}

/* Places an image in an opening. */
static enum status stand_in_window(struct marked_pose *to, const struct marked_image *m, const struct model_plan *plan,
                                   const struct camera *lens, struct err *err)
{
    const struct reference_mark *h = m->horizon;
    const struct model_wall *wall;
    struct window_pose w = {.level = !h};
    if (reference_mark_locate(&w.at, &wall, m->window, m->list, plan, err)) return err->status;
    w.out = vec3_make(-wall->normal[0], -wall->normal[1], 0);
    if (h) memcpy(w.horizon, (double[2][2]){{h->x, h->y}, {h->other[0], h->other[1]}}, sizeof w.horizon);
    to->in_window = true;
    to->level = w.level;
    to->stated = m->window->at;
    snprintf(to->opening, sizeof to->opening, "%s", m->window->opening);
    while (strcmp(plan->openings[to->opening_idx].name, m->window->opening) != 0) to->opening_idx++;
    to->found.count = 1;
    snprintf(to->wall, sizeof to->wall, "%s", wall->name);
    if (window_pose_find(&to->found.poses[0].cam_from_world, &w, lens, err))
        err_context(err, "%s:%d", m->list->path, h ? h->line : m->window->line);
    return err->status;
}

enum status marked_pose_to_scene(struct marked_pose *m, struct pose *cam_from_world,
                                 const struct reference_frame *frame, const struct merge_params *params,
                                 struct provenance *prov, struct err *err)
{
    const struct reference_frame in_model = {.axes = frame->axes};
    struct frame_agreement none;
    struct model_axes axes;
    if (model_axes_read(&axes, frame->axes, prov, err)) return err->status;
    m->metric = axes.metric;
    *cam_from_world = m->found.poses[m->chosen].cam_from_world;
    return reference_pose_find(cam_from_world, &none, NULL, NULL, &in_model, params, prov, err);
}

enum status marked_pose_find(struct marked_pose *m, struct camera *lens, struct pose *cam_from_world, bool *known,
                             const struct photo_record *image, const char *model, const struct reference_frame *frame,
                             const struct merge_params *params, struct provenance *prov, struct err *err)
{
    struct reference_marks list = {0};
    struct model_plan plan = {0};
    struct marked_image marked = {.image = image, .list = &list};
    *m = (struct marked_pose){0};
    if (!reference_marks_read(&list, frame->marks, prov, err) && !model_plan_read(&plan, frame->plan, prov, err))
        collect(&marked, &plan, err);
    *known = !err->status && (marked.count || marked.window);
    if (*known) find_lens(lens, &marked, model, prov, err);
    if (*known && !err->status && marked.window) stand_in_window(m, &marked, &plan, lens, err);
    if (*known && !err->status && !marked.window &&
        resection_find(&m->found, lens, marked.marks, marked.count, params->mark_error, image->id, err))
        err_context(err, "%s", list.path);
    if (*known && !err->status && !marked.window) choose(m, &marked, params, err);
    if (*known && !err->status) marked_pose_to_scene(m, cam_from_world, frame, params, prov, err);
    model_plan_release(&plan);
    reference_marks_release(&list);
    return err->status;
}
