/* edit_chain.c - applies script files to a plan; see edit_chain.h. */
#include "stages/build_model/plan/edit_chain.h"

#include <stdio.h>
#include <string.h>

#include "common/base/file_path.h"
#include "stages/build_model/script/verbs.h"

/* The provenance has the script's file name without its folder: the product does not depend on the scene's folder. */
static enum status read_script(struct script *script, const char *path, struct provenance *prov, struct err *err)
{
    return script_read(script, path, err) || provenance_add_file(prov, path_file_name(path), path, err) ? err->status
                                                                                                        : ST_OK;
}

enum status edit_chain_apply_model(struct plan *plan, const char *path, const struct placer *placer,
                                   struct provenance *prov, struct err *err)
{
    struct script script = {0};
    read_script(&script, path, prov, err);
    if (!err->status && script.base)
        err_set(err, ST_DATA, "%s:%d: found base %s, but only an edit stands on another edit.", path, script.base_line,
                script.base);
    if (!err->status) plan_apply(plan, &script, false, placer, err);
    script_release(&script);
    return err->status;
}

enum status edit_chain_apply_objects(struct plan *plan, const char *path, struct provenance *prov, struct err *err)
{
    struct script script = {0};
    script_read(&script, path, err);
    /* an edit may be named objects */
    if (!err->status) provenance_add_file(prov, "scene/objects.txt", path, err);
    for (int i = 0; !err->status && i < script.count; i++)
        if (!(script.statements[i].verb->where & IN_OBJECTS))
            err_set(err, ST_DATA, "%s:%d: found %s, wanted object: this file places objects in all edits.", path,
                    script.statements[i].line, script.statements[i].verb->word);
    if (!err->status) plan_apply(plan, &script, true, NULL, err);
    script_release(&script);
    return err->status;
}

/* An edit, and those that stand on it, the nearest first. */
struct chain {
    const char *path;
    const struct chain *above;
};

/* path: of the edit that the script stands on. */
static enum status base_path(char path[FILE_PATH], const struct script *script, const struct chain *edit,
                             struct err *err)
{
    const int folder = (int)(path_file_name(edit->path) - edit->path);
    if (snprintf(path, FILE_PATH, "%.*s%s.txt", folder, edit->path, script->base) >= FILE_PATH)
        return err_set(err, ST_IO, "%s: the path is too long.", edit->path);
    for (const struct chain *e = edit; e; e = e->above)
        if (!strcmp(path_file_name(path), path_file_name(e->path)))
            return err_set(err, ST_DATA, "%s:%d: base %s goes in a circle: that edit stands on this one.", edit->path,
                           script->base_line, script->base);
    if (path_is_file(path)) return ST_OK;
    return err_set(err, ST_DATA, "%s:%d: found base %s, but there is no %s.", edit->path, script->base_line,
                   script->base, path);
}

static enum status apply_chain(struct plan *plan, const struct chain *edit, const struct placer *placer,
                               struct provenance *prov, struct err *err)
{
    struct script script = {0};
    char path[FILE_PATH];
    read_script(&script, edit->path, prov, err);
    if (!err->status && script.base) {
        const struct chain below = {path, edit};
        if (!base_path(path, &script, edit, err)) apply_chain(plan, &below, placer, prov, err);
    }
    if (!err->status) plan_apply(plan, &script, true, placer, err);
    script_release(&script);
    return err->status;
}

enum status edit_chain_apply_edit(struct plan *plan, const char *path, const struct placer *placer,
                                  struct provenance *prov, struct err *err)
{
    const struct chain edit = {path, NULL};
    return apply_chain(plan, &edit, placer, prov, err);
}
