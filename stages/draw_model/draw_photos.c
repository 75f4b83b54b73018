/* draw_photos.c - the photographs of a page.
 *
 * Their rows are those of the stored photo, and they carry no orientation, so that a pixel of the page is a pixel of
 * the scripts. A larger photo becomes smaller by an integer factor, which the page takes into account by its size.
 *
 * Each is a JPEG in a script: of a page that was opened from a disk, a browser shows picture files, but does not give
 * their pixels, which the draft of an edit needs. The list of photos shows small ones. */
#include <dirent.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/capture/photo_list.h"
#include "common/image/photo.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/draw_model/draw_data.h"

enum { SMALL_SIDE = 160, SMALL_QUALITY = 70 };

/* A JPEG of the photo, made smaller by an integer factor so that no side is longer, as a string of base64. */
static enum status write_jpeg(FILE *to, const struct photo *photo, int side, int quality, struct err *err)
{
    const int w = photo->info.width, h = photo->info.height, longest = w > h ? w : h,
              shift = photo->info.bits == 16 ? 8 : 0;
    const int k = (longest + side - 1) / side, width = (w + k - 1) / k, height = (h + k - 1) / k;
    unsigned char *rgb = malloc(3 * (size_t)width * (size_t)height), *bytes = NULL;
    size_t size = 0;
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
    putc('"', to);
    if (!jpeg_encode(&bytes, &size, rgb, width, height, quality, err)) base64_write(to, bytes, size);
    putc('"', to);
    free(bytes);
    free(rgb);
    return err->status;
}

/* One photo: its script, and its line in photos.js. list: of that file, where a photo is one more. */
static enum status write_photo(const char *folder, FILE *list, const char *id, const struct photo *photo, bool is_first,
                               const struct draw_params *params, struct err *err)
{
    const struct product_key key = {.photo = id};
    struct outfile out = {0};
    char path[FILE_PATH];
    if (product_path_in(path, folder, PRODUCT_DRAW_PHOTO, &key, err) || outfile_open(&out, path, err))
        return err->status;
    fputs("remodel.photo(", out.fp);
    draw_data_write_string(out.fp, id, strlen(id));
    fputs(", ", out.fp);
    write_jpeg(out.fp, photo, params->photo_side, params->photo_quality, err);
    fputs(");\n", out.fp);
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    fputs(is_first ? "\n" : ",\n", list);
    draw_data_write_string(list, id, strlen(id));
    fprintf(list, ": [%d, %d, ", photo->info.width, photo->info.height);
    if (!err->status) write_jpeg(list, photo, SMALL_SIDE, SMALL_QUALITY, err);
    putc(']', list);
    return err->status;
}

static enum status write_views(const char *folder, FILE *list, const struct draw_sources *from, struct err *err)
{
    const struct scene_files files = {.views = from->views};
    struct scene_inputs in = {0};
    scene_inputs_read(&in, SCENE_LENSES, &files, NULL, err);
    for (int i = 0; !err->status && i < in.lenses.count; i++) {
        const char *id = in.lenses.lenses[i].photo;
        struct photo_record record = {0};
        struct photo photo = {0};
        char path[FILE_PATH];
        bool made = false;
        for (int k = 0; k < i && !made; k++) made = !strcmp(in.lenses.lenses[k].photo, id);
        if (!made && !photo_record_read(&record, from->records, id, NULL, err) &&
            !file_path(path, from->photos, record.file, "", err) && !photo_read(&photo, path, err))
            write_photo(folder, list, id, &photo, i == 0, from->params, err);
        photo_release(&photo);
        photo_record_release(&record);
    }
    scene_inputs_release(&in);
    return err->status;
}

static int is_jpeg(const struct dirent *entry)
{
    const size_t n = strlen(entry->d_name);
    return entry->d_name[0] != '.' && n > 4 && !strcmp(entry->d_name + n - 4, ".jpg");
}

static enum status write_references(const char *folder, FILE *list, const struct draw_sources *from, struct err *err)
{
    struct dirent **entries = NULL;
    const int count = from->references ? scandir(from->references, &entries, is_jpeg, alphasort) : 0;
    if (count < 0 && errno != ENOENT) err_errno(err, "list", from->references);
    for (int i = 0; i < count; i++) {
        struct photo photo = {0};
        char path[FILE_PATH], id[FILE_PATH];
        snprintf(id, sizeof id, "%.*s", (int)strlen(entries[i]->d_name) - 4, entries[i]->d_name);
        if (!err->status && !file_path(path, from->references, entries[i]->d_name, "", err) &&
            !photo_read(&photo, path, err))
            write_photo(folder, list, id, &photo, i == 0, from->params, err);
        photo_release(&photo);
        free(entries[i]);
    }
    free(entries);
    return err->status;
}

enum status draw_photos_write(const char *folder, const struct draw_sources *from, struct err *err)
{
    struct outfile out = {0};
    char path[FILE_PATH];
    if (product_path_in(path, folder, PRODUCT_DRAW_PHOTOS, NULL, err) || outfile_open(&out, path, err))
        return err->status;
    fputs("remodel.small = {", out.fp);
    write_views(folder, out.fp, from, err);
    fputs("};\nremodel.references = {", out.fp);
    if (!err->status) write_references(folder, out.fp, from, err);
    fputs("};\n", out.fp);
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    return err->status;
}
