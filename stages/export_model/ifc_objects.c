/* ifc_objects.c - synthetic objects in IFC4: an IfcFurniture of triangles each, in its colour. */
#include <stdlib.h>

#include "stages/export_model/ifc.h"

static void put_points(struct ifc *f, const struct obj_mesh *mesh)
{
    char x[40], y[40], z[40];
    fputs("((", f->to);
    for (int i = 0; i < 3 * mesh->count; i++) {
        const struct vec3 p = mesh->triangles[i / 3][i % 3];
        fprintf(f->to, "%s(%s,%s,%s)", i ? "," : "", ifc_real(x, p.x), ifc_real(y, p.y), ifc_real(z, p.z));
    }
    fputs("))", f->to);
}

static int put_style(struct ifc *f, const char *name, struct rgb albedo)
{
    char r[40], g[40], b[40];
    const int colour =
        ifc_put(f, "IFCCOLOURRGB($,%s,%s,%s)", ifc_real(r, albedo.r), ifc_real(g, albedo.g), ifc_real(b, albedo.b));
    const int shading = ifc_put(f, "IFCSURFACESTYLESHADING(#%d,0.)", colour), style = ifc_next(f);
    fprintf(f->to, "#%d=IFCSURFACESTYLE(", style);
    ifc_text(f->to, name);
    fprintf(f->to, ",.BOTH.,(#%d));\n", shading);
    return style;
}

enum status ifc_objects(struct ifc *f)
{
    const struct export_objects *objects = f->s->objects;
    for (int i = 0; !f->err->status && i < objects->list.count; i++) {
        const struct object *o = &objects->list.items[i];
        const struct obj_mesh *mesh = &objects->meshes[i];
        const int list = ifc_next(f);
        fprintf(f->to, "#%d=IFCCARTESIANPOINTLIST3D", list);
        put_points(f, mesh);
        fputs(";\n", f->to);
        int set = ifc_next(f);
        fprintf(f->to, "#%d=IFCTRIANGULATEDFACESET(#%d,$,.F.,(", set, list);
        for (int k = 0; k < mesh->count; k++)
            fprintf(f->to, "%s(%d,%d,%d)", k ? "," : "", 3 * k + 1, 3 * k + 2, 3 * k + 3);
        fputs("),$);\n", f->to);
        ifc_put(f, "IFCSTYLEDITEM(#%d,(#%d),$)", set, put_style(f, o->name, o->brdf.albedo));
        const int shape = ifc_tessellation(f, &(struct ifc_ids){&set, 1});
        ifc_keep(f, &f->contained, ifc_element(f, "IFCFURNITURE", o->name, shape, ",.NOTDEFINED."));
    }
    return f->err->status;
}
