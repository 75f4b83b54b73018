/* outdoors_gather.h - the picture of the outdoors from all pictures that show some of it. */
#ifndef REMODEL_OUTDOORS_GATHER_H
#define REMODEL_OUTDOORS_GATHER_H

#include "common/gather/outdoors_picture.h"
#include "common/texture/outdoors.h"
#include "stages/bake_outdoors/outdoors_params.h"

enum { MAX_CANDIDATES = 12 }; /* of a cell */

/* What a picture shows at the centre of a cell. */
struct outdoors_candidate {
    float luminance;
    float score; /* of candidates of the same rank, the one to prefer */
    int picture; /* index; -1: none, and none follows */
    bool clipped;
    bool outvoted; /* set by outdoors_choose() */
};

/* The cells of the picture of the outdoors, CELL px wide. */
struct outdoors_cells {
    int width, height;
    struct outdoors_candidate (*lists)[MAX_CANDIDATES]; /* of each cell; owned */
    int *chosen;                                        /* picture of each cell, -1: none; owned */
};

/* 0: the candidate is clipped; otherwise 1 plus the order of its picture. */
int outdoors_rank(const struct outdoors_candidate *c, const struct outdoors_picture *pictures);

/* outdoors_gains.c. Sets gain[photo] for the photos of the pictures; photos are numbered from 0. Those that reference
 * images have in common with photos decide the level, and reference images keep the gain 1. */
enum status outdoors_find_gains(double *gain, int photos, const struct outdoors_cells *cells,
                                const struct outdoors_picture *pictures, struct err *err);

/* outdoors_choose.c. Sets chosen. */
void outdoors_choose(struct outdoors_cells *cells, const struct outdoors_picture *pictures, const double *gain,
                     double agree);

/* The model without panes, and the normals of its faces. {0} is the empty state. */
struct outdoors_model {
    struct model_rays rays;
    struct vec3 *normals; /* by id of a face's name; owned */
};

enum status outdoors_model_read(struct outdoors_model *m, const char *path, struct provenance *prov, struct err *err);
void outdoors_model_release(struct outdoors_model *m);

/* What a run used, for its log. */
struct outdoors_totals {
    int references, photos;          /* pictures that the outdoors are taken from */
    double by_references, by_photos; /* shares of the sphere */
    double min_gain, max_gain;       /* of photos */
};

/* Makes the picture of what pictures show; the rest stays black. Files that show the outdoors are added to prov, named
 * views/VIEW.exr, ids/VIEW.exr, lri/ID.exr. o is {0} on entry; the caller releases it. Same bits for any number of
 * threads. */
enum status outdoors_gather(struct outdoors *o, struct outdoors_totals *totals, struct outdoors_picture *pictures,
                            int count, int photos, const struct outdoors_model *model,
                            const struct outdoors_params *params, struct provenance *prov, struct err *err);

#endif
