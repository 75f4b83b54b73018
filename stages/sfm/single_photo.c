/* single_photo.c - the camera of a single photo.
 *
 * Its focal length cannot be found from one picture, and matters little to a film: with another one the scene is deeper
 * or flatter, and looks the same from where the photo was taken. */
#include "stages/sfm/single_photo.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/base/log.h"
#include "common/math/numbers.h"
#include "stages/sfm/start_lens.h"

static const double ORDINARY_FIELD = 60; /* degrees across the longer side: between a phone's lens and a normal one */
static const double FILM_SIDE = 36;      /* mm */

static enum status find_lens(struct camera *lens, const struct photo_list *photos, const struct sfm_params *params,
                             struct err *err)
{
    const struct photo_record *photo = &photos->photos[0];
    const struct photo_info *info = &photo->info;
    const double side = fmax(info->width, info->height);
    char text[SFM_LENS_TEXT] = "";
    *lens = (struct camera){.model = CAMERA_SIMPLE_PINHOLE, .width = info->width, .height = info->height};
    if (sfm_is_equisolid(params)) {
        lens->model = CAMERA_OPENCV_FISHEYE;
        if (sfm_equisolid_lens(text, photos, params, err)) return err->status;
    } else if (*params->camera_params) {
        camera_model_from_name(params->camera_model, &lens->model);
        snprintf(text, sizeof text, "%s", params->camera_params);
    }
    if (*text) {
        sfm_parse_numbers(lens->params, text);
        log_note("the lens of %s is that of [sfm] camera_params", photo->file);
        return ST_OK;
    }
    lens->params[0] =
        info->focal35_mm > 0 ? info->focal35_mm / FILM_SIDE * side : side / 2 / tan(ORDINARY_FIELD / 2 * PI / 180);
    lens->params[1] = info->width / 2.0;
    lens->params[2] = info->height / 2.0;
    if (info->focal35_mm > 0)
        log_note("the lens of %s has %.4g mm for 35 mm film, as EXIF says: %.3g degrees across its longer side",
                 photo->file, info->focal35_mm, 2 * atan(side / 2 / lens->params[0]) * 180 / PI);
    else
        log_note(
            "EXIF of %s does not state its focal length; an ordinary angle of view is taken, %g degrees across its "
            "longer side ([sfm] camera_params gives another)",
            photo->file, ORDINARY_FIELD);
    return ST_OK;
}

enum status single_photo_add(struct sfm_folder *folder, const struct photo_list *photos,
                             const struct sfm_params *params, const struct provenance *prov, struct err *err)
{
    struct sfm_camera camera = {.id = 1};
    struct sfm_image image = {.id = 1, .cam_from_world = {.rotation = {1, 0, 0, 0}}, .name = photos->photos[0].file};
    const struct sfm_model model = {.cameras = &camera, .images = &image, .camera_count = 1, .image_count = 1};
    folder->given = "model";
    return find_lens(&camera.camera, photos, params, err) || sfm_folder_add(folder, &model, prov, err) ? err->status
                                                                                                       : ST_OK;
}
