/* draw_data.c - scripts that hand texts to the page; see draw_data.h.
 *
 * Each script calls a function of the page. Texts are JSON strings. */
#include "stages/draw_model/draw_data.h"

#include <dirent.h>
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/capture/line_list.h"
#include "common/capture/photo_camera.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"

#define PARAM_STRUCT struct draw_params
const struct param draw_param_table[] = {DRAW_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* "NAME": "its text", if there is such a file. */
static enum status write_file(FILE *to, const char *name, const char *path, struct err *err)
{
    struct file_bytes file = {0};
    if (!path || !path_is_file(path) || file_bytes_read(&file, path, err)) return err->status;
    fputs(",\n", to);
    draw_data_write_string(to, name, strlen(name));
    fputs(": ", to);
    draw_data_write_string(to, file.bytes, file.size);
    file_bytes_release(&file);
    return ST_OK;
}

/* Texts, and meshes of objects. */
static int is_text(const struct dirent *entry)
{
    const size_t n = strlen(entry->d_name);
    const char *end = entry->d_name + n - (n > 4 ? 4 : 0);
    return entry->d_name[0] != '.' && (!strcmp(end, ".txt") || !strcmp(end, ".obj"));
}

/* The files that people write: scenes/NAME/X.txt as scene/X.txt. */
static enum status write_folder(FILE *to, const char *as, const char *folder, struct err *err)
{
    struct dirent **entries = NULL;
    const int count = scandir(folder, &entries, is_text, alphasort);
    if (count < 0 && errno != ENOENT) err_errno(err, "list", folder);
    for (int i = 0; i < count; i++) {
        char path[FILE_PATH], name[FILE_PATH];
        if (!err->status && !file_path(path, folder, entries[i]->d_name, "", err) &&
            !file_path(name, as, entries[i]->d_name, "", err))
            write_file(to, name, path, err);
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

static enum status write_texts(FILE *to, const struct draw_sources *from, struct err *err)
{
    static const enum product_id of_views[] = {PRODUCT_CAMERAS, PRODUCT_IMAGES, PRODUCT_POINTS3D, PRODUCT_LENSES};
    char path[FILE_PATH], name[FILE_PATH];
    for (size_t i = 0; i < sizeof of_views / sizeof *of_views; i++)
        if (product_path_in(path, from->views, of_views[i], NULL, err) ||
            file_path(name, "out/views", path_file_name(path), "", err) || write_file(to, name, path, err))
            return err->status;
    if (write_file(to, "out/model/axes.txt", from->axes, err) ||
        write_file(to, "out/model/suggested.txt", from->suggested, err) ||
        write_file(to, "out/lights/candidates.txt", from->candidates, err) ||
        write_file(to, "out/lights/lights.txt", from->lights, err) ||
        write_file(to, "out/build_model.cfg", from->config, err) || file_path(name, "scenes", from->name, "", err) ||
        write_folder(to, name, from->scene, err))
        return err->status;
    return file_path(path, from->scene, "edits", "", err) || file_path(name, "scenes", from->name, "/edits", err) ||
                   write_folder(to, name, path, err)
               ? err->status
               : ST_OK;
}

/* --------------------------------------------------------------------------------------------------- straight edges */

/* A pixel of a view in the photo that it was made from. */
static bool to_photo(double photo[2], const struct view *view, const struct lens *lens, double u, double v)
{
    const struct vec3 ray = vec3_make((u - view->cx) / view->fx, (v - view->cy) / view->fy, 1);
    const struct mat3 turn = mat3_transpose(mat3_from_quat(lens->view_from_photo));
    return camera_project(&lens->camera, mat3_apply(turn, ray), &photo[0], &photo[1]) && photo[0] >= 0 &&
           photo[1] >= 0 && photo[0] <= lens->camera.width && photo[1] <= lens->camera.height;
}

static void write_line(FILE *to, const struct view *view, const struct lens *lens, const struct view_line *l,
                       bool *more)
{
    enum { PARTS = 4 };
    double at[PARTS + 1][2];
    for (int i = 0; i <= PARTS; i++) {
        const double t = (double)i / PARTS;
        if (!to_photo(at[i], view, lens, l->u0 + t * (l->u1 - l->u0), l->v0 + t * (l->v1 - l->v0))) return;
    }
    fputs(*more ? ",[" : "[", to);
    for (int i = 0; i <= PARTS; i++) fprintf(to, "%s%.1f,%.1f", i ? "," : "", at[i][0], at[i][1]);
    putc(']', to);
    *more = true;
}

static enum status write_lines(FILE *to, const struct draw_sources *from, struct err *err)
{
    const struct scene_files files = {.views = from->views};
    struct scene_inputs in = {0};
    const char *photo = "";
    bool more = false;
    scene_inputs_read(&in, SCENE_CAMERAS | SCENE_LENSES, &files, NULL, err);
    for (int i = 0; !err->status && i < in.set.view_count; i++) {
        const struct lens *lens = photo_lens_of_view(&in.set, &in.lenses, i);
        const struct product_key key = {.view = in.set.views[i].name};
        struct line_list lines = {0};
        char path[FILE_PATH];
        if (!lens || product_path_in(path, from->lines, PRODUCT_LINES, &key, err) || !path_is_file(path)) continue;
        line_list_read(&lines, path, NULL, err);
        if (strcmp(photo, lens->photo)) {
            fputs(*photo ? "],\n" : "\n", to);
            draw_data_write_string(to, lens->photo, strlen(lens->photo));
            fputs(": [", to);
            photo = lens->photo;
            more = false;
        }
        for (int k = 0; k < lines.count; k++) write_line(to, &in.set.views[i], lens, &lines.lines[k], &more);
        line_list_release(&lines);
    }
    if (*photo) fputs("]", to);
    scene_inputs_release(&in);
    return err->status;
}

enum status draw_data_write_scene(const char *path, const struct draw_sources *from, struct err *err)
{
    struct outfile out = {0};
    if (outfile_open(&out, path, err)) return err->status;
    fputs("remodel.scene = {\"name\": ", out.fp);
    draw_data_write_string(out.fp, from->name, strlen(from->name));
    fputs(", \"files\": {\"\": \"\"", out.fp);
    write_texts(out.fp, from, err);
    fputs("},\n\"lines\": {", out.fp);
    if (!err->status && from->lines) write_lines(out.fp, from, err);
    fputs("},\n\"masks\": {", out.fp);
    if (!err->status) draw_masks_write(out.fp, from, err);
    fputs("},\n\"things\": ", out.fp);
    if (!err->status) draw_things_write(out.fp, from, err);
    fputs("};\n", out.fp);
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    return err->status;
}

enum status draw_data_write_code(const char *path, const struct draw_sources *from, struct err *err)
{
    struct outfile out = {0};
    if (!path_is_file(from->wasm))
        return err_set(err, ST_IO,
                       "%s is missing: the page needs build_model as WebAssembly; run make draw, or make wasm before "
                       "make install.",
                       from->wasm);
    if (!outfile_open(&out, path, err)) {
        fputs("remodel.code = \"", out.fp);
        base64_write_file(out.fp, from->wasm, err);
        fputs("\";\n", out.fp);
        if (!err->status) outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}
