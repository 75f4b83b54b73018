/* ifc_shapes.c - shapes in IFC4: extrusions, polyhedra, triangles with texture; see ifc.h. */
#include <stdlib.h>
#include <string.h>

#include "stages/export_model/ifc.h"

int ifc_representation(struct ifc *f, const char *identifier, const char *type, const struct ifc_ids *items)
{
    const int id = ifc_next(f);
    fprintf(f->to, "#%d=IFCSHAPEREPRESENTATION(#%d,'%s','%s',", id, f->context, identifier, type);
    ifc_put_ids(f, items);
    fputs(");\n", f->to);
    return id;
}

/* The shape of one representation item. */
static int put_shape(struct ifc *f, const char *type, const struct ifc_ids *items)
{
    const int body = ifc_representation(f, "Body", type, items);
    return ifc_put(f, "IFCPRODUCTDEFINITIONSHAPE($,$,(#%d))", body);
}

int ifc_tessellation(struct ifc *f, const struct ifc_ids *sets) { return put_shape(f, "Tessellation", sets); }

int ifc_extrusion(struct ifc *f, const struct ifc_outline *o)
{
    char u[40], v[40];
    struct ifc_ids points = {0};
    for (int i = 0; i < o->count; i++)
        ifc_keep(
            f, &points,
            ifc_put(f, "IFCCARTESIANPOINT((%s,%s))", ifc_real(u, o->corners[i][0]), ifc_real(v, o->corners[i][1])));
    ifc_keep(f, &points, points.count ? points.list[0] : 0);
    const int line = ifc_next(f);
    fprintf(f->to, "#%d=IFCPOLYLINE(", line);
    ifc_put_ids(f, &points);
    fputs(");\n", f->to);
    free(points.list);
    const int profile = ifc_put(f, "IFCARBITRARYCLOSEDPROFILEDEF(.AREA.,$,#%d)", line);
    const int origin = ifc_point(f, o->origin), z = ifc_direction(f, o->axis), x = ifc_direction(f, o->x);
    const int place = ifc_put(f, "IFCAXIS2PLACEMENT3D(#%d,#%d,#%d)", origin, z, x);
    const struct vec3 y = vec3_cross(o->axis, o->x); /* the direction in the frame of the profile */
    const struct vec3 along = {vec3_dot(o->x, o->along), vec3_dot(y, o->along), vec3_dot(o->axis, o->along)};
    const int direction = ifc_direction(f, along);
    int solid = ifc_put(f, "IFCEXTRUDEDAREASOLID(#%d,#%d,#%d,%s)", profile, place, direction, ifc_real(u, o->depth));
    return put_shape(f, "SweptSolid", &(struct ifc_ids){&solid, 1});
}

int ifc_box(struct ifc *f, struct vec3 origin, struct vec3 x, double width, double depth, double height)
{
    double corners[4][2] = {{0, 0}, {width, 0}, {width, depth}, {0, depth}};
    const struct vec3 up = {0, 0, 1};
    const struct ifc_outline o = {corners, 4, origin, x, up, up, height};
    return ifc_extrusion(f, &o);
}

int ifc_prism(struct ifc *f, const double (*corners)[2], int count, const double plane[3], double height)
{
    const struct vec3 up = {0, 0, 1}, axis = vec3_normalize(vec3_make(-plane[1], -plane[2], 1));
    const struct vec3 x = vec3_normalize(vec3_make(1, 0, plane[1])), y = vec3_cross(axis, x);
    double(*local)[2] = malloc(((size_t)count + 1) * sizeof *local);
    if (!local) return err_nomem(f->err, "an outline", (size_t)count * sizeof *local), 0;
    for (int i = 0; i < count; i++) { /* from the point of the plane over the origin */
        const struct vec3 p = {corners[i][0], corners[i][1], plane[1] * corners[i][0] + plane[2] * corners[i][1]};
        local[i][0] = vec3_dot(x, p);
        local[i][1] = vec3_dot(y, p);
    }
    const struct ifc_outline o = {local, count, {0, 0, plane[0]}, x, axis, up, height};
    const int shape = ifc_extrusion(f, &o);
    free(local);
    return shape;
}

/* The number of a point in the list, from 1; it is added if it is new. */
static int point_number(struct vec3 *points, int *count, struct vec3 p)
{
    for (int i = 0; i < *count; i++)
        if (vec3_length(vec3_sub(points[i], p)) < 1e-9) return i + 1;
    points[(*count)++] = p;
    return *count;
}

int ifc_polyhedron(struct ifc *f, const struct vec3 *corners, const int *ends, int count)
{
    const int total = count ? ends[count - 1] : 0;
    struct vec3 *points = malloc(((size_t)total + 1) * sizeof *points);
    struct ifc_ids faces = {0};
    int point_count = 0;
    if (!points) return err_nomem(f->err, "corners", (size_t)total * sizeof *points), 0;
    for (int i = 0, k = 0; i < count; i++) {
        const int id = ifc_next(f), first = k;
        fprintf(f->to, "#%d=IFCINDEXEDPOLYGONALFACE((", id);
        for (; k < ends[i]; k++)
            fprintf(f->to, "%s%d", k > first ? "," : "", point_number(points, &point_count, corners[k]));
        fputs("));\n", f->to);
        ifc_keep(f, &faces, id);
    }
    const int list = ifc_points(f, points, point_count);
    int set = ifc_next(f);
    fprintf(f->to, "#%d=IFCPOLYGONALFACESET(#%d,.T.,", set, list);
    ifc_put_ids(f, &faces);
    fputs(",$);\n", f->to);
    free(points);
    free(faces.list);
    return ifc_tessellation(f, &(struct ifc_ids){&set, 1});
}

static void put_points(struct ifc *f, int first, int end)
{
    char x[40], y[40], z[40];
    fputs("((", f->to);
    for (int i = first; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const struct vec3 p = f->s->faces->triangles[i].p[k];
            fprintf(f->to, "%s(%s,%s,%s)", i > first || k ? "," : "", ifc_real(x, p.x), ifc_real(y, p.y),
                    ifc_real(z, p.z));
        }
    fputs("))", f->to);
}

static void put_indices(struct ifc *f, int triangles)
{
    fputc('(', f->to);
    for (int i = 0; i < triangles; i++) fprintf(f->to, "%s(%d,%d,%d)", i ? "," : "", 3 * i + 1, 3 * i + 2, 3 * i + 3);
    fputc(')', f->to);
}

int ifc_triangles(struct ifc *f, int first, int end, int page)
{
    const int list = ifc_next(f);
    fprintf(f->to, "#%d=IFCCARTESIANPOINTLIST3D", list);
    put_points(f, first, end);
    fputs(";\n", f->to);
    const int set = ifc_next(f);
    fprintf(f->to, "#%d=IFCTRIANGULATEDFACESET(#%d,$,.F.,", set, list);
    put_indices(f, end - first);
    fputs(",$);\n", f->to);
    if (page < 0) return set;
    const int vertices = ifc_next(f);
    char u[40], v[40];
    fprintf(f->to, "#%d=IFCTEXTUREVERTEXLIST((", vertices);
    for (int i = first; i < end; i++)
        for (int k = 0; k < 3; k++) {
            const double *uv = f->s->faces->triangles[i].uv[k];
            fprintf(f->to, "%s(%s,%s)", i > first || k ? "," : "", ifc_real(u, uv[0]), ifc_real(v, 1 - uv[1]));
        }
    fputs("));\n", f->to);
    const int map = ifc_next(f);
    fprintf(f->to, "#%d=IFCINDEXEDTRIANGLETEXTUREMAP((#%d),#%d,#%d,", map, f->maps[page], set, vertices);
    put_indices(f, end - first);
    fputs(");\n", f->to);
    ifc_put(f, "IFCSTYLEDITEM(#%d,(#%d),$)", set, f->styles[page]);
    return set;
}

/* Whether a face's name is KIND/NAME or KIND/NAME/PART. */
static bool is_face_of(const char *face, const char *kind, const char *name)
{
    const size_t k = strlen(kind), n = strlen(name);
    return !strncmp(face, kind, k) && face[k] == '/' && !strncmp(face + k + 1, name, n) &&
           (!face[k + 1 + n] || face[k + 1 + n] == '/');
}

int ifc_faces_of(struct ifc *f, const char *kind, const char *name)
{
    struct ifc_ids sets = {0};
    for (int i = 0; i < f->s->mesh->face_count; i++) {
        const int *first = f->s->faces->first;
        if (is_face_of(solid_face_name(f->s->mesh, i), kind, name) && first[i] < first[i + 1])
            ifc_keep(f, &sets, ifc_triangles(f, first[i], first[i + 1], -1));
    }
    const int shape = sets.count ? ifc_tessellation(f, &sets) : 0;
    free(sets.list);
    return shape;
}
