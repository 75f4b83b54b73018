/* write_ifc.c - IFC4 (ISO 16739) as a STEP file (ISO 10303-21).
 *
 * Walls, slabs and spaces are extruded outlines; an opening is a box that voids its wall, and a door or window fills it.
 * Walls that are along no axis are the triangles of their faces. Photographic texture is on coverings: each face of the
 * model is an IfcCovering of triangles, with the texture maps that IFC4 defines for IfcTriangulatedFaceSet, so that
 * readers without textures lose nothing of the building. */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/version.h"
#include "stages/export_model/writers.h"

struct ids {
    int *list; /* owned */
    int count;
};

struct ifc {
    FILE *to;
    const struct export_scene *s;
    int last;                             /* the last number that was given */
    int context, storey, placement, axes; /* of what all elements share */
    int *styles;                          /* surface style of each page */
    int *maps;                            /* picture of each page */
    struct ids contained, spaces;
    struct err *err;
};

static int next_id(struct ifc *f) { return ++f->last; }

/* Writes "#N=" and the formatted text; returns N. */
static int put(struct ifc *f, const char *fmt, ...) PRINTF_LIKE(2, 3);
static int put(struct ifc *f, const char *fmt, ...)
{
    va_list args;
    const int id = next_id(f);
    fprintf(f->to, "#%d=", id);
    va_start(args, fmt);
    vfprintf(f->to, fmt, args);
    va_end(args);
    fputs(";\n", f->to);
    return id;
}

/* Begins "#N=KIND('guid',$,'name'": the GUID is that of the kind and the name. */
static int begin(struct ifc *f, const char *kind, const char *name)
{
    char guid[23], text[1200];
    const int id = next_id(f);
    snprintf(text, sizeof text, "%s/%s/%s", f->s->name, kind, name);
    ifc_guid(guid, text);
    fprintf(f->to, "#%d=%s('%s',$,", id, kind, guid);
    ifc_text(f->to, name);
    return id;
}

static enum status keep(struct ifc *f, struct ids *ids, int id)
{
    if (array_append(&ids->list, (size_t)ids->count, sizeof *ids->list, "elements", f->err)) return f->err->status;
    ids->list[ids->count++] = id;
    return ST_OK;
}

static void put_ids(struct ifc *f, const struct ids *ids)
{
    fputc('(', f->to);
    for (int i = 0; i < ids->count; i++) fprintf(f->to, "%s#%d", i ? "," : "", ids->list[i]);
    fputc(')', f->to);
}

/* A number as STEP wants it: with a point. */
static const char *real(char text[40], double value)
{
    snprintf(text, 40, "%.9g", value + 0.0);
    if (strpbrk(text, ".e") == NULL) strcat(text, ".");
    char *e = strchr(text, 'e');
    if (e && !memchr(text, '.', (size_t)(e - text))) {
        memmove(e + 1, e, strlen(e) + 1);
        *e = '.';
    }
    if ((e = strchr(text, 'e'))) *e = 'E';
    return text;
}

static int put_point(struct ifc *f, struct vec3 p)
{
    char x[40], y[40], z[40];
    return put(f, "IFCCARTESIANPOINT((%s,%s,%s))", real(x, p.x), real(y, p.y), real(z, p.z));
}

static int put_direction(struct ifc *f, struct vec3 d)
{
    char x[40], y[40], z[40];
    return put(f, "IFCDIRECTION((%s,%s,%s))", real(x, d.x), real(y, d.y), real(z, d.z));
}

/* ---------------------------------------------------------------------------------------------------------- shapes */

struct outline {
    double (*corners)[2]; /* counter-clockwise, in the plane of the extrusion */
    int count;
    struct vec3 origin, x, axis; /* of the plane; extruded along the axis */
    double depth;
};

/* An IfcProductDefinitionShape of an extruded outline. */
static int put_extrusion(struct ifc *f, const struct outline *o)
{
    char u[40], v[40];
    struct ids points = {0};
    for (int i = 0; i < o->count; i++)
        keep(f, &points, put(f, "IFCCARTESIANPOINT((%s,%s))", real(u, o->corners[i][0]), real(v, o->corners[i][1])));
    keep(f, &points, points.count ? points.list[0] : 0);
    const int line = next_id(f);
    fprintf(f->to, "#%d=IFCPOLYLINE(", line);
    put_ids(f, &points);
    fputs(");\n", f->to);
    free(points.list);
    const int profile = put(f, "IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#%d)", line);
    const int origin = put_point(f, o->origin), z = put_direction(f, o->axis), x = put_direction(f, o->x);
    const int place = put(f, "IFCAXIS2PLACEMENT3D(#%d,#%d,#%d)", origin, z, x);
    const int up = put_direction(f, vec3_make(0, 0, 1));
    const int solid = put(f, "IFCEXTRUDEDAREASOLID(#%d,#%d,#%d,%s)", profile, place, up, real(u, o->depth));
    const int shape = put(f, "IFCSHAPEREPRESENTATION(#%d,'Body','SweptSolid',(#%d))", f->context, solid);
    return put(f, "IFCPRODUCTDEFINITIONSHAPE($,$,(#%d))", shape);
}

/* A box with edges along x and y of its own frame. */
static int put_box(struct ifc *f, struct vec3 origin, struct vec3 x, double width, double depth, double height)
{
    double corners[4][2] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
    const struct outline o = {corners, 4, origin, x, vec3_make(0, 0, 1), height};
    return put_extrusion(f, &o);
}

/* An outline on the ground, from z upwards. */
static int put_plate(struct ifc *f, const struct model_room *room, double z, double height)
{
    double(*corners)[2] = malloc(((size_t)room->corner_count + 1) * sizeof *corners);
    if (!corners) return err_nomem(f->err, "a room's corners", (size_t)room->corner_count * sizeof *corners), 0;
    for (int i = 0; i < room->corner_count; i++) {
        corners[i][0] = room->corners[i].x;
        corners[i][1] = room->corners[i].y;
    }
    const struct outline o = {corners, room->corner_count, {0, 0, z}, {1, 0, 0}, {0, 0, 1}, height};
    const int shape = put_extrusion(f, &o);
    free(corners);
    return shape;
}

static void put_points(struct ifc *f, int first, int end)
{
    char x[40], y[40], z[40];
    fputs("((", f->to);
    for (int i = first; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = f->s->faces->triangles[i].p[k];
            fprintf(f->to, "%s(%s,%s,%s)", i > first || k ? "," : "", real(x, p.x), real(y, p.y), real(z, p.z));
        }
    fputs("))", f->to);
}

static void put_indices(struct ifc *f, int triangles)
{
    fputc('(', f->to);
    for (int i = 0; i < triangles; i++) fprintf(f->to, "%s(%d,%d,%d)", i ? "," : "", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    fputc(')', f->to);
}

/* Triangles first .. end - 1 as an IfcTriangulatedFaceSet; of a page, with its texture map. */
static int put_triangles(struct ifc *f, int first, int end, int page)
{
    const int list = next_id(f);
    fprintf(f->to, "#%d=IFCCARTESIANPOINTLIST3D", list);
    put_points(f, first, end);
    fputs(";\n", f->to);
    const int set = next_id(f);
    fprintf(f->to, "#%d=IFCTRIANGULATEDFACESET(#%d,$,.F.,", set, list);
    put_indices(f, end - first);
    fputs(",$);\n", f->to);
    if (page < 0) return set;
    const int vertices = next_id(f);
    char u[40], v[40];
    fprintf(f->to, "#%d=IFCTEXTUREVERTEXLIST((", vertices);
    for (int i = first; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const double *uv = f->s->faces->triangles[i].uv[k];
            fprintf(f->to, "%s(%s,%s)", i > first || k ? "," : "", real(u, uv[0]), real(v, 1 - uv[1]));
        }
    fputs("));\n", f->to);
    const int map = next_id(f);
    fprintf(f->to, "#%d=IFCINDEXEDTRIANGLETEXTUREMAP((#%d),#%d,#%d,", map, f->maps[page], set, vertices);
    put_indices(f, end - first);
    fputs(");\n", f->to);
    put(f, "IFCSTYLEDITEM(#%d,(#%d),$)", set, f->styles[page]);
    return set;
}

/* ---------------------------------------------------------------------------------------------------- the building */

static int put_units(struct ifc *f)
{
    /* without a scale the unit's name says so */
    const int length = put(f, "IFCSIUNIT(*,.LENGTHUNIT.,$,.METRE.)");
    const int area = put(f, "IFCSIUNIT(*,.AREAUNIT.,$,.SQUARE_METRE.)");
    const int volume = put(f, "IFCSIUNIT(*,.VOLUMEUNIT.,$,.CUBIC_METRE.)");
    const int angle = put(f, "IFCSIUNIT(*,.PLANEANGLEUNIT.,$,.RADIAN.)");
    return put(f, "IFCUNITASSIGNMENT((#%d,#%d,#%d,#%d))", length, area, volume, angle);
}

static int put_part(struct ifc *f, const char *kind, const char *name, const char *rest)
{
    const int id = begin(f, kind, name);
    fprintf(f->to, ",%s,$,#%d,$%s);\n", f->s->metric ? "$" : "'The scale is unknown: lengths are not metres.'",
            f->placement, rest);
    return id;
}

static void put_aggregate(struct ifc *f, int whole, const char *name, const struct ids *parts)
{
    begin(f, "IFCRELAGGREGATES", name);
    fprintf(f->to, ",$,#%d,", whole);
    put_ids(f, parts);
    fputs(");\n", f->to);
}

static void put_head(struct ifc *f)
{
    const int origin = put_point(f, vec3_make(0, 0, 0));
    const int z = put_direction(f, vec3_make(0, 0, 1)), x = put_direction(f, vec3_make(1, 0, 0));
    f->axes = put(f, "IFCAXIS2PLACEMENT3D(#%d,#%d,#%d)", origin, z, x);
    f->placement = put(f, "IFCLOCALPLACEMENT($,#%d)", f->axes);
    f->context = put(f, "IFCGEOMETRICREPRESENTATIONCONTEXT($,'Model',3,1.E-6,#%d,$)", f->axes);
    const int units = put_units(f);
    const int project = begin(f, "IFCPROJECT", f->s->name);
    fprintf(f->to, ",$,$,$,$,(#%d),#%d);\n", f->context, units);
    int site = put_part(f, "IFCSITE", "site", ",$,.ELEMENT.,$,$,$,$,$");
    int building = put_part(f, "IFCBUILDING", "building", ",$,.ELEMENT.,$,$,$");
    f->storey = put_part(f, "IFCBUILDINGSTOREY", "storey", ",$,.ELEMENT.,0.");
    put_aggregate(f, project, "project", &(struct ids){&site, 1});
    put_aggregate(f, site, "site", &(struct ids){&building, 1});
    put_aggregate(f, building, "building", &(struct ids){&f->storey, 1});
}

static void put_pages(struct ifc *f)
{
    for (int i = 0; i < f->s->page_count; i++) {
        f->maps[i] = put(f, "IFCIMAGETEXTURE(.F.,.F.,'DIFFUSE',$,$,'page%d.png')", i);
        const int textures = put(f, "IFCSURFACESTYLEWITHTEXTURES((#%d))", f->maps[i]);
        const int white = put(f, "IFCCOLOURRGB($,1.,1.,1.)");
        const int shading = put(f, "IFCSURFACESTYLESHADING(#%d,0.)", white);
        f->styles[i] = put(f, "IFCSURFACESTYLE('page%d',.BOTH.,(#%d,#%d))", i, shading, textures);
    }
}

/* An element of the storey: "kind name ... , placement, shape, tag, rest". */
static int put_element(struct ifc *f, const char *kind, const char *name, int shape, const char *rest)
{
    const int id = begin(f, kind, name);
    fprintf(f->to, ",$,$,#%d,#%d,$%s);\n", f->placement, shape, rest);
    return id;
}

/* ----------------------------------------------------------------------------------------------- walls and openings */

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

/* A box on a wall, from S to S and z to z, and from `off` to `off + thick` behind its inner face. */
static int put_wall_box(struct ifc *f, const struct model_wall *w, const double s[2], const double z[2], double off,
                        double thick)
{
    const bool along_x = fabs(w->normal[1]) > 0.5;
    const double n = along_x ? w->normal[1] : w->normal[0], face = n * w->offset;
    const double near = face - n * off, far = face - n * (off + thick), low = fmin(near, far);
    const struct vec3 origin = along_x ? vec3_make(s[0], low, z[0]) : vec3_make(low, s[0], z[0]);
    const struct vec3 x = vec3_make(1, 0, 0);
    return along_x ? put_box(f, origin, x, s[1] - s[0], thick, z[1] - z[0])
                   : put_box(f, origin, x, thick, s[1] - s[0], z[1] - z[0]);
}

static enum status put_filling(struct ifc *f, const struct model_opening *o, const struct model_wall *w, int opening)
{
    char width[40], height[40], rest[160], name[300];
    if (o->kind == MODEL_PASSAGE && !o->closed) return ST_OK;
    const bool window = o->kind == MODEL_WINDOW;
    const double thick = fmin(0.04, w->thickness);
    const double at = window ? w->thickness - thick : (w->thickness - thick) / 2;
    snprintf(rest, sizeof rest, ",%s,%s,%s,$,$", real(height, o->z[1] - o->z[0]), real(width, fabs(o->s[1] - o->s[0])),
             window ? ".WINDOW." : ".DOOR.");
    const int shape = put_wall_box(f, w, o->s, o->z, at, thick);
    const int id = put_element(f, window ? "IFCWINDOW" : "IFCDOOR", o->name, shape, rest);
    snprintf(name, sizeof name, "fills %s", o->name);
    begin(f, "IFCRELFILLSELEMENT", name);
    fprintf(f->to, ",$,#%d,#%d);\n", opening, id);
    return keep(f, &f->contained, id);
}

static enum status put_opening(struct ifc *f, const struct model_opening *o, const struct model_wall *w, int wall)
{
    static const double beyond = 0.01; /* past both faces, so that nothing thin stays */
    char name[300];
    const int shape = put_wall_box(f, w, o->s, o->z, -beyond, w->thickness + 2 * beyond);
    const int id = put_element(f, "IFCOPENINGELEMENT", o->name, shape, ",.OPENING.");
    snprintf(name, sizeof name, "voids %s", o->name);
    begin(f, "IFCRELVOIDSELEMENT", name);
    fprintf(f->to, ",$,#%d,#%d);\n", wall, id);
    return put_filling(f, o, w, id);
}

/* Whether a face's name is KIND/NAME or KIND/NAME/PART. */
static bool is_face_of(const char *face, const char *kind, const char *name)
{
    const size_t k = strlen(kind), n = strlen(name);
    return !strncmp(face, kind, k) && face[k] == '/' && !strncmp(face + k + 1, name, n) &&
           (!face[k + 1 + n] || face[k + 1 + n] == '/');
}

/* A shape of all triangles of an item's faces; 0: there are none. */
static int put_faces_of(struct ifc *f, const char *kind, const char *name)
{
    struct ids sets = {0};
    for (int i = 0; i < f->s->mesh->face_count; i++) {
        const int *first = f->s->faces->first;
        if (is_face_of(solid_face_name(f->s->mesh, i), kind, name) && first[i] < first[i + 1])
            keep(f, &sets, put_triangles(f, first[i], first[i + 1], -1));
    }
    int shape = 0;
    if (sets.count) {
        const int body = next_id(f);
        fprintf(f->to, "#%d=IFCSHAPEREPRESENTATION(#%d,'Body','Tessellation',", body, f->context);
        put_ids(f, &sets);
        fputs(");\n", f->to);
        shape = put(f, "IFCPRODUCTDEFINITIONSHAPE($,$,(#%d))", body);
    }
    free(sets.list);
    return shape;
}

static enum status put_walls(struct ifc *f)
{
    const struct model_plan *plan = f->s->plan;
    enum status st = ST_OK;
    for (int i = 0; !st && i < plan->wall_count; i++) {
        const struct model_wall *w = &plan->walls[i];
        double reach[2];
        wall_reach(reach, plan, w);
        const double z[2] = {w->foot, w->top};
        const bool box = is_along_axis(w);
        const int shape = box ? put_wall_box(f, w, reach, z, 0, w->thickness) : put_faces_of(f, "wall", w->name);
        if (!shape) continue;
        const int id = put_element(f, "IFCWALL", w->name, shape, ",.STANDARD.");
        st = keep(f, &f->contained, id);
        for (int o = 0; !st && box && o < plan->opening_count; o++)
            if (plan->openings[o].wall == i) st = put_opening(f, &plan->openings[o], w, id);
    }
    return st;
}

/* ----------------------------------------------------------------------------------------- rooms, boxes, coverings */

static enum status put_rooms(struct ifc *f)
{
    static const double slab = 0.2; /* metres: the plan does not say how thick slabs are */
    const struct model_plan *plan = f->s->plan;
    enum status st = ST_OK;
    for (int i = 0; !st && i < plan->room_count; i++) {
        const struct model_room *r = &plan->rooms[i];
        double ceiling = INFINITY;
        for (int k = 0; k < r->corner_count; k++)
            ceiling = fmin(ceiling, model_room_ceiling(r, r->corners[k].x, r->corners[k].y));
        if (r->corner_count < 3 || !(ceiling > r->floor)) continue;
        const int floor = put_element(f, "IFCSLAB", r->name, put_plate(f, r, r->floor - slab, slab), ",.FLOOR.");
        st = keep(f, &f->contained, floor);
        char name[300];
        snprintf(name, sizeof name, "%s ceiling", r->name);
        const int above = put_element(f, "IFCSLAB", name, put_plate(f, r, ceiling, slab), ",.ROOF.");
        if (!st) st = keep(f, &f->contained, above);
        const int shape = put_plate(f, r, r->floor, ceiling - r->floor);
        const int space = begin(f, "IFCSPACE", r->name);
        fprintf(f->to, ",$,$,#%d,#%d,$,.ELEMENT.,.SPACE.,$);\n", f->placement, shape);
        if (!st) st = keep(f, &f->spaces, space);
    }
    return st;
}

static enum status put_boxes(struct ifc *f)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < f->s->plan->box_count; i++) {
        const struct model_box *b = &f->s->plan->boxes[i];
        const double turn = b->turn * M_PI / 180, dx = b->high.x - b->low.x, dy = b->high.y - b->low.y;
        const struct vec3 x = vec3_make(cos(turn), sin(turn), 0), y = vec3_make(-x.y, x.x, 0);
        struct vec3 at = vec3_make((b->low.x + b->high.x) / 2, (b->low.y + b->high.y) / 2, b->low.z);
        at = vec3_sub(at, vec3_add(vec3_scale(x, dx / 2), vec3_scale(y, dy / 2)));
        const int shape = put_box(f, at, x, dx, dy, b->high.z - b->low.z);
        st = keep(f, &f->contained, put_element(f, "IFCBUILDINGELEMENTPROXY", b->name, shape, ",.NOTDEFINED."));
    }
    return st;
}

static const char *covering_type(const char *face)
{
    if (!strncmp(face, "floor/", 6)) return ",.FLOORING.";
    if (!strncmp(face, "ceiling/", 8)) return ",.CEILING.";
    return ",.CLADDING.";
}

/* The textured triangles of a face, one set for each page. */
static enum status put_covering(struct ifc *f, int face)
{
    const struct export_faces *all = f->s->faces;
    struct ids sets = {0};
    enum status st = ST_OK;
    for (int i = all->first[face], end; !st && i < all->first[face + 1]; i = end) {
        const int page = all->triangles[i].material;
        end = i + 1;
        while (end < all->first[face + 1] && all->triangles[end].material == page) end++;
        if (page >= 0) st = keep(f, &sets, put_triangles(f, i, end, page));
    }
    if (!st && sets.count) {
        char name[1100];
        const int body = next_id(f);
        fprintf(f->to, "#%d=IFCSHAPEREPRESENTATION(#%d,'Body','Tessellation',", body, f->context);
        put_ids(f, &sets);
        fputs(");\n", f->to);
        const int shape = put(f, "IFCPRODUCTDEFINITIONSHAPE($,$,(#%d))", body);
        /* faces of one name are told apart by their number */
        snprintf(name, sizeof name, "%s %d", solid_face_name(f->s->mesh, face), face);
        st = keep(f, &f->contained,
                  put_element(f, "IFCCOVERING", name, shape, covering_type(solid_face_name(f->s->mesh, face))));
    }
    free(sets.list);
    return st;
}

static enum status put_body(struct ifc *f)
{
    put_head(f);
    put_pages(f);
    enum status st = put_walls(f);
    if (!st) st = put_rooms(f);
    if (!st) st = put_boxes(f);
    for (int i = 0; !st && i < f->s->mesh->face_count; i++) st = put_covering(f, i);
    if (!st && f->contained.count) {
        begin(f, "IFCRELCONTAINEDINSPATIALSTRUCTURE", "elements");
        fputs(",$,", f->to);
        put_ids(f, &f->contained);
        fprintf(f->to, ",#%d);\n", f->storey);
    }
    if (!st && f->spaces.count) put_aggregate(f, f->storey, "storey", &f->spaces);
    return st;
}

enum status write_ifc(const struct export_scene *s, struct err *err)
{
    struct ifc f = {.s = s, .err = err};
    struct outfile out = {0};
    char path[FILE_PATH];
    f.styles = calloc((size_t)s->page_count + 1, sizeof *f.styles);
    f.maps = calloc((size_t)s->page_count + 1, sizeof *f.maps);
    enum status st = f.styles && f.maps ? file_path(path, s->out, "model.ifc", "", err)
                                        : err_nomem(err, "pages", (size_t)s->page_count * sizeof *f.styles);
    if (!st) st = outfile_open(&out, path, err);
    if (!st) {
        f.to = out.fp;
        fputs("ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION(('ViewDefinition [ReferenceView]'),'2;1');\nFILE_NAME(", f.to);
        ifc_text(f.to, s->name);
        /* no date: the same model gives the same bytes */
        fputs(",'1970-01-01T00:00:00',(''),(''),'remodel " REMODEL_VERSION "','remodel " REMODEL_VERSION
              "','');\nFILE_SCHEMA(('IFC4'));\nENDSEC;\nDATA;\n",
              f.to);
        st = put_body(&f);
        fputs("ENDSEC;\nEND-ISO-10303-21;\n", f.to);
        if (!st) st = outfile_commit(&out, err);
    }
    outfile_discard(&out);
    free(f.contained.list);
    free(f.spaces.list);
    free(f.styles);
    free(f.maps);
    return st;
}
