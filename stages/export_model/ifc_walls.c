/* ifc_walls.c - walls, their openings, doors and windows in IFC4; see ifc.h. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/export_model/ifc.h"
#include "stages/export_model/wall_top.h"

/* The part of a wall's line from cap to cap: a corner reaches to the far face of the other wall. */
static void wall_reach(double reach[2], const struct model_plan *plan, const struct model_wall *w)
{
    const bool along_x = fabs(w->normal[1]) > fabs(w->normal[0]);
    /* the start is at the low end where S grows from left to right as seen from inside */
    const double d = along_x ? -w->normal[1] : w->normal[0];
    memcpy(reach, w->span, 2 * sizeof *reach);
    if (reach[0] > reach[1]) {
        const double swap = reach[0];
        reach[0] = reach[1];
        reach[1] = swap;
    }
    for (int end = 0; end < 2; end++) {
        const int other = w->neighbours[end] ? model_plan_find_wall(plan, w->neighbours[end]) : -1;
        if (w->ends[end] != MODEL_WALL_CORNER || other < 0) continue;
        const bool at_high = (end == 1) == (d > 0);
        if (at_high)
            reach[1] += plan->walls[other].thickness;
        else
            reach[0] -= plan->walls[other].thickness;
    }
}

static bool is_along_axis(const struct model_wall *w)
{
    return fabs(fabs(w->normal[0]) - 1) < 1e-9 || fabs(fabs(w->normal[1]) - 1) < 1e-9;
}

/* The body of a wall with an upper edge of several heights: its profile, extruded from face to face. */
static int put_profile(struct ifc *f, const struct model_wall *w, const double reach[2], const double (*top)[2],
                       int count)
{
    const bool along_x = fabs(w->normal[1]) > 0.5;
    const double n = along_x ? w->normal[1] : w->normal[0], faces[2] = {n * w->offset, n * (w->offset - w->thickness)};
    double(*corners)[2] = malloc(((size_t)count + 2) * sizeof *corners);
    if (!corners) return err_nomem(f->err, "a wall's profile", (size_t)count * sizeof *corners), 0;
    memcpy(corners[0], (const double[2]){reach[0], w->foot}, sizeof *corners);
    memcpy(corners[1], (const double[2]){reach[1], w->foot}, sizeof *corners);
    for (int i = 0; i < count; i++) memcpy(corners[2 + i], top[count - 1 - i], sizeof *corners);
    /* S, z and the axis are right-handed: S is x and the axis -y, or S is y and the axis x */
    const struct vec3 axis = along_x ? vec3_make(0, -1, 0) : vec3_make(1, 0, 0);
    const double from = along_x ? fmax(faces[0], faces[1]) : fmin(faces[0], faces[1]);
    const struct vec3 origin = along_x ? vec3_make(0, from, 0) : vec3_make(from, 0, 0);
    const struct vec3 s = along_x ? vec3_make(1, 0, 0) : vec3_make(0, 1, 0);
    const struct ifc_outline o = {corners, count + 2, origin, s, axis, axis, w->thickness};
    const int shape = ifc_extrusion(f, &o);
    free(corners);
    return shape;
}

/* A box on a wall, from S to S and z to z, and from `off` to `off + thick` behind its inner face. */
static int wall_box(struct ifc *f, const struct model_wall *w, const double s[2], const double z[2], double off,
                    double thick)
{
    const bool along_x = fabs(w->normal[1]) > 0.5;
    const double n = along_x ? w->normal[1] : w->normal[0], face = n * w->offset;
    const double near = face - n * off, far = face - n * (off + thick), low = fmin(near, far);
    const struct vec3 origin = along_x ? vec3_make(s[0], low, z[0]) : vec3_make(low, s[0], z[0]);
    const struct vec3 x = vec3_make(1, 0, 0);
    return along_x ? ifc_box(f, origin, x, s[1] - s[0], thick, z[1] - z[0])
                   : ifc_box(f, origin, x, thick, s[1] - s[0], z[1] - z[0]);
}

/* A leaf or pane that the model does not show as faces of its own, because it is as thick as the wall. */
static int whole_filling(struct ifc *f, const struct model_opening *o, const struct model_wall *w)
{
    return o->closed ? wall_box(f, w, o->s, o->z, 0, w->thickness) : 0;
}

/* A door or window; opening: that it fills, 0: none, in a wall along no axis. Passages have one if they are closed. */
static enum status put_filling(struct ifc *f, const struct model_opening *o, const struct model_wall *w, int opening)
{
    static const char *const kinds[] = {[MODEL_DOOR] = "door", [MODEL_PASSAGE] = "passage", [MODEL_WINDOW] = "window"};
    const double size[2] = {fabs(o->s[1] - o->s[0]), o->z[1] - o->z[0]};
    const bool window = o->kind == MODEL_WINDOW;
    int shape = o->closed ? ifc_filling_shape(f, kinds[o->kind], o->name) : 0;
    if (!shape && opening) shape = whole_filling(f, o, w);
    if (!shape && (o->kind == MODEL_PASSAGE || !opening)) return ST_OK;
    return ifc_filling(f, window ? "IFCWINDOW" : "IFCDOOR", o->name, opening, shape, size,
                       window ? ".WINDOW." : ".DOOR.");
}

static enum status put_opening(struct ifc *f, const struct model_opening *o, const struct model_wall *w, int wall)
{
    static const double beyond = 0.01; /* past both faces, so that nothing thin stays */
    const int shape = wall_box(f, w, o->s, o->z, -beyond, w->thickness + 2 * beyond);
    const int opening = ifc_opening(f, o->name, wall, shape);
    const double width = fabs(o->s[1] - o->s[0]), height = o->z[1] - o->z[0];
    const struct ifc_quantity list[] = {{IFC_LENGTH, "Width", width},
                                        {IFC_LENGTH, "Height", height},
                                        {IFC_LENGTH, "Depth", w->thickness},
                                        {IFC_AREA, "Area", width * height},
                                        {IFC_VOLUME, "Volume", width * height * w->thickness}};
    ifc_quantities(f, opening, "Qto_OpeningElementBaseQuantities", o->name, list, 5);
    return put_filling(f, o, w, opening);
}

/* Length and side of a wall, without its openings. */
struct wall_size {
    double length, height, side;
};

/* The area of a profile whose lower edge is level: that below its upper edge. */
static double area_below(const double (*top)[2], int count, double foot)
{
    double area = 0;
    for (int i = 0; i + 1 < count; i++) area += (top[i + 1][0] - top[i][0]) * ((top[i][1] + top[i + 1][1]) / 2 - foot);
    return fabs(area);
}

/* The body of a wall along an axis. */
static int put_body(struct ifc *f, int wall, struct wall_size *size)
{
    const struct model_plan *plan = f->s->plan;
    const struct model_wall *w = &plan->walls[wall];
    double reach[2], (*top)[2] = NULL;
    int count = 0, shape = 0;
    wall_reach(reach, plan, w);
    const double z[2] = {w->foot, w->top};
    size->length = reach[1] - reach[0];
    size->height = w->top - w->foot;
    size->side = size->length * size->height;
    if (!wall_top_find(&top, &count, plan, wall, reach, f->err))
        shape = count ? put_profile(f, w, reach, (const double(*)[2])top, count)
                      : wall_box(f, w, reach, z, 0, w->thickness);
    if (count) {
        size->side = area_below((const double(*)[2])top, count, w->foot);
        for (int i = 0; i < count; i++) size->height = fmax(size->height, top[i][1] - w->foot);
    }
    free(top);
    return shape;
}

static void put_quantities(struct ifc *f, int id, int wall, const struct wall_size *size)
{
    const struct model_plan *plan = f->s->plan;
    const struct model_wall *w = &plan->walls[wall];
    double open = 0;
    for (int o = 0; o < plan->opening_count; o++)
        if (plan->openings[o].wall == wall)
            open += fabs(plan->openings[o].s[1] - plan->openings[o].s[0]) *
                    (plan->openings[o].z[1] - plan->openings[o].z[0]);
    const struct ifc_quantity list[] = {{IFC_LENGTH, "Length", size->length},
                                        {IFC_LENGTH, "Height", size->height},
                                        {IFC_LENGTH, "Width", w->thickness},
                                        {IFC_AREA, "GrossSideArea", size->side},
                                        {IFC_AREA, "NetSideArea", size->side - open},
                                        {IFC_VOLUME, "GrossVolume", size->side * w->thickness},
                                        {IFC_VOLUME, "NetVolume", (size->side - open) * w->thickness}};
    ifc_quantities(f, id, "Qto_WallBaseQuantities", w->name, list, 7);
}

enum status ifc_walls(struct ifc *f)
{
    const struct model_plan *plan = f->s->plan;
    for (int i = 0; !f->err->status && i < plan->wall_count; i++) {
        const struct model_wall *w = &plan->walls[i];
        const bool along_axis = is_along_axis(w);
        const double length = fabs(w->span[1] - w->span[0]), height = w->top - w->foot;
        struct wall_size size = {length, height, length * height};
        const int shape = along_axis ? put_body(f, i, &size) : ifc_faces_of(f, "wall", w->name);
        if (f->err->status) return f->err->status;
        if (!shape) continue;
        const int id = ifc_element(f, "IFCWALL", w->name, shape, ",.STANDARD.");
        ifc_keep(f, &f->contained, id);
        put_quantities(f, id, i, &size);
        for (int o = 0; !f->err->status && o < plan->opening_count; o++) {
            if (plan->openings[o].wall != i) continue;
            /* the faces of a wall along no axis have its openings */
            if (along_axis)
                put_opening(f, &plan->openings[o], w, id);
            else
                put_filling(f, &plan->openings[o], w, 0);
        }
    }
    return f->err->status;
}
