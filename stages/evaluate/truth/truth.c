/* truth.c - see truth.h. */
#include "stages/evaluate/truth/truth.h"

#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include "common/capture/photo_match.h"
#include "common/image/exr.h"

enum status truth_photo_read_depth(struct true_photo *p, const char *path, double far, struct err *err)
{
    static const char *const NAMES[] = {"Z"};
    struct exr_image im = {0};
    exr_read(&im, path, NAMES, 1, err);
    const struct exr_plane *z = err->status ? NULL : exr_find(&im, "Z");
    if (!err->status && !z->f) err_set(err, ST_DATA, "%s: channel Z holds integers, wanted half or float.", path);
    if (!err->status && (im.width != p->lens.width || im.height != p->lens.height))
        err_set(err, ST_DATA, "%s is %d x %d px, but the truth's camera is %d x %d px.", path, im.width, im.height,
                p->lens.width, p->lens.height);
    if (!err->status) {
        const char *kind = exr_attribute(&im, "remodel:depth");
        size_t pixels = (size_t)im.width * (size_t)im.height;
        p->along_ray = kind ? !strcmp(kind, "ray") : camera_model_is_fisheye(p->lens.model);
        if (kind && strcmp(kind, "ray") && strcmp(kind, "z"))
            err_set(err, ST_DATA, "%s: found remodel:depth \"%s\", wanted \"z\" or \"ray\".", path, kind);
        else if (!(p->depth = malloc(pixels * sizeof *p->depth)))
            err_nomem(err, "a true depth map", pixels * sizeof *p->depth);
        for (size_t i = 0; !err->status && i < pixels; i++) p->depth[i] = z->f[i] > 0 && z->f[i] <= far ? z->f[i] : 0;
    }
    exr_image_release(&im);
    return err->status;
}

/* Reads depth/NAME.exr if it exists; NAME is the image's without its extension. */
static enum status find_depth(struct truth *t, struct true_photo *p, const char *folder, const char *image, double far,
                              struct provenance *prov, struct err *err)
{
    const char *dot = strrchr(image, '.');
    int stem = dot && dot != image ? (int)(dot - image) : (int)strlen(image);
    size_t size = strlen(folder) + (size_t)stem + 32;
    char *path = malloc(size), *name = malloc(size);
    struct stat info;
    if (path && name) {
        snprintf(path, size, "%s/depth/%.*s.exr", folder, stem, image);
        snprintf(name, size, "truth/depth/%.*s.exr", stem, image);
        if (!stat(path, &info)) {
            if (!truth_photo_read_depth(p, path, far, err)) provenance_add_file(prov, name, path, err);
            t->depths += !err->status;
        }
    } else {
        err_nomem(err, "a file name", size);
    }
    free(path);
    free(name);
    return err->status;
}

enum status truth_read(struct truth *t, const char *folder, const struct photo_list *photos, double far,
                       struct provenance *prov, struct err *err)
{
    struct sfm_model m = {0};
    *t = (struct truth){.count = photos->count};
    if (!sfm_model_read_cameras(&m, folder, NULL, err) &&
        !provenance_add_in(prov, "truth", folder, "cameras.txt", "", NULL, err))
        provenance_add_in(prov, "truth", folder, "images.txt", "", NULL, err);
    if (!err->status && !(t->photos = calloc((size_t)photos->count + 1, sizeof *t->photos)))
        err_nomem(err, "true photos", (size_t)photos->count * sizeof *t->photos);
    t->images = m.image_count;
    for (int i = 0; !err->status && i < m.image_count; i++) {
        int at = photo_list_match(photos, m.images[i].name);
        if (at < 0) {
            t->unknown_images++;
            continue;
        }
        if (t->photos[at].lens.width)
            err_set(err, ST_DATA, "%s/images.txt: found two images with the name of photo \"%s\", wanted one.", folder,
                    photos->photos[at].file);
        t->photos[at].lens = m.cameras[m.images[i].camera_idx].camera;
        t->photos[at].pose = m.images[i].cam_from_world;
        if (!err->status) find_depth(t, &t->photos[at], folder, m.images[i].name, far, prov, err);
    }
    sfm_model_release(&m);
    if (err->status) truth_release(t);
    return err->status;
}

void truth_release(struct truth *t)
{
    for (int i = 0; t->photos && i < t->count; i++) free(t->photos[i].depth);
    free(t->photos);
    *t = (struct truth){0};
}
