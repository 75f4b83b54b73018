/* marks.c - reads the marks of users and finds their positions.
 *
 * A mark is a pixel of a photo with a name. A file of marks is checked as a whole before anything is located, so
 * that a name without a partner is an error of its line.
 *
 * A point of the world is found in one of four ways:
 *   - marked in several views: the point with the least sum of squared distances from the rays. With unit rays r
 *     through centres c that is the solution of sum (I - r r') x = sum (I - r r') c. Rays less than a degree apart
 *     leave the distance open, and a reprojection error above 2 % of the photo's longer side means that the marks
 *     are of different points: both are errors
 *   - on the floor: where the ray meets it, at least a degree below the horizon
 *   - on a surface: the points of the cloud near the ray, within 0.3 % of their depth or 1.5 cells. Several surfaces
 *     may lie on a ray, so only points at most 2 % behind the first one count; their mean depth is the point's
 *   - above another point: on the vertical line through that, where it is nearest to the ray; 2 % of the longer side
 *     is the limit here too
 *
 * The effect of a click. mark_error() moves every coordinate of every mark by `click` pixels, one at a time,
 * measures the result again, and adds the squared changes: the standard error that clicks with that standard
 * deviation give, to first order. A move that leaves the photo is made to the other side. It takes 2 n measurements
 * for n marks.
 *
 * The cloud is searched from end to end for each mark on a surface, two passes of O(points); there are few marks. */
#include "stages/find_axes/marks.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"

enum { MAX_MARKS = 10000 };
static const double MIN_ANGLE = 1 * M_PI / 180; /* between rays for triangulation, and between a ray and the floor */
static const double MAX_MISS = 0.02;            /* max reprojection error, as a fraction of the photo's longer side */
static const double CONE = 0.003; /* max distance of a surface's points from the ray, as a fraction of their depth */
static const double THIN = 0.02;  /* max depth of a surface's points behind the first, as a fraction of its depth */

static const char *const kinds[] = {[MARK_POINT] = "mark",    [MARK_LENGTH] = "length", [MARK_HEIGHT] = "height",
                                    [MARK_CORNER] = "corner", [MARK_EDGE] = "edge",     [MARK_THICKNESS] = "thickness"};
static const char *const wanted_kinds[] = {[MARKS_SCALE] = "\"mark\", \"length\" or \"height\"",
                                           [MARKS_FIX] = "\"corner\", \"edge\", \"mark\" or \"thickness\""};

void mark_list_release(struct mark_list *list)
{
    if (!list) return;
    for (int i = 0; i < list->count; i++) {
        free(list->marks[i].name);
        free(list->marks[i].view);
        free(list->marks[i].foot);
    }
    free(list->marks);
    free(list->path);
    *list = (struct mark_list){0};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_kind(struct textfile *t, struct mark *m, enum mark_file file, struct err *err)
{
    char *word;
    if (textfile_word(t, wanted_kinds[file], &word, err)) return err->status;
    for (int k = MARK_POINT; k <= MARK_THICKNESS; k++) {
        const bool allowed = k == MARK_POINT || (k <= MARK_HEIGHT) == (file == MARKS_SCALE);
        if (!allowed || strcmp(word, kinds[k])) continue;
        m->kind = (enum mark_kind)k;
        return ST_OK;
    }
    return textfile_error(t, err, word, "%s", wanted_kinds[file]);
}

static enum status read_on(struct textfile *t, struct mark *m, struct err *err)
{
    static const char wanted[] = "\"floor\", \"surface\", \"above\" or the end of the line";
    char *word;
    if (m->kind != MARK_POINT || !textfile_more(t)) return ST_OK;
    if (textfile_word(t, wanted, &word, err)) return err->status;
    m->on = !strcmp(word, "floor")     ? MARK_ON_FLOOR
            : !strcmp(word, "surface") ? MARK_ON_SURFACE
            : !strcmp(word, "above")   ? MARK_ABOVE
                                       : MARK_IN_VIEWS;
    if (m->on == MARK_ABOVE) {
        if (textfile_word(t, "the name of the mark below", &word, err)) return err->status;
        m->foot = strdup(word);
        return m->foot ? ST_OK : err_nomem(err, "a name", strlen(word));
    }
    return m->on == MARK_IN_VIEWS ? textfile_error(t, err, word, wanted) : ST_OK;
}

/* METRES, above 0. */
static enum status read_metres(struct textfile *t, struct mark *m, struct err *err)
{
    char text[32];
    if (textfile_double(t, "metres", &m->metres, err)) return err->status;
    if (m->metres > 0) return ST_OK;
    snprintf(text, sizeof text, "%.9g", m->metres);
    return textfile_error(t, err, text, "a length above 0, in metres");
}

static enum status read_mark(struct textfile *t, struct mark *m, enum mark_file file, struct err *err)
{
    char *name, *view = NULL;
    m->line = t->line;
    if (read_kind(t, m, file, err)) return err->status;
    const bool pair = m->kind == MARK_LENGTH || m->kind == MARK_THICKNESS, height = m->kind == MARK_HEIGHT;
    if (textfile_word(t, height ? "\"ceiling\" or the name of a mark" : "a name", &name, err) ||
        (!height && textfile_word(t, pair ? "a second name" : "a photo or view", &view, err)))
        return err->status;
    m->name = strdup(name);
    m->view = strdup(view ? view : "");
    if (!m->name || !m->view) return err_nomem(err, "a name", strlen(name) + 1);
    if (!pair && !height &&
        (textfile_double(t, "x", &m->x, err) || textfile_double(t, "y", &m->y, err) || read_on(t, m, err)))
        return err->status;
    if ((m->kind == MARK_LENGTH || height) && read_metres(t, m, err)) return err->status;
    return textfile_end(t, err);
}

bool mark_is_ceiling(const struct mark *m) { return m->kind == MARK_HEIGHT && !strcmp(m->name, "ceiling"); }

static int count_of(const struct mark_list *list, enum mark_kind kind, const char *name, const char *view)
{
    int count = 0;
    for (int i = 0; i < list->count; i++) {
        const struct mark *m = &list->marks[i];
        count += m->kind == kind && !strcmp(m->name, name) && (!view || !strcmp(m->view, view));
    }
    return count;
}

static enum status needs_mark(const struct mark_list *list, const struct mark *m, const char *name, struct err *err)
{
    if (count_of(list, MARK_POINT, name, NULL)) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: %s is used, but no line marks it; add a line \"mark %s VIEW X Y\".",
                   list->path, m->line, name, name);
}

/* What is above a point must be marked, and itself stand on nothing that is above another point. */
static enum status check_foot(const struct mark_list *list, const struct mark *m, struct err *err)
{
    if (needs_mark(list, m, m->foot, err)) return err->status;
    for (int i = 0; i < list->count; i++)
        if (list->marks[i].kind == MARK_POINT && list->marks[i].on == MARK_ABOVE &&
            !strcmp(list->marks[i].name, m->foot))
            return err_set(err, ST_DATA, "%s:%d: %s is above %s, which is above another mark; name the lowest of them.",
                           list->path, m->line, m->name, m->foot);
    return ST_OK;
}

static enum status check_pair(const struct mark_list *list, const struct mark *m, struct err *err)
{
    const char *names[2] = {m->name, m->view};
    for (int k = 0; k < 2; k++)
        if (needs_mark(list, m, names[k], err)) return err->status;
    if (!strcmp(names[0], names[1]))
        return err_set(err, ST_DATA, "%s:%d: found %s twice, wanted two different marks.", list->path, m->line,
                       names[0]);
    return ST_OK;
}

/* Checks a line against the others. */
static enum status check_mark(const struct mark_list *list, const struct mark *m, struct err *err)
{
    if (m->kind == MARK_LENGTH || m->kind == MARK_THICKNESS) return check_pair(list, m, err);
    if (m->kind == MARK_HEIGHT) return mark_is_ceiling(m) ? ST_OK : needs_mark(list, m, m->name, err);
    if (m->on == MARK_ABOVE && check_foot(list, m, err)) return err->status;
    if (m->kind == MARK_EDGE && !count_of(list, MARK_CORNER, m->name, m->view))
        return err_set(err, ST_DATA,
                       "%s:%d: the corner %s of this edge is not marked in %s; add a line \"corner %s %s X Y\".",
                       list->path, m->line, m->name, m->view, m->name, m->view);
    if (m->kind != MARK_EDGE && count_of(list, m->kind, m->name, m->view) > 1)
        return err_set(err, ST_DATA, "%s:%d: %s is marked twice in %s; delete one of the lines.", list->path, m->line,
                       m->name, m->view);
    const int views = count_of(list, m->kind, m->name, NULL);
    if (m->kind == MARK_POINT && m->on != MARK_IN_VIEWS && views > 1)
        return err_set(err, ST_DATA,
                       "%s:%d: %s is marked in %d views, wanted one for a point on the floor, on a surface or above "
                       "another; delete the "
                       "other lines, or the words after X Y.",
                       list->path, m->line, m->name, views);
    if (m->kind == MARK_POINT && m->on == MARK_IN_VIEWS && views < 2)
        return err_set(
            err, ST_DATA,
            "%s:%d: %s is marked in one view alone, so its distance is unknown; mark it in another view too, or "
            "add \"floor\", \"surface\" or \"above NAME\" to the line if it lies there.",
            list->path, m->line, m->name);
    if (m->kind == MARK_CORNER && views < 2 && !count_of(list, MARK_EDGE, m->name, NULL))
        return err_set(err, ST_DATA,
                       "%s:%d: the corner %s corrects nothing yet; mark it in another view too, for the height of the "
                       "floor, or mark points on its edges, for the axes.",
                       list->path, m->line, m->name);
    return ST_OK;
}

enum status mark_list_read(struct mark_list *list, const char *path, enum mark_file file, struct provenance *prov,
                           struct err *err)
{
    struct textfile t = {0};
    *list = (struct mark_list){.path = strdup(path)};
    const char *name = file == MARKS_SCALE ? "scale.txt" : "axes_fix.txt";
    if (list->path)
        provenance_open(prov, name, &t, path, err);
    else
        err_nomem(err, "a file name", strlen(path));
    while (!err->status && textfile_next(&t)) {
        if (list->count < MAX_MARKS)
            array_append(&list->marks, (size_t)list->count, sizeof *list->marks, "marks", err);
        else
            err_set(err, ST_DATA, "%s:%d: found more than %d lines.", path, t.line, MAX_MARKS);
        if (err->status) break;
        struct mark *m = &list->marks[list->count++];
        *m = (struct mark){0};
        read_mark(&t, m, file, err);
    }
    textfile_release(&t);
    int lengths = 0, thicknesses = 0;
    for (int i = 0; !err->status && i < list->count; i++) {
        const struct mark *m = &list->marks[i];
        check_mark(list, m, err);
        lengths += m->kind == MARK_LENGTH || m->kind == MARK_HEIGHT;
        thicknesses += m->kind == MARK_THICKNESS;
        if (!err->status && thicknesses > 1)
            err_set(err, ST_DATA, "%s:%d: found a second thickness, wanted one for all walls.", path, m->line);
    }
    if (!err->status && file == MARKS_SCALE && !lengths)
        err_set(err, ST_DATA,
                "%s: no length is given; add a line \"length NAME NAME METRES\" or \"height ceiling METRES\".", path);
    if (err->status) mark_list_release(list);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- placing */

enum status mark_ray(const struct mark *m, const struct mark_list *list, const struct mark_scene *scene,
                     struct photo_camera *camera, struct vec3 *ray, struct err *err)
{
    if (photo_camera_find(camera, m->view, scene->set, scene->lenses, list->path, m->line, err)) return err->status;
    if (photo_camera_ray(camera, m->x, m->y, ray)) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: the pixel %.9g %.9g is outside the picture of %s, which has %d x %d pixels; give pixels of "
                   "the photo as "
                   "it is stored.",
                   list->path, m->line, m->x, m->y, m->view, camera->lens.width, camera->lens.height);
}

static enum status on_floor(struct vec3 *world, const struct mark *m, const struct mark_list *list,
                            const struct mark_scene *scene, struct vec3 center, struct vec3 ray, struct err *err)
{
    const double above = vec3_dot(center, scene->up) - scene->floor, down = -vec3_dot(ray, scene->up);
    if (!(down > sin(MIN_ANGLE)) || !(above > 0))
        return err_set(
            err, ST_DATA,
            "%s:%d: the floor is not visible at the pixel %.9g %.9g of %s, which is at or above the horizon; "
            "mark a pixel on the floor.",
            list->path, m->line, m->x, m->y, m->view);
    *world = vec3_add(center, vec3_scale(ray, above / down));
    return ST_OK;
}

/* The mean of the points near the ray that are not much farther away than the first of them. */
static enum status on_surface(struct vec3 *world, const struct mark *m, const struct mark_list *list,
                              const struct point_cloud *cloud, struct vec3 center, struct vec3 ray, struct err *err)
{
    double first = HUGE_VAL, count = 0, sum = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t i = 0; i < cloud->count; i++) {
            const struct vec3 p = vec3_sub(cloud->points[i].position, center);
            const double along = vec3_dot(p, ray);
            if (!(along > 0) || vec3_length(vec3_cross(p, ray)) > fmax(CONE * along, 1.5 * cloud->cell)) continue;
            if (!pass) {
                first = fmin(first, along);
            } else if (along <= first * (1 + THIN)) {
                sum += along;
                count++;
            }
        }
    if (!(count > 0))
        return err_set(err, ST_DATA,
                       "%s:%d: there are no points at the pixel %.9g %.9g of %s; mark it in a second view instead of "
                       "writing \"surface\".",
                       list->path, m->line, m->x, m->y, m->view);
    *world = vec3_add(center, vec3_scale(ray, sum / count));
    return ST_OK;
}

/* Solves a x = b for a symmetric a. */
static struct vec3 solve(const double a[6], struct vec3 b) /* a: xx xy xz yy yz zz */
{
    const struct vec3 r0 = {a[0], a[1], a[2]}, r1 = {a[1], a[3], a[4]}, r2 = {a[2], a[4], a[5]};
    const struct vec3 c0 = vec3_cross(r1, r2), c1 = vec3_cross(r2, r0), c2 = vec3_cross(r0, r1);
    const double det = vec3_dot(r0, c0);
    return vec3_scale(vec3_add(vec3_add(vec3_scale(c0, b.x), vec3_scale(c1, b.y)), vec3_scale(c2, b.z)), 1 / det);
}

/* Triangulates a point: the least squares intersection of its rays. Its reprojection errors must be small. */
static enum status triangulate(struct vec3 *world, enum mark_kind kind, const char *name, const struct mark_list *list,
                               const struct mark_scene *scene, struct err *err)
{
    double a[6] = {0}, angle = 0;
    struct vec3 b = {0}, first = {0};
    const struct mark *last = NULL;
    struct photo_camera camera;
    for (int i = 0; i < list->count; i++) {
        const struct mark *m = &list->marks[i];
        struct vec3 r;
        if (m->kind != kind || strcmp(m->name, name)) continue;
        if (mark_ray(m, list, scene, &camera, &r, err)) return err->status;
        if (!last) first = r;
        last = m;
        angle = fmax(angle, atan2(vec3_length(vec3_cross(r, first)), vec3_dot(r, first)));
        const double across[6] = {1 - r.x * r.x, -r.x * r.y, -r.x * r.z, 1 - r.y * r.y, -r.y * r.z, 1 - r.z * r.z};
        for (int k = 0; k < 6; k++) a[k] += across[k];
        b = vec3_add(b, vec3_sub(camera.center, vec3_scale(r, vec3_dot(r, camera.center))));
    }
    if (!(angle > MIN_ANGLE))
        return err_set(err, ST_DATA,
                       "%s:%d: the rays of %s are nearly parallel (%.2g degrees apart), so its distance is unknown; "
                       "mark it in a view "
                       "from elsewhere.",
                       list->path, last->line, name, angle * 180 / M_PI);
    *world = solve(a, b);
    for (int i = 0; i < list->count; i++) {
        const struct mark *m = &list->marks[i];
        struct vec3 r;
        double u, v;
        if (m->kind != kind || strcmp(m->name, name)) continue;
        if (mark_ray(m, list, scene, &camera, &r, err)) return err->status;
        const double side = fmax(camera.lens.width, camera.lens.height);
        const bool visible =
            vec3_dot(vec3_sub(*world, camera.center), r) > 0 && photo_camera_project(&camera, *world, &u, &v);
        const double miss = visible ? hypot(u - m->x, v - m->y) : HUGE_VAL;
        if (miss <= MAX_MISS * side) continue;
        if (!visible)
            return err_set(err, ST_DATA,
                           "%s:%d: the rays of %s diverge in front of %s; mark the same point in all views.",
                           list->path, m->line, name, m->view);
        return err_set(
            err, ST_DATA,
            "%s:%d: the marks of %s are not the same point: its reprojection error in %s is %.1f px; mark the "
            "same point in all views.",
            list->path, m->line, name, m->view, miss);
    }
    return ST_OK;
}

/* The point above its foot that is nearest to the mark's ray. */
static enum status above_foot(struct vec3 *world, const struct mark *m, const struct mark_list *list,
                              const struct mark_scene *scene, const struct photo_camera *camera, struct vec3 ray,
                              struct err *err)
{
    struct vec3 foot;
    double u, v;
    if (mark_locate(&foot, MARK_POINT, m->foot, list, scene, err)) return err->status;
    const struct vec3 up = scene->up, from = vec3_sub(foot, camera->center);
    const double b = vec3_dot(up, ray), sine2 = 1 - b * b;
    const double rise = sine2 > 0 ? (b * vec3_dot(ray, from) - vec3_dot(up, from)) / sine2 : -1;
    *world = vec3_add(foot, vec3_scale(up, rise));
    const double side = fmax(camera->lens.width, camera->lens.height);
    const bool visible =
        vec3_dot(vec3_sub(*world, camera->center), ray) > 0 && photo_camera_project(camera, *world, &u, &v);
    if (rise > 0 && visible && hypot(u - m->x, v - m->y) <= MAX_MISS * side) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s:%d: the pixel %.9g %.9g of %s is not straight above the mark %s; mark two points on one upright "
                   "edge, such as the head and the foot of a door.",
                   list->path, m->line, m->x, m->y, m->view, m->foot);
}

enum status mark_locate(struct vec3 *world, enum mark_kind kind, const char *name, const struct mark_list *list,
                        const struct mark_scene *scene, struct err *err)
{
    const struct mark *m = list->marks;
    struct photo_camera camera;
    struct vec3 ray;
    while (m->kind != kind || strcmp(m->name, name)) m++; /* mark_list_read() checked that it exists */
    if (m->on == MARK_IN_VIEWS) return triangulate(world, kind, name, list, scene, err);
    if (mark_ray(m, list, scene, &camera, &ray, err)) return err->status;
    if (m->on == MARK_ABOVE) return above_foot(world, m, list, scene, &camera, ray, err);
    return m->on == MARK_ON_FLOOR ? on_floor(world, m, list, scene, camera.center, ray, err)
                                  : on_surface(world, m, list, scene->cloud, camera.center, ray, err);
}

double mark_error(struct mark_list *list, double click, bool (*measure)(void *ctx, double *value), void *ctx)
{
    double value, moved, sum = 0;
    if (!measure(ctx, &value)) return 0;
    for (int i = 0; i < list->count; i++) {
        double *const c[2] = {&list->marks[i].x, &list->marks[i].y};
        for (int k = 0; k < 2; k++) {
            const double before = *c[k];
            *c[k] = before + click;
            bool known = measure(ctx, &moved);
            if (!known) { /* outside the photo */
                *c[k] = before - click;
                known = measure(ctx, &moved);
            }
            *c[k] = before;
            if (known) sum += (moved - value) * (moved - value);
        }
    }
    return sqrt(sum);
}
