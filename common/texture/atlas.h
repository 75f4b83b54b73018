/* atlas.h - texture atlases of a solid model: pages of texels, and tiles that map the model's faces to them
 * [Colburn 2014, 4.5.1, 4.5.3].
 *
 * A folder holds page0.exr, page1.exr, ... and atlas.txt (docs/formats.md). A tile shows a part of one face, as one
 * pinhole view sees it (a view-dependent atlas, VDTA) or orthogonally (a view-independent atlas, VITA). Its matrix
 * takes points of the model's frame to pixels of its page: (x, y, w) = matrix (X, Y, Z, 1), pixel (x / w, y / w),
 * centres at +0.5. A look-up counts where w > 0 and the pixel is inside the tile's rectangle. Tiles of one face and
 * view that were cut because a page is too small share a border texel.
 *
 * A page has R G B (half, scene-linear, never negative), A (half: 1 where there is a texel, else 0 and all channels 0),
 * and source (uint): how the texel was made, an enum atlas_source, or ATLAS_VIEWS + k for the k-th of atlas.txt's
 * sources. */
#ifndef REMODEL_ATLAS_H
#define REMODEL_ATLAS_H

#include <stdbool.h>
#include <stdint.h>

#include "common/base/provenance.h"
#include "common/math/vec.h"

#define ATLAS_PAGE 1024 /* texels: the side of a full page; the last page may be smaller */

enum atlas_source {
    ATLAS_NONE,        /* no texel: outside the face, or nothing that the atlas is to hold */
    ATLAS_SYNTHESISED, /* from the nearest seen texels of the same face; no view shows the place clean */
    ATLAS_DEFAULT,     /* the default colour: no view shows any of the face */
    ATLAS_VIEWS,       /* and above: copied or warped from a view */
};

struct atlas_tile {
    int face;            /* id of the face, as in model.txt */
    int view;            /* index into views: whose projection; -1 in a VITA */
    int page, x, y;      /* the rectangle's first texel */
    int width, height;   /* texels */
    double matrix[3][4]; /* model frame -> pixels of the page */
};

/* {0} is the empty state; everything is owned. */
struct atlas {
    char *viewpoint;    /* the photo's id; NULL in a VITA */
    struct vec3 centre; /* of the viewpoint, in the model's frame */
    char **views;       /* the viewpoint's own views: sources from these are original texels */
    int view_count;
    char **sources; /* names of the views that texels come from, in order of name */
    int source_count;
    struct atlas_tile *tiles; /* in order of face, then view, then place in the view */
    int tile_count;
    int (*page_sizes)[2]; /* width and height of each page */
    int page_count;
};

/* A page in memory. */
struct atlas_page {
    int width, height;
    float *rgb;       /* 3 a texel */
    uint32_t *source; /* ATLAS_NONE: no texel */
};

void atlas_release(struct atlas *a); /* idempotent; NULL is allowed */
enum status atlas_page_init(struct atlas_page *p, int width, int height, struct err *err);
void atlas_page_release(struct atlas_page *p);

/* First-fit decreasing: sets page, x, y of each tile from its width and height, and a->page_sizes, page_count. Taller
 * tiles first, then wider, then in the given order; each goes to the first page, and there to the first place (upper,
 * then left), in which it fits. ST_DATA: a tile larger than a page. Tiles keep their order. */
enum status atlas_pack(struct atlas *a, struct err *err);

/* FOLDER/pageN.exr. */
enum status atlas_page_path(char path[FILE_PATH], const char *folder, int page, struct err *err);
/* Writes FOLDER/pageN.exr, which appears whole or not at all. A colour below 0, which a gradient solve may leave,
 * becomes 0. ST_DATA: NaN. */
enum status atlas_write_page(const struct atlas_page *p, const char *folder, int page, const struct provenance *prov,
                             struct err *err);
/* Writes FOLDER/atlas.txt, when all pages have been written, and removes pages that an earlier atlas had beyond these.
 * Tiles are written in order; they may be in any order in memory. prov may be NULL. ST_DATA: a name that
 * textfile_quote() refuses. */
enum status atlas_write_list(const struct atlas *a, const char *folder, const struct provenance *prov, struct err *err);
/* Both, for page_count pages. */
enum status atlas_write(const struct atlas *a, const struct atlas_page *pages, const char *folder,
                        const struct provenance *prov, struct err *err);
/* Reads atlas.txt. Afterwards indices are in range, rectangles inside their pages, numbers finite, names and tiles in
 * order; otherwise ST_DATA with file and line. */
enum status atlas_read(struct atlas *a, const char *folder, struct provenance *prov, struct err *err);
/* Reads a page. ST_DATA: another size than atlas.txt says, a source that it does not list, a negative colour, alpha
 * other than 1 where there is a source and 0 elsewhere. */
enum status atlas_page_read(struct atlas_page *p, const struct atlas *a, int page, const char *folder,
                            struct provenance *prov, struct err *err);

/* The first tile whose face is not below `face`; tile_count: none. The tiles of a face follow each other. */
int atlas_first_tile(const struct atlas *a, int face);
/* The tile of a face that shows a point of the model's frame, and the page pixel there; NULL: none does. Of several
 * tiles it is the one in which the pixel lies farthest from the rectangle's edges. So tiles that share a border texel
 * meet at its centre, and their look-ups there are equal. Tiles must be in order, as atlas_read() leaves them. */
const struct atlas_tile *atlas_find(const struct atlas *a, int face, struct vec3 p, double *x, double *y);
/* The page pixel of a point of the model's frame in a tile; false: the look-up does not count. */
bool atlas_tile_project(const struct atlas_tile *t, struct vec3 p, double *x, double *y);
/* The colour there, bilinear over the texels that exist; false: none of the four does. *nearest (may be NULL): source
 * of the nearest texel. */
bool atlas_sample(float rgb[3], uint32_t *nearest, const struct atlas_page *p, const struct atlas_tile *t, double x,
                  double y);

#endif
