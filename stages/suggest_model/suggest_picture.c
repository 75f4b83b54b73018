/* suggest_picture.c - the plan of a suggestion as SVG, for people.
 *
 * From bottom to top: points of walls as small dots, one per square of the plan; walls, the stronger the more
 * confident; openings; doubts as dashed lines; cameras. x and y of the model become right and up. */
#include <math.h>
#include <stdlib.h>

#include "stages/suggest_model/suggest_script.h"

enum { SIDE = 1000, DOTS = 400 }; /* px; squares along the longer side */

struct sheet {
    FILE *to;
    double left, top, scale;
};

static void put(const struct sheet *s, const double p[2], const char *before)
{
    fprintf(s->to, "%s%.2f %.2f", before, s->scale * (p[0] - s->left), s->scale * (s->top - p[1]));
}

static void put_line(const struct sheet *s, const double a[2], const double b[2], const char *class)
{
    fprintf(s->to, "<path class=\"%s\" d=\"", class);
    put(s, a, "M");
    put(s, b, "L");
    fputs("\"/>\n", s->to);
}

static bool is_of_wall(const struct cloud_point *p, double height)
{
    return fabs((double)p->normal[2]) < 0.5 && p->position.z > 0.04 * height && p->position.z < 0.96 * height;
}

static void put_points(const struct sheet *s, const struct sights *sights, double height, double wide)
{
    unsigned char *seen = calloc((size_t)DOTS * DOTS, 1);
    fputs("<path class=\"points\" d=\"", s->to);
    for (size_t i = 0; seen && i < sights->points.cloud.count; i++) {
        const struct cloud_point *p = &sights->points.cloud.points[i];
        const double x = (p->position.x - s->left) / wide * DOTS, y = (s->top - p->position.y) / wide * DOTS;
        if (!is_of_wall(p, height) || !(x >= 0 && y >= 0 && x < DOTS && y < DOTS)) continue;
        unsigned char *at = &seen[(size_t)y * DOTS + (size_t)x];
        if (!*at) fprintf(s->to, "M%.1f %.1fh.1", (floor(x) + 0.5) * SIDE / DOTS, (floor(y) + 0.5) * SIDE / DOTS);
        *at = 1;
    }
    fputs("\"/>\n", s->to);
    free(seen);
}

static void put_wall(const struct sheet *s, const struct suggested_wall *w, const char *name, double height)
{
    const double thickness = w->thickness > 0 ? w->thickness : WALL_THICKNESS * height;
    double p[2];
    fprintf(s->to, "<path class=\"wall\" fill-opacity=\"%.2f\" d=\"", 0.15 + 0.75 * w->confidence);
    for (int k = 0; k < 4; k++) {
        line_point(&w->line, k == 1 || k == 2 ? w->end : w->begin, k >= 2 ? -thickness : 0, p);
        put(s, p, k ? "L" : "M");
    }
    line_point(&w->line, 0.5 * (w->begin + w->end), 0.06 * height, p);
    fprintf(s->to, "Z\"/>\n<text x=\"%.2f\" y=\"%.2f\">%s %.2f</text>\n", s->scale * (p[0] - s->left),
            s->scale * (s->top - p[1]), name, w->confidence);
}

static void put_plan(const struct sheet *s, const struct suggestion *plan, const struct wall_names *names,
                     const struct sights *sights)
{
    double a[2], b[2];
    for (int i = 0; i < plan->wall_count; i++) put_wall(s, &plan->walls[i], names->names[i], plan->ceiling);
    for (int i = 0; i < plan->opening_count; i++) {
        const struct suggested_opening *o = &plan->openings[i];
        line_point(&plan->walls[o->wall].line, o->begin, 0, a);
        line_point(&plan->walls[o->wall].line, o->end, 0, b);
        put_line(s, a, b, o->doubtful ? "doubt" : o->window ? "window" : "passage");
    }
    for (int i = 0; i < plan->doubt_count; i++) {
        const struct suggested_doubt *d = &plan->doubts[i];
        put_line(s, d->a, d->b, d->kind == DOUBT_FACE ? "face" : "doubt");
    }
    for (int v = 0; v < sights->view_count; v++) {
        const double at[2] = {sights->views[v].center.x, sights->views[v].center.y};
        fprintf(s->to, "<circle class=\"camera\" cx=\"%.2f\" cy=\"%.2f\" r=\"3\"/>\n", s->scale * (at[0] - s->left),
                s->scale * (s->top - at[1]));
    }
}

/* Bounds of cameras, walls and doubts. */
static void find_bounds(const struct suggestion *plan, const struct sights *sights, double low[2], double high[2])
{
    low[0] = low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    const int count = sights->view_count + 2 * plan->wall_count + 2 * plan->doubt_count;
    for (int i = 0; i < count; i++) {
        double p[2];
        int k = i - sights->view_count;
        if (k < 0) {
            p[0] = sights->views[i].center.x;
            p[1] = sights->views[i].center.y;
        } else if (k < 2 * plan->wall_count) {
            const struct suggested_wall *w = &plan->walls[k / 2];
            line_point(&w->line, k % 2 ? w->end : w->begin, 0, p);
        } else {
            k -= 2 * plan->wall_count;
            const struct suggested_doubt *d = &plan->doubts[k / 2];
            for (int c = 0; c < 2; c++) p[c] = k % 2 ? d->b[c] : d->a[c];
        }
        for (int c = 0; c < 2; c++) {
            low[c] = fmin(low[c], p[c]);
            high[c] = fmax(high[c], p[c]);
        }
    }
    for (int c = 0; c < 2; c++)
        if (!(high[c] > low[c])) low[c] = count ? low[c] - 1 : 0, high[c] = low[c] + 2;
}

void suggest_picture_print(FILE *to, const struct suggestion *plan, const struct wall_names *names,
                           const struct sights *sights, bool metric)
{
    double low[2], high[2];
    find_bounds(plan, sights, low, high);
    const double wide = 1.12 * fmax(high[0] - low[0], high[1] - low[1]);
    const struct sheet s = {to, 0.5 * (low[0] + high[0] - wide), 0.5 * (low[1] + high[1] + wide), SIDE / wide};
    const double bar = pow(10, floor(log10(wide / 4)));
    fprintf(to,
            "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %d %d\" role=\"img\" aria-label=\"Plan of the "
            "suggestion\">\n<style>text{font:12px sans-serif;text-anchor:middle;fill:#222}"
            ".points{stroke:#7a8793;stroke-width:2;stroke-linecap:round;fill:none}"
            ".wall{fill:#1f4e79;stroke:#1f4e79;stroke-width:.8}.window{stroke:#2aa5e0;stroke-width:5;fill:none}"
            ".passage{stroke:#fff;stroke-width:4;fill:none}"
            ".doubt{stroke:#d33;stroke-width:3;stroke-dasharray:8 6;fill:none}"
            ".face{stroke:#e08a1e;stroke-width:2;stroke-dasharray:3 4;fill:none}.camera{fill:#d33;fill-opacity:.6}"
            ".bar{stroke:#222;stroke-width:4;fill:none}</style>\n<rect width=\"100%%\" height=\"100%%\" "
            "fill=\"#fff\"/>\n",
            SIDE, SIDE);
    put_points(&s, sights, plan->ceiling, wide);
    put_plan(&s, plan, names, sights);
    const double a[2] = {s.left + 0.03 * wide, s.top - 0.97 * wide}, b[2] = {a[0] + bar, a[1]};
    put_line(&s, a, b, "bar");
    fprintf(to, "<text x=\"%.2f\" y=\"%.2f\">%.4g %s</text>\n</svg>\n", s.scale * (0.5 * (a[0] + b[0]) - s.left),
            0.96 * SIDE, bar, metric ? "m" : "units");
}
