/* own_view.c - see own_view.h. */
#include "stages/bake_vdta/own_view.h"

#include "common/product/product.h"

static void scale_depth(float *z, size_t pixels, double scale)
{
    for (size_t i = 0; i < pixels; i++) z[i] = (float)(scale * z[i]);
}

enum status own_view_read(struct own_view *v, const struct source_files *files, const char *reveal,
                          const struct view *camera, double scale, const struct texture_params *params,
                          struct provenance *prov, struct err *err)
{
    const size_t pixels = (size_t)camera->width * (size_t)camera->height;
    char path[FILE_PATH];
    *v = (struct own_view){0};
    if (!source_view_read(&v->view, &v->ids, files, camera, params, prov, err) &&
        !product_path_in(path, reveal, PRODUCT_REVEAL, &(struct product_key){.view = camera->name}, err) &&
        !view_reveal_read(&v->reveal, camera, path, prov, err))
        scale_depth(v->ids.z, pixels, scale);
    for (int k = 0; !err->status && k < v->reveal.layers; k++) scale_depth(v->reveal.z[k], pixels, scale);
    return err->status;
}

void own_view_release(struct own_view *v)
{
    source_view_release(&v->view);
    view_ids_release(&v->ids);
    view_reveal_release(&v->reveal);
}
