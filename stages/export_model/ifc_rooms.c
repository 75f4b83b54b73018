/* ifc_rooms.c - slabs with their openings, spaces and boxes in IFC4; see ifc.h.
 *
 * A ceiling is a slab for each of its planes: the outline of the room's part under that plane, in the plane, extruded
 * upwards. A space under a sloping ceiling is a polyhedron, others are extrusions. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "stages/export_model/ceiling_parts.h"
#include "stages/export_model/ifc.h"

static const double default_slab = 0.2; /* metres: of a slab of which a face is hidden */

/* The height of the first face of a name, which is not upright, at (x, y); *found is cleared if there is none. */
static double face_height(const struct ifc *f, const char *name, double x, double y, bool *found)
{
    const struct solid_mesh *mesh = f->s->mesh;
    for (int i = 0; i < mesh->face_count; i++) {
        const struct solid_face *face = &mesh->faces[i];
        if (strcmp(solid_face_name(mesh, i), name) || fabs(face->normal.z) < 1e-6) continue;
        return (face->offset - face->normal.x * x - face->normal.y * y) / face->normal.z;
    }
    *found = false;
    return 0;
}

/* The thickness of a room's floor: build_model gives its ceiling the same, measured upwards. */
static double slab_thickness(const struct ifc *f, const struct model_room *r)
{
    char upper[300], lower[300];
    bool found = true;
    snprintf(upper, sizeof upper, "floor/%s", r->name);
    snprintf(lower, sizeof lower, "floor/%s/bottom", r->name);
    const double by = face_height(f, upper, 0, 0, &found) - face_height(f, lower, 0, 0, &found);
    return found && by > 0 ? by : default_slab;
}

/* ---------------------------------------------------------------------------------- openings in ceilings and floors */

/* Whether an opening is, at one of its corners or in its middle, under a plane of the ceiling. */
static bool is_under(const struct model_slot *o, const struct model_room *r, int plane)
{
    for (int i = 0; i < 5; i++) {
        const double x = i == 4 ? (o->low[0] + o->high[0]) / 2 : i & 1 ? o->high[0] : o->low[0];
        const double y = i == 4 ? (o->low[1] + o->high[1]) / 2 : i & 2 ? o->high[1] : o->low[1];
        const double *c = r->ceiling[plane], z = c[0] + c[1] * x + c[2] * y;
        if (z <= model_room_ceiling(r, x, y) + 1e-9) return true;
    }
    return false;
}

/* A box through the slab, from below its lowest to above its highest point over the opening. */
static int slot_shape(struct ifc *f, const struct model_slot *o, const struct model_room *r, double slab)
{
    static const double beyond = 0.01;
    double low = o->skylight ? INFINITY : r->floor - slab, high = o->skylight ? -INFINITY : r->floor;
    for (int p = 0; o->skylight && p < r->ceilings; p++)
        for (int i = 0; i < 4; i++) {
            const double *c = r->ceiling[p];
            const double z = c[0] + c[1] * (i & 1 ? o->high[0] : o->low[0]) + c[2] * (i & 2 ? o->high[1] : o->low[1]);
            low = fmin(low, z);
            high = fmax(high, z + slab);
        }
    return ifc_box(f, vec3_make(o->low[0], o->low[1], low - beyond), vec3_make(1, 0, 0), o->high[0] - o->low[0],
                   o->high[1] - o->low[1], high - low + 2 * beyond);
}

/* Openings of a slab; plane: of the ceiling, -1: the floor. The first slab of a gable that an opening is in has what
 * fills it. */
static enum status put_slots(struct ifc *f, int room, int plane, int element, double slab)
{
    const struct model_plan *plan = f->s->plan;
    const struct model_room *r = &plan->rooms[room];
    for (int i = 0; !f->err->status && i < plan->slot_count; i++) {
        const struct model_slot *o = &plan->slots[i];
        const bool second = plane == 1 && is_under(o, r, 0);
        char name[300];
        if (o->room != room || o->skylight != (plane >= 0) || (plane >= 0 && !is_under(o, r, plane))) continue;
        snprintf(name, sizeof name, "%s%s", o->name, second ? " 2" : "");
        const int opening = ifc_opening(f, name, element, slot_shape(f, o, r, slab));
        if (second) continue;
        const double size[2] = {o->high[0] - o->low[0], o->high[1] - o->low[1]};
        const int shape = o->closed ? ifc_filling_shape(f, o->skylight ? "skylight" : "hatch", o->name) : 0;
        ifc_filling(f, o->skylight ? "IFCWINDOW" : "IFCDOOR", o->name, opening, shape, size,
                    o->skylight ? ".SKYLIGHT." : ".TRAPDOOR.");
    }
    return f->err->status;
}

/* ------------------------------------------------------------------------------------------------------------ rooms */

static int put_slab(struct ifc *f, const char *name, const double (*corners)[2], int count, const double plane[3],
                    double slab, const char *type)
{
    const int id = ifc_element(f, "IFCSLAB", name, ifc_prism(f, corners, count, plane, slab), type);
    ifc_keep(f, &f->contained, id);
    return id;
}

static enum status put_ceiling(struct ifc *f, int room, const struct ceiling_parts *parts, double slab)
{
    const struct model_room *r = &f->s->plan->rooms[room];
    for (int k = 0; !f->err->status && k < r->ceilings; k++) {
        char name[300];
        if (!parts->counts[k]) continue;
        snprintf(name, sizeof name, "%s ceiling%s", r->name, k ? " 2" : "");
        const int id =
            put_slab(f, name, (const double(*)[2])parts->corners[k], parts->counts[k], r->ceiling[k], slab, ",.ROOF.");
        put_slots(f, room, k, id, slab);
    }
    return f->err->status;
}

struct faces { /* of a polyhedron */
    struct vec3 *corners;
    int *ends, count;
};

static void add_corner(struct faces *to, double x, double y, double z)
{
    to->corners[to->ends[to->count]++] = vec3_make(x, y, z);
}

static void end_face(struct faces *to)
{
    to->count++;
    to->ends[to->count] = to->ends[to->count - 1];
}

/* Floor, walls and ceiling of a room, seen from outside of the space. */
static void add_faces(struct faces *to, const struct model_room *r, const struct ceiling_parts *parts)
{
    const double(*p)[2] = (const double(*)[2])parts->outline;
    for (int i = parts->outline_count - 1; i >= 0; i--) add_corner(to, p[i][0], p[i][1], r->floor);
    end_face(to);
    for (int i = 0; i < parts->outline_count; i++) {
        const double *a = p[i], *b = p[(i + 1) % parts->outline_count];
        add_corner(to, a[0], a[1], r->floor);
        add_corner(to, b[0], b[1], r->floor);
        add_corner(to, b[0], b[1], model_room_ceiling(r, b[0], b[1]));
        add_corner(to, a[0], a[1], model_room_ceiling(r, a[0], a[1]));
        end_face(to);
    }
    for (int k = 0; k < r->ceilings; k++) {
        for (int i = 0; i < parts->counts[k]; i++) {
            const double *q = parts->corners[k][i];
            add_corner(to, q[0], q[1], r->ceiling[k][0] + r->ceiling[k][1] * q[0] + r->ceiling[k][2] * q[1]);
        }
        if (parts->counts[k]) end_face(to);
    }
}

static int put_polyhedron(struct ifc *f, const struct model_room *r, const struct ceiling_parts *parts)
{
    const size_t corners = 5 * (size_t)parts->outline_count + (size_t)parts->counts[0] + (size_t)parts->counts[1];
    struct faces faces = {.corners = malloc((corners + 1) * sizeof *faces.corners),
                          .ends = calloc((size_t)parts->outline_count + 5, sizeof *faces.ends)};
    int shape = 0;
    if (faces.corners && faces.ends) {
        add_faces(&faces, r, parts);
        shape = ifc_polyhedron(f, faces.corners, faces.ends, faces.count);
    } else {
        err_nomem(f->err, "a space", corners * sizeof *faces.corners);
    }
    free(faces.corners);
    free(faces.ends);
    return shape;
}

/* The area of a polygon, and the mean of a plane z = c[0] + c[1] x + c[2] y over it. */
static double polygon_area(const double (*p)[2], int count, const double c[3], double *mean)
{
    double area = 0, x = 0, y = 0;
    for (int i = 0; i < count; i++) {
        const double *a = p[i], *b = p[(i + 1) % count], cross = a[0] * b[1] - b[0] * a[1];
        area += cross / 2;
        x += (a[0] + b[0]) * cross / 6;
        y += (a[1] + b[1]) * cross / 6;
    }
    *mean = area != 0 ? c[0] + c[1] * x / area + c[2] * y / area : c[0];
    return fabs(area);
}

static void put_space_quantities(struct ifc *f, int space, const struct model_room *r,
                                 const struct ceiling_parts *parts)
{
    static const double level[3] = {0, 0, 0};
    const double(*p)[2] = (const double(*)[2])parts->outline;
    double perimeter = 0, walls = 0, volume = 0, ceiling = 0, mean, high = 0;
    const double floor = polygon_area(p, parts->outline_count, level, &mean);
    for (int i = 0; i < parts->outline_count; i++) {
        const double *a = p[i], *b = p[(i + 1) % parts->outline_count], length = hypot(b[0] - a[0], b[1] - a[1]);
        const double at_a = model_room_ceiling(r, a[0], a[1]) - r->floor;
        perimeter += length;
        walls += length * (at_a + model_room_ceiling(r, b[0], b[1]) - r->floor) / 2;
        high = fmax(high, at_a);
    }
    for (int k = 0; k < r->ceilings; k++) {
        const double *c = r->ceiling[k];
        const double area = polygon_area((const double(*)[2])parts->corners[k], parts->counts[k], c, &mean);
        volume += area * (mean - r->floor);
        ceiling += area * sqrt(1 + c[1] * c[1] + c[2] * c[2]);
        for (int i = 0; i < parts->counts[k]; i++)
            high = fmax(high, c[0] + c[1] * parts->corners[k][i][0] + c[2] * parts->corners[k][i][1] - r->floor);
    }
    const struct ifc_quantity list[] = {{IFC_LENGTH, "Height", high},        {IFC_LENGTH, "GrossPerimeter", perimeter},
                                        {IFC_AREA, "GrossFloorArea", floor}, {IFC_AREA, "NetFloorArea", floor},
                                        {IFC_AREA, "GrossWallArea", walls},  {IFC_AREA, "GrossCeilingArea", ceiling},
                                        {IFC_VOLUME, "GrossVolume", volume}, {IFC_VOLUME, "NetVolume", volume}};
    ifc_quantities(f, space, "Qto_SpaceBaseQuantities", r->name, list, 8);
}

static enum status put_room(struct ifc *f, int room, const struct ceiling_parts *parts)
{
    const struct model_room *r = &f->s->plan->rooms[room];
    const double slab = slab_thickness(f, r), under[3] = {r->floor - slab, 0, 0}, floor[3] = {r->floor, 0, 0};
    const double(*outline)[2] = (const double(*)[2])parts->outline, *c = r->ceiling[0];
    const bool level = r->ceilings == 1 && fabs(c[1]) < 1e-12 && fabs(c[2]) < 1e-12;
    const int below = put_slab(f, r->name, outline, parts->outline_count, under, slab, ",.FLOOR.");
    if (put_slots(f, room, -1, below, slab) || put_ceiling(f, room, parts, slab)) return f->err->status;
    const int shape =
        level ? ifc_prism(f, outline, parts->outline_count, floor, c[0] - r->floor) : put_polyhedron(f, r, parts);
    const int space = ifc_begin(f, "IFCSPACE", r->name);
    fprintf(f->to, ",$,$,#%d,#%d,$,.ELEMENT.,.SPACE.,$);\n", f->placement, shape);
    put_space_quantities(f, space, r, parts);
    return f->err->status ? f->err->status : ifc_keep(f, &f->spaces, space);
}

enum status ifc_rooms(struct ifc *f)
{
    const struct model_plan *plan = f->s->plan;
    for (int i = 0; !f->err->status && i < plan->room_count; i++) {
        const struct model_room *r = &plan->rooms[i];
        struct ceiling_parts parts = {0};
        double ceiling = INFINITY;
        for (int k = 0; k < r->corner_count; k++)
            ceiling = fmin(ceiling, model_room_ceiling(r, r->corners[k].x, r->corners[k].y));
        if (r->corner_count < 3 || !(ceiling > r->floor)) continue;
        if (!ceiling_parts_make(&parts, r, f->err)) put_room(f, i, &parts);
        ceiling_parts_release(&parts);
    }
    return f->err->status;
}

/* ------------------------------------------------------------------------------------------------------------ boxes */

enum status ifc_boxes(struct ifc *f)
{
    for (int i = 0; !f->err->status && i < f->s->plan->box_count; i++) {
        const struct model_box *b = &f->s->plan->boxes[i];
        const double turn = b->turn * M_PI / 180, dx = b->high.x - b->low.x, dy = b->high.y - b->low.y;
        const struct vec3 x = vec3_make(cos(turn), sin(turn), 0), y = vec3_make(-x.y, x.x, 0);
        struct vec3 at = vec3_make((b->low.x + b->high.x) / 2, (b->low.y + b->high.y) / 2, b->low.z);
        at = vec3_sub(at, vec3_add(vec3_scale(x, dx / 2), vec3_scale(y, dy / 2)));
        const int shape = ifc_box(f, at, x, dx, dy, b->high.z - b->low.z);
        ifc_keep(f, &f->contained, ifc_element(f, "IFCBUILDINGELEMENTPROXY", b->name, shape, ",.NOTDEFINED."));
    }
    return f->err->status;
}
