/* plan_picture.c - the plan as SVG.
 *
 * Drawn from the plan, not from the solids. Order is from bottom to top: the floor under removed walls, rooms,
 * boxes, walls, openings with their leaves or panes, slots, names of walls, lamps that an edit hangs, photographs. x
 * and y of the model become right and up; SVG's y points down, so sheet_y() turns it over.
 *
 * A room's label is at the centroid of its outline, with its area and its height there: with the cross products c_i
 * = a_i x a_(i+1) of consecutive corners, area = sum c_i / 2 and centroid = sum (a_i + a_(i+1)) c_i / (6 area).
 *
 * Texts along walls are turned to be read from below or from the right. A photograph is a triangle: the left and
 * right edge of its field of view in its middle row, at most 60 degrees to either side, projected onto the floor. */
#include "stages/build_model/picture/plan_picture.h"

#include <math.h>
#include <stdio.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/math/numbers.h"
#include "common/model/plan_sheet.h"
#include "stages/build_model/layout/layout.h"

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

static void put_opening(const struct sheet *s, const struct plan *p, const struct plan_opening *o)
{
    const struct plan_wall *w = &p->walls[o->wall];
    double c[4][2], line[2][2], off[2];
    for (int k = 0; k < 4; k++) plan_wall_point(w, o->s[k == 1 || k == 2], k >= 2 ? w->thickness : 0, c[k]);
    put_polygon(s, c, 4, o->z[0] > w->foot + 0.01 ? "window" : "hole");
    if (layout_opening_filling(p, o, off)) {
        for (int k = 0; k < 2; k++) plan_wall_point(w, o->s[k], 0.5 * (off[0] + off[1]), line[k]);
        put_polygon(s, line, 2, o->fill == FILL_GLASS ? "glass" : "leaf");
    }
    double at[2];
    plan_wall_point(w, 0.5 * (o->s[0] + o->s[1]), w->thickness + 0.14, at);
    put_name(s, at[0], at[1], "small", readable(w->d), o->name);
}

static void put_slot(const struct sheet *s, const struct plan_slot *o)
{
    double c[4][2] = {
        {o->low[0], o->low[1]}, {o->high[0], o->low[1]}, {o->high[0], o->high[1]}, {o->low[0], o->high[1]}};
    put_polygon(s, c, 4, "slot");
    put_name(s, 0.5 * (o->low[0] + o->high[0]), 0.5 * (o->low[1] + o->high[1]), "small", 0, o->name);
}

static void put_lamp(const struct sheet *s, const struct plan_lamp *l)
{
    plan_sheet_lamp_sign(s->to, sheet_x(s, l->placed.at[0]), sheet_y(s, l->placed.at[1]));
    put_name(s, l->placed.at[0], l->placed.at[1] - 17 / s->scale, "small", 0, l->name);
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
                plan_top_at(&r->lower, middle) - r->floor, metric ? "m" : "units");
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
        plan_wall_corners(plan, i, c);
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
        plan_wall_corners(plan, i, c);
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
        plan_wall_corners(plan, i, c);
        put_polygon(s, c, 4, "wall");
    }
    for (int i = 0; i < plan->opening_count; i++)
        if (plan_opening_is_there(plan, &plan->openings[i])) put_opening(s, plan, &plan->openings[i]);
    for (int i = 0; i < plan->slot_count; i++)
        if (plan_slot_is_there(plan, &plan->slots[i])) put_slot(s, &plan->slots[i]);
    for (int i = 0; i < plan->wall_count; i++) {
        const struct plan_wall *w = &plan->walls[i];
        double span[2], at[2];
        if (w->removed) continue;
        plan_wall_span(plan, i, span);
        plan_wall_point(w, span[0] + 0.12 * (span[1] - span[0]), -0.08 * unit, at);
        put_name(s, at[0], at[1], "name", readable(w->d), w->name);
    }
    for (int i = 0; i < plan->lamp_count; i++) {
        const double *by = plan->lamps[i].scale, *c = plan->lamps[i].placed.colour;
        if (plan->lamps[i].file && by[0] * c[0] + by[1] * c[1] + by[2] * c[2] > 0) put_lamp(s, &plan->lamps[i]);
    }
    put_cameras(s, placer, PICTURE_FRUSTUM * unit);
}

static struct sheet sheet_of(const struct plan *plan, const struct placer *placer, double low[2], double high[2],
                             double *margin)
{
    find_bounds(plan, placer, low, high);
    const double wide = fmax(high[0] - low[0], high[1] - low[1]);
    *margin = 0.06 * wide;
    return (struct sheet){NULL, low[0] - *margin, high[1] + *margin, 1000 / (wide + 2 * *margin)};
}

void plan_picture_place(const struct plan *plan, const struct placer *placer, double place[3])
{
    double low[2], high[2], margin;
    const struct sheet s = sheet_of(plan, placer, low, high, &margin);
    place[0] = s.left;
    place[1] = s.top;
    place[2] = s.scale;
}

enum status plan_picture_write(const struct plan *plan, const struct placer *placer, bool metric, const char *path,
                               struct err *err)
{
    struct outfile f = {0};
    double low[2], high[2], margin;
    if (outfile_open(&f, path, err)) return err->status;
    const locale_t before = uselocale(scan_c_locale());
    struct sheet s = sheet_of(plan, placer, low, high, &margin);
    const double wide = fmax(high[0] - low[0], high[1] - low[1]), scale = s.scale;
    const double unit = (plan->ceiling > 0 ? plan->ceiling : 0.3 * wide) / 2.5;
    s.to = f.fp;
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
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
