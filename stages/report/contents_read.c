/* contents_read.c - reads everything that the page shows; contents_*.c read the parts. */
#include "stages/report/contents.h"

#include <stdlib.h>
#include <sys/stat.h>

#include "stages/report/contents_parts.h"

static bool same_folder(const char *a, const char *b)
{
    struct stat x, y;
    return !stat(a, &x) && !stat(b, &y) && x.st_dev == y.st_dev && x.st_ino == y.st_ino;
}

/* Logs and slices of the two folders, each once. The shared folder comes last: of a parameter in both, its value is
 * the one that counts, because a shared stage ran with it. */
static enum status read_runs(struct contents *c, const struct contents_sources *from, struct err *err)
{
    const char *folders[2] = {from->folder, from->shared};
    struct settings defaults = {0};

    for (int i = 0; i < (same_folder(folders[0], folders[1]) ? 1 : 2) && !err->status; i++) {
        struct err problem = ERR_INIT;
        char path[PATH_SIZE];
        snprintf(path, sizeof path, "%s/log", folders[i]);
        if (usage_add_folder(&c->usage, path, REPORT_STAGE, &problem))
            contents_note(c, err, "Not all logs can be read. %s", problem.text);
        problem.status = ST_OK;
        snprintf(path, sizeof path, "%s/slice", folders[i]);
        if (!err->status && settings_add_folder(&c->settings, path, &problem))
            contents_note(c, err, "Not all parameters can be read. %s", problem.text);
    }
    if (from->defaults && !err->status) {
        struct err problem = ERR_INIT;
        if (settings_add_file(&defaults, from->defaults, &problem))
            contents_note(c, err, "The default parameters cannot be read. %s", problem.text);
        settings_compare(&c->settings, &defaults);
    }
    settings_release(&defaults);
    return err->status;
}

static enum status read_rooms(struct contents *c, const struct contents_sources *from, struct err *err)
{
    const struct rooms_sources rooms = {from->folder, from->shared, from->photos, from->scripts};
    return rooms_read(&c->rooms, &rooms, err);
}

enum status contents_read(struct contents *c, const struct contents_sources *from, struct err *err)
{
    const char *folder = c->folder = from->folder;
    if (stage_list_parse(&c->stages, from->stages, err)) return err->status;
    if (!path_is_folder(folder))
        return err_set(err, ST_IO, "%s is not a folder, so there is no scene to report on; make the scene first.",
                       folder);
    if (contents_read_photos(c, from->shared, from->photos, err) || contents_read_metrics(c, folder, err) ||
        contents_read_views(c, folder, err) || contents_read_lens(c, folder, err) ||
        contents_read_held(c, folder, err) || contents_check_age(c, folder, err) ||
        contents_read_effects(c, folder, err) || contents_read_axes(c, folder, err) ||
        contents_read_models(c, folder, err) || contents_read_textures(c, folder, err) ||
        contents_read_light(c, folder, err) || contents_read_relit(c, folder, from->shared, err) ||
        contents_read_tours(c, folder, err) || read_rooms(c, from, err))
        return err->status;
    contents_find_things(c, folder);
    char page[FILE_PATH];
    c->has_remodel_page = contents_product(page, folder, PRODUCT_REMODEL_PAGE, NULL);
    c->has_walk = contents_product(page, folder, PRODUCT_WALK_PAGE, NULL);
    c->has_levels = contents_product(page, folder, PRODUCT_LEVELS_PAGE, NULL);
    c->has_draw = contents_product(page, folder, PRODUCT_DRAW_PAGE, NULL);
    return read_runs(c, from, err);
}

void contents_release(struct contents *c)
{
    for (int i = 0; c->photo_cards && i < c->photos.count; i++) picture_release(&c->photo_cards[i].picture);
    for (int i = 0; c->view_cards && i < c->views.view_count; i++) {
        picture_release(&c->view_cards[i].picture);
        picture_release(&c->view_cards[i].depth_picture);
        picture_release(&c->view_cards[i].truth_picture);
        page_depth_thumb_release(&c->view_cards[i].depth);
        page_depth_thumb_release(&c->view_cards[i].truth);
    }
    for (int i = 0; c->held_cards && i < c->held.view_count; i++) {
        picture_release(&c->held_cards[i].picture);
        picture_release(&c->held_cards[i].frame);
    }
    for (int i = 0; i < c->effect_count; i++) effect_card_release(&c->effects[i]);
    for (int i = 0; i < c->axes_count; i++) picture_release(&c->axes[i].picture);
    free(c->axes);
    free(c->lens_forms);
    for (int i = 0; i < c->model_count; i++) model_card_release(&c->models[i]);
    free(c->models);
    free(c->thing_sheet);
    free(c->thing_plan);
    for (int i = 0; i < c->texture_count; i++) texture_card_release(&c->textures[i]);
    free(c->textures);
    light_contents_release(&c->light);
    for (int i = 0; i < c->relit_count; i++) relit_card_release(&c->relit[i]);
    free(c->relit);
    for (int i = 0; i < c->tour_count; i++) free(c->tours[i].video);
    free(c->tours);
    rooms_release(&c->rooms);
    free(c->photo_cards);
    free(c->view_cards);
    free(c->held_cards);
    free(c->effects);
    free(c->left_out);
    free(c->notes);
    usage_table_release(&c->usage);
    settings_release(&c->settings);
    metric_rows_release(&c->metrics);
    metric_rows_release(&c->view_metrics);
    lens_list_release(&c->held_lenses);
    camera_set_release(&c->held);
    lens_list_release(&c->lenses);
    camera_set_release(&c->views);
    photo_list_release(&c->photos);
    stage_list_release(&c->stages);
    *c = (struct contents){0};
}
