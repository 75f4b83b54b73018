/* tour_picture.c - see tour_picture.h. */
#include "stages/plan_tour/tour_picture.h"

#include <math.h>

#include "common/base/outfile.h"
#include "common/model/plan_sheet.h"

static void put_way(const struct plan_sheet *s, const struct camera_path *path, const struct model_axes *axes)
{
    const int every = (int)fmax(1, floor(path->fps / 2));
    const double length = 22 / s->scale;
    fputs("<polyline class=\"way\" points=\"", s->to);
    for (int f = 0; f < path->frame_count; f++) {
        const struct vec3 at = model_from_world_view(axes, &path->frames[f].camera).center;
        fprintf(s->to, "%s%.2f,%.2f", f ? " " : "", plan_sheet_x(s, at.x), plan_sheet_y(s, at.y));
    }
    fputs("\"/>\n", s->to);
    for (int f = 0; f < path->frame_count; f += every) {
        const struct view v = model_from_world_view(axes, &path->frames[f].camera);
        const double x = v.center.x + length * v.cam_from_world.m[2][0],
                     y = v.center.y + length * v.cam_from_world.m[2][1];
        fprintf(s->to, "<path class=\"look\" d=\"M%.2f %.2fL%.2f %.2f\"/>\n", plan_sheet_x(s, v.center.x),
                plan_sheet_y(s, v.center.y), plan_sheet_x(s, x), plan_sheet_y(s, y));
    }
}

static void put_viewpoints(const struct plan_sheet *s, const struct tour_graph *g, const struct tour_stop *stops,
                           int stop_count)
{
    for (int i = 0; i < g->count; i++)
        fprintf(s->to, "<circle class=\"%s\" cx=\"%.2f\" cy=\"%.2f\" r=\"3\"/>\n", g->nodes[i].usable ? "view" : "left",
                plan_sheet_x(s, g->nodes[i].centre.x), plan_sheet_y(s, g->nodes[i].centre.y));
    for (int i = 0; i < stop_count; i++) {
        const struct tour_node *n = &g->nodes[stops[i].node];
        fprintf(s->to, "<circle class=\"stop\" cx=\"%.2f\" cy=\"%.2f\" r=\"6\"/>\n", plan_sheet_x(s, n->centre.x),
                plan_sheet_y(s, n->centre.y));
        plan_sheet_put_text(s, n->centre.x, n->centre.y + 14 / s->scale, "photo", n->photo);
    }
}

enum status tour_picture_write(const struct camera_path *path, const struct tour_graph *g,
                               const struct tour_stop *stops, int stop_count, const struct model_plan *plan,
                               const struct model_axes *axes, const char *file, struct err *err)
{
    struct outfile f = {0};
    struct plan_sheet s = {0};
    if (outfile_open(&f, file, err)) return err->status;
    plan_sheet_fit(&s, plan);
    for (int i = 0; i < g->count; i++) plan_sheet_hold(&s, g->nodes[i].centre.x, g->nodes[i].centre.y);
    plan_sheet_begin(&s, f.fp, "The tour on the plan of the model",
                     ".photo{fill:#a33}.way{fill:none;stroke:#1f78c8;stroke-width:2.5}"
                     ".look{stroke:#1f78c8;stroke-width:.8}.view{fill:#d33}.left{fill:none;stroke:#999}"
                     ".stop{fill:none;stroke:#d33;stroke-width:2}");
    plan_sheet_put_plan(&s, plan);
    put_way(&s, path, axes);
    put_viewpoints(&s, g, stops, stop_count);
    plan_sheet_end(&s);
    outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
