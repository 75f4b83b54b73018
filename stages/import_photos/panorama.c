/* panorama.c - equirectangular photos, and the pinhole views that are cut out of them.
 *
 * Column x of a panorama of width W shows the longitude (x / W - 1/2) 360 degrees, row y the latitude (1/2 - y / H) 180
 * degrees; its middle is the direction of yaw 0. A view takes bilinear samples: it is nowhere coarser than the
 * panorama.
 *
 * Phones also take photos of 2:1 that are no panoramas. A panorama ends where it begins, and its first row shows one
 * point. */
#include "stages/import_photos/panorama.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/file_path.h"
#include "common/base/parallel.h"
#include "common/math/numbers.h"

enum { XMP_BYTES = 1 << 18 }; /* of the file's beginning, where XMP is */

static bool says_panorama(const char *path)
{
    char *bytes = malloc(XMP_BYTES);
    FILE *fp = fopen(path, "rb");
    const size_t size = bytes && fp ? fread(bytes, 1, XMP_BYTES, fp) : 0;
    const bool says = size && memmem(bytes, size, "ProjectionType", 14) && memmem(bytes, size, "equirectangular", 15);
    if (fp) fclose(fp);
    free(bytes);
    return says;
}

/* Mean difference of two columns, or of the neighbours in a row, of 8-bit values. */
static double difference(const struct photo *p, int x0, int x1, int row)
{
    const double unit = p->info.bits == 16 ? 257 : 1;
    const int count = row < 0 ? p->info.height : p->info.width - 1;
    double sum = 0;
    for (int i = 0; i < count; i++) {
        const size_t y = (size_t)(row < 0 ? i : row) * (size_t)p->info.width;
        const uint16_t *a = p->samples + 3 * (y + (size_t)(row < 0 ? x0 : i)),
                       *b = p->samples + 3 * (y + (size_t)(row < 0 ? x1 : i + 1));
        for (int c = 0; c < 3; c++) sum += fabs((double)a[c] - b[c]) / unit;
    }
    return sum / (3.0 * count);
}

static bool looks_panoramic(const char *path)
{
    struct photo p = {0};
    struct err ignored = ERR_INIT;
    if (photo_read(&p, path, &ignored)) return false;
    const int w = p.info.width, h = p.info.height;
    const double seam = difference(&p, w - 1, 0, -1);
    const double inside = difference(&p, w / 2 - 1, w / 2, -1) + difference(&p, w / 4 - 1, w / 4, -1);
    const double poles = fmax(difference(&p, 0, 0, 0), difference(&p, 0, 0, h - 1));
    photo_release(&p);
    return seam <= 2 + inside && poles <= 2;
}

static bool is_panorama(const char *path, bool all)
{
    struct photo_info info;
    struct err ignored = ERR_INIT;
    if (photo_read_info(&info, path, &ignored) || info.bits > 16 || info.width != 2 * info.height || info.height < 256)
        return false;
    return all || says_panorama(path) || looks_panoramic(path);
}

int panorama_find(struct photo_scan *scan, const struct photo_params *params)
{
    int found = 0;
    for (int i = 0; strcmp(params->panoramas, "no") && i < scan->count; i++) {
        struct scanned_photo *p = &scan->photos[i];
        char path[FILE_PATH];
        struct err ignored = ERR_INIT;
        if (p->excluded || file_path(path, scan->folder, p->file, "", &ignored)) continue;
        p->panorama = is_panorama(path, !strcmp(params->panoramas, "yes"));
        found += p->panorama;
    }
    return found;
}

int panorama_side(const struct photo *panorama) { return 2 * (int)lrint(panorama->info.width / (2 * PI) + 0.25); }

struct cut_job {
    struct photo *to;
    const struct photo *from;
    double yaw; /* radians */
};

/* One sample; columns go round. */
static double sample_at(const struct photo *p, long x, long y, int channel)
{
    const long w = p->info.width, h = p->info.height;
    const long row = y < 0 ? 0 : y >= h ? h - 1 : y, column = (x % w + w) % w;
    return p->samples[3 * ((size_t)row * (size_t)w + (size_t)column) + (size_t)channel];
}

static void cut_rows(void *ctx, size_t begin, size_t end, int thread)
{
    const struct cut_job *j = ctx;
    const int side = j->to->info.width;
    const double f = side / 2.0, w = j->from->info.width, h = j->from->info.height;
    (void)thread;
    for (size_t v = begin; v < end; v++)
        for (int u = 0; u < side; u++) {
            const double dx = (u + 0.5 - f) / f, dy = ((double)v + 0.5 - f) / f;
            const double longitude = j->yaw + atan2(dx, 1), latitude = atan2(dy, hypot(dx, 1)); /* down */
            const double x = (longitude / (2 * PI) + 0.5) * w - 0.5, y = (latitude / PI + 0.5) * h - 0.5;
            const double x0 = floor(x), y0 = floor(y), fx = x - x0, fy = y - y0;
            for (int c = 0; c < 3; c++) {
                const long ix = (long)x0, iy = (long)y0;
                const double top = (1 - fx) * sample_at(j->from, ix, iy, c) + fx * sample_at(j->from, ix + 1, iy, c);
                const double low =
                    (1 - fx) * sample_at(j->from, ix, iy + 1, c) + fx * sample_at(j->from, ix + 1, iy + 1, c);
                j->to->samples[3 * (v * (size_t)side + (size_t)u) + (size_t)c] =
                    (uint16_t)lrint((1 - fy) * top + fy * low);
            }
        }
}

enum status panorama_cut(struct photo *view, const struct photo *panorama, int yaw, struct err *err)
{
    struct cut_job job = {view, panorama, yaw * PI / 180};
    *view = (struct photo){.info = panorama->info};
    view->info.width = view->info.height = panorama_side(panorama);
    view->info.orientation = 1;
    view->info.focal_mm = view->info.focal35_mm = 0; /* the lens is known by the view's name */
    if (photo_init_samples(view, err)) return err->status;
    parallel_for((size_t)view->info.height, 16, cut_rows, &job);
    return ST_OK;
}
