/* linear_photo.c - a photograph as scene-linear colour. */
#include "common/capture/linear_photo.h"

#include <stdio.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/image/exr.h"
#include "common/image/photo.h"

static enum status read_single(struct image *linear, struct photo_quality *quality, const char *photos,
                               const char *file, const struct single_exposure *assumed, struct provenance *prov,
                               struct err *err)
{
    struct photo photo = {0};
    char path[FILE_PATH], name[FILE_PATH];
    if (!file_path(path, photos, file, "", err) && !file_path(name, "photos", file, "", err) &&
        !photo_read_input(&photo, path, name, prov, err))
        photo_to_linear(linear, &photo, err);
    if (!err->status && quality) photo_quality_of_exposure(quality, &photo, linear, assumed, err);
    photo_release(&photo);
    return err->status;
}

static enum status read_merged(struct image *linear, struct photo_quality *quality, const char *folder, const char *id,
                               char radiometry[RADIOMETRY_SIZE], struct provenance *prov, struct err *err)
{
    static const char *const names[] = {"R", "G", "B", "clipped", "variance"};
    struct exr_image exr = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, folder, PRODUCT_HDR, &(struct product_key){.photo = id}, err))
        exr_read_product(&exr, PRODUCT_HDR, path, names, quality ? 5 : 3, prov, err);
    for (int c = 0; !err->status && c < 3; c++)
        if (!exr_find(&exr, names[c])->f)
            err_set(err, ST_DATA, "%s: channel %s contains integers, wanted half or float; merge the view again.", path,
                    names[c]);
    if (!err->status && !image_init(linear, exr.width, exr.height, 3, err)) {
        const float *const r = exr_find(&exr, "R")->f, *const g = exr_find(&exr, "G")->f,
                           *const b = exr_find(&exr, "B")->f;
        const size_t pixels = (size_t)exr.width * (size_t)exr.height;
        for (size_t i = 0; i < pixels; i++) {
            float *to = linear->data + 3 * i;
            to[0] = r[i];
            to[1] = g[i];
            to[2] = b[i];
        }
    }
    if (!err->status && quality) photo_quality_of_merged(quality, &exr, path, linear, err);
    const char *stored = exr_attribute(&exr, "remodel:radiometry");
    if (!err->status && stored) snprintf(radiometry, RADIOMETRY_SIZE, "%s", stored);
    exr_image_release(&exr);
    return err->status;
}

enum status linear_photo_read(struct image *linear, struct photo_quality *quality, char radiometry[RADIOMETRY_SIZE],
                              const char *photos, const struct photo_record *record,
                              const struct single_exposure *assumed, struct provenance *prov, struct err *err)
{
    strcpy(radiometry, "approximate");
    if (record->bracket_count) return read_merged(linear, quality, photos, record->id, radiometry, prov, err);
    return read_single(linear, quality, photos, record->file, assumed, prov, err);
}

static enum status open_single(struct linear_photo *p, const char *photos, const char *file,
                               const struct single_exposure *assumed, struct provenance *prov, struct err *err)
{
    char path[FILE_PATH], name[FILE_PATH];
    if (!file_path(path, photos, file, "", err) && !file_path(name, "photos", file, "", err) &&
        !photo_read_compact(&p->photo, path, name, prov, err))
        photo_light_init(&p->light, &p->photo, err);
    if (err->status) return err->status;
    photo_quality_judge_init(&p->judge, &p->photo, assumed);
    p->width = p->photo.info.width;
    p->height = p->photo.info.height;
    return ST_OK;
}

enum status linear_photo_open(struct linear_photo *p, char radiometry[RADIOMETRY_SIZE], const char *photos,
                              const struct photo_record *record, const struct single_exposure *assumed,
                              struct provenance *prov, struct err *err)
{
    *p = (struct linear_photo){0};
    strcpy(radiometry, "approximate");
    if (!record->bracket_count) return open_single(p, photos, record->file, assumed, prov, err);
    read_merged(&p->linear, &p->quality, photos, record->id, radiometry, prov, err);
    p->width = p->linear.width;
    p->height = p->linear.height;
    return err->status;
}

void linear_photo_take(const struct linear_photo *p, float *rgb, float *variance, uint8_t *marks, size_t first,
                       size_t count)
{
    photo_light_take(&p->light, rgb, first, count);
    photo_quality_judge(&p->judge, variance, marks, rgb, first, count);
}

void linear_photo_release(struct linear_photo *p)
{
    if (!p) return;
    image_release(&p->linear);
    photo_quality_release(&p->quality);
    photo_light_release(&p->light);
    photo_release(&p->photo);
    *p = (struct linear_photo){0};
}
