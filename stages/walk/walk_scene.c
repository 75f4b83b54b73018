/* walk_scene.c - see walk_scene.h. */
#include "stages/walk/walk_scene.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/capture/photo_camera.h"
#include "common/product/product.h"
#include "common/texture/scene_exposure.h"

/* Views are in order of name, so those of a photo follow each other. */
static enum status find_places(struct walk_scene *s, struct err *err)
{
    const size_t views = (size_t)s->in.set.view_count + 1;
    s->places = calloc(views, sizeof *s->places);
    s->cameras = calloc(views, sizeof *s->cameras);
    if (!s->places || !s->cameras) return err_nomem(err, "viewpoints", views * sizeof *s->places);
    for (int i = 0; i < s->in.set.view_count; i++) {
        const struct lens *lens = photo_lens_of_view(&s->in.set, &s->in.lenses, i);
        if (!lens)
            return err_set(err, ST_DATA, "%s/lenses.txt has no line of view %s. Run make views again.", s->files->views,
                           s->in.set.views[i].name);
        s->cameras[i] = model_from_world_view(&s->in.axes, &s->in.set.views[i]);
        struct walk_viewpoint *last = s->places + s->place_count - 1;
        if (s->place_count && !strcmp(last->photo, lens->photo))
            last->count++;
        else
            s->places[s->place_count++] = (struct walk_viewpoint){.photo = lens->photo, .first = i, .count = 1};
    }
    return ST_OK;
}

/* The comment lines at the head of an edit's script, which say what it does. */
static enum status read_about(char **about, const char *folder, const char *edit, struct err *err)
{
    char path[FILE_PATH];
    struct textfile t = {0};
    size_t length = 0, used = 0, size;
    const char *line;
    if (file_path(path, folder, edit, ".txt", err) || textfile_open(&t, path, err)) return err->status;
    *about = calloc(t.size + 1, 1);
    if (!*about) err_nomem(err, "a comment", t.size);
    while (!err->status && (line = textfile_peek(&t, &length))) {
        size = length;
        while (size && (*line == '#' || *line == ' ')) line++, size--;
        if (length && size == length && strncmp(line, "remodel-script", 14)) break;
        if (size && size < length) {
            if (used) (*about)[used++] = ' ';
            memcpy(*about + used, line, size);
            used += size;
        }
        textfile_next_raw(&t);
    }
    textfile_release(&t);
    return err->status;
}

static enum status read_objects(struct walk_model *m, const char *path, const char *folder, struct provenance *prov,
                                struct err *err)
{
    if (object_list_read(&m->objects, path, prov, err)) return err->status;
    m->meshes = calloc((size_t)m->objects.count + 1, sizeof *m->meshes);
    if (!m->meshes) err_nomem(err, "objects", (size_t)m->objects.count * sizeof *m->meshes);
    for (int i = 0; !err->status && folder && i < m->objects.count; i++)
        object_mesh_read(&m->meshes[i], &m->objects.items[i], folder, err);
    return err->status;
}

static enum status read_tour(struct walk_model *m, const char *folder, struct provenance *prov, struct err *err)
{
    char tour[FILE_PATH], path[FILE_PATH];
    if (file_path(tour, folder, "tour", "", err) || product_path_in(path, tour, PRODUCT_PATH, NULL, err))
        return err->status;
    if (!path_is_file(path)) return ST_OK;
    if (camera_path_read(&m->tour, tour, prov, err) || product_path_in(path, tour, PRODUCT_TOUR_PAIRS, NULL, err))
        return err->status;
    return path_is_file(path) ? viewpoint_pairs_read(&m->pairs, path, prov, err) : ST_OK;
}

static enum status read_relit(struct walk_model *m, const char *relight, struct provenance *prov, struct err *err)
{
    char folder[FILE_PATH], vita[FILE_PATH], list[FILE_PATH];
    if (file_path(folder, relight, m->edit, "", err) || file_path(vita, folder, "vita", "", err) ||
        product_path_in(list, vita, PRODUCT_ATLAS, NULL, err))
        return err->status;
    m->relit = path_is_file(list);
    return m->relit ? atlas_read(&m->relit_atlas, vita, prov, err) : ST_OK;
}

static enum status read_edit(struct walk_model *m, const struct walk_scene *s, const char *folder,
                             struct provenance *prov, struct err *err)
{
    char map[FILE_PATH], objects[FILE_PATH];
    const struct walk_files *files = s->files;
    if (product_path_in(map, folder, PRODUCT_TEXTURE_MAP, NULL, err) || texture_map_read(&m->map, map, prov, err) ||
        product_path_in(objects, folder, PRODUCT_OBJECTS, NULL, err))
        return err->status;
    if (path_is_file(objects) && read_objects(m, objects, files->meshes, prov, err)) return err->status;
    if (files->relight && read_relit(m, files->relight, prov, err)) return err->status;
    return files->scripts ? read_about(&m->about, files->scripts, m->edit, err) : ST_OK;
}

static enum status read_model(struct walk_scene *s, const char *edit, struct provenance *prov, struct err *err)
{
    struct walk_model *m = &s->models[s->model_count++];
    char folder[FILE_PATH], model[FILE_PATH], plan[FILE_PATH];
    m->edit = edit;
    if (file_path(folder, edit ? s->files->remodel : s->files->model, edit ? edit : "", "", err) ||
        product_path_in(model, folder, PRODUCT_MODEL, NULL, err) ||
        product_path_in(plan, folder, PRODUCT_PLAN, NULL, err) ||
        model_rays_read(&m->rays, model, MODEL_WITH_GLASS, prov, err) || model_plan_read(&m->plan, plan, prov, err) ||
        (edit && read_edit(m, s, folder, prov, err)) || read_tour(m, folder, prov, err))
        return err->status;
    return placed_things_read(&m->things, s->files->things, edit ? &m->map : NULL, &s->models[0].rays, &m->rays, prov,
                              err);
}

enum status walk_scene_read(struct walk_scene *s, const struct walk_files *files, const struct walk_params *params,
                            struct provenance *prov, struct err *err)
{
    const struct scene_files inputs = {.views = files->views, .axes = files->axes};
    char folder[FILE_PATH];
    *s = (struct walk_scene){.files = files, .params = params, .exposure = 1};
    s->models = calloc((size_t)files->edits.count + 1, sizeof *s->models);
    if (!s->models) err_nomem(err, "models", ((size_t)files->edits.count + 1) * sizeof *s->models);
    if (!err->status && !scene_inputs_read(&s->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES, &inputs, prov, err) &&
        !find_places(s, err) && files->exposure)
        scene_exposure_read(&s->exposure, files->exposure, prov, err);
    if (!err->status) atlas_read(&s->vita, files->vita, prov, err);
    for (int i = 0; !err->status && i < s->place_count; i++)
        if (!file_path(folder, files->vdta, s->places[i].photo, "", err))
            atlas_read(&s->places[i].atlas, folder, prov, err);
    for (int i = -1; !err->status && i < files->edits.count; i++)
        read_model(s, i < 0 ? NULL : files->edits.items[i], prov, err);
    return err->status;
}

static void release_model(struct walk_model *m)
{
    for (int i = 0; m->meshes && i < m->objects.count; i++) obj_mesh_release(&m->meshes[i]);
    free(m->meshes);
    object_list_release(&m->objects);
    placed_things_release(&m->things);
    camera_path_release(&m->tour);
    viewpoint_pairs_release(&m->pairs);
    atlas_release(&m->relit_atlas);
    model_plan_release(&m->plan);
    texture_map_release(&m->map);
    model_rays_release(&m->rays);
    free(m->about);
}

void walk_scene_release(struct walk_scene *s)
{
    for (int i = 0; s->models && i < s->model_count; i++) release_model(&s->models[i]);
    for (int i = 0; s->places && i < s->place_count; i++) atlas_release(&s->places[i].atlas);
    free(s->models);
    free(s->places);
    free(s->cameras);
    atlas_release(&s->vita);
    scene_inputs_release(&s->in);
    *s = (struct walk_scene){0};
}
