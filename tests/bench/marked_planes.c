/* marked_planes.c - depth against planes that a person marked in the views.
 *
 *   marked_planes --views DIR --depth DIR --marks FILE
 *
 * Fits a plane to each face of the marks, whose format tests/long/real_room_marks.txt explains. The depth only starts
 * the fit; it does not pull the planes. Faces that are stated level share one normal, up, and those stated upright are
 * parallel to it: edges seen from few places leave a plane's slope free by some degrees, and a room's builder did not.
 * Headings of upright faces are free, so they show whether the planes are right. Prints a line for each face and one
 * for all: number of marks, their root mean square distance in px, the heading against that of the first upright face
 * in degrees, pixels of the regions, the part of these whose depth is within 5 % of the plane's in %, and the median of
 * depth over the plane's. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/textfile.h"
#include "common/capture/camera_set.h"
#include "common/layers/layered_depth.h"
#include "common/math/ceres_least_squares.h"
#include "common/math/cholesky.h"
#include "common/math/numbers.h"
#include "common/math/weighted.h"

enum { MAX_FACES = 16, MAX_CORNERS = 64, MAX_MARKS = 2000, MAX_REGIONS = 200, ITERATIONS = 1000 };
enum { AGAIN = 4 };                              /* solutions from the last: the solver stops early in flat valleys */
enum { SWEEPS = 6, TURNS = 60, DISTANCES = 65 }; /* of the search for a start */
#define WITHIN 0.05
#define OFF    1e4 /* distance of a mark that a plane does not meet, px */

struct pixel {
    int view;
    double x, y;
};

struct mark {
    int face[2]; /* the second is -1 for a point */
    int first;   /* the mark of a point's first pixel */
    struct pixel at;
};

struct region {
    int face, corners;
    struct pixel corner[MAX_CORNERS];
};

enum stance { FREE, LEVEL, UPRIGHT }; /* what is known of a face */

struct marked {
    struct camera_set set;
    char faces[MAX_FACES][64];
    enum stance stances[MAX_FACES];
    int face_count, mark_count, region_count;
    double size[2]; /* of the views that were marked */
    struct mark marks[MAX_MARKS];
    struct region regions[MAX_REGIONS];
    struct vec3 origin; /* the mean of the views' centres */
    double soft;        /* distance from which on a mark pulls less, px */
};

static enum status read_face(struct marked *m, struct textfile *t, int *face, struct err *err)
{
    char *name;
    if (textfile_word(t, "face", &name, err)) return err->status;
    for (*face = 0; *face < m->face_count; ++*face)
        if (!strcmp(m->faces[*face], name)) return ST_OK;
    if (m->face_count == MAX_FACES) return textfile_error(t, err, name, "at most %d faces", MAX_FACES);
    snprintf(m->faces[m->face_count++], sizeof *m->faces, "%s", name);
    return ST_OK;
}

static enum status read_view(const struct marked *m, struct textfile *t, struct pixel *p, struct err *err)
{
    char *name;
    if (textfile_word(t, "view", &name, err)) return err->status;
    p->view = camera_set_find(&m->set, name);
    return p->view < 0 ? textfile_error(t, err, name, "the name of a view") : ST_OK;
}

static enum status read_pixel(const struct marked *m, struct textfile *t, struct pixel *p, struct err *err)
{
    if (textfile_double(t, "x", &p->x, err) || textfile_double(t, "y", &p->y, err)) return err->status;
    p->x *= m->set.views[p->view].width / m->size[0];
    p->y *= m->set.views[p->view].height / m->size[1];
    return ST_OK;
}

static enum status read_record(struct marked *m, struct textfile *t, struct err *err)
{
    char *kind;
    int face[2] = {-1, -1};
    struct pixel p = {.view = 0};
    if (textfile_word(t, "size, level, upright, edge, point or region", &kind, err)) return err->status;
    if (!strcmp(kind, "size"))
        return textfile_number(t, "width", 1, 1e6, &m->size[0], err) ||
                       textfile_number(t, "height", 1, 1e6, &m->size[1], err)
                   ? err->status
                   : ST_OK;
    if (!strcmp(kind, "level") || !strcmp(kind, "upright")) {
        const enum stance stance = !strcmp(kind, "level") ? LEVEL : UPRIGHT;
        while (textfile_more(t)) {
            if (read_face(m, t, &face[0], err)) return err->status;
            m->stances[face[0]] = stance;
        }
        return ST_OK;
    }
    const bool edge = !strcmp(kind, "edge"), point = !strcmp(kind, "point"), region = !strcmp(kind, "region");
    if (!(edge || point || region) || !(m->size[0] > 0))
        return textfile_error(t, err, kind, "size, level or upright, and after these edge, point or region");
    for (int k = 0; k < 1 + edge; k++)
        if (read_face(m, t, &face[k], err)) return err->status;
    if (!point && read_view(m, t, &p, err)) return err->status;
    struct region *r = &m->regions[m->region_count];
    const int first = m->mark_count;
    while (textfile_more(t)) {
        if (m->mark_count == MAX_MARKS || m->region_count == MAX_REGIONS || r->corners == MAX_CORNERS)
            return textfile_error(t, err, kind, "fewer marks");
        if ((point && read_view(m, t, &p, err)) || read_pixel(m, t, &p, err)) return err->status;
        if (region)
            r->corner[r->corners++] = p;
        else
            m->marks[m->mark_count++] = (struct mark){{face[0], face[1]}, first, p};
    }
    if (region) r->face = face[0], m->region_count++;
    return ST_OK;
}

static struct vec3 ray_of(const struct marked *m, const struct pixel *p) /* its z in the camera is 1 */
{
    const struct view *v = &m->set.views[p->view];
    return vec3_sub(view_unproject(v, p->x, p->y, 1), v->center);
}

struct plane_fit { /* n . (X - origin) = d */
    struct vec3 n;
    double d;
};

/* x: normal and distance of each face, then up, of any length. Of a normal only what the face's stance leaves free
 * counts. */
static struct plane_fit plane_in(const struct marked *m, const double *x, int face)
{
    const double *own = &x[4 * face], *top = &x[4 * m->face_count];
    const struct vec3 up = vec3_normalize(vec3_make(top[0], top[1], top[2]));
    struct vec3 n = vec3_make(own[0], own[1], own[2]);
    if (m->stances[face] == LEVEL) n = up;
    if (m->stances[face] == UPRIGHT) n = vec3_sub(n, vec3_scale(up, vec3_dot(n, up)));
    return (struct plane_fit){vec3_normalize(n), own[3]};
}

/* Distance of a view's centre from a plane. */
static double miss_of(const struct marked *m, struct plane_fit plane, int view)
{
    return plane.d - vec3_dot(plane.n, vec3_sub(m->set.views[view].center, m->origin));
}

/* Depth of a plane at a pixel. */
static double plane_depth(const struct marked *m, struct plane_fit plane, const struct pixel *p)
{
    return miss_of(m, plane, p->view) / vec3_dot(plane.n, ray_of(m, p));
}

/* Signed distance in px of an edge's mark from the picture of the line where its planes meet: the plane of the pencil
 * through the camera's centre has the normal miss_b * a - miss_a * b. */
static double edge_distance(const struct marked *m, const double *x, const struct mark *k)
{
    const struct view *v = &m->set.views[k->at.view];
    const struct plane_fit a = plane_in(m, x, k->face[0]), b = plane_in(m, x, k->face[1]);
    const struct vec3 normal =
        vec3_sub(vec3_scale(a.n, miss_of(m, b, k->at.view)), vec3_scale(b.n, miss_of(m, a, k->at.view)));
    const struct vec3 n = mat3_apply(v->cam_from_world, normal);
    const double steep = hypot(n.x / v->fx, n.y / v->fy);
    return vec3_dot(normal, ray_of(m, &k->at)) / fmax(steep, 1e-12);
}

/* A point's first pixel places it on the plane; the others are compared with it. */
static double point_distance(const struct marked *m, const double *x, const struct mark *k)
{
    const struct pixel *first = &m->marks[k->first].at;
    const double z = plane_depth(m, plane_in(m, x, k->face[0]), first);
    const struct vec3 at = vec3_add(m->set.views[first->view].center, vec3_scale(ray_of(m, first), z));
    double u, v;
    if (!(view_project(&m->set.views[k->at.view], at, &u, &v) > 0)) return OFF;
    return hypot(u - k->at.x, v - k->at.y);
}

static void distances(void *ctx, const double *x, double *r)
{
    const struct marked *m = ctx;
    for (int i = 0; i < m->mark_count; i++) {
        const struct mark *k = &m->marks[i];
        const double d = k->face[1] >= 0 ? edge_distance(m, x, k) : point_distance(m, x, k);
        r[i] = isfinite(d) ? clamp(d, -OFF, OFF) : OFF;
    }
}

/* What the fit makes small: distances whose squares grow less from m->soft px on. */
static void soft_distances(void *ctx, const double *x, double *r)
{
    const struct marked *m = ctx;
    distances(ctx, x, r);
    for (int i = 0; i < m->mark_count; i++) {
        const double far = r[i] / m->soft;
        r[i] = m->soft * far / sqrt(0.5 * (1 + sqrt(1 + far * far)));
    }
}

/* The median point of those at `depth` along the marks of a face. */
static struct vec3 middle_of(const struct vec3 *points, int count)
{
    struct weighted values[MAX_MARKS];
    double middle[3];
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < count; i++)
            values[i] = (struct weighted){k == 0 ? points[i].x : k == 1 ? points[i].y : points[i].z, 1};
        middle[k] = weighted_percentile(values, (size_t)count, 0.5);
    }
    return vec3_make(middle[0], middle[1], middle[2]);
}

/* The direction in which points spread least about `middle`, by inverse iteration. */
static struct vec3 thin_direction(const struct vec3 *points, int count, struct vec3 middle)
{
    double a[9] = {0}, n[3] = {0.6, 0.5, 0.4};
    for (int i = 0; i < count; i++) {
        const struct vec3 off = vec3_sub(points[i], middle);
        const double at[3] = {off.x, off.y, off.z};
        for (int r = 0; r < 9; r++) a[r] += at[r / 3] * at[r % 3];
    }
    for (int r = 0; r < 3; r++) a[4 * r] += 1e-9 * (a[0] + a[4] + a[8] + 1);
    if (!cholesky_factor(a, 3)) return vec3_make(0, 0, 1);
    for (int i = 0; i < 50; i++) {
        cholesky_forward(a, 3, n);
        cholesky_backward(a, 3, n);
        const double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
        for (int k = 0; k < 3; k++) n[k] /= length;
    }
    return vec3_make(n[0], n[1], n[2]);
}

/* Planes fitted to the depths at the marks. Up is as the cameras were held. */
static void start_planes(const struct marked *m, const double *depth, double *x)
{
    struct vec3 up = {0, 0, 0};
    for (int i = 0; i < m->set.view_count; i++) up = vec3_sub(up, mat3_row(m->set.views[i].cam_from_world, 1));
    up = vec3_normalize(up);
    x[4 * m->face_count] = up.x;
    x[4 * m->face_count + 1] = up.y;
    x[4 * m->face_count + 2] = up.z;
    for (int f = 0; f < m->face_count; f++) {
        struct vec3 points[MAX_MARKS];
        int count = 0;
        for (int i = 0; i < m->mark_count; i++) {
            const struct mark *k = &m->marks[i];
            if ((k->face[0] != f && k->face[1] != f) || !(depth[i] > 0)) continue;
            points[count++] = vec3_add(m->set.views[k->at.view].center, vec3_scale(ray_of(m, &k->at), depth[i]));
        }
        const struct vec3 middle = middle_of(points, count),
                          n = m->stances[f] == LEVEL ? up : thin_direction(points, count, middle);
        x[4 * f] = n.x;
        x[4 * f + 1] = n.y;
        x[4 * f + 2] = n.z;
        x[4 * f + 3] = vec3_dot(n, vec3_sub(middle, m->origin));
    }
}

/* Tries headings and distances for one face after the other, since depth may have started a face anywhere. */
static void search_planes(struct marked *m, double *x)
{
    double off[MAX_MARKS];
    for (int k = 0; k < SWEEPS * m->face_count; k++) {
        const int f = k % m->face_count, turns = m->stances[f] == UPRIGHT ? TURNS : 1;
        const struct vec3 up = vec3_make(x[4 * m->face_count], x[4 * m->face_count + 1], x[4 * m->face_count + 2]);
        const struct vec3 side = vec3_normalize(vec3_cross(up, vec3_make(up.y, up.z, up.x)));
        const double reach = fabs(x[4 * f + 3]);
        double *own = &x[4 * f], best[4] = {own[0], own[1], own[2], own[3]}, least = INFINITY;
        if (m->stances[f] == FREE) continue;
        for (int i = 0; i <= turns * 2 * DISTANCES; i++) {
            if (i) { /* the first is the face as it is */
                const double angle = (i - 1) % turns * PI / TURNS;
                const int step = (i - 1) / turns;
                const struct vec3 n =
                    turns == 1 ? up
                               : vec3_add(vec3_scale(side, cos(angle)), vec3_scale(vec3_cross(up, side), sin(angle)));
                own[0] = n.x, own[1] = n.y, own[2] = n.z;
                own[3] = (step % 2 ? -1 : 1) * reach * exp2((step / 2 - DISTANCES / 2) / 16.0);
            }
            double sum = 0;
            soft_distances(m, x, off);
            for (int j = 0; j < m->mark_count; j++) sum += off[j] * off[j];
            if (sum < least) least = sum, memcpy(best, own, sizeof best);
        }
        memcpy(own, best, sizeof best);
    }
}

static bool is_inside(const struct region *r, double x, double y)
{
    bool inside = false;
    for (int i = 0, j = r->corners - 1; i < r->corners; j = i++) {
        const struct pixel *a = &r->corner[i], *b = &r->corner[j];
        if ((a->y > y) != (b->y > y) && x < (b->x - a->x) * (y - a->y) / (b->y - a->y) + a->x) inside = !inside;
    }
    return inside;
}

struct tally {
    size_t pixels, within;
    struct weighted *ratios;
};

/* Adds the region's pixels to its face's tally and to that of all. */
static enum status add_region(struct tally *of, struct tally *all, const struct marked *m, const struct region *r,
                              const double *x, const struct layered_depth *d, struct err *err)
{
    const size_t room = (size_t)d->width * (size_t)d->height;
    struct tally *to[2] = {of, all};
    for (int k = 0; k < 2; k++) {
        struct weighted *more = realloc(to[k]->ratios, (to[k]->pixels + room) * sizeof *more);
        if (!more) return err_nomem(err, "depths", room * sizeof *more);
        to[k]->ratios = more;
    }
    for (int v = 0; v < d->height; v++)
        for (int u = 0; u < d->width; u++) {
            const struct pixel p = {r->corner[0].view, u + 0.5, v + 0.5};
            if (!is_inside(r, p.x, p.y)) continue;
            const double z = (double)d->interior.z[(size_t)v * (size_t)d->width + (size_t)u];
            const double ratio = z / plane_depth(m, plane_in(m, x, r->face), &p);
            for (int k = 0; k < 2; k++) {
                to[k]->ratios[to[k]->pixels++] = (struct weighted){ratio, 1};
                to[k]->within += fabs(ratio - 1) < WITHIN;
            }
        }
    return ST_OK;
}

static void print_tally(const char *name, struct tally *t, int marks, double squares, const char *heading)
{
    printf("%s\t%d\t%.2f\t%s\t%zu\t%.1f\t%.3f\n", name, marks, sqrt(squares / fmax(marks, 1)), heading, t->pixels,
           100.0 * (double)t->within / fmax((double)t->pixels, 1), weighted_percentile(t->ratios, t->pixels, 0.5));
    free(t->ratios);
}

/* The angle between two walls, at most 90 degrees. */
static double angle_between(struct vec3 a, struct vec3 b)
{
    return atan2(vec3_length(vec3_cross(a, b)), fabs(vec3_dot(a, b))) * 180 / PI;
}

static enum status read_depth(struct layered_depth *d, const struct marked *m, const char *folder, int view,
                              struct err *err)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.exr", folder, m->set.views[view].name);
    return layered_depth_read_interior(d, path, NULL, err);
}

/* The depths at the marks, 0 where a view has none. */
static enum status read_marks(double *depth, const struct marked *m, const char *folder, struct err *err)
{
    for (int v = 0; v < m->set.view_count && !err->status; v++) {
        struct layered_depth d = {0};
        if (read_depth(&d, m, folder, v, err)) break;
        for (int i = 0; i < m->mark_count; i++) {
            const struct pixel *p = &m->marks[i].at;
            if (p->view == v && p->x >= 0 && p->y >= 0 && p->x < d.width && p->y < d.height)
                depth[i] = (double)d.interior.z[(size_t)p->y * (size_t)d.width + (size_t)p->x];
        }
        layered_depth_release(&d);
    }
    return err->status;
}

static void print_scores(struct marked *m, const double *x, struct tally *of, struct tally *all)
{
    double off[MAX_MARKS], sum = 0;
    distances(m, x, off);
    int first = 0;
    while (first < m->face_count - 1 && m->stances[first] != UPRIGHT) first++;
    printf("face\tmarks\trms_px\theading\tpixels\twithin_5\tmedian\n");
    for (int f = 0; f < m->face_count; f++) {
        double squares = 0;
        int marks = 0;
        for (int i = 0; i < m->mark_count; i++)
            if (m->marks[i].face[0] == f || m->marks[i].face[1] == f) squares += off[i] * off[i], marks++;
        char heading[32] = "-";
        if (m->stances[f] == UPRIGHT)
            snprintf(heading, sizeof heading, "%.1f", angle_between(plane_in(m, x, first).n, plane_in(m, x, f).n));
        print_tally(m->faces[f], &of[f], marks, squares, heading);
    }
    for (int i = 0; i < m->mark_count; i++) sum += off[i] * off[i];
    print_tally("all", all, m->mark_count, sum, "-");
}

/* The best of fits that differ in how far a mark pulls at first: planes that start off must be pulled, by the right
 * marks. */
static enum status fit_planes(struct marked *m, double *x, struct err *err)
{
    const struct least_squares problem = {4 * m->face_count + 3, m->mark_count, soft_distances, m, ITERATIONS};
    double best[4 * MAX_FACES + 3], start[4 * MAX_FACES + 3], off[MAX_MARKS], least = INFINITY;
    memcpy(start, x, sizeof start);
    for (int first = 8; first <= 128 && !err->status; first *= 4) {
        double sum = 0;
        memcpy(x, start, sizeof start);
        for (m->soft = first; m->soft >= 2 && !err->status; m->soft /= 4) {
            search_planes(m, x);
            ceres_least_squares(&problem, x, err);
        }
        m->soft = 2;
        soft_distances(m, x, off);
        for (int i = 0; i < m->mark_count; i++) sum += off[i] * off[i];
        if (sum < least) least = sum, memcpy(best, x, sizeof best);
    }
    memcpy(x, best, sizeof best);
    return err->status;
}

static enum status score(struct marked *m, const char *folder, struct err *err)
{
    double x[4 * MAX_FACES + 3] = {0}, depth[MAX_MARKS] = {0};
    struct tally of[MAX_FACES] = {{0}}, all = {0};
    for (int i = 0; i < m->set.view_count; i++)
        m->origin = vec3_add(m->origin, vec3_scale(m->set.views[i].center, 1.0 / m->set.view_count));
    if (read_marks(depth, m, folder, err)) return err->status;
    start_planes(m, depth, x);
    fit_planes(m, x, err);
    for (int i = 0; i < m->region_count && !err->status; i++) {
        struct layered_depth d = {0};
        const struct region *r = &m->regions[i];
        if (!read_depth(&d, m, folder, r->corner[0].view, err)) add_region(&of[r->face], &all, m, r, x, &d, err);
        layered_depth_release(&d);
    }
    if (!err->status) print_scores(m, x, of, &all);
    return err->status;
}

int main(int argc, char **argv)
{
    static struct marked m;
    const char *views = NULL, *depth = NULL, *marks = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Compares depth with planes that a person marked in the views."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "folder of the views' layers"),
        CLI_STR("marks", &marks, CLI_REQUIRED, "file of marks"),
        CLI_END,
    };
    struct err err = ERR_INIT;
    struct provenance prov = {0};
    struct textfile t = {0};
    if (cli_parse(argc, argv, "marked_planes", opts, &prov, &err) == CLI_RUN &&
        !camera_set_read(&m.set, views, NULL, &err) && !textfile_open(&t, marks, &err)) {
        while (!err.status && textfile_next(&t))
            if (!read_record(&m, &t, &err)) textfile_end(&t, &err);
        if (!err.status) score(&m, depth, &err);
    }
    textfile_release(&t);
    provenance_release(&prov);
    camera_set_release(&m.set);
    err_report(&err);
    return err_exit_code(&err);
}
