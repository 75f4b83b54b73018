/* ifc_objects.c - synthetic objects and furniture in IFC4: an IfcFurniture of triangles each, in its colour. */
#include <stdio.h>
#include <stdlib.h>

#include "stages/export_model/ifc.h"

enum { MAX_KEY = 300 };

int ifc_style(struct ifc *f, const char *name, const double colour[3])
{
    char r[40], g[40], b[40];
    const int rgb =
        ifc_put(f, "IFCCOLOURRGB($,%s,%s,%s)", ifc_real(r, colour[0]), ifc_real(g, colour[1]), ifc_real(b, colour[2]));
    const int shading = ifc_put(f, "IFCSURFACESTYLESHADING(#%d,0.)", rgb), style = ifc_next(f);
    fprintf(f->to, "#%d=IFCSURFACESTYLE(", style);
    ifc_text(f->to, name);
    fprintf(f->to, ",.BOTH.,(#%d));\n", shading);
    return style;
}

int ifc_triangle_set(struct ifc *f, const struct vec3 *points, int point_count, const int (*corners)[3], int count)
{
    const int list = ifc_points(f, points, point_count);
    const int set = ifc_next(f);
    fprintf(f->to, "#%d=IFCTRIANGULATEDFACESET(#%d,$,.F.,(", set, list);
    for (int k = 0; k < count; k++) {
        const int own[3] = {3 * k, 3 * k + 1, 3 * k + 2}, *c = corners ? corners[k] : own;
        fprintf(f->to, "%s(%d,%d,%d)", k ? "," : "", c[0] + 1, c[1] + 1, c[2] + 1);
    }
    fputs("),$);\n", f->to);
    return set;
}

static enum status put_furniture(struct ifc *f, const char *key, const char *name, int set, const double colour[3])
{
    ifc_put(f, "IFCSTYLEDITEM(#%d,(#%d),$)", set, ifc_style(f, name, colour));
    const int shape = ifc_tessellation(f, &(struct ifc_ids){&set, 1});
    return ifc_keep(f, &f->contained, ifc_element_of(f, "IFCFURNITURE", key, name, shape, ",.NOTDEFINED."));
}

enum status ifc_objects(struct ifc *f)
{
    const struct export_objects *objects = f->s->objects;
    for (int i = 0; !f->err->status && i < objects->list.count; i++) {
        const struct object *o = &objects->list.items[i];
        const struct obj_mesh *mesh = &objects->meshes[i];
        const int set = ifc_triangle_set(f, (const struct vec3 *)mesh->triangles, 3 * mesh->count, NULL, mesh->count);
        const double colour[3] = {o->brdf.albedo.r, o->brdf.albedo.g, o->brdf.albedo.b};
        put_furniture(f, o->name, o->name, set, colour);
    }
    for (int i = 0; !f->err->status && i < f->s->things->count; i++) {
        const struct export_thing *t = &f->s->things->things[i];
        const struct thing_mesh *m = &t->mesh;
        const int set =
            ifc_triangle_set(f, m->vertices, m->vertex_count, (const int(*)[3])m->triangles, m->triangle_count);
        char key[MAX_KEY]; /* an object may have the same name */
        double colour[3];
        snprintf(key, sizeof key, "thing/%s", t->name);
        export_thing_colour(colour, t, f->s->exposure);
        put_furniture(f, key, t->name, set, colour);
    }
    return f->err->status;
}
