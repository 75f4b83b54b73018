/* objects.c - see objects.h. */
#include "stages/build_model/building/objects.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/math/numbers.h"

void object_matrix(double m[3][4], const struct script_object *placed)
{
    const double turn = fmod(placed->turn, 360) * DEGREE, *by = placed->scale;
    double c = cos(turn), s = sin(turn);
    if (fmod(placed->turn, 90) == 0) c = round(c), s = round(s);
    const double rows[3][3] = {{c * by[0], -s * by[1], 0}, {s * by[0], c * by[1], 0}, {0, 0, by[2]}};
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++) m[i][k] = rows[i][k] + 0.0; /* -0 is 0 */
        m[i][3] = placed->at[i] + 0.0;
    }
}

/* Where the object is, for a person to check. */
static void log_place(const struct object *o, const struct obj_mesh *mesh)
{
    struct vec3 low = mesh->triangles[0][0], high = low;
    for (int i = 0; i < 3 * mesh->count; i++) {
        const struct vec3 p = mesh->triangles[i / 3][i % 3];
        low = vec3_make(fmin(low.x, p.x), fmin(low.y, p.y), fmin(low.z, p.z));
        high = vec3_make(fmax(high.x, p.x), fmax(high.y, p.y), fmax(high.z, p.z));
    }
    log_note("object %s: %d triangle%s, from %.4g %.4g %.4g to %.4g %.4g %.4g", o->name, mesh->count,
             mesh->count == 1 ? "" : "s", low.x, low.y, low.z, high.x, high.y, high.z);
}

static enum status check_mesh(struct object *o, const struct plan_object *p, const char *scene, struct err *err)
{
    struct obj_mesh mesh = {0};
    char path[FILE_PATH];
    if (!scene)
        return err_set(err, ST_DATA, "%s:%d: the mesh %s is in the scene's folder, which is unknown; give --scene.",
                       p->path, p->line, p->file);
    if (file_path(path, scene, p->file, "", err)) return err->status;
    if (!path_is_file(path))
        return err_set(err, ST_DATA, "%s:%d: found no file %s, wanted the mesh of the object %s; copy it there.",
                       p->path, p->line, path, p->name);
    if (!hash_file(o->hash, path, err)) obj_mesh_read(&mesh, path, err);
    if (err->status) return err_context(err, "%s:%d", p->path, p->line);
    obj_mesh_move(&mesh, o->matrix);
    log_place(o, &mesh);
    obj_mesh_release(&mesh);
    return ST_OK;
}

enum status objects_make(struct object_list *list, const struct plan *plan, const char *scene, struct err *err)
{
    for (int i = 0; i < plan->object_count; i++) {
        const struct plan_object *p = &plan->objects[i];
        if (p->removed) continue;
        if (array_append(&list->items, (size_t)list->count, sizeof *list->items, "objects", err)) return err->status;
        struct object *o = &list->items[list->count++];
        *o = (struct object){.name = strdup(p->name), .file = strdup(p->file), .brdf = p->placed.brdf};
        if (!o->name || !o->file) return err_nomem(err, "an object", strlen(p->name) + strlen(p->file));
        object_matrix(o->matrix, &p->placed);
        if (check_mesh(o, p, scene, err)) return err->status;
    }
    return ST_OK;
}
