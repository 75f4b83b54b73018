/* export_objects.c - see export_objects.h. */
#include "stages/export_model/export_objects.h"

#include <stdlib.h>

enum status export_objects_read(struct export_objects *o, const char *path, const char *scene, struct provenance *prov,
                                struct err *err)
{
    if (!path || object_list_read(&o->list, path, prov, err)) return err->status;
    o->meshes = calloc((size_t)o->list.count + 1, sizeof *o->meshes);
    if (!o->meshes) err_nomem(err, "objects", (size_t)o->list.count * sizeof *o->meshes);
    if (!err->status && o->list.count && !scene)
        err_set(err, ST_USAGE, "--objects wants --scene, the folder of the objects' meshes.");
    for (int i = 0; !err->status && i < o->list.count; i++)
        object_mesh_read(&o->meshes[i], &o->list.items[i], scene, err);
    return err->status;
}

void export_objects_release(struct export_objects *o)
{
    for (int i = 0; o->meshes && i < o->list.count; i++) obj_mesh_release(&o->meshes[i]);
    free(o->meshes);
    object_list_release(&o->list);
    *o = (struct export_objects){0};
}

struct vec3 export_objects_normal(const struct vec3 t[3])
{
    return vec3_normalize(vec3_cross(vec3_sub(t[1], t[0]), vec3_sub(t[2], t[0])));
}
