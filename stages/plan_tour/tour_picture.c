/* tour_picture.c - see tour_picture.h. */
#include "stages/plan_tour/tour_picture.h"

#include <math.h>

#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/math/numbers.h"

static const double picture_side = 1000; /* px */

struct sheet {
    FILE *to;
    double low[2], high[2], scale; /* x px = scale (x - low[0]), y px = scale (high[1] - y) */
};

static double sheet_x(const struct sheet *s, double x) { return s->scale * (x - s->low[0]); }
static double sheet_y(const struct sheet *s, double y) { return s->scale * (s->high[1] - y); }

static void hold_point(struct sheet *s, double x, double y)
{
    s->low[0] = fmin(s->low[0], x), s->high[0] = fmax(s->high[0], x);
    s->low[1] = fmin(s->low[1], y), s->high[1] = fmax(s->high[1], y);
}

/* The part of the model's frame that is shown: rooms and viewpoints, with a margin. */
static void fit_sheet(struct sheet *s, const struct model_plan *plan, const struct tour_graph *g)
{
    s->low[0] = s->low[1] = INFINITY;
    s->high[0] = s->high[1] = -INFINITY;
    for (int r = 0; r < plan->room_count; r++)
        for (int k = 0; k < plan->rooms[r].corner_count; k++)
            hold_point(s, plan->rooms[r].corners[k].x, plan->rooms[r].corners[k].y);
    for (int i = 0; i < g->count; i++) hold_point(s, g->nodes[i].centre.x, g->nodes[i].centre.y);
    double wide = fmax(s->high[0] - s->low[0], s->high[1] - s->low[1]);
    if (!(wide > 0)) wide = 1;
    for (int k = 0; k < 2; k++) {
        s->low[k] -= 0.08 * wide;
        s->high[k] += 0.08 * wide;
    }
    s->scale = picture_side / (1.16 * wide);
}

static void put_polygon(const struct sheet *s, double (*p)[2], int count, const char *class)
{
    fprintf(s->to, "<path class=\"%s\" d=\"", class);
    for (int i = 0; i < count; i++)
        fprintf(s->to, "%s%.2f %.2f", i ? "L" : "M", sheet_x(s, p[i][0]), sheet_y(s, p[i][1]));
    fputs("Z\"/>\n", s->to);
}

static void put_text(const struct sheet *s, double x, double y, const char *class, const char *text)
{
    fprintf(s->to, "<text class=\"%s\" x=\"%.2f\" y=\"%.2f\">", class, sheet_x(s, x), sheet_y(s, y));
    for (; *text; text++) switch (*text) {
        case '<':
            fputs("&lt;", s->to);
            break;
        case '&':
            fputs("&amp;", s->to);
            break;
        default:
            fputc(*text, s->to);
        }
    fputs("</text>\n", s->to);
}

static void put_rooms(const struct sheet *s, const struct model_plan *plan)
{
    for (int r = 0; r < plan->room_count; r++) {
        const struct model_room *room = &plan->rooms[r];
        fputs("<path class=\"room\" d=\"", s->to);
        for (int k = 0; k < room->corner_count; k++)
            fprintf(s->to, "%s%.2f %.2f", k ? "L" : "M", sheet_x(s, room->corners[k].x),
                    sheet_y(s, room->corners[k].y));
        fputs("Z\"/>\n", s->to);
    }
}

static void put_room_names(const struct sheet *s, const struct model_plan *plan)
{
    for (int r = 0; r < plan->room_count; r++) {
        const struct model_room *room = &plan->rooms[r];
        double x = 0, low = INFINITY;
        for (int k = 0; k < room->corner_count; k++) {
            x += room->corners[k].x / room->corner_count;
            low = fmin(low, room->corners[k].y);
        }
        put_text(s, x, low + 16 / s->scale, "name", room->name);
    }
}

/* A part of a wall's body, along S. False: the wall is parallel to no axis. */
static bool wall_part(double p[4][2], const struct model_wall *w, double from, double to)
{
    const int across = fabs(w->normal[0]) > fabs(w->normal[1]) ? 0 : 1;
    if (fabs(w->normal[1 - across]) > 1e-9) return false;
    for (int k = 0; k < 4; k++) {
        p[k][across] = w->normal[across] * (w->offset - (k >= 2 ? w->thickness : 0));
        p[k][1 - across] = k == 1 || k == 2 ? to : from;
    }
    return true;
}

static void put_walls(const struct sheet *s, const struct model_plan *plan)
{
    double p[4][2];
    for (int i = 0; i < plan->wall_count; i++)
        if (wall_part(p, &plan->walls[i], plan->walls[i].span[0], plan->walls[i].span[1])) put_polygon(s, p, 4, "wall");
    for (int i = 0; i < plan->opening_count; i++) {
        const struct model_opening *o = &plan->openings[i];
        if (wall_part(p, &plan->walls[o->wall], o->s[0], o->s[1]))
            put_polygon(s, p, 4, o->kind == MODEL_WINDOW ? "window" : o->closed ? "door" : "room");
    }
}

static void put_boxes(const struct sheet *s, const struct model_plan *plan)
{
    for (int i = 0; i < plan->box_count; i++) {
        const struct model_box *b = &plan->boxes[i];
        const double x = 0.5 * (b->low.x + b->high.x), y = 0.5 * (b->low.y + b->high.y);
        const double c = cos(b->turn * DEGREE), t = sin(b->turn * DEGREE);
        double p[4][2];
        for (int k = 0; k < 4; k++) {
            const double u = (k == 1 || k == 2 ? b->high.x : b->low.x) - x, v = (k >= 2 ? b->high.y : b->low.y) - y;
            p[k][0] = x + c * u - t * v;
            p[k][1] = y + t * u + c * v;
        }
        put_polygon(s, p, 4, "box");
    }
}

static void put_way(const struct sheet *s, const struct camera_path *path, const struct model_axes *axes)
{
    const int every = (int)fmax(1, floor(path->fps / 2));
    const double length = 22 / s->scale;
    fputs("<polyline class=\"way\" points=\"", s->to);
    for (int f = 0; f < path->frame_count; f++) {
        const struct vec3 at = model_from_world_view(axes, &path->frames[f].camera).center;
        fprintf(s->to, "%s%.2f,%.2f", f ? " " : "", sheet_x(s, at.x), sheet_y(s, at.y));
    }
    fputs("\"/>\n", s->to);
    for (int f = 0; f < path->frame_count; f += every) {
        const struct view v = model_from_world_view(axes, &path->frames[f].camera);
        const double x = v.center.x + length * v.cam_from_world.m[2][0],
                     y = v.center.y + length * v.cam_from_world.m[2][1];
        fprintf(s->to, "<path class=\"look\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n", sheet_x(s, v.center.x),
                sheet_y(s, v.center.y), sheet_x(s, x), sheet_y(s, y));
    }
}

static void put_viewpoints(const struct sheet *s, const struct tour_graph *g, const struct tour_stop *stops,
                           int stop_count)
{
    for (int i = 0; i < g->count; i++)
        fprintf(s->to, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"3\"/>\n", g->nodes[i].usable ? "view" : "left",
                sheet_x(s, g->nodes[i].centre.x), sheet_y(s, g->nodes[i].centre.y));
    for (int i = 0; i < stop_count; i++) {
        const struct tour_node *n = &g->nodes[stops[i].node];
        fprintf(s->to, "<circle class=\"stop\" cx=\"%.2f\" cy=\"%.2f\" r=\"6\"/>\n", sheet_x(s, n->centre.x),
                sheet_y(s, n->centre.y));
        put_text(s, n->centre.x, n->centre.y + 14 / s->scale, "photo", n->photo);
    }
}

enum status tour_picture_write(const struct camera_path *path, const struct tour_graph *g,
                               const struct tour_stop *stops, int stop_count, const struct model_plan *plan,
                               const struct model_axes *axes, const char *file, struct err *err)
{
    struct outfile f = {0};
    if (outfile_open(&f, file, err)) return err->status;
    const locale_t before = uselocale(scan_c_locale());
    struct sheet s = {.to = f.fp};
    fit_sheet(&s, plan, g);
    fprintf(f.fp,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"The tour on "
            "the plan of the model\">\n<style>text{font:11px sans-serif;text-anchor:middle;fill:#222}"
            ".name{font-size:14px;font-weight:600}.photo{fill:#a33}.room{fill:#f3efe6}.wall{fill:#6b7078}"
            ".window{fill:#9cc4e4}.door{fill:#8a5a2b}.box{fill:#cdb48a;stroke:#6b5530;stroke-width:.8}"
            ".way{fill:none;stroke:#1f78c8;stroke-width:2.5}.look{stroke:#1f78c8;stroke-width:.8}"
            ".view{fill:#d33}.left{fill:none;stroke:#999}.stop{fill:none;stroke:#d33;stroke-width:2}</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            s.scale * (s.high[0] - s.low[0]), s.scale * (s.high[1] - s.low[1]));
    put_rooms(&s, plan);
    put_walls(&s, plan);
    put_boxes(&s, plan);
    put_room_names(&s, plan);
    put_way(&s, path, axes);
    put_viewpoints(&s, g, stops, stop_count);
    fputs("</svg>\n", f.fp);
    uselocale(before);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
