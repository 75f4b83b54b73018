/* room_axes.c - a room's axes, floor, ceiling, scale and extent.
 *
 * Overview [Colburn 2014, 4.4.1].
 *   1. three axes come from the straight edges of all views, if these have common directions (find_frame), which
 *      determine them to hundredths of a degree; else from the directions of most normals (directions.c); else from
 *      marked edges. z is the one nearest to the mean up direction of the cameras, x the one nearest to the right
 *      direction of the most central camera, y completes them
 *   2. the planes across the axes with the most points turn axes of normals a little (planes.c), and marked edges turn
 *      any axes that they contradict (correct.c); after these, the planes are found again
 *   3. heights of points with upward and downward normals give floor and ceiling (heights.c), or those that straight
 *      edges say, where the points have none. Corners of the floor
 *      that are marked in several views replace the floor where there is none, or where the two differ by more than
 *      twice their common standard error
 *   4. marked lengths and heights give metres: with distances d and lengths m the scale is sum d m / sum d^2, and its
 *      error combines the effect of clicks (mark_error()) with what the lengths leave unexplained; the height of the
 *      ceiling also has that of its level. A ceiling that was not found gets the height that is given
 *   5. marks on both sides of a wall give its thickness; the extent is that of the outermost walls that face
 *      inwards, or else of all points
 *
 * The origin is on the floor under the most central camera. Up to step 4 lengths are in scene units from that
 * camera; after it in metres, if there is a scale.
 *
 * Differs from the source: marks, standard errors, and the ceiling. */
#include "stages/find_axes/room_axes.h"

#include <stdlib.h>
#include <string.h>

#include "common/capture/central_views.h"
#include "common/capture/upright.h"
#include "common/math/numbers.h"
#include "stages/find_axes/directions.h"

static const double LEVEL_EDGE = 0.3;    /* |cosine| between up and the normal of the plane of a level edge */
static const double HIGHEST_CEILING = 5; /* times the camera's height above the floor, above the camera */
static const double UNKNOWN_EXTENT = 2;  /* times the camera's height, in each direction, of a room without points */
static const double CONTRADICTS = 2; /* min difference between the floor and its marked corners, in standard errors */

static enum status central_view(int *central, const struct camera_set *set, struct err *err)
{
    int *order = malloc(((size_t)set->view_count + 1) * sizeof *order);
    if (!order) return err_nomem(err, "an order of views", (size_t)set->view_count * sizeof *order);
    if (!central_views(order, set, err)) *central = order[0];
    free(order);
    return err->status;
}

/* Orders the rows and sets their signs: z is nearest to up, x nearest to right. */
static struct mat3 model_order(struct mat3 rows, double part[3], struct vec3 up, struct vec3 right)
{
    struct vec3 axis[3] = {mat3_row(rows, 0), mat3_row(rows, 1), mat3_row(rows, 2)};
    const double before[3] = {part[0], part[1], part[2]};
    int z = 0;
    for (int k = 1; k < 3; k++)
        if (fabs(vec3_dot(axis[k], up)) > fabs(vec3_dot(axis[z], up))) z = k;
    const int a = (z + 1) % 3, b = (z + 2) % 3;
    const int x = fabs(vec3_dot(axis[b], right)) > fabs(vec3_dot(axis[a], right)) ? b : a, y = a + b - x;
    const struct vec3 k = vec3_scale(axis[z], vec3_dot(axis[z], up) < 0 ? -1 : 1);
    const struct vec3 i = vec3_scale(axis[x], vec3_dot(axis[x], right) < 0 ? -1 : 1), j = vec3_cross(k, i);
    part[0] = before[x];
    part[1] = before[y];
    part[2] = before[z];
    return (struct mat3){{{i.x, i.y, i.z}, {j.x, j.y, j.z}, {k.x, k.y, k.z}}};
}

/* ------------------------------------------------------------------------------------------------------------ marks */

struct mark_context {
    const struct mark_list *list;
    struct mark_scene scene;
    struct mat3 axes;
    struct vec3 origin;
    double ceiling; /* above the floor; 0: none was found */
};

/* Mean height, from the origin, of the floor's corners that are marked in several views; false: none, or err is set. */
static bool corner_height(const struct mark_context *m, double *height, struct err *err)
{
    double sum = 0;
    int count = 0;
    for (int i = 0; i < m->list->count; i++) {
        const struct mark *a = &m->list->marks[i];
        int views = 0, first = 1;
        struct vec3 p;
        if (a->kind != MARK_CORNER) continue;
        for (int j = 0; j < m->list->count; j++) {
            const struct mark *b = &m->list->marks[j];
            if (b->kind != MARK_CORNER || strcmp(a->name, b->name)) continue;
            views++;
            first &= j >= i;
        }
        if (views < 2 || !first) continue;
        if (mark_locate(&p, MARK_CORNER, a->name, m->list, &m->scene, err)) return false;
        sum += vec3_dot(vec3_sub(p, m->origin), mat3_row(m->axes, 2));
        count++;
    }
    if (count) *height = sum / count;
    return count > 0;
}

static bool measure_corners(void *ctx, double *value)
{
    struct err ignored = ERR_INIT;
    return corner_height(ctx, value, &ignored);
}

/* The length of a `length` or a `height` in scene units; *known is false of a ceiling that was not found. */
static enum status marked_length(double *d, bool *known, const struct mark *a, const struct mark_context *m,
                                 struct err *err)
{
    struct vec3 p, q;
    *known = !mark_is_ceiling(a) || m->ceiling > 0;
    *d = m->ceiling;
    if (mark_is_ceiling(a) || mark_locate(&p, MARK_POINT, a->name, m->list, &m->scene, err)) return err->status;
    if (a->kind == MARK_HEIGHT) {
        *d = vec3_dot(p, m->scene.up) - m->scene.floor;
        if (*d > 0) return ST_OK;
        return err_set(err, ST_DATA, "%s:%d: %s is marked at the floor or below it; mark a point above the floor.",
                       m->list->path, a->line, a->name);
    }
    if (mark_locate(&q, MARK_POINT, a->view, m->list, &m->scene, err)) return err->status;
    *d = vec3_length(vec3_sub(q, p));
    if (*d > 0) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: %s and %s are marked at the same position; mark two different points.",
                   m->list->path, a->line, a->name, a->view);
}

/* Metres per scene unit, by least squares over the lengths and heights; *misfit: its standard error from their
 * residuals. */
static bool lengths_scale(const struct mark_context *m, double *scale, double *misfit, struct err *err)
{
    double product = 0, square = 0, sum = 0;
    int count = 0;
    for (int pass = 0; pass < 2; pass++)
        for (int i = 0; i < m->list->count; i++) {
            const struct mark *a = &m->list->marks[i];
            double d;
            bool known;
            if (a->kind != MARK_LENGTH && a->kind != MARK_HEIGHT) continue;
            if (marked_length(&d, &known, a, m, err)) return false;
            if (!known) continue;
            if (!pass) {
                product += d * a->metres;
                square += d * d;
                count++;
                *scale = product / square;
            } else {
                sum += (d * *scale - a->metres) * (d * *scale - a->metres);
            }
        }
    if (!count)
        err_set(err, ST_DATA,
                "%s: the height of the ceiling is given, but no ceiling was found; mark a point of it in two views, or "
                "above a point of the floor, and write \"height NAME METRES\".",
                m->list->path);
    *misfit = count > 1 ? sqrt(sum / (count - 1) / square) : 0;
    return count > 0;
}

static bool measure_scale(void *ctx, double *value)
{
    struct err ignored = ERR_INIT;
    double misfit;
    return lengths_scale(ctx, value, &misfit, &ignored);
}

/* Distance of the marks on both sides of a wall's end, along the axis of the larger difference. */
static enum status find_thickness(double *thickness, const struct mark_context *m, struct err *err)
{
    for (int i = 0; i < m->list->count; i++) {
        const struct mark *a = &m->list->marks[i];
        struct vec3 p, q;
        if (a->kind != MARK_THICKNESS) continue;
        if (mark_locate(&p, MARK_POINT, a->name, m->list, &m->scene, err) ||
            mark_locate(&q, MARK_POINT, a->view, m->list, &m->scene, err))
            return err->status;
        const struct vec3 d = mat3_apply(m->axes, vec3_sub(q, p));
        *thickness = fmax(fabs(d.x), fabs(d.y));
        if (!(*thickness > 0))
            return err_set(err, ST_DATA, "%s:%d: %s and %s are marked at the same position; mark two different points.",
                           m->list->path, a->line, a->name, a->view);
    }
    return ST_OK;
}

/* --------------------------------------------------------------------------------------------------------- the room */

/* The room's extent along x and y: between the outermost walls that face inwards, or else of all points. */
static void find_extent(struct room *room, const struct room_planes *planes, const struct point_cloud *cloud)
{
    for (int k = 0; k < 2; k++) {
        double low = HUGE_VAL, high = -HUGE_VAL, lowest = HUGE_VAL, highest = -HUGE_VAL;
        for (int i = 0; i < planes->count; i++) {
            const struct room_plane *p = &planes->planes[i];
            if (p->axis != k) continue;
            if (p->side > 0)
                low = fmin(low, p->offset);
            else
                high = fmax(high, p->offset);
        }
        for (size_t i = 0; i < cloud->count; i++) {
            const struct vec3 p = model_from_world_point(&room->axes, cloud->points[i].position);
            lowest = fmin(lowest, k ? p.y : p.x);
            highest = fmax(highest, k ? p.y : p.x);
        }
        if (!(lowest <= highest)) { /* no points */
            lowest = UNKNOWN_EXTENT * room->floor.height * room->axes.scale;
            highest = -lowest;
        }
        room->low[k] = low < HUGE_VAL ? low * room->axes.scale : lowest;
        room->high[k] = high > -HUGE_VAL ? high * room->axes.scale : highest;
        if (room->high[k] > room->low[k]) continue;
        room->low[k] = lowest;
        room->high[k] = highest;
    }
}

/* Takes the level that straight edges say where the points have none. eye: height of the origin in the frame. */
static void take_level(struct height_level *level, const struct frame_level *known, double eye)
{
    if (!known->known || level->count) return;
    level->height = known->height - eye;
    level->error = level->spread = known->error;
    level->count = level->candidates = 1;
    level->of_edges = true;
}

/* Forgets a ceiling that no room has: below a camera, or many times as high as the cameras. */
static void drop_implausible(struct room *room, const struct mark_context *m, const struct camera_set *set)
{
    double highest = 0;
    for (int i = 0; i < set->view_count; i++)
        highest = fmax(highest, vec3_dot(vec3_sub(set->views[i].center, m->origin), mat3_row(m->axes, 2)));
    if (room->ceiling.height > highest && room->ceiling.height < HIGHEST_CEILING * -room->floor.height) return;
    room->ceiling.count = 0;
}

static enum status find_heights(struct room *room, struct mark_context *m, const struct room_inputs *in,
                                struct vec3 errors, const struct axes_params *params, struct err *err)
{
    if (height_find_level(&room->floor, 1, &m->axes, m->origin, errors, in->cloud, params, err) ||
        height_find_level(&room->ceiling, -1, &m->axes, m->origin, errors, in->cloud, params, err))
        return err->status;
    if (room->source == AXES_OF_LINES) {
        const double eye = vec3_dot(in->frame->up, m->origin);
        if (in->frame->ceiling.known && in->frame->ceiling.error < room->ceiling.error)
            room->ceiling.count = 0; /* edges know it better */
        take_level(&room->floor, &in->frame->floor, eye);
        take_level(&room->ceiling, &in->frame->ceiling, eye);
    }
    m->list = in->fix;
    if (in->fix && corner_height(m, &room->corner_height, err)) {
        const double error = mark_error(in->fix, params->click, measure_corners, m);
        const double off = fabs(room->corner_height - room->floor.height);
        room->floor_marked = !room->floor.count || off > CONTRADICTS * hypot(error, room->floor.error);
        if (room->floor_marked) {
            room->floor.height = room->corner_height;
            room->floor.error = error;
        }
    }
    if (err->status) return err->status;
    if (!room->floor_marked && !room->floor.count)
        return err_set(
            err, ST_DATA,
            "no floor was found: of %zu points only %zu lie below the central camera and have upward normals (within "
            "%.3g "
            "degrees). Photograph more of the floor, or mark one of its corners in two views in axes_fix.txt.",
            in->cloud->count, room->floor.candidates, params->up_angle);
    if (!(room->floor.height < 0))
        return err_set(err, ST_DATA,
                       "%s: the corners lie above the central camera, so they are not on its floor; mark a corner "
                       "where two walls meet "
                       "the floor.",
                       in->fix->path);
    drop_implausible(room, m, in->set);
    return ST_OK;
}

static enum status find_scale(struct room *room, struct mark_context *m, const struct room_inputs *in, double click,
                              struct err *err)
{
    struct model_axes *a = &room->axes;
    double misfit = 0;
    m->list = in->fix;
    if (in->fix && find_thickness(&a->thickness, m, err)) return err->status;
    m->list = in->scale;
    if (!in->scale) return ST_OK;
    if (!lengths_scale(m, &a->scale, &misfit, err)) return err->status;
    a->metric = true;
    a->scale_error = hypot(mark_error(in->scale, click, measure_scale, m), misfit) / a->scale;
    for (int i = 0; i < in->scale->count; i++) {
        if (!mark_is_ceiling(&in->scale->marks[i])) continue;
        if (m->ceiling > 0)
            a->scale_error = hypot(a->scale_error, hypot(room->ceiling.error, room->floor.error) / m->ceiling);
        else
            a->ceiling = in->scale->marks[i].metres;
    }
    return ST_OK;
}

/* Axes from a marked edge on the floor, and up. False: none is marked. */
static bool axes_of_marks(struct mat3 *axes, const struct mark_context *m, const struct room_inputs *in, struct vec3 up,
                          struct err *err)
{
    for (int i = 0; in->fix && !err->status && i < in->fix->count; i++) {
        const struct mark *a = &in->fix->marks[i];
        struct vec3 along;
        if (a->kind != MARK_EDGE || correct_edge_plane(&along, a, in->fix, &m->scene, err)) continue;
        if (fabs(vec3_dot(along, up)) < LEVEL_EDGE) continue; /* an upright edge */
        const struct vec3 x = vec3_normalize(vec3_cross(along, up)), y = vec3_cross(up, x);
        *axes = (struct mat3){{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {up.x, up.y, up.z}}};
        return true;
    }
    return false;
}

/* Axes, in any order, from what determines them best. */
static enum status find_directions(struct directions *d, struct room *room, const struct mark_context *m,
                                   const struct room_inputs *in, struct vec3 up, const struct axes_params *params,
                                   struct err *err)
{
    struct err none = ERR_INIT;
    struct mat3 axes;
    room->source = AXES_OF_NORMALS;
    if (in->frame && in->frame->known) {
        const struct vec3 x = in->frame->headings[0].along, y = vec3_cross(in->frame->up, x), z = in->frame->up;
        room->source = AXES_OF_LINES;
        *d = (struct directions){.axes = {{{x.x, x.y, x.z}, {y.x, y.y, y.z}, {z.x, z.y, z.z}}}};
        directions_count(d, in->cloud);
        return ST_OK;
    }
    if (directions_find(d, in->cloud, params->min_part, &none) != ST_DATA)
        return none.status ? err_set(err, none.status, "%s", none.text) : ST_OK;
    room->source = AXES_OF_MARKS;
    if (axes_of_marks(&axes, m, in, up, err)) {
        *d = (struct directions){.axes = axes};
        directions_count(d, in->cloud);
        return ST_OK;
    }
    if (err->status) return err->status;
    return err_set(err, ST_DATA,
                   "%s The views' straight edges have no common directions, either. To give the axes by hand, mark a "
                   "corner of the floor in axes_fix.txt, in a photo such as %s: \"corner a %s X Y\", and points on two "
                   "of the edges that leave it: \"edge a %s X Y\"; mark the corner in a second photo, too, where the "
                   "points show no floor.",
                   none.text, in->set->views[room->central].name, in->set->views[room->central].name,
                   in->set->views[room->central].name);
}

static enum status find_errors(struct vec3 *errors, const struct room *room, const struct mark_context *m,
                               const struct room_inputs *in, struct err *err)
{
    switch (room->source) {
    case AXES_OF_LINES:
        *errors = vec3_make(in->frame->up_error, in->frame->up_error, in->frame->headings[0].error);
        return ST_OK;
    case AXES_OF_MARKS: /* correct_axes() says */
        *errors = vec3_make(1, 1, 1);
        return ST_OK;
    default:
        return direction_errors(errors, &m->axes, m->origin, in->cloud, err);
    }
}

static enum status find_all(struct room *room, const struct room_inputs *in, const struct axes_params *params,
                            struct room_planes *planes, struct err *err)
{
    struct directions d = {0};
    struct vec3 errors;
    struct model_axes *a = &room->axes;
    if (central_view(&room->central, in->set, err)) return err->status;
    const struct view *central = &in->set->views[room->central];
    struct mark_context m = {.scene = {.set = in->set, .lenses = in->lenses, .cloud = in->cloud},
                             .origin = central->center};
    const struct vec3 down = vec3_scale(in->ups[room->central], -1), right = vec3_cross(down, vec3_make(0, 0, 1));
    const struct vec3 up = upright_mean(in->set, in->ups);
    if (find_directions(&d, room, &m, in, up, params, err)) return err->status;
    m.axes = model_order(d.axes, d.part, up, mat3_apply(mat3_transpose(central->cam_from_world), right));
    for (int k = 0; k < 3; k++) room->part[k] = d.part[k];
    if (find_errors(&errors, room, &m, in, err) ||
        planes_find(planes, &m.axes, room->source == AXES_OF_NORMALS, &errors, m.origin, in->cloud, params, err))
        return err->status;
    if (in->fix && correct_axes(&m.axes, &errors, &room->fix, in->fix, &m.scene, params->click, err))
        return err->status;
    if (room->fix.turn > 0) {
        planes_release(planes);
        if (planes_find(planes, &m.axes, false, &errors, m.origin, in->cloud, params, err)) return err->status;
    }
    if (find_heights(room, &m, in, errors, params, err)) return err->status;
    m.scene.up = mat3_row(m.axes, 2);
    m.scene.floor = vec3_dot(m.origin, m.scene.up) + room->floor.height;
    if (room->ceiling.count) m.ceiling = room->ceiling.height - room->floor.height;
    *a = (struct model_axes){.rotation = quat_from_mat3(m.axes), .scale = 1};
    if (find_scale(room, &m, in, params->click, err)) return err->status;
    const struct vec3 foot = vec3_add(m.origin, vec3_scale(m.scene.up, room->floor.height));
    a->translation = vec3_scale(model_from_world_direction(a, foot), -a->scale);
    a->tilt_error = hypot(errors.x, errors.y) / DEGREE;
    a->heading_error = errors.z / DEGREE;
    a->floor_error = room->floor.error * a->scale;
    a->thickness *= a->scale;
    if (room->ceiling.count) {
        a->ceiling = (room->ceiling.height - room->floor.height) * a->scale;
        a->ceiling_error = hypot(room->ceiling.error, room->floor.error) * a->scale;
    }
    room->leaning = atan2(vec3_length(vec3_cross(up, m.scene.up)), vec3_dot(up, m.scene.up)) / DEGREE;
    find_extent(room, planes, in->cloud);
    return ST_OK;
}

enum status room_find(struct room *room, const struct room_inputs *in, const struct axes_params *params,
                      struct err *err)
{
    struct room_planes planes = {0};
    *room = (struct room){0};
    find_all(room, in, params, &planes, err);
    planes_release(&planes);
    return err->status;
}
