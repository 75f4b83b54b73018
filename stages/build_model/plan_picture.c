/* plan_picture.c - pictures of a model: plan, view from above, edges on photographs.
 *
 * Whether an edge is visible in a photograph is decided by a cube map of depth about the camera: six square perspective
 * pictures of the model's triangles. So any lens can ask in any direction. */
#include "stages/build_model/plan_picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/math/numbers.h"
#include "stages/build_model/raster.h"

enum { VIEW_WIDTH = 1400, VIEW_HEIGHT = 1000, SUPERSAMPLING = 2, CUBE = 1024 };
#define FRUSTUM 0.35 /* length of a frustum's edges, for a room 2.5 units high */

static bool starts_with(const char *text, const char *with) { return !strncmp(text, with, strlen(with)); }

/* ------------------------------------------------------------------------------------------------------ the plan */

struct sheet {
    FILE *to;
    double left, top, scale; /* x px = scale (x - left), y px = scale (top - y) */
};

static double sheet_x(const struct sheet *s, double x) { return s->scale * (x - s->left); }
static double sheet_y(const struct sheet *s, double y) { return s->scale * (s->top - y); }

static void put_point(const struct sheet *s, const double p[2], const char *before)
{
    fprintf(s->to, "%s%.2f %.2f", before, sheet_x(s, p[0]), sheet_y(s, p[1]));
}

static void put_polygon(const struct sheet *s, double (*p)[2], int count, const char *class)
{
    fprintf(s->to, "<path class=\"%s\" d=\"", class);
    for (int i = 0; i < count; i++) put_point(s, p[i], i ? "L" : "M");
    fputs("Z\"/>\n", s->to);
}

static void put_name(const struct sheet *s, double x, double y, const char *class, double turn, const char *name)
{
    fprintf(s->to, "<text class=\"%s\" transform=\"translate(%.2f %.2f) rotate(%.2f)\">%s</text>\n", class,
            sheet_x(s, x), sheet_y(s, y), turn, name);
}

/* Degrees of a text along d, turned to be upright. */
static double readable(const double d[2])
{
    double turn = -atan2(d[1], d[0]) / DEGREE;
    if (turn >= 90) turn -= 180;
    if (turn < -90) turn += 180;
    return turn;
}

static void wall_corners(const struct plan *p, int wall, double corners[4][2])
{
    const struct plan_wall *w = &p->walls[wall];
    for (int end = 0; end < 2; end++) {
        int face_wall, face_side;
        const struct plan_line cap = wall_cap(p, wall, end, &face_wall, &face_side);
        for (int side = 0; side < 2; side++)
            line_cross(wall_face(w, side), cap, corners[end == END_START ? side : 3 - side]);
    }
}

static void put_opening(const struct sheet *s, const struct plan *p, const struct plan_opening *o)
{
    const struct plan_wall *w = &p->walls[o->wall];
    double c[4][2], line[2][2], off[2];
    for (int k = 0; k < 4; k++) wall_point(w, o->s[k == 1 || k == 2], k >= 2 ? w->thickness : 0, c[k]);
    put_polygon(s, c, 4, o->z[0] > w->foot + 0.01 ? "window" : "hole");
    if (opening_filling(p, o, off)) {
        for (int k = 0; k < 2; k++) wall_point(w, o->s[k], 0.5 * (off[0] + off[1]), line[k]);
        put_polygon(s, line, 2, o->fill == FILL_GLASS ? "glass" : "leaf");
    }
    double at[2];
    wall_point(w, 0.5 * (o->s[0] + o->s[1]), w->thickness + 0.14, at);
    put_name(s, at[0], at[1], "small", readable(w->d), o->name);
}

static void put_slot(const struct sheet *s, const struct plan_slot *o)
{
    double c[4][2] = {
        {o->low[0], o->low[1]}, {o->high[0], o->low[1]}, {o->high[0], o->high[1]}, {o->low[0], o->high[1]}};
    put_polygon(s, c, 4, "slot");
    put_name(s, 0.5 * (o->low[0] + o->high[0]), 0.5 * (o->low[1] + o->high[1]), "small", 0, o->name);
}

static void put_cameras(const struct sheet *s, const struct placer *placer, double size)
{
    for (int i = 0; placer && i < placer->photo_count; i++) {
        const struct photo_camera *c = &placer->photos[i].camera;
        const struct mat3 turn = mat3_transpose(c->cam_from_world);
        double p[3][2] = {{c->center.x, c->center.y}, {0, 0}, {0, 0}};
        for (int k = 0; k < 2; k++) {
            struct vec3 ray;
            const double u = k ? c->lens.width : 0;
            if (!camera_unproject(&c->lens, u, 0.5 * c->lens.height, &ray) || ray.z < 0.5)
                ray = vec3_make(k ? sin(60 * DEGREE) : -sin(60 * DEGREE), 0, cos(60 * DEGREE));
            const struct vec3 r = mat3_apply(turn, ray);
            p[k + 1][0] = c->center.x + size * r.x;
            p[k + 1][1] = c->center.y + size * r.y;
        }
        put_polygon(s, p, 3, "camera");
        put_name(s, 0.5 * (p[1][0] + p[2][0]), 0.5 * (p[1][1] + p[2][1]), "photo", 0, placer->photos[i].id);
    }
}

static void put_rooms(const struct sheet *s, const struct plan *p, bool metric)
{
    for (int i = 0; i < p->room_count; i++) {
        const struct plan_room *r = &p->rooms[i];
        double area = 0, middle[2] = {0, 0};
        if (r->removed) continue;
        fputs("<path class=\"room\" d=\"", s->to);
        for (int e = 0; e < r->edge_count; e++) {
            const double *a = r->edges[e].corner, *b = r->edges[(e + 1) % r->edge_count].corner;
            const double part = a[0] * b[1] - a[1] * b[0];
            put_point(s, a, e ? "L" : "M");
            area += part / 2;
            for (int k = 0; k < 2; k++) middle[k] += (a[k] + b[k]) * part / 6;
        }
        fputs("Z\"/>\n", s->to);
        for (int k = 0; k < 2; k++) middle[k] /= area;
        put_name(s, middle[0], middle[1], "name", 0, r->name);
        fprintf(s->to, "<text class=\"small\" x=\"%.2f\" y=\"%.2f\">%.2f %s, %.3g %s high</text>\n",
                sheet_x(s, middle[0]), sheet_y(s, middle[1]) + 16, area, metric ? "m²" : "square units",
                top_at(&r->lower, middle) - r->floor, metric ? "m" : "units");
    }
}

static void put_scale_bar(const struct sheet *s, double x, double y, double width, bool metric)
{
    double length = pow(10, floor(log10(width / 4)));
    if (length * 5 <= width / 4)
        length *= 5;
    else if (length * 2 <= width / 4)
        length *= 2;
    for (int k = 0; k < 2; k++) {
        double bar[4][2] = {{x + k * length / 2, y},
                            {x + (k + 1) * length / 2, y},
                            {x + (k + 1) * length / 2, y - 0.008 * width},
                            {x + k * length / 2, y - 0.008 * width}};
        put_polygon(s, bar, 4, k ? "bar white" : "bar");
    }
    fprintf(s->to, "<text class=\"scale\" x=\"%.2f\" y=\"%.2f\">%.4g %s</text>\n", sheet_x(s, x + length) + 6,
            sheet_y(s, y) + 10, length, metric ? "m" : "units");
}

static void find_bounds(const struct plan *plan, const struct placer *placer, double low[2], double high[2])
{
    low[0] = low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    for (int i = 0; i < plan->wall_count; i++) {
        double c[4][2];
        if (plan->walls[i].removed) continue;
        wall_corners(plan, i, c);
        for (int k = 0; k < 8; k++) {
            low[k % 2] = fmin(low[k % 2], c[k / 2][k % 2]);
            high[k % 2] = fmax(high[k % 2], c[k / 2][k % 2]);
        }
    }
    for (int i = 0; i < plan->box_count; i++)
        for (int k = 0; k < 2 && !plan->boxes[i].removed; k++) {
            low[k] = fmin(low[k], plan->boxes[i].low[k]);
            high[k] = fmax(high[k], plan->boxes[i].high[k]);
        }
    for (int i = 0; placer && i < placer->photo_count; i++) {
        const double at[2] = {placer->photos[i].camera.center.x, placer->photos[i].camera.center.y};
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    for (int k = 0; k < 2; k++)
        if (!(high[k] > low[k])) low[k] = 0, high[k] = 1;
}

static void put_plan(const struct sheet *s, const struct plan *plan, const struct placer *placer, bool metric,
                     double unit)
{
    /* floors continue under walls; under a removed wall the floor is visible */
    for (int i = 0; i < plan->wall_count; i++) {
        double c[4][2];
        if (!plan->walls[i].removed) continue;
        wall_corners(plan, i, c);
        put_polygon(s, c, 4, "room");
    }
    put_rooms(s, plan, metric);
    for (int i = 0; i < plan->box_count; i++) {
        const struct plan_box *b = &plan->boxes[i];
        const double turn = b->turn * DEGREE,
                     middle[2] = {0.5 * (b->low[0] + b->high[0]), 0.5 * (b->low[1] + b->high[1])};
        double c[4][2];
        if (b->removed) continue;
        for (int k = 0; k < 4; k++) {
            const double x = (k == 1 || k == 2 ? b->high[0] : b->low[0]) - middle[0];
            const double y = (k >= 2 ? b->high[1] : b->low[1]) - middle[1];
            c[k][0] = middle[0] + cos(turn) * x - sin(turn) * y;
            c[k][1] = middle[1] + sin(turn) * x + cos(turn) * y;
        }
        put_polygon(s, c, 4, "box");
        put_name(s, middle[0], middle[1], "small", 0, b->name);
    }
    for (int i = 0; i < plan->wall_count; i++) {
        double c[4][2];
        if (plan->walls[i].removed) continue;
        wall_corners(plan, i, c);
        put_polygon(s, c, 4, "wall");
    }
    for (int i = 0; i < plan->opening_count; i++)
        if (opening_is_there(plan, &plan->openings[i])) put_opening(s, plan, &plan->openings[i]);
    for (int i = 0; i < plan->slot_count; i++)
        if (slot_is_there(plan, &plan->slots[i])) put_slot(s, &plan->slots[i]);
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        double span[2], at[2];
        if (w->removed) continue;
        wall_span(plan, i, span);
        wall_point(w, span[0] + 0.12 * (span[1] - span[0]), -0.08 * unit, at);
        put_name(s, at[0], at[1], "name", readable(w->d), w->name);
    }
    put_cameras(s, placer, FRUSTUM * unit);
}

enum status plan_picture_write(const struct plan *plan, const struct placer *placer, bool metric, const char *path,
                               struct err *err)
{
    struct outfile f = {0};
    double low[2], high[2];
    if (outfile_open(&f, path, err)) return err->status;
    const locale_t before = uselocale(scan_c_locale());
    find_bounds(plan, placer, low, high);
    const double wide = fmax(high[0] - low[0], high[1] - low[1]), margin = 0.06 * wide;
    const double scale = 1000 / (wide + 2 * margin);
    const double unit = (plan->ceiling > 0 ? plan->ceiling : 0.3 * wide) / 2.5;
    const struct sheet s = {f.fp, low[0] - margin, high[1] + margin, scale};
    const double width = scale * (high[0] - low[0] + 2 * margin), height = scale * (high[1] - low[1] + 3 * margin);
    fprintf(f.fp,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"Plan of the "
            "model\">\n<style>text{font:11px sans-serif;text-anchor:middle;dominant-baseline:middle;fill:#222}"
            ".name{font-size:14px;font-weight:600}.small{font-size:11px}.photo{font-size:8px;fill:#a33}"
            ".scale{text-anchor:start;font-size:12px}.wall{fill:#6b7078;stroke:#2c2f33;stroke-width:.8}"
            ".room{fill:#f3efe6}.hole{fill:#f3efe6;stroke:#2c2f33;stroke-width:.8}"
            ".slot{fill:none;stroke:#1f78c8;stroke-width:.8;stroke-dasharray:4 "
            "3}.window{fill:#d7dce2;stroke:#2c2f33;stroke-width:.8}.glass{stroke:#1f78c8;stroke-width:3;fill:none}"
            ".leaf{stroke:#8a5a2b;stroke-width:3;fill:none}.box{fill:#cdb48a;stroke:#6b5530;stroke-width:.8}"
            ".camera{fill:#d33;fill-opacity:.12;stroke:#d33;stroke-width:.7}.bar{fill:#222;stroke:#222}"
            ".white{fill:#fff}</style>\n<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            width, height);
    put_plan(&s, plan, placer, metric, unit);
    put_scale_bar(&s, low[0], low[1] - 1.2 * margin, high[0] - low[0], metric);
    fputs("</svg>\n", f.fp);
    uselocale(before);
    const enum status st = outfile_commit(&f, err);
    outfile_discard(&f);
    return st;
}

/* ---------------------------------------------------------------------------------------------- the view from above */

struct aerial {
    struct vec3 right, down, back; /* of the picture, and towards the viewer */
    double scale, x, y;
};

static struct vec3 aerial_point(const struct aerial *a, struct vec3 p)
{
    return vec3_make(a->scale * vec3_dot(a->right, p) + a->x, a->scale * vec3_dot(a->down, p) + a->y,
                     vec3_dot(a->back, p));
}

static void aerial_line(struct raster *r, const struct aerial *a, struct vec3 p, struct vec3 q, bool through,
                        double radius, const unsigned char color[3])
{
    const struct vec3 x = aerial_point(a, p), y = aerial_point(a, q);
    const int steps = (int)fmin(hypot(y.x - x.x, y.y - x.y) * 1.5, 1e5) + 1;
    for (int i = 0; i <= steps; i++) {
        const double t = (double)i / steps, u = x.x + t * (y.x - x.x), v = x.y + t * (y.y - x.y);
        if (!(u >= 0 && v >= 0 && u < r->width && v < r->height)) continue;
        const double near = x.z + t * (y.z - x.z) + 6 / a->scale;
        if (!through && near < (double)r->near[(size_t)v * (size_t)r->width + (size_t)u]) continue;
        raster_dot(r->rgb, r->width, r->height, u, v, radius, color, 0.8);
    }
}

/* Draws a triangle's part below a height. */
static void aerial_triangle(struct raster *r, const struct aerial *a, const struct vec3 p[3], double top,
                            const unsigned char color[3])
{
    struct vec3 kept[4];
    int n = 0;
    for (int k = 0; k < 3; k++) {
        const struct vec3 u = p[k], v = p[(k + 1) % 3];
        if (u.z <= top) kept[n++] = u;
        if ((u.z <= top) != (v.z <= top))
            kept[n++] = vec3_add(u, vec3_scale(vec3_sub(v, u), (top - u.z) / (v.z - u.z)));
    }
    for (int k = 1; k + 1 < n; k++)
        raster_triangle(r, aerial_point(a, kept[0]), aerial_point(a, kept[k]), aerial_point(a, kept[k + 1]), color);
}

/* Draws the cut tops of the walls dark. */
static void draw_cuts(struct raster *r, const struct aerial *a, const struct plan *plan, double top)
{
    static const unsigned char dark[3] = {92, 96, 104}, ink[3] = {40, 42, 48};
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        double c[4][2], span[2];
        if (w->removed) continue;
        wall_corners(plan, i, c);
        wall_span(plan, i, span);
        const double z = fmin(top, plan_wall_top(plan, i, span[0], span[1]));
        struct vec3 p[4];
        for (int k = 0; k < 4; k++) p[k] = vec3_make(c[k][0], c[k][1], z);
        for (int k = 1; k < 3; k++) aerial_triangle(r, a, (const struct vec3[3]){p[0], p[k], p[k + 1]}, HUGE_VAL, dark);
        for (int k = 1; k < 4; k += 2) aerial_line(r, a, p[k], p[(k + 1) % 4], false, 0.7, k == 1 ? dark : ink);
    }
}

static bool is_ceiling(const struct solid_mesh *mesh, int face)
{
    return starts_with(solid_face_name(mesh, face), "ceiling/");
}

/* Scales and centres the view on the mesh's vertices. */
static void fit_view(struct aerial *a, const struct solid_mesh *mesh, const struct raster *r)
{
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    a->scale = 1;
    a->x = a->y = 0;
    for (int i = 0; i < mesh->vertex_count; i++) {
        const struct vec3 p = aerial_point(a, mesh->vertices[i].p);
        low[0] = fmin(low[0], p.x), high[0] = fmax(high[0], p.x);
        low[1] = fmin(low[1], p.y), high[1] = fmax(high[1], p.y);
    }
    if (!(high[0] > low[0])) return;
    a->scale = 0.92 * fmin(r->width / (high[0] - low[0]), r->height / (high[1] - low[1]));
    a->x = 0.5 * (r->width - a->scale * (low[0] + high[0]));
    a->y = 0.5 * (r->height - a->scale * (low[1] + high[1]));
}

static void face_color(const struct solid_mesh *mesh, int face, unsigned char color[3])
{
    static const struct {
        const char *with;
        double rgb[3];
    } tints[] = {{"floor/", {0.80, 0.72, 0.58}}, {"box/", {0.72, 0.60, 0.42}},    {"door/", {0.75, 0.55, 0.40}},
                 {"glass/", {0.45, 0.68, 0.90}}, {"window/", {0.70, 0.78, 0.86}}, {"", {0.86, 0.86, 0.84}}};
    const struct vec3 n = mesh->faces[face].normal;
    const double light = 0.62 + 0.26 * n.z + 0.14 * (0.8 * n.x - 0.6 * n.y);
    size_t i = 0;
    while (!starts_with(solid_face_name(mesh, face), tints[i].with)) i++;
    for (int c = 0; c < 3; c++) color[c] = (unsigned char)(255 * fmin(1, fmax(0.05, light * 1.1 * tints[i].rgb[c])));
}

static void draw_frusta(struct raster *r, const struct aerial *a, const struct placer *placer, double size)
{
    static const unsigned char red[3] = {205, 40, 40};
    for (int i = 0; placer && i < placer->photo_count; i++) {
        const struct photo_camera *c = &placer->photos[i].camera;
        const struct mat3 turn = mat3_transpose(c->cam_from_world);
        struct vec3 corner[4];
        for (int k = 0; k < 4; k++) {
            struct vec3 ray;
            const double u = k == 1 || k == 2 ? c->lens.width : 0, v = k >= 2 ? c->lens.height : 0;
            if (!camera_unproject(&c->lens, u, v, &ray) || ray.z < 0.4)
                ray = vec3_normalize(vec3_make(k == 1 || k == 2 ? 1.2 : -1.2, k >= 2 ? 0.8 : -0.8, 1));
            corner[k] = vec3_add(c->center, vec3_scale(mat3_apply(turn, ray), size));
        }
        for (int k = 0; k < 4; k++) {
            aerial_line(r, a, c->center, corner[k], true, 0.9, red);
            aerial_line(r, a, corner[k], corner[(k + 1) % 4], true, 0.9, red);
        }
    }
}

/* All faces that look towards the viewer, except ceilings. */
static void draw_faces(struct raster *r, const struct aerial *a, const struct solid_mesh *mesh,
                       const struct solid_triangles *tris, double top)
{
    for (int i = 0; i < tris->count; i++) {
        const struct solid_triangle *t = &tris->triangles[i];
        unsigned char color[3];
        if (is_ceiling(mesh, t->face) || vec3_dot(mesh->faces[t->face].normal, a->back) <= 0) continue;
        face_color(mesh, t->face, color);
        aerial_triangle(
            r, a,
            (const struct vec3[3]){mesh->vertices[t->v[0]].p, mesh->vertices[t->v[1]].p, mesh->vertices[t->v[2]].p},
            top, color);
    }
}

/* The visible parts below the top of all edges, except those between ceilings. */
static void draw_mesh_edges(struct raster *r, const struct aerial *a, const struct solid_mesh *mesh, double top)
{
    static const unsigned char ink[3] = {40, 42, 48};
    for (int h = 0; h < mesh->half_edge_count; h++) {
        const struct solid_half_edge *e = &mesh->half_edges[h];
        const int f = mesh->loops[e->loop].face, g = mesh->loops[mesh->half_edges[e->twin].loop].face;
        if (e->twin < h || (is_ceiling(mesh, f) && is_ceiling(mesh, g))) continue;
        struct vec3 p = mesh->vertices[e->origin].p, q = mesh->vertices[mesh->half_edges[e->next].origin].p;
        if (p.z > q.z) {
            const struct vec3 swap = p;
            p = q;
            q = swap;
        }
        if (p.z >= top) continue;
        if (q.z > top) q = vec3_add(p, vec3_scale(vec3_sub(q, p), (top - p.z) / (q.z - p.z)));
        aerial_line(r, a, p, q, false, 0.7, ink);
    }
}

static enum status write_downsampled(const struct raster *r, const char *path, struct err *err)
{
    const int w = r->width / SUPERSAMPLING, h = r->height / SUPERSAMPLING;
    unsigned char *small = malloc(3 * (size_t)w * (size_t)h);
    if (!small) return err_nomem(err, "a picture", 3 * (size_t)w * (size_t)h);
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0;
                for (int k = 0; k < SUPERSAMPLING * SUPERSAMPLING; k++)
                    sum += r->rgb[3 * ((size_t)(SUPERSAMPLING * y + k / SUPERSAMPLING) * (size_t)r->width +
                                       (size_t)(SUPERSAMPLING * x + k % SUPERSAMPLING)) +
                                  (size_t)c];
                small[3 * ((size_t)y * (size_t)w + (size_t)x) + (size_t)c] =
                    (unsigned char)(sum / (SUPERSAMPLING * SUPERSAMPLING));
            }
    const enum status st = png_write(path, small, w, h, 3, err);
    free(small);
    return st;
}

enum status view_picture_write(const struct solid_mesh *mesh, const struct plan *plan, const struct placer *placer,
                               const char *path, struct err *err)
{
    static const unsigned char paper[3] = {248, 248, 246};
    struct solid_triangles tris = {0};
    struct raster r = {0};
    double high = 0;
    for (int i = 0; i < plan->wall_count; i++) high = fmax(high, plan->walls[i].removed ? 0 : plan->walls[i].top);
    for (int i = 0; i < plan->room_count; i++)
        for (int e = 0; !plan->rooms[i].removed && e < plan->rooms[i].edge_count; e++)
            high = fmax(high, top_at(&plan->rooms[i].lower, plan->rooms[i].edges[e].corner));
    /* from the south-west, 55 degrees above the horizon */
    const struct vec3 back =
        vec3_make(-0.30 * cos(55 * DEGREE) / hypot(0.30, 1), -cos(55 * DEGREE) / hypot(0.30, 1), sin(55 * DEGREE));
    struct aerial a = {.back = vec3_normalize(back)};
    a.right = vec3_normalize(vec3_cross(vec3_make(0, 0, 1), a.back));
    a.down = vec3_cross(a.right, a.back);
    a.down = vec3_scale(a.down, a.down.z < 0 ? 1 : -1);
    if (raster_init(&r, SUPERSAMPLING * VIEW_WIDTH, SUPERSAMPLING * VIEW_HEIGHT, paper, err)) return err->status;
    enum status st = solid_mesh_triangulate(&tris, mesh, err);
    if (!st) fit_view(&a, mesh, &r);
    if (!st) draw_faces(&r, &a, mesh, &tris, high);
    if (!st) draw_mesh_edges(&r, &a, mesh, high);
    if (!st) draw_cuts(&r, &a, plan, high);
    if (!st) draw_frusta(&r, &a, placer, FRUSTUM * (high > 0 ? high / 2.5 : 1));
    if (!st) st = write_downsampled(&r, path, err);
    solid_triangles_release(&tris);
    raster_release(&r);
    return st;
}

/* ------------------------------------------------------------------------------------------------- edges on a photo */

struct cube {
    struct raster side[6];
    struct vec3 center;
};

/* Coordinates in the frame of one of the cube's six cameras: z the largest. */
static struct vec3 cube_turn(int side, struct vec3 p)
{
    switch (side) {
    case 0:
        return vec3_make(p.y, p.z, p.x);
    case 1:
        return vec3_make(p.y, p.z, -p.x);
    case 2:
        return vec3_make(p.x, p.z, p.y);
    case 3:
        return vec3_make(p.x, p.z, -p.y);
    case 4:
        return vec3_make(p.x, p.y, p.z);
    default:
        return vec3_make(p.x, p.y, -p.z);
    }
}

static struct vec3 cube_pixel(struct vec3 p)
{
    return vec3_make(0.5 * CUBE * (1 + p.x / p.z), 0.5 * CUBE * (1 + p.y / p.z), 1 / p.z);
}

static void cube_triangle(struct cube *c, const struct vec3 corners[3])
{
    const double min_z = 1e-3;
    for (int side = 0; side < 6; side++) {
        struct vec3 p[3], clipped[4];
        int n = 0;
        for (int k = 0; k < 3; k++) p[k] = cube_turn(side, vec3_sub(corners[k], c->center));
        for (int k = 0; k < 3; k++) { /* clip at min_z */
            const struct vec3 a = p[k], b = p[(k + 1) % 3];
            if (a.z > min_z) clipped[n++] = a;
            if ((a.z > min_z) != (b.z > min_z))
                clipped[n++] = vec3_add(a, vec3_scale(vec3_sub(b, a), (min_z - a.z) / (b.z - a.z)));
        }
        for (int k = 1; k + 1 < n; k++)
            raster_triangle(&c->side[side], cube_pixel(clipped[0]), cube_pixel(clipped[k]), cube_pixel(clipped[k + 1]),
                            NULL);
    }
}

static bool cube_sees(const struct cube *c, struct vec3 point)
{
    const struct vec3 to = vec3_sub(point, c->center);
    const double x = fabs(to.x), y = fabs(to.y), z = fabs(to.z);
    const int side = x >= y && x >= z ? (to.x < 0) : y >= z ? 2 + (to.y < 0) : 4 + (to.z < 0);
    const struct vec3 p = cube_turn(side, to);
    if (!(p.z > 1e-3)) return true;
    const struct vec3 at = cube_pixel(p);
    /* visible if nothing is clearly in front of one of the 3 x 3 pixels: an edge lies on the border of its faces */
    for (int k = 0; k < 9; k++) {
        const int u = (int)at.x + k % 3 - 1, v = (int)at.y + k / 3 - 1;
        if (u < 0 || v < 0 || u >= CUBE || v >= CUBE) continue;
        if ((double)c->side[side].near[(size_t)v * CUBE + (size_t)u] <= at.z * 1.01) return true;
    }
    return false;
}

static void draw_edge(unsigned char *rgb, int width, int height, double scale, const struct photo_camera *camera,
                      const struct cube *cube, struct vec3 a, struct vec3 b, bool glass)
{
    static const unsigned char seen[3] = {255, 70, 20}, blue[3] = {60, 150, 255}, hidden[3] = {250, 240, 90};
    enum { STEPS = 4096 };
    double last[2] = {-1e9, -1e9};
    for (int i = 0; i <= STEPS; i++) {
        const struct vec3 p = vec3_add(a, vec3_scale(vec3_sub(b, a), (double)i / STEPS));
        double u, v;
        if (!photo_camera_project(camera, p, &u, &v)) continue;
        u *= scale, v *= scale;
        if (hypot(u - last[0], v - last[1]) < 0.7 || u < 0 || v < 0 || u > width || v > height) continue;
        last[0] = u, last[1] = v;
        const bool sees = cube_sees(cube, p);
        raster_dot(rgb, width, height, u, v, sees ? 0.9 : 0.3, glass ? blue : sees ? seen : hidden, sees ? 0.75 : 0.22);
    }
}

/* The photo, downsampled by an integer factor. */
static enum status shrink(unsigned char **rgb, int *width, int *height, double *scale, const struct photo *photo,
                          int side, struct err *err)
{
    const int longest = photo->info.width > photo->info.height ? photo->info.width : photo->info.height;
    const int k = (longest + side - 1) / side, shift = photo->info.bits == 16 ? 8 : 0;
    *width = photo->info.width / k;
    *height = photo->info.height / k;
    *scale = 1.0 / k;
    if (*width < 1 || *height < 1) *width = *height = 1;
    *rgb = malloc(3 * (size_t)*width * (size_t)*height);
    if (!*rgb) return err_nomem(err, "a picture", 3 * (size_t)*width * (size_t)*height);
    for (int y = 0; y < *height; y++)
        for (int x = 0; x < *width; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0, n = 0;
                for (int j = y * k; j < y * k + k && j < photo->info.height; j++)
                    for (int i = x * k; i < x * k + k && i < photo->info.width; i++, n++)
                        sum += photo->samples[3 * ((size_t)j * (size_t)photo->info.width + (size_t)i) + (size_t)c] >>
                               shift;
                (*rgb)[3 * ((size_t)y * (size_t)*width + (size_t)x) + (size_t)c] = (unsigned char)(sum / (n ? n : 1));
            }
    return ST_OK;
}

enum status overlay_write(const struct solid_mesh *mesh, const struct photo_camera *camera, const struct photo *photo,
                          int side, const char *path, struct err *err)
{
    struct solid_triangles tris = {0};
    struct cube *cube = calloc(1, sizeof *cube);
    unsigned char *rgb = NULL;
    int width = 0, height = 0;
    double scale = 1;
    enum status st = cube ? ST_OK : err_nomem(err, "a cube of pictures", sizeof *cube);
    if (!st) cube->center = camera->center;
    for (int i = 0; i < 6 && !st; i++) st = raster_init(&cube->side[i], CUBE, CUBE, NULL, err);
    if (!st) st = solid_mesh_triangulate(&tris, mesh, err);
    if (!st) st = shrink(&rgb, &width, &height, &scale, photo, side, err);
    for (int i = 0; !st && i < tris.count; i++) {
        const struct solid_triangle *t = &tris.triangles[i];
        if (starts_with(mesh->bodies[mesh->faces[t->face].body].name, "glass/")) continue;
        cube_triangle(cube, (const struct vec3[3]){mesh->vertices[t->v[0]].p, mesh->vertices[t->v[1]].p,
                                                   mesh->vertices[t->v[2]].p});
    }
    for (int h = 0; !st && h < mesh->half_edge_count; h++) {
        const struct solid_half_edge *e = &mesh->half_edges[h];
        const int f = mesh->loops[e->loop].face;
        if (e->twin < h) continue;
        draw_edge(rgb, width, height, scale, camera, cube, mesh->vertices[e->origin].p,
                  mesh->vertices[mesh->half_edges[e->next].origin].p,
                  starts_with(mesh->bodies[mesh->faces[f].body].name, "glass/"));
    }
    if (!st) st = jpeg_write(path, rgb, width, height, 88, err);
    for (int i = 0; cube && i < 6; i++) raster_release(&cube->side[i]);
    free(cube);
    free(rgb);
    solid_triangles_release(&tris);
    return st;
}
