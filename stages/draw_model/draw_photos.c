/* draw_photos.c - the photographs of a page, as JPEG files that browsers show.
 *
 * Their rows are those of the stored photo, and they carry no orientation, so that a pixel of the page is a pixel of
 * the scripts. A larger photo becomes smaller by an integer factor, which the page takes into account by its size. */
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/capture/photo_list.h"
#include "common/image/photo.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/draw_model/draw_data.h"

static enum status write_photo(const char *path, const struct photo *photo, int side, struct err *err)
{
    const int w = photo->info.width, h = photo->info.height, longest = w > h ? w : h,
              shift = photo->info.bits == 16 ? 8 : 0;
    const int k = (longest + side - 1) / side, width = (w + k - 1) / k, height = (h + k - 1) / k;
    unsigned char *rgb = malloc(3 * (size_t)width * (size_t)height);
    if (!rgb) return err_nomem(err, "a photo", 3 * (size_t)width * (size_t)height);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < 3; c++) {
                int sum = 0, n = 0;
                for (int j = y * k; j < y * k + k && j < h; j++)
                    for (int i = x * k; i < x * k + k && i < w; i++, n++)
                        sum += photo->samples[3 * ((size_t)j * (size_t)w + (size_t)i) + (size_t)c] >> shift;
                rgb[3 * ((size_t)y * (size_t)width + (size_t)x) + (size_t)c] = (unsigned char)(sum / n);
            }
    jpeg_write(path, rgb, width, height, 90, err);
    free(rgb);
    return err->status;
}

enum status draw_photos_write(const char *folder, const struct draw_sources *from, const struct draw_params *params,
                              struct err *err)
{
    const struct scene_files files = {.views = from->views};
    struct scene_inputs in = {0};
    scene_inputs_read(&in, SCENE_LENSES, &files, NULL, err);
    for (int i = 0; !err->status && i < in.lenses.count; i++) {
        const struct product_key key = {.photo = in.lenses.lenses[i].photo};
        struct photo_record record = {0};
        struct photo photo = {0};
        char path[FILE_PATH], to[FILE_PATH];
        bool made = false;
        for (int k = 0; k < i && !made; k++) made = !strcmp(in.lenses.lenses[k].photo, key.photo);
        if (!made && !photo_record_read(&record, from->records, key.photo, NULL, err) &&
            !file_path(path, from->photos, record.file, "", err) && !photo_read(&photo, path, err) &&
            !product_path_in(to, folder, PRODUCT_DRAW_PHOTO, &key, err))
            write_photo(to, &photo, params->photo_side, err);
        photo_release(&photo);
        photo_record_release(&record);
    }
    scene_inputs_release(&in);
    return err->status;
}
