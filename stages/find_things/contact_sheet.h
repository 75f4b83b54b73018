/* contact_sheet.h - a picture of all things for people, each in the view that shows it best: things/sheet.svg. */
#ifndef REMODEL_CONTACT_SHEET_H
#define REMODEL_CONTACT_SHEET_H

#include "common/image/image.h"
#include "common/model/thing_list.h"

/* A part of a photo as JPEG. */
struct sheet_tile {
    unsigned char *jpeg; /* owned; NULL: none */
    size_t size;
    int width, height;
};

/* Cuts the thing `id` out of a view: its rectangle with a margin, other pixels darker. photo: the view's linear
 * picture, R G B A; mask: the things of its pixels. */
enum status sheet_tile_make(struct sheet_tile *tile, const struct image *photo, const uint32_t *mask, uint32_t id,
                            const double rect[4], struct err *err);
void sheet_tile_release(struct sheet_tile *tile);

/* tiles: one for each thing. unit: "m", or "" where the scale is not known. */
enum status contact_sheet_write(const struct thing_list *list, const struct sheet_tile *tiles, const char *unit,
                                const char *path, struct err *err);

#endif
