/* bake_inputs.c - see bake_inputs.h. */
#include "common/texture/bake_inputs.h"

enum status bake_inputs_read(struct camera_set *set, struct lens_list *lenses, struct model_axes *axes,
                             const char *views, const char *axes_file, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    enum status st = camera_set_read_cameras(set, views, err);
    if (!st) st = camera_set_add_camera_inputs(prov, views, err);
    if (!st) st = provenance_add_in(prov, "views", views, "lenses", ".txt", path, err);
    if (!st) st = lens_list_read(lenses, path, err);
    if (!st) st = model_axes_read(axes, axes_file, err);
    if (!st) st = provenance_add_file(prov, "model/axes.txt", axes_file, err);
    for (int i = 0; !st && i < set->view_count; i++) set->views[i] = model_from_world_view(axes, &set->views[i]);
    return st;
}
