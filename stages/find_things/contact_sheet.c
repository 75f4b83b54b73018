/* contact_sheet.c - pictures of things with their names and sizes; see contact_sheet.h. */
#include "stages/find_things/contact_sheet.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/base64.h"
#include "common/base/outfile.h"
#include "common/image/draw.h"
#include "common/image/photo.h"

enum {
    COLUMNS = 5,
    TILE_WIDTH = 240, /* px of the sheet */
    TILE_HEIGHT = 200,
    TEXT = 56, /* height of a tile's text */
    GAP = 12,
    LARGEST = 480, /* px of a tile's picture */
    QUALITY = 85
};

#define MARGIN 0.15f /* of the rectangle's sides */
#define DARK   0.35f /* brightness of what is not the thing */
#define BRIGHT 0.9   /* share of the part's pixels that are at most white */

void sheet_tile_release(struct sheet_tile *tile)
{
    free(tile->jpeg);
    *tile = (struct sheet_tile){0};
}

static int clamped(double x, int low, int high) { return x < low ? low : x > high ? high : (int)x; }

enum status sheet_tile_make(struct sheet_tile *tile, const struct image *photo, const uint32_t *mask, uint32_t id,
                            const double rect[4], struct err *err)
{
    const double wide = rect[2] - rect[0], tall = rect[3] - rect[1];
    const int x0 = clamped(rect[0] - MARGIN * wide, 0, photo->width - 1),
              x1 = clamped(rect[2] + MARGIN * wide, 0, photo->width - 1),
              y0 = clamped(rect[1] - MARGIN * tall, 0, photo->height - 1),
              y1 = clamped(rect[3] + MARGIN * tall, 0, photo->height - 1);
    const int every = (x1 - x0 > y1 - y0 ? x1 - x0 : y1 - y0) / LARGEST + 1;
    struct image part = {0};
    unsigned char *rgb = NULL;
    tile->width = (x1 - x0) / every + 1;
    tile->height = (y1 - y0) / every + 1;
    if (image_init(&part, tile->width, tile->height, 4, err)) return err->status;
    for (int y = 0; y < tile->height; y++)
        for (int x = 0; x < tile->width; x++) {
            const int u = x0 + x * every, v = y0 + y * every;
            const float bright = mask[(size_t)v * (size_t)photo->width + (size_t)u] == id ? 1 : DARK;
            for (int c = 0; c < 3; c++) image_at(&part, x, y)[c] = bright * image_at(photo, u, v)[c];
            image_at(&part, x, y)[3] = image_at(photo, u, v)[3];
        }
    if (!(rgb = malloc((size_t)tile->width * (size_t)tile->height * 3))) err_nomem(err, "a tile", LARGEST);
    if (!err->status && !image_expose(&part, BRIGHT, 1, err)) {
        image_to_srgb8(&part, rgb);
        jpeg_encode(&tile->jpeg, &tile->size, rgb, tile->width, tile->height, QUALITY, err);
    }
    free(rgb);
    image_release(&part);
    return err->status;
}

static void put_tile(FILE *to, const struct thing *t, const struct sheet_tile *tile, const char *unit, int k)
{
    const int x = GAP + k % COLUMNS * (TILE_WIDTH + GAP), y = GAP + k / COLUMNS * (TILE_HEIGHT + TEXT + GAP);
    if (tile->jpeg) {
        fprintf(to, "<image x=\"%d\" y=\"%d\" width=\"%d\" height=\"%d\" href=\"data:image/jpeg;base64,", x, y,
                TILE_WIDTH, TILE_HEIGHT);
        base64_write(to, tile->jpeg, tile->size);
        fputs("\"/>\n", to);
    }
    fprintf(to, "<text class=\"name\" x=\"%d\" y=\"%d\">%s</text>\n", x, y + TILE_HEIGHT + 18, t->name);
    fprintf(to, "<text x=\"%d\" y=\"%d\">%.2f x %.2f x %.2f%s%s, %s%s</text>\n", x, y + TILE_HEIGHT + 34,
            t->high.x - t->low.x, t->high.y - t->low.y, t->high.z - t->low.z, *unit ? " " : "", unit,
            t->support == THING_ON_NONE ? "no support" : "on the ",
            t->support == THING_ON_NONE ? "" : thing_support_word(t->support));
    fprintf(to, "<text x=\"%d\" y=\"%d\">in %d view%s, best in %s</text>\n", x, y + TILE_HEIGHT + 49, t->views,
            t->views == 1 ? "" : "s", t->view);
}

enum status contact_sheet_write(const struct thing_list *list, const struct sheet_tile *tiles, const char *unit,
                                const char *path, struct err *err)
{
    const int columns = list->count < COLUMNS ? (list->count ? list->count : 1) : COLUMNS,
              rows = list->count ? (list->count + COLUMNS - 1) / COLUMNS : 1;
    const int width = GAP + columns * (TILE_WIDTH + GAP), height = GAP + rows * (TILE_HEIGHT + TEXT + GAP);
    struct outfile f = {0};
    if (!outfile_open(&f, path, err)) {
        fprintf(f.fp,
                "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%d\" height=\"%d\" viewBox=\"0 0 %d %d\">\n"
                "<style>text{font:11px sans-serif}.name{font:bold 15px sans-serif}</style>\n"
                "<rect width=\"100%%\" height=\"100%%\" fill=\"white\"/>\n",
                width, height, width, height);
        for (int k = 0; k < list->count; k++) put_tile(f.fp, &list->things[k], &tiles[k], unit, k);
        if (!list->count) fprintf(f.fp, "<text x=\"%d\" y=\"%d\">No things were found.</text>\n", GAP, 3 * GAP);
        fputs("</svg>\n", f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}
