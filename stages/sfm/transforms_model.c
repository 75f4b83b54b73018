/* transforms_model.c - cameras in transforms.json (common/capture/transforms_file.c) as those of photos.
 *
 * Paths are those of the program that wrote the file, so only the names of files count; names may lack their
 * extension. */
#include "stages/sfm/transforms_model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/capture/photo_match.h"
#include "common/capture/transforms_file.h"
#include "stages/sfm/given_cameras.h"
#include "stages/sfm/sfm_folder.h"

#define DEPTH_STEP 0.001 /* of whole numbers: millimetres, where the file does not say */

/* t->root stays NULL if there is no such file. */
static enum status open_in(struct transforms_file *t, const char *folder, struct err *err)
{
    static const char *const names[] = {"transforms.json", "transforms_train.json"};
    char path[FILE_PATH];
    *t = (struct transforms_file){0};
    for (int i = 0; i < 2; i++) {
        if (file_path(path, folder, names[i], "", err)) return err->status;
        if (path_is_file(path)) return transforms_file_open(t, path, err);
    }
    return ST_OK;
}

/* photo: NULL: the image is no photo of the scene. *known: false if the size of its pictures is unknown. */
static enum status read_lens(struct camera *c, bool *known, const struct transforms_frame *f,
                             const struct photo_record *photo, struct err *err)
{
    struct given_lens lens;
    const double w = photo ? photo->info.width : 0, h = photo ? photo->info.height : 0;
    if (transforms_file_lens(&lens, known, f, w, h, err) || !*known) return err->status;
    return given_lens_camera(c, &lens, f->where, err);
}

/* *name: of the file of frame i; it lasts as long as t. */
static enum status frame_at(struct transforms_frame *f, const char **name, const struct transforms_file *t, size_t i,
                            struct err *err)
{
    transforms_file_frame(f, name, t, i);
    return *name ? ST_OK : err_set(err, ST_DATA, "%s has no \"file_path\", the name of its picture.", f->where);
}

enum status transforms_model_read(struct sfm_model *m, bool *found, const char *folder, const struct photo_list *photos,
                                  struct provenance *prov, struct err *err)
{
    struct transforms_file t = {0};
    int unsized = 0;
    *m = (struct sfm_model){0};
    *found = !open_in(&t, folder, err) && t.root;
    if (!*found) return err->status;
    if (prov) provenance_add_file(prov, "model/transforms.json", t.path, err);
    for (size_t i = 0; !err->status && i < json_array_size(t.frames); i++) {
        struct transforms_frame f;
        struct camera c;
        struct vec3 axes[3], center;
        const char *name = NULL;
        bool sized = false;
        if (frame_at(&f, &name, &t, i, err)) break;
        const int photo = photo_list_match(photos, name);
        if (transforms_file_is_panorama(&f)) {
            sized = true;
            if (given_panorama_lens(&c, name, photos, f.where, err)) break;
        } else if (read_lens(&c, &sized, &f, photo < 0 ? NULL : &photos->photos[photo], err)) {
            break;
        }
        unsized += !sized;
        if (sized && !transforms_file_pose(axes, &center, &f, err))
            given_cameras_add(m, name, &c, axes, center, f.where, err);
    }
    if (!err->status && unsized)
        log_note("%d frames of %s are not photos of the scene and are left out", unsized, t.path);
    if (!err->status) given_cameras_end(m, t.path, err);
    transforms_file_close(&t);
    if (err->status) sfm_model_release(m);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- depth */

static const char *depth_name(const struct transforms_frame *f)
{
    const char *name = json_string_value(json_object_get(f->own, "depth_file_path"));
    return name ? name : json_string_value(json_object_get(f->own, "depth_path"));
}

/* Links to/ID.EXT to the depth of a photo; the path is relative to the folder of transforms.json. *linked: whether the
 * file exists. */
static enum status link_map(bool *linked, const char *to, const char *folder, const char *name, const char *id,
                            struct err *err)
{
    char from[FILE_PATH], file[FILE_PATH], ending[16] = "";
    const char *dot = strrchr(path_file_name(name), '.');
    *linked = false;
    if (*name == '/' ? file_path(from, "", name + 1, "", err) : file_path(from, folder, name, "", err))
        return err->status;
    for (char *p = from; *p; p++)
        if (*p == '\\') *p = '/';
    if (!dot || strlen(dot) >= sizeof ending || !path_is_file(from)) return ST_OK;
    for (size_t i = 0; dot[i]; i++) ending[i] = (char)(dot[i] >= 'A' && dot[i] <= 'Z' ? dot[i] + 32 : dot[i]);
    char *whole = realpath(from, NULL);
    if (!whole) return err_errno(err, "open", from);
    if (!file_path(file, to, id, ending, err)) {
        unlink(file);
        if (symlink(whole, file)) err_errno(err, "make", file);
        *linked = !err->status;
    }
    free(whole);
    return err->status;
}

/* depth.txt: the maps show the photos with their lens; step: the scale, 0: none is needed. */
static enum status write_units(const char *to, double step, struct err *err)
{
    struct outfile f = {0};
    char path[FILE_PATH];
    if (!file_path(path, to, "depth.txt", "", err) && !outfile_open(&f, path, err)) {
        if (step > 0) fprintf(f.fp, "scale %.9g\n", step);
        fputs("pixels photo\n", f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

enum status transforms_link_depth(int *count, const char *to, const char *folder, const struct photo_list *photos,
                                  struct err *err)
{
    struct transforms_file t = {0};
    double step = 0;
    bool whole_numbers = false; /* of any map */
    *count = 0;
    if (sfm_remove_tree(to, err) || open_in(&t, folder, err) || !t.root) return err->status;
    for (size_t i = 0; !err->status && i < json_array_size(t.frames); i++) {
        struct transforms_frame f;
        const char *name = NULL;
        bool linked = false;
        if (frame_at(&f, &name, &t, i, err)) break;
        const char *depth = depth_name(&f);
        const int photo = depth ? photo_list_match(photos, name) : -1;
        if (photo < 0) continue;
        if (!*count && outfile_make_folders(to, err)) break;
        if (transforms_file_number(&f, "depth_unit_scale_factor", &step, err) ||
            transforms_file_number(&f, "integer_depth_scale", &step, err))
            break;
        link_map(&linked, to, folder, depth, photos->photos[photo].id, err);
        *count += linked;
        whole_numbers = whole_numbers || !strcasecmp(depth + strlen(depth) - (strlen(depth) < 4 ? 0 : 4), ".png");
    }
    if (!err->status && *count) write_units(to, step > 0 || !whole_numbers ? step : DEPTH_STEP, err);
    if (!*count || err->status) sfm_remove_tree(to, &(struct err)ERR_INIT);
    transforms_file_close(&t);
    return err->status;
}
