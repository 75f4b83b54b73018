/* start_lens.c - the lens that COLMAP starts from.
 *
 * An equisolid fisheye maps the angle theta from the axis to the radius r = 2 f sin(theta / 2). COLMAP has no model for
 * it, but OPENCV_FISHEYE, r = f theta (1 + k1 theta^2 + k2 theta^4 + ...), reproduces it (camera_equisolid()).
 *
 * Frames of one clip have one lens. Two clips have two, even of one camera, because zoom and stabilization differ. The
 * lens of views of panoramas is known (panorama_name.h). */
#include "stages/sfm/start_lens.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

#include "common/capture/frame_name.h"
#include "common/capture/panorama_name.h"

enum status sfm_single_camera(bool *single, const struct photo_list *photos, const struct sfm_params *params,
                              struct err *err)
{
    const struct photo_info *first = photos->count ? &photos->photos[0].info : NULL;
    int other = 0;
    bool same_size = true, same_lens = true;
    for (int i = 1; i < photos->count; i++) {
        const struct photo_info *info = &photos->photos[i].info;
        if (info->width != first->width || info->height != first->height) {
            if (same_size) other = i;
            same_size = false;
        }
        const size_t clip = frame_name_clip(photos->photos[i].file);
        int yaw;
        /* a value missing from EXIF is 0 or "", and must be missing from all photos */
        same_lens =
            same_lens && info->focal_mm == first->focal_mm && !strcmp(info->make, first->make) &&
            !strcmp(info->model, first->model) && clip == frame_name_clip(photos->photos[0].file) &&
            !strncmp(photos->photos[i].file, photos->photos[0].file, clip) &&
            !panorama_name_read(&yaw, photos->photos[i].file) == !panorama_name_read(&yaw, photos->photos[0].file);
    }
    *single =
        !strcmp(params->single_camera, "yes") || (!strcmp(params->single_camera, "auto") && same_size && same_lens);
    if (*single && !same_size) {
        const struct photo_record *a = &photos->photos[0], *b = &photos->photos[other];
        return err_set(
            err, ST_USAGE,
            "[sfm] single_camera is yes, but photo \"%s\" is %d x %d px and \"%s\" %d x %d px; set it to auto or no.",
            a->file, a->info.width, a->info.height, b->file, b->info.width, b->info.height);
    }
    return ST_OK;
}

bool sfm_panorama_lens(char text[SFM_LENS_TEXT], const struct photo_record *photo)
{
    int yaw;
    const double f = photo->info.width / 2.0;
    if (!panorama_name_read(&yaw, photo->file)) return false;
    snprintf(text, SFM_LENS_TEXT, "%.9g,%.9g,%.9g,%.9g", f, f, f, f);
    return true;
}

void sfm_png_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params)
{
    const struct photo_info *first = photos->count ? &photos->photos[0].info : NULL;
    enum camera_model model = CAMERA_SIMPLE_RADIAL;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        const char *end = strrchr(p->file, '.');
        if (!end || strcasecmp(end, ".png") || !(p->info.focal35_mm > 0) || p->info.focal35_mm != first->focal35_mm ||
            p->info.width != first->width || p->info.height != first->height)
            return;
    }
    if (!first || !camera_model_from_name(params->camera_model, &model)) return;
    const int count = camera_model_params(model);
    const bool one = camera_model_has_one_focal(model);
    /* COLMAP's rule for JPEGs: the longer side is 35 mm */
    const double focal = first->focal35_mm / 35 * fmax(first->width, first->height);
    int length = snprintf(text, SFM_LENS_TEXT, "%.9g", focal);
    if (!one) length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",%.9g", focal);
    length +=
        snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",%.9g,%.9g", first->width / 2.0, first->height / 2.0);
    for (int i = one ? 3 : 4; i < count; i++) length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",0");
}

enum status sfm_equisolid_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos,
                               const struct sfm_params *params, struct err *err)
{
    const double film_diagonal = hypot(36, 24); /* mm; EXIF's 35 mm focal length refers to the diagonal */
    double numbers[CAMERA_MAX_PARAMS] = {0};
    const int given = *params->camera_params ? sfm_parse_numbers(numbers, params->camera_params) : 0;
    const struct photo_record *first = photos->count ? &photos->photos[0] : NULL;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        const bool same_size = p->info.width == first->info.width && p->info.height == first->info.height;
        if (!given && !(p->info.focal35_mm > 0))
            return err_set(
                err, ST_USAGE,
                "[sfm] camera_model = EQUISOLID needs a focal length to start from, and EXIF of photo \"%s\" does "
                "not state it for 35 mm film. Set camera_params = F in pixels: the focal length divided by "
                "the sensor's width, both in mm, times %d, the photo's width.",
                p->file, p->info.width);
        if (!same_size || (!given && p->info.focal35_mm != first->info.focal35_mm))
            return err_set(
                err, ST_USAGE,
                "[sfm] camera_model = EQUISOLID needs photos of one lens, but \"%s\" and \"%s\" differ in %s. "
                "Leave out those of other lenses (EXCLUDE), or set camera_model = OPENCV_FISHEYE.",
                first->file, p->file, same_size ? "focal length" : "size");
    }
    if (!first) return ST_OK;
    const double w = first->info.width, h = first->info.height;
    const double focal = given ? numbers[0] : first->info.focal35_mm / film_diagonal * hypot(w, h);
    const struct camera lens = camera_equisolid(first->info.width, first->info.height, focal,
                                                given == 3 ? numbers[1] : w / 2, given == 3 ? numbers[2] : h / 2);
    int length = 0;
    for (int i = 0; i < camera_model_params(lens.model); i++)
        length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, i < 4 ? "%s%.9g" : "%s%.12g", i ? "," : "",
                           lens.params[i]);
    return ST_OK;
}

enum status sfm_start_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params,
                           struct err *err)
{
    if (sfm_is_equisolid(params)) return sfm_equisolid_lens(text, photos, params, err);
    if (*params->camera_params)
        snprintf(text, SFM_LENS_TEXT, "%s", params->camera_params);
    else
        sfm_png_lens(text, photos, params);
    return ST_OK;
}
