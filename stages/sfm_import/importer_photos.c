/* importer_photos.c - which photo each image of the model is, and its lens at the photo's size. */
#include <stdlib.h>
#include <string.h>

#include "common/base/log.h"
#include "common/capture/photo_match.h"
#include "stages/sfm_import/importer.h"
#include "stages/sfm_import/name_lines.h"

enum status importer_match_photos(struct importer *imp, struct import_stats *stats, struct err *err)
{
    const struct photo_list *photos = imp->photos;
    int *image_of = malloc(((size_t)photos->count + 1) * sizeof *image_of);
    struct name_lines unknown = {.heading = "left out, images of the model that are not photos of the scene"};
    struct name_lines missing = {.heading = "not placed"};
    if (!image_of) return err_nomem(err, "photos", (size_t)photos->count * sizeof *image_of);
    for (int i = 0; i < photos->count; i++) image_of[i] = -1;
    for (int i = 0; !err->status && i < imp->in->image_count; i++) {
        int photo = imp->images[i].photo = photo_list_match(photos, imp->in->images[i].name);
        if (photo < 0) {
            name_lines_add(&unknown, imp->in->images[i].name);
            stats->unknown++;
        } else if (image_of[photo] >= 0) {
            err_set(err, ST_DATA,
                    "images \"%s\" and \"%s\" of the model are both named like photo \"%s\"; give photos of "
                    "different folders different names, in the model too.",
                    imp->in->images[image_of[photo]].name, imp->in->images[i].name, photos->photos[photo].file);
        } else {
            image_of[photo] = i;
            stats->registered++;
        }
    }
    for (int i = 0; i < photos->count; i++)
        if (image_of[i] < 0) name_lines_add(&missing, photos->photos[i].file);
    stats->unregistered = photos->count - stats->registered;
    if (!err->status) {
        name_lines_end(&unknown);
        log_note("%d of %d photos are placed", stats->registered, photos->count);
        if (stats->unregistered && stats->registered) {
            name_lines_end(&missing);
            log_note(
                "photos that are not placed overlap too little with the others, are blurred or show little texture; "
                "photos taken in between help");
        }
    }
    if (!err->status && stats->registered == 0)
        err_set(err, ST_DATA,
                "none of the model's %d images (\"%s\", ...) is named like a photo of the scene (\"%s\", ...); use the "
                "model of these photos.",
                imp->in->image_count, imp->in->images[0].name, photos->count ? photos->photos[0].file : "");
    if (!err->status && stats->registered < 2 && photos->count > 1) /* of one photo the depth is given */
        err_set(
            err, ST_DATA,
            "the model places only %d of %d photos, and depth needs at least 2; take more photos, a step apart, each "
            "overlapping most of its neighbours.",
            stats->registered, photos->count);
    free(image_of);
    return err->status;
}

static enum status fit_lens(struct input_image *im, const struct camera *c, const struct photo_record *photo,
                            struct err *err)
{
    int w = photo->info.width, h = photo->info.height;
    im->lens = *c;
    if (!camera_resize(&im->lens, w, h))
        return err_set(
            err, ST_DATA,
            "the model's camera for photo \"%s\" is %d x %d px, but the photo is %d x %d px; the model must be of the "
            "photos as stored (not cropped, undistorted or rotated).",
            photo->file, c->width, c->height, w, h);
    im->scale_u = (double)w / c->width;
    im->scale_v = (double)h / c->height;
    return ST_OK;
}

enum status importer_fit_lenses(struct importer *imp, struct err *err)
{
    int scaled = 0, last = 0;
    for (int i = 0; i < imp->in->image_count; i++) {
        struct input_image *im = &imp->images[i];
        const struct sfm_image *from = &imp->in->images[i];
        im->cam_from_world = mat3_from_quat(from->cam_from_world.rotation);
        im->translation = from->cam_from_world.translation;
        if (im->photo < 0) continue;
        if (fit_lens(im, &imp->in->cameras[from->camera_idx].camera, &imp->photos->photos[im->photo], err))
            return err->status;
        if (im->scale_u != 1 || im->scale_v != 1) {
            scaled++;
            last = i;
        }
    }
    if (scaled)
        log_note(
            "the model was made from %s pictures: cameras and observations of %d photos are scaled (\"%s\" by %.6g)",
            imp->images[last].scale_u > 1 ? "smaller" : "larger", scaled,
            imp->photos->photos[imp->images[last].photo].file, imp->images[last].scale_u);
    return ST_OK;
}
