/* ifc_fillings.c - openings in walls and slabs, and what is in them: leaves and panes as build_model made them.
 *
 * A pane is a body of the model of its own. A leaf is a part of the body of the walls, whose edges are hidden in the
 * reveals; so it is the box between its two faces. */
#include <math.h>
#include <string.h>

#include "stages/export_model/ifc.h"

/* The bounding rectangle of the faces of a name in the axes of the first one's plane; NULL: there is no such face. */
static const struct solid_face *face_rectangle(double u[2], double v[2], struct vec3 axes[2], const struct ifc *f,
                                               const char *name)
{
    const struct solid_mesh *mesh = f->s->mesh;
    const struct solid_face *first = NULL;
    u[0] = v[0] = INFINITY;
    u[1] = v[1] = -INFINITY;
    for (int i = 0; i < mesh->face_count; i++) {
        const struct solid_face *face = &mesh->faces[i];
        if (strcmp(solid_face_name(mesh, i), name)) continue;
        if (!first) {
            first = face;
            axes[0] = fabs(face->normal.z) < 0.999 ? vec3_normalize(vec3_cross(vec3_make(0, 0, 1), face->normal))
                                                   : vec3_make(1, 0, 0);
            axes[1] = vec3_cross(face->normal, axes[0]);
        }
        const int begin = mesh->loops[face->loop].half_edge;
        int h = begin;
        do {
            const struct vec3 p = mesh->vertices[mesh->half_edges[h].origin].p;
            u[0] = fmin(u[0], vec3_dot(axes[0], p));
            u[1] = fmax(u[1], vec3_dot(axes[0], p));
            v[0] = fmin(v[0], vec3_dot(axes[1], p));
            v[1] = fmax(v[1], vec3_dot(axes[1], p));
            h = mesh->half_edges[h].next;
        } while (h != begin);
    }
    return first;
}

/* The box between a leaf's faces. */
static int leaf_shape(struct ifc *f, const char *kind, const char *name)
{
    char in[300], out[300];
    double u[2], v[2], unused[2][2];
    struct vec3 axes[2], other[2];
    snprintf(in, sizeof in, "%s/%s/leaf-in", kind, name);
    snprintf(out, sizeof out, "%s/%s/leaf-out", kind, name);
    const struct solid_face *front = face_rectangle(u, v, axes, f, in);
    const struct solid_face *back = face_rectangle(unused[0], unused[1], other, f, out);
    if (!front || !back || vec3_dot(front->normal, back->normal) > -1 + 1e-9) return 0;
    const double depth = front->offset + back->offset;
    const struct vec3 behind = vec3_scale(front->normal, -1);
    double corners[4][2] = {{u[0], v[0]}, {u[1], v[0]}, {u[1], v[1]}, {u[0], v[1]}};
    const struct ifc_outline o = {corners,       4,    vec3_scale(behind, back->offset), axes[0], front->normal,
                                  front->normal, depth};
    return depth > 0 ? ifc_extrusion(f, &o) : 0;
}

int ifc_filling_shape(struct ifc *f, const char *kind, const char *name)
{
    const int glass = ifc_faces_of(f, "glass", name);
    return glass ? glass : leaf_shape(f, kind, name);
}

int ifc_opening(struct ifc *f, const char *name, int element, int shape)
{
    char relation[300];
    const int id = ifc_element(f, "IFCOPENINGELEMENT", name, shape, ",.OPENING.");
    snprintf(relation, sizeof relation, "voids %s", name);
    ifc_begin(f, "IFCRELVOIDSELEMENT", relation);
    fprintf(f->to, ",$,#%d,#%d);\n", element, id);
    return id;
}

static void put_filling_quantities(struct ifc *f, int filling, const char *kind, const char *name, const double size[2])
{
    const struct ifc_quantity list[] = {{IFC_LENGTH, "Width", size[0]},
                                        {IFC_LENGTH, "Height", size[1]},
                                        {IFC_LENGTH, "Perimeter", 2 * (size[0] + size[1])},
                                        {IFC_AREA, "Area", size[0] * size[1]}};
    ifc_quantities(f, filling, strcmp(kind, "IFCWINDOW") ? "Qto_DoorBaseQuantities" : "Qto_WindowBaseQuantities", name,
                   list, 4);
}

enum status ifc_filling(struct ifc *f, const char *kind, const char *name, int opening, int shape, const double size[2],
                        const char *type)
{
    char width[40], height[40], rest[160], relation[300];
    snprintf(rest, sizeof rest, ",%s,%s,%s,$,$", ifc_real(height, size[1]), ifc_real(width, size[0]), type);
    const int id = ifc_element(f, kind, name, shape, rest);
    if (opening) {
        snprintf(relation, sizeof relation, "fills %s", name);
        ifc_begin(f, "IFCRELFILLSELEMENT", relation);
        fprintf(f->to, ",$,#%d,#%d);\n", opening, id);
    }
    put_filling_quantities(f, id, kind, name, size);
    return ifc_keep(f, &f->contained, id);
}
