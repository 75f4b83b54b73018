/* scene_inputs.c - reads parts of a scene; see scene_inputs.h. */
#include "common/model/scene_inputs.h"

#include "common/product/product.h"

static enum status read_lenses(struct lens_list *lenses, const char *views, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, views, PRODUCT_LENSES, NULL, err)) return err->status;
    return lens_list_read(lenses, path, prov, err);
}

enum status scene_inputs_read(struct scene_inputs *in, unsigned wanted, const struct scene_files *files,
                              struct provenance *prov, struct err *err)
{
    *in = (struct scene_inputs){0};
    if ((wanted & SCENE_POINTS && camera_set_read(&in->set, files->views, prov, err)) ||
        (wanted & SCENE_CAMERAS && camera_set_read_cameras(&in->set, files->views, prov, err)) ||
        (wanted & SCENE_LENSES && read_lenses(&in->lenses, files->views, prov, err)) ||
        (wanted & SCENE_AXES && model_axes_read(&in->axes, files->axes, prov, err)) ||
        (wanted & SCENE_MESH && solid_mesh_read(&in->mesh, files->mesh, prov, err)) ||
        (wanted & SCENE_PLAN && model_plan_read(&in->plan, files->plan, prov, err)))
        return err->status;
    for (int i = 0; wanted & SCENE_MODEL_VIEWS && i < in->set.view_count; i++)
        in->set.views[i] = model_from_world_view(&in->axes, &in->set.views[i]);
    return ST_OK;
}

void scene_inputs_release(struct scene_inputs *in)
{
    if (!in) return;
    camera_set_release(&in->set);
    lens_list_release(&in->lenses);
    solid_mesh_release(&in->mesh);
    model_plan_release(&in->plan);
    *in = (struct scene_inputs){0};
}
