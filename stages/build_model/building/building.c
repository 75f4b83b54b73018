/* building.c - what build_model and the pages that draw a model share: scripts become a plan, the plan becomes solids,
 * their union becomes a checked mesh. */
#include "stages/build_model/building/building.h"

#include "common/base/file_path.h"
#include "common/product/product.h"
#include "stages/build_model/building/objects.h"
#include "stages/build_model/building/plan_file.h"
#include "stages/build_model/layout/layout.h"
#include "stages/build_model/plan/edit_chain.h"
#include "stages/build_model/plan/plan_things.h"
#include "stages/build_model/texture/texture_rules.h"

/* The objects of all edits, if the scene has such a file, then the edit. */
static enum status apply_edit(struct plan *plan, const struct building_files *files, const struct placer *placer,
                              struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (files->scene && file_path(path, files->scene, "objects.txt", "", err)) return err->status;
    if (files->scene && path_is_file(path) && edit_chain_apply_objects(plan, path, prov, err)) return err->status;
    return edit_chain_apply_edit(plan, files->edit, placer, prov, err);
}

enum status building_make(struct building *b, const struct building_files *files, const struct model_axes *axes,
                          const struct placer *placer, struct provenance *prov, struct err *err)
{
    plan_begin(&b->plan, axes);
    edit_chain_apply_model(&b->plan, files->script, placer, prov, err);
    if (!err->status && files->things) plan_things_add(&b->plan, files->things, prov, err);
    if (!err->status && files->edit) apply_edit(&b->plan, files, placer, prov, err);
    if (!err->status && !layout_solids(&b->solids, &b->plan, err) && !b->solids.count)
        err_set(err, ST_DATA, "%s: the script describes no solid; add walls, rooms or boxes.", files->script);
    if (!err->status && !unite_solids(&b->mesh, &b->solids, &b->log, err))
        solid_mesh_check(&b->mesh, 0, &b->report, err);
    return err->status;
}

enum status building_write_edit(struct building *b, const struct building_files *files, const char *folder,
                                struct provenance *prov, struct err *err)
{
    struct solid_mesh base = {0};
    struct texture_map map = {0};
    struct object_list objects = {0};
    char path[FILE_PATH];
    if (!solid_mesh_read(&base, files->base, prov, err) && !solid_mesh_carry_ids(&b->mesh, &base, err) &&
        !texture_rules_make(&map, &b->mesh, &base, &b->plan, err) &&
        !objects_make(&objects, &b->plan, files->scene, err) &&
        !product_path_in(path, folder, PRODUCT_OBJECTS, NULL, err) && !object_list_write(&objects, path, prov, err) &&
        !product_path_in(path, folder, PRODUCT_TEXTURE_MAP, NULL, err))
        texture_map_write(&map, path, prov, err);
    object_list_release(&objects);
    texture_map_release(&map);
    solid_mesh_release(&base);
    return err->status;
}

enum status building_write(const struct building *b, const char *folder, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    if (product_path_in(path, folder, PRODUCT_PLAN, NULL, err) || plan_write(&b->plan, path, prov, err) ||
        product_path_in(path, folder, PRODUCT_MERGED, NULL, err) || plan_merged_write(&b->log, path, prov, err) ||
        product_path_in(path, folder, PRODUCT_MODEL, NULL, err))
        return err->status;
    return solid_mesh_write(&b->mesh, path, prov, err);
}

void building_release(struct building *b)
{
    solid_report_release(&b->report);
    unite_log_release(&b->log);
    solid_mesh_release(&b->mesh);
    solid_list_release(&b->solids);
    plan_release(&b->plan);
    *b = (struct building){0};
}
