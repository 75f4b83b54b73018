/* textures.c - see textures.h. */
#include "stages/evaluate/texture/textures.h"

#include <dirent.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"

enum status textures_folder(char folder[FILE_PATH], const struct evaluation *e, const char *name, struct err *err)
{
    char vdta[FILE_PATH];
    if (!name) return file_path(folder, e->folder, "vita", "", err);
    return file_path(vdta, e->folder, "vdta", "", err) ? err->status : file_path(folder, vdta, name, "", err);
}

static enum status find_viewpoints(struct textures *t, struct evaluation *e, struct err *err)
{
    struct dirent **entries = NULL;
    char folder[FILE_PATH];
    enum status st = file_path(folder, e->folder, "vdta", "", err);
    if (st || !path_is_folder(folder)) return st;
    const int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0) return err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        char at[FILE_PATH], path[FILE_PATH];
        if (!st && *name != '.' && strlen(name) < sizeof *t->viewpoints) {
            st = textures_folder(at, e, name, err);
            if (!st) st = product_path_in(path, at, PRODUCT_ATLAS, NULL, err);
            if (!st && path_is_file(path) &&
                !(st = array_append(&t->viewpoints, (size_t)t->viewpoint_count, sizeof *t->viewpoints, "viewpoints",
                                    err)))
                snprintf(t->viewpoints[t->viewpoint_count++], sizeof *t->viewpoints, "%s", name);
        }
        free(entries[i]);
    }
    free(entries);
    return st;
}

static enum status read_model(struct textures *t, struct evaluation *e, struct err *err)
{
    char path[FILE_PATH];
    enum status st = evaluation_path(path, e, PRODUCT_MODEL, NULL, err);
    if (!st) st = solid_mesh_read(&t->mesh, path, e->prov, err);
    for (int i = 0; !st && i < t->mesh.name_count; i++)
        if (t->mesh.names[i].id >= t->ids) t->ids = t->mesh.names[i].id + 1;
    if (!st && !(t->face_of_id = malloc(((size_t)t->ids + 1) * sizeof *t->face_of_id)))
        st = err_nomem(err, "faces", (size_t)t->ids * sizeof *t->face_of_id);
    for (int i = 0; !st && i < t->ids; i++) t->face_of_id[i] = -1;
    for (int i = t->mesh.face_count; !st && i-- > 0;) t->face_of_id[solid_face_id(&t->mesh, i)] = i;
    return st;
}

enum status textures_find(struct textures *t, struct evaluation *e, struct err *err)
{
    char folder[FILE_PATH], path[FILE_PATH];
    *t = (struct textures){.ids = 1};
    enum status st = find_viewpoints(t, e, err);
    if (!st) st = textures_folder(folder, e, NULL, err);
    if (!st) st = product_path_in(path, folder, PRODUCT_ATLAS, NULL, err);
    t->vita = !st && path_is_file(path);
    if (!st && (t->vita || t->viewpoint_count)) st = read_model(t, e, err);
    return st;
}

void textures_release(struct textures *t)
{
    free(t->viewpoints);
    free(t->face_of_id);
    solid_mesh_release(&t->mesh);
    *t = (struct textures){0};
}

enum status textures_read(struct atlas *a, struct evaluation *e, const char *name, struct err *err)
{
    char folder[FILE_PATH];
    const enum status st = textures_folder(folder, e, name, err);
    return st ? st : atlas_read(a, folder, e->prov, err);
}

int textures_face(const struct textures *t, int id) { return id > 0 && id < t->ids ? t->face_of_id[id] : -1; }
