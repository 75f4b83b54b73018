/* plan_sheet.c - see plan_sheet.h. */
#include "common/model/plan_sheet.h"

#include <math.h>

#include "common/base/scan.h"
#include "common/math/numbers.h"

static const double LAMP_RADIUS = 7; /* px */

static const double picture_side = 1000; /* px */

double plan_sheet_x(const struct plan_sheet *s, double x) { return s->scale * (x - s->low[0]); }
double plan_sheet_y(const struct plan_sheet *s, double y) { return s->scale * (s->high[1] - y); }

void plan_sheet_hold(struct plan_sheet *s, double x, double y)
{
    s->low[0] = fmin(s->low[0], x), s->high[0] = fmax(s->high[0], x);
    s->low[1] = fmin(s->low[1], y), s->high[1] = fmax(s->high[1], y);
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

void plan_sheet_fit(struct plan_sheet *s, const struct model_plan *plan)
{
    s->low[0] = s->low[1] = INFINITY;
    s->high[0] = s->high[1] = -INFINITY;
    for (int r = 0; r < plan->room_count; r++)
        for (int k = 0; k < plan->rooms[r].corner_count; k++)
            plan_sheet_hold(s, plan->rooms[r].corners[k].x, plan->rooms[r].corners[k].y);
    for (int i = 0; !plan->room_count && i < plan->wall_count; i++) {
        double p[4][2];
        if (!wall_part(p, &plan->walls[i], plan->walls[i].span[0], plan->walls[i].span[1])) continue;
        for (int k = 0; k < 4; k++) plan_sheet_hold(s, p[k][0], p[k][1]);
    }
}

void plan_sheet_begin(struct plan_sheet *s, FILE *to, const char *label, const char *styles)
{
    for (int k = 0; k < 2; k++)
        if (!(s->low[k] <= s->high[k])) s->low[k] = s->high[k] = 0; /* nothing to hold */
    double wide = fmax(s->high[0] - s->low[0], s->high[1] - s->low[1]);
    if (!(wide > 0)) wide = 1;
    for (int k = 0; k < 2; k++) {
        s->low[k] -= 0.08 * wide;
        s->high[k] += 0.08 * wide;
    }
    s->scale = picture_side / (1.16 * wide);
    s->to = to;
    s->before = uselocale(scan_c_locale());
    fprintf(to,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %.0f %.0f\" role=\"img\" aria-label=\"%s\">\n"
            "<style>text{font:11px sans-serif;text-anchor:middle;fill:#222}.name{font-size:14px;font-weight:600}"
            ".room{fill:#f3efe6}.wall{fill:#6b7078}.window{fill:#9cc4e4}.door{fill:#8a5a2b}"
            ".box{fill:#cdb48a;stroke:#6b5530;stroke-width:.8}%s</style>\n"
            "<rect width=\"100%%\" height=\"100%%\" fill=\"#fff\"/>\n",
            s->scale * (s->high[0] - s->low[0]), s->scale * (s->high[1] - s->low[1]), label, styles);
}

void plan_sheet_end(struct plan_sheet *s)
{
    fputs("</svg>\n", s->to);
    uselocale(s->before);
}

void plan_sheet_put_polygon(const struct plan_sheet *s, double (*p)[2], int count, const char *class)
{
    fprintf(s->to, "<path class=\"%s\" d=\"", class);
    for (int i = 0; i < count; i++)
        fprintf(s->to, "%s%.2f %.2f", i ? "L" : "M", plan_sheet_x(s, p[i][0]), plan_sheet_y(s, p[i][1]));
    fputs("Z\"/>\n", s->to);
}

void plan_sheet_put_text(const struct plan_sheet *s, double x, double y, const char *class, const char *text)
{
    fprintf(s->to, "<text class=\"%s\" x=\"%.2f\" y=\"%.2f\">", class, plan_sheet_x(s, x), plan_sheet_y(s, y));
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

void plan_sheet_lamp_sign(FILE *to, double x, double y)
{
    const double r = LAMP_RADIUS, d = r * M_SQRT1_2;
    fprintf(to,
            "<path class=\"lamp\" fill=\"#fff4c2\" stroke=\"#2c2f33\" d=\"M%.2f %.2fa%g %g 0 1 0 %g 0a%g %g 0 1 0 "
            "-%g 0M%.2f %.2fl%.2f %.2fm0 -%.2fl-%.2f %.2f\"/>\n",
            x - r, y, r, r, 2 * r, r, r, 2 * r, x - d, y - d, 2 * d, 2 * d, 2 * d, 2 * d, 2 * d);
}

void plan_sheet_put_lamp(const struct plan_sheet *s, double x, double y, const char *name)
{
    plan_sheet_lamp_sign(s->to, plan_sheet_x(s, x), plan_sheet_y(s, y));
    plan_sheet_put_text(s, x, y - 3 * LAMP_RADIUS / s->scale, "place", name);
}

static void put_rooms(const struct plan_sheet *s, const struct model_plan *plan)
{
    for (int r = 0; r < plan->room_count; r++) {
        const struct model_room *room = &plan->rooms[r];
        fputs("<path class=\"room\" d=\"", s->to);
        for (int k = 0; k < room->corner_count; k++)
            fprintf(s->to, "%s%.2f %.2f", k ? "L" : "M", plan_sheet_x(s, room->corners[k].x),
                    plan_sheet_y(s, room->corners[k].y));
        fputs("Z\"/>\n", s->to);
    }
}

static void put_room_names(const struct plan_sheet *s, const struct model_plan *plan)
{
    for (int r = 0; r < plan->room_count; r++) {
        const struct model_room *room = &plan->rooms[r];
        double x = 0, low = INFINITY;
        for (int k = 0; k < room->corner_count; k++) {
            x += room->corners[k].x / room->corner_count;
            low = fmin(low, room->corners[k].y);
        }
        plan_sheet_put_text(s, x, low + 16 / s->scale, "name", room->name);
    }
}

static void put_walls(const struct plan_sheet *s, const struct model_plan *plan)
{
    double p[4][2];
    for (int i = 0; i < plan->wall_count; i++)
        if (wall_part(p, &plan->walls[i], plan->walls[i].span[0], plan->walls[i].span[1]))
            plan_sheet_put_polygon(s, p, 4, "wall");
    for (int i = 0; i < plan->opening_count; i++) {
        const struct model_opening *o = &plan->openings[i];
        if (wall_part(p, &plan->walls[o->wall], o->s[0], o->s[1]))
            plan_sheet_put_polygon(s, p, 4, o->kind == MODEL_WINDOW ? "window" : o->closed ? "door" : "room");
    }
}

static void put_boxes(const struct plan_sheet *s, const struct model_plan *plan)
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
        plan_sheet_put_polygon(s, p, 4, "box");
    }
}

void plan_sheet_put_plan(const struct plan_sheet *s, const struct model_plan *plan)
{
    put_rooms(s, plan);
    put_walls(s, plan);
    put_boxes(s, plan);
    put_room_names(s, plan);
}
