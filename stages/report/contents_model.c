/* contents_model.c - pictures of the room's axes, the solid models and the furniture. */
#include "stages/report/contents_parts.h"

#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/image/photo.h"

enum { OVERLAYS_OF_EDIT = 6 }; /* pictures of edges that the page has of an edit */

static enum status read_axes_card(struct contents *c, const char *path, const char *view, struct err *err)
{
    struct photo photo = {0};
    struct err problem = ERR_INIT;
    struct axes_card *card = &c->axes[c->axes_count];
    if (photo_read(&photo, path, &problem))
        return contents_note(c, err, "A picture of the axes cannot be read. %s", problem.text);
    snprintf(card->view, sizeof card->view, "%s", view);
    const int at = camera_set_find(&c->views, view);
    if (at >= 0 && c->view_cards[at].photo) photo.info.orientation = c->view_cards[at].photo->info.orientation;
    picture_from_photo(&card->picture, &photo, AXES_HEIGHT, err);
    c->axes_count += !err->status;
    photo_release(&photo);
    return err->status;
}

/* model/axes/VIEW.png, if the axes were found */
enum status contents_read_axes(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    if (!contents_product(path, folder, PRODUCT_AXES, NULL)) return ST_OK;
    snprintf(path, sizeof path, "%s/model/axes", folder);
    int count = scandir(path, &names, NULL, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    c->axes = calloc((size_t)(count > 0 ? count : 0) + 1, sizeof *c->axes);
    if (!c->axes) err_nomem(err, "pictures of axes", (size_t)count * sizeof *c->axes);
    for (int i = 0; i < count; i++) {
        char *name = names[i]->d_name, *dot = strrchr(name, '.');
        snprintf(path, sizeof path, "%s/model/axes/%s", folder, name);
        if (!err->status && dot && dot != name && name[0] != '.' && !strcmp(dot, ".png")) {
            *dot = '\0';
            read_axes_card(c, path, name, err);
        }
        free(names[i]);
    }
    free(names);
    return err->status;
}

static int is_jpeg(const struct dirent *e)
{
    const char *dot = strrchr(e->d_name, '.');
    return e->d_name[0] != '.' && dot && !strcmp(dot, ".jpg");
}

/* Edges on photographs: all of the unedited model, some of an edit, evenly spaced. */
static enum status list_overlays(struct model_card *m, const char *folder, const char *model, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE];
    snprintf(path, sizeof path, "%s/%s/overlay", folder, model);
    const int found = scandir(path, &names, is_jpeg, alphasort), all = found > 0 ? found : 0;
    if (found < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    const int shown = m->name[0] && all > OVERLAYS_OF_EDIT ? OVERLAYS_OF_EDIT : all;
    m->overlays = calloc((size_t)shown + 1, sizeof *m->overlays);
    m->overlay_ids = calloc((size_t)shown + 1, sizeof *m->overlay_ids);
    if (!m->overlays || !m->overlay_ids) err_nomem(err, "pictures of a model", (size_t)shown * sizeof *m->overlay_ids);
    for (int i = 0; !err->status && i < shown; i++) {
        const char *file = names[(int64_t)i * all / shown]->d_name;
        char *id = m->overlay_ids[m->overlay_count] = strndup(file, strlen(file) - strlen(".jpg"));
        if (!id) err_nomem(err, "a name", strlen(file));
        const struct product_key key = {.model = model, .photo = id};
        m->overlays[m->overlay_count] = id ? contents_product_name(folder, PRODUCT_OVERLAY, &key) : NULL;
        m->overlay_count += m->overlays[m->overlay_count] != NULL;
    }
    m->overlays_left_out = all - shown;
    for (int i = 0; i < all; i++) free(names[i]);
    free(names);
    return err->status;
}

/* model: "model", "remodel/EDIT"; name: of the edit, or "" */
static enum status read_model(struct contents *c, const char *folder, const char *model, const char *name,
                              struct err *err)
{
    const struct product_key key = {.model = model};
    char path[FILE_PATH];
    if (!contents_product(path, folder, PRODUCT_MODEL, &key)) return ST_OK;
    if (array_append(&c->models, (size_t)c->model_count, sizeof *c->models, "models", err)) return err->status;
    struct model_card *m = &c->models[c->model_count++];
    *m = (struct model_card){.plan = contents_product_name(folder, PRODUCT_PLAN_PICTURE, &key),
                             .view = contents_product_name(folder, PRODUCT_MODEL_PICTURE, &key)};
    snprintf(m->name, sizeof m->name, "%s", name);
    return list_overlays(m, folder, model, err);
}

/* model/, and remodel/EDIT/ for every edit */
enum status contents_read_models(struct contents *c, const char *folder, struct err *err)
{
    struct dirent **names = NULL;
    char path[PATH_SIZE], model[FILE_PATH];
    read_model(c, folder, "model", "", err);
    snprintf(path, sizeof path, "%s/remodel", folder);
    const int count = scandir(path, &names, NULL, alphasort);
    if (count < 0 && errno != ENOENT && errno != ENOTDIR) err_errno(err, "list", path);
    for (int i = 0; i < count; i++) {
        snprintf(model, sizeof model, "remodel/%s", names[i]->d_name);
        if (!err->status && names[i]->d_name[0] != '.') read_model(c, folder, model, names[i]->d_name, err);
        free(names[i]);
    }
    free(names);
    return err->status;
}

/* things/, if find_things has run */
void contents_find_things(struct contents *c, const char *folder)
{
    c->thing_sheet = contents_product_name(folder, PRODUCT_THING_SHEET, NULL);
    c->thing_plan = contents_product_name(folder, PRODUCT_THING_PLAN, NULL);
}

void model_card_release(struct model_card *m)
{
    for (int i = 0; m->overlays && m->overlay_ids && i < m->overlay_count; i++) {
        free(m->overlays[i]);
        free(m->overlay_ids[i]);
    }
    free(m->overlays);
    free(m->overlay_ids);
    free(m->plan);
    free(m->view);
}
