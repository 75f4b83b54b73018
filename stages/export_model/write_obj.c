/* write_obj.c - Wavefront OBJ, model.obj with model.mtl: an object for each body, a group for each face name, then the
 * synthetic objects, then the luminous openings of lamps, then the furniture; z is up. */
#include <stdio.h>

#include "stages/export_model/writers.h"

#include "common/product/product.h"

static void put_material(FILE *to, const struct export_triangle *t)
{
    if (t->material >= 0)
        fprintf(to, "usemtl page%d\n", t->material);
    else if (t->material == MATERIAL_GLASS)
        fputs("usemtl glass\n", to);
    else
        fprintf(to, "usemtl colour_%.6g_%.6g_%.6g\n", (double)t->albedo[0], (double)t->albedo[1], (double)t->albedo[2]);
}

static bool same_material(const struct export_triangle *a, const struct export_triangle *b)
{
    return a->material == b->material && a->albedo[0] == b->albedo[0] && a->albedo[1] == b->albedo[1] &&
           a->albedo[2] == b->albedo[2];
}

static void put_corners(FILE *to, const struct vec3 p[3])
{
    for (int k = 0; k < 3; k++) fprintf(to, "v %.9g %.9g %.9g\n", p[k].x, p[k].y, p[k].z);
}

static void put_faces(FILE *to, const struct export_scene *s)
{
    const struct export_faces *f = s->faces;
    int body = -1;
    for (int i = 0; i < f->count; i++) {
        const struct export_triangle *t = &f->triangles[i], *last = i ? t - 1 : NULL;
        const struct solid_face *face = &s->mesh->faces[t->face];
        const bool first = !last || last->face != t->face;
        if (face->body != body) fprintf(to, "o %s\n", s->mesh->bodies[body = face->body].name);
        if (first) fprintf(to, "g %s\n", solid_face_name(s->mesh, t->face));
        if (first || !same_material(t, last)) put_material(to, t);
        put_corners(to, t->p);
        for (int k = 0; k < 3; k++) fprintf(to, "vt %.9g %.9g\n", t->uv[k][0], 1 - t->uv[k][1]);
        if (first) fprintf(to, "vn %.9g %.9g %.9g\n", face->normal.x, face->normal.y, face->normal.z);
        fprintf(to, "f -3/-3/-1 -2/-2/-1 -1/-1/-1\n");
    }
}

static void put_objects(FILE *to, const struct export_scene *s)
{
    for (int i = 0; i < s->objects->list.count; i++) {
        const struct obj_mesh *mesh = &s->objects->meshes[i];
        fprintf(to, "o object/%s\ng object/%s\nusemtl object_%s\n", s->objects->list.items[i].name,
                s->objects->list.items[i].name, s->objects->list.items[i].name);
        for (int k = 0; k < mesh->count; k++) {
            const struct vec3 n = export_objects_normal(mesh->triangles[k]);
            put_corners(to, mesh->triangles[k]);
            fprintf(to, "vn %.9g %.9g %.9g\nf -3//-1 -2//-1 -1//-1\n", n.x, n.y, n.z);
        }
    }
}

/* Luminous openings, which emit light (Ke); the format has no lamps, so a comment has the rest. */
static void put_lamps(FILE *to, const struct export_scene *s)
{
    for (int i = 0; i < s->lamps->planned.count; i++) {
        const struct planned_lamp *l = &s->lamps->planned.list[i];
        struct vec3 p[PLANNED_LAMP_CORNERS];
        const int count = export_lamps_outline(p, s->lamps, i);
        fprintf(to, "# lamp %s: %s, %.6g lm, at %.9g %.9g %.9g aim %.9g %.9g %.9g\n", l->name, s->lamps->files[i],
                export_lamps_lumens(l), l->at.x, l->at.y, l->at.z, l->down.x, l->down.y, l->down.z);
        fprintf(to, "o lamp/%s\ng lamp/%s\nusemtl lamp_%s\n", l->name, l->name, l->name);
        for (int k = 0; k < count; k++) fprintf(to, "v %.9g %.9g %.9g\n", p[k].x, p[k].y, p[k].z);
        fprintf(to, "vn %.9g %.9g %.9g\nf", l->down.x, l->down.y, l->down.z);
        for (int k = count; k > 0; k--) fprintf(to, " -%d//-1", k);
        fputc('\n', to);
    }
}

/* Curved surfaces, whose triangles share corners. */
static void put_things(FILE *to, const struct export_scene *s)
{
    for (int i = 0; i < s->things->count; i++) {
        const struct export_thing *t = &s->things->things[i];
        const int n = t->mesh.vertex_count;
        fprintf(to, "o thing/%s\ng thing/%s\nusemtl thing_%s\n", t->name, t->name, t->name);
        for (int k = 0; k < n; k++) {
            const struct vec3 p = t->mesh.vertices[k];
            fprintf(to, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
        }
        for (int k = 0; k < t->mesh.triangle_count; k++) { /* -1 is the last corner above */
            const int *c = t->mesh.triangles[k];
            fprintf(to, "f %d %d %d\n", c[0] - n, c[1] - n, c[2] - n);
        }
    }
}

static void put_model(FILE *to, const struct export_scene *s)
{
    put_faces(to, s);
    put_objects(to, s);
    put_lamps(to, s);
    put_things(to, s);
}

static void put_materials(FILE *to, const struct export_scene *s)
{
    fprintf(to, "# pages hold radiance times %.9g, as sRGB; Kd of things is the same, linear\n", s->exposure);
    for (int i = 0; i < s->page_count; i++)
        fprintf(to, "newmtl page%d\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nillum 1\nmap_Kd page%d.png\n", i, i);
    fputs("newmtl glass\nKa 0 0 0\nKd 0.8 0.9 0.95\nKs 0 0 0\nd 0.2\nillum 1\n", to);
    for (int i = 0; i < s->faces->count; i++) {
        const struct export_triangle *t = &s->faces->triangles[i];
        bool known = t->material != MATERIAL_COLOUR;
        for (int k = 0; k < i && !known; k++) known = same_material(t, &s->faces->triangles[k]);
        if (known) continue;
        fprintf(to, "newmtl colour_%.6g_%.6g_%.6g\nKa 0 0 0\nKd %.6g %.6g %.6g\nKs 0 0 0\nillum 1\n",
                (double)t->albedo[0], (double)t->albedo[1], (double)t->albedo[2], (double)t->albedo[0],
                (double)t->albedo[1], (double)t->albedo[2]);
    }
    for (int i = 0; i < s->objects->list.count; i++) {
        const struct object *o = &s->objects->list.items[i];
        fprintf(to, "newmtl object_%s\nKa 0 0 0\nKd %.6g %.6g %.6g\nKs 0 0 0\nillum 1\n", o->name, o->brdf.albedo.r,
                o->brdf.albedo.g, o->brdf.albedo.b);
    }
    for (int i = 0; i < s->lamps->planned.count; i++) {
        double c[3];
        export_lamps_colour(c, &s->lamps->planned.list[i]);
        fprintf(to, "newmtl lamp_%s\nKa 0 0 0\nKd 1 1 1\nKs 0 0 0\nKe %.6g %.6g %.6g\nillum 1\n",
                s->lamps->planned.list[i].name, c[0], c[1], c[2]);
    }
    for (int i = 0; i < s->things->count; i++) {
        double c[3];
        export_thing_colour(c, &s->things->things[i], s->exposure);
        fprintf(to, "newmtl thing_%s\nKa 0 0 0\nKd %.6g %.6g %.6g\nKs 0 0 0\nillum 1\n", s->things->things[i].name,
                c[0], c[1], c[2]);
    }
}

static enum status write_text(const struct export_scene *s, enum product_id id, const char *head,
                              void (*put)(FILE *, const struct export_scene *), struct err *err)
{
    struct outfile out = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, s->out, id, NULL, err)) product_begin(&out, id, path, s->prov, err);
    if (!err->status) {
        fputs(head, out.fp);
        put(out.fp, s);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}

enum status write_obj(const struct export_scene *s, struct err *err)
{
    return write_text(s, PRODUCT_EXPORT_MTL, "", put_materials, err) ||
                   write_text(s, PRODUCT_EXPORT_OBJ, "# z is up\nmtllib model.mtl\n", put_model, err)
               ? err->status
               : ST_OK;
}
