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
    if (file_path(folder, e->folder, "vdta", "", err) || !path_is_folder(folder)) return err->status;
    const int count = scandir(folder, &entries, NULL, alphasort);
    if (count < 0) return err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        const char *name = entries[i]->d_name;
        char at[FILE_PATH], path[FILE_PATH];
        if (!err->status && *name != '.' && strlen(name) < sizeof *t->viewpoints &&
            !textures_folder(at, e, name, err) && !product_path_in(path, at, PRODUCT_ATLAS, NULL, err) &&
            path_is_file(path) &&
            !array_append(&t->viewpoints, (size_t)t->viewpoint_count, sizeof *t->viewpoints, "viewpoints", err))
            snprintf(t->viewpoints[t->viewpoint_count++], sizeof *t->viewpoints, "%s", name);
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

static enum status read_model(struct textures *t, struct evaluation *e, struct err *err)
{
    char path[FILE_PATH];
    if (!evaluation_path(path, e, PRODUCT_MODEL, NULL, err)) solid_mesh_read(&t->mesh, path, e->prov, err);
    for (int i = 0; !err->status && i < t->mesh.name_count; i++)
        if (t->mesh.names[i].id >= t->ids) t->ids = t->mesh.names[i].id + 1;
    if (!err->status && !(t->face_of_id = malloc(((size_t)t->ids + 1) * sizeof *t->face_of_id)))
        err_nomem(err, "faces", (size_t)t->ids * sizeof *t->face_of_id);
    for (int i = 0; !err->status && i < t->ids; i++) t->face_of_id[i] = -1;
    for (int i = t->mesh.face_count; !err->status && i-- > 0;) t->face_of_id[solid_face_id(&t->mesh, i)] = i;
    return err->status;
}

enum status textures_find(struct textures *t, struct evaluation *e, struct err *err)
{
    char folder[FILE_PATH], path[FILE_PATH];
    *t = (struct textures){.ids = 1};
    if (!find_viewpoints(t, e, err) && !textures_folder(folder, e, NULL, err))
        product_path_in(path, folder, PRODUCT_ATLAS, NULL, err);
    t->vita = !err->status && path_is_file(path);
    if (!err->status && (t->vita || t->viewpoint_count)) read_model(t, e, err);
    return err->status;
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
    return textures_folder(folder, e, name, err) || atlas_read(a, folder, e->prov, err) ? err->status : ST_OK;
}

int textures_face(const struct textures *t, int id) { return id > 0 && id < t->ids ? t->face_of_id[id] : -1; }
