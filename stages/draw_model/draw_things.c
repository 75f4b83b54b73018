/* draw_things.c - masks and furniture for the page.
 *
 * Masks of furniture are made for views; the page has photographs. So a grid of pixels of each photo is looked up in
 * the views that were cut out of it. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/base/file_path.h"
#include "common/model/scene_inputs.h"
#include "common/model/thing_list.h"
#include "common/model/thing_mask.h"
#include "common/product/product.h"
#include "stages/draw_model/draw_data.h"

enum { THINGS = 255 }; /* what a byte of a mask can say */

static int is_png(const struct dirent *entry)
{
    const size_t n = strlen(entry->d_name);
    return entry->d_name[0] != '.' && n > 4 && !strcmp(entry->d_name + n - 4, ".png");
}

enum status draw_masks_write(FILE *to, const struct draw_sources *from, struct err *err)
{
    char folder[FILE_PATH];
    struct dirent **entries = NULL;
    if (file_path(folder, from->scene, "masks", "", err)) return err->status;
    const int count = scandir(folder, &entries, is_png, alphasort);
    if (count < 0 && errno != ENOENT) err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH];
        if (!err->status && !file_path(path, folder, entries[i]->d_name, "", err)) {
            fputs(i ? ",\n" : "\n", to);
            draw_data_write_string(to, entries[i]->d_name, strlen(entries[i]->d_name) - 4);
            fputs(": \"", to);
            base64_write_file(to, path, err);
            putc('"', to);
        }
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

/* Fills the cells of a photo's grid that a view shows. */
static void look_up(unsigned char *cells, int columns, int rows, const struct lens *lens, const struct view *view,
                    const struct thing_mask *mask)
{
    const struct mat3 turn = mat3_from_quat(lens->view_from_photo);
    for (int j = 0; j < rows; j++)
        for (int i = 0; i < columns; i++) {
            struct vec3 ray;
            const double u = (i + 0.5) * lens->camera.width / columns, v = (j + 0.5) * lens->camera.height / rows;
            if (!camera_unproject(&lens->camera, u, v, &ray)) continue;
            ray = mat3_apply(turn, ray);
            const double x = view->fx * ray.x / ray.z + view->cx, y = view->fy * ray.y / ray.z + view->cy;
            if (!(ray.z > 0 && x >= 0 && y >= 0 && x < view->width && y < view->height)) continue;
            const uint32_t thing = mask->shows[(size_t)y * (size_t)view->width + (size_t)x];
            if (thing && thing <= THINGS) cells[(size_t)j * (size_t)columns + (size_t)i] = (unsigned char)thing;
        }
}

static enum status write_cells(FILE *to, const struct draw_sources *from, const struct scene_inputs *in,
                               const char *photo, bool first, struct err *err)
{
    unsigned char *cells = NULL;
    int columns = 0, rows = 0;
    for (int i = 0; !err->status && i < in->lenses.count; i++) {
        const struct lens *lens = &in->lenses.lenses[i];
        const int at = camera_set_find(&in->set, lens->view);
        const struct view *view = at < 0 ? NULL : &in->set.views[at];
        const struct product_key key = {.view = lens->view};
        struct thing_mask mask = {0};
        char path[FILE_PATH];
        if (!view || strcmp(lens->photo, photo) || product_path_in(path, from->things, PRODUCT_THING_MASK, &key, err) ||
            !path_is_file(path) || thing_mask_read(&mask, view, path, UINT32_MAX, NULL, err))
            continue;
        columns = from->params->mask_columns;
        rows = (columns * lens->camera.height + lens->camera.width - 1) / lens->camera.width;
        if (!cells) cells = calloc((size_t)columns, (size_t)rows);
        if (cells)
            look_up(cells, columns, rows, lens, view, &mask);
        else
            err_nomem(err, "furniture of a photo", (size_t)columns * (size_t)rows);
        thing_mask_release(&mask);
    }
    if (cells && !err->status) {
        fputs(first ? "\n" : ",\n", to);
        draw_data_write_string(to, photo, strlen(photo));
        fprintf(to, ": {\"columns\": %d, \"rows\": %d, \"parts\": ", columns, rows);
        draw_data_write_packed(to, cells, (size_t)columns * (size_t)rows, err);
        putc('}', to);
    }
    free(cells);
    return err->status;
}

static enum status write_list(FILE *to, const struct thing_list *list, const struct thing_volume *volume,
                              struct err *err)
{
    for (int i = 0; !err->status && i < list->count && i < THINGS; i++) {
        const struct thing *t = &list->things[i];
        const struct vec3 middle = vec3_scale(vec3_add(t->low, t->high), 0.5);
        fputs(i ? ",\n{\"name\": " : "\n{\"name\": ", to);
        draw_data_write_string(to, t->name, strlen(t->name));
        fprintf(to, ", \"middle\": [%.6g, %.6g, %.6g], \"radius\": %.6g, \"hangs\": %d, \"shape\": ", middle.x,
                middle.y, middle.z, vec3_length(vec3_sub(t->high, middle)), t->support == THING_ON_CEILING);
        draw_shape_write(to, t, (uint32_t)i + 1, volume, err);
        putc('}', to);
    }
    return err->status;
}

enum status draw_things_write(FILE *to, const struct draw_sources *from, struct err *err)
{
    const struct scene_files files = {.views = from->views};
    struct scene_inputs in = {0};
    struct thing_list list = {0};
    struct thing_volume volume = {0};
    char path[FILE_PATH];
    if (!from->things) {
        fputs("null", to);
        return ST_OK;
    }
    if (!product_path_in(path, from->things, PRODUCT_THINGS, NULL, err) && !thing_list_read(&list, path, NULL, err))
        scene_inputs_read(&in, SCENE_CAMERAS | SCENE_LENSES, &files, NULL, err);
    if (!err->status && !product_path_in(path, from->things, PRODUCT_THING_VOLUME, NULL, err))
        thing_volume_read(&volume, path, (uint32_t)list.count, NULL, err);
    fputs("{\"list\": [", to);
    if (!err->status) write_list(to, &list, &volume, err);
    fputs("],\n\"photos\": {", to);
    for (int i = 0, written = 0; !err->status && i < in.lenses.count; i++) {
        bool known = false;
        for (int k = 0; k < i && !known; k++) known = !strcmp(in.lenses.lenses[k].photo, in.lenses.lenses[i].photo);
        const long before = ftell(to);
        if (!known) write_cells(to, from, &in, in.lenses.lenses[i].photo, !written, err);
        written += ftell(to) != before;
    }
    fputs("}}", to);
    thing_list_release(&list);
    thing_volume_release(&volume);
    scene_inputs_release(&in);
    return err->status;
}
