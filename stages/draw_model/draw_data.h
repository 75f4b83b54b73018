/* draw_data.h - what a page needs of a scene, as scripts beside it: pages from a disk may not read files. */
#ifndef REMODEL_DRAW_DATA_H
#define REMODEL_DRAW_DATA_H

#include "common/base/err.h"
#include "common/base/param.h"

/* name, type, default, min, max, unit, help */
#define DRAW_PARAMS(X)                                                                                        \
    X(max_points, int, 4000000, 1000, 20000000, "",                                                           \
      "points that the page has at most, for walls drawn by rectangles; of more points it has an even share") \
    X(photo_side, int, 4096, 64, 20000, "px", "length of the longer side of the page's photographs at most")

struct draw_params {
    DRAW_PARAMS(PARAM_FIELD)
};
#define DRAW_PARAMS_DEFAULT        \
    {                              \
        DRAW_PARAMS(PARAM_DEFAULT) \
    }
extern const struct param draw_param_table[];

struct draw_sources { /* paths; NULL: none */
    const char *name, *scene, *views, *axes, *points, *lines, *suggested, *candidates, *config, *photos, *records,
        *wasm, *page;
};

/* scene.js: texts that the C code reads, the scene's own files, and the straight edges of each photo, in its pixels. */
enum status draw_data_write_scene(const char *path, const struct draw_sources *from, struct err *err);
/* points.js: points.ply, compressed; without points an empty list. */
enum status draw_data_write_points(const char *path, const struct draw_sources *from, const struct draw_params *params,
                                   struct err *err);
/* code.js: the WebAssembly module. */
enum status draw_data_write_code(const char *path, const struct draw_sources *from, struct err *err);
/* photos/PHOTO.jpg of each photo that has a view: its rows as they are stored. */
enum status draw_photos_write(const char *folder, const struct draw_sources *from, const struct draw_params *params,
                              struct err *err);
/* The page itself, from its sources: PAGE/page.html with the styles and scripts that it names. */
enum status draw_page_write(const char *path, const struct draw_sources *from, struct err *err);

#endif
