/* draw_data.h - what a page needs of a scene, as scripts beside it: pages from a disk may not read files. */
#ifndef REMODEL_DRAW_DATA_H
#define REMODEL_DRAW_DATA_H

#include <stdio.h>

#include "common/base/err.h"
#include "common/base/param.h"
#include "common/model/thing_list.h"
#include "common/model/thing_volume.h"

/* name, type, default, min, max, unit, help */
#define DRAW_PARAMS(X)                                                                                        \
    X(max_points, int, 2000000, 1000, 20000000, "",                                                           \
      "points that the page has at most, for walls drawn by rectangles; of more points it has an even share") \
    X(photo_side, int, 4096, 64, 20000, "px", "length of the longer side of the page's photographs at most")  \
    X(photo_quality, int, 85, 1, 100, "", "JPEG quality of the page's photographs")                           \
    X(mask_columns, int, 320, 8, 4000, "", "cells across a photo in which the page knows furniture")

struct draw_params {
    DRAW_PARAMS(PARAM_FIELD)
};
#define DRAW_PARAMS_DEFAULT        \
    {                              \
        DRAW_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param draw_param_table[];

struct draw_sources { /* paths; NULL: none */
    const char *name, *scene, *views, *axes, *points, *lines, *suggested, *candidates, *lights, *things, *references,
        *config, *photos, *records, *wasm, *page;
    const struct draw_params *params;
};

/* Parts of scripts: a JSON string; bytes, compressed by zlib's format, which browsers read, as base64 in parts, because
 * a string of a browser has a largest length. */
void draw_data_write_string(FILE *to, const char *text, size_t size);
enum status draw_data_write_packed(FILE *to, const void *bytes, size_t size, struct err *err);
/* The scene's masks/PHOTO.png: "PHOTO": "base64", ... */
enum status draw_masks_write(FILE *to, const struct draw_sources *from, struct err *err);
/* The furniture and which of it each photo shows; null without `things`. */
enum status draw_things_write(FILE *to, const struct draw_sources *from, struct err *err);

/* The surface of a thing, the id-th of its list: corners and triangles; null where it has none. */
enum status draw_shape_write(FILE *to, const struct thing *t, uint32_t id, const struct thing_volume *volume,
                             struct err *err);

/* scene.js: texts that the C code reads, the scene's own files, straight edges of each photo, masks, furniture. */
enum status draw_data_write_scene(const char *path, const struct draw_sources *from, struct err *err);
/* points.js: the scene's points, quantised and compressed; null without points. */
enum status draw_points_write(const char *path, const struct draw_sources *from, struct err *err);
/* code.js: the WebAssembly module. */
enum status draw_data_write_code(const char *path, const struct draw_sources *from, struct err *err);
/* photos/PHOTO.js of each photo that has a view, its rows as they are stored, and photos.js: all of them small, and the
 * names of reference images. */
enum status draw_photos_write(const char *folder, const struct draw_sources *from, struct err *err);
/* The page itself, from its sources: PAGE/page.html with the styles and scripts that it names. */
enum status draw_page_write(const char *path, const struct draw_sources *from, struct err *err);

#endif
