/* evaluation_parts.h - the metrics of an evaluation, by group, and the helpers of the groups. */
#ifndef REMODEL_EVALUATION_PARTS_H
#define REMODEL_EVALUATION_PARTS_H

#include <stdbool.h>

#include "common/base/file_path.h"
#include "common/base/provenance.h"
#include "common/capture/camera_alignment.h"
#include "common/capture/photo_camera.h"
#include "common/product/product.h"
#include "stages/evaluate/evaluate_params.h"
#include "stages/evaluate/evaluation.h"
#include "stages/evaluate/linear_picture.h"
#include "stages/evaluate/metric_table.h"
#include "stages/evaluate/true_set.h"
#include "stages/evaluate/truth.h"

struct view_set { /* the cameras of the kept or of the held-out views, and the lenses of their photographs */
    struct camera_set cameras;
    struct lens_list lenses;
};

struct evaluation {
    const char *folder, *shared;
    const char *rendered;     /* folder of rendered pictures */
    const char *truth_folder; /* NULL: no truth is given */
    const struct evaluate_params *params;
    struct provenance *prov;
    int shared_inputs; /* of prov: cameras and truth, without the files of single views */
    struct photo_list photos;
    struct view_set views, held;
    bool has_held, aligned;
    struct truth truth;
    struct similarity truth_from_scene; /* if aligned */
    double baseline;                    /* of disparities; 0: there is none */
    double radiance_scale;              /* true radiance of 1 in the products; 0: unknown */
    double white;                       /* true radiance that is white in 8 bits; 0: unknown */
    struct metric_table table;
};

/* Each group adds its metrics to the table, or a note that says why it has none. Cameras come first: they set `aligned`
 * and truth_from_scene. */
enum status evaluate_cameras(struct evaluation *e, struct err *err);      /* camera.* */
enum status evaluate_axes(struct evaluation *e, struct err *err);         /* axes.* */
enum status evaluate_walls(struct evaluation *e, struct err *err);        /* model.* */
enum status evaluate_edited_walls(struct evaluation *e, struct err *err); /* edited.E.*, of the models of edits */
enum status evaluate_faces(struct evaluation *e, struct err *err);        /* model.faces, edited.E.faces */
enum status evaluate_depths(struct evaluation *e, struct err *err);       /* depth.* */
enum status evaluate_pictures(struct evaluation *e, struct err *err);     /* holdout.* */

enum status evaluate_radiance(struct evaluation *e, struct err *err);      /* radiance.*; sets radiance_scale */
enum status evaluate_renders(struct evaluation *e, struct err *err);       /* novel.*, edited.E.* */
enum status evaluate_revealed(struct evaluation *e, struct err *err);      /* edited.E.revealed* */
enum status evaluate_relit(struct evaluation *e, struct err *err);         /* edited.E.relit_*, edited.E.unlit_psnr */
enum status evaluate_films(struct evaluation *e, struct err *err);         /* edited.E.flicker* */
enum status evaluate_irradiance(struct evaluation *e, struct err *err);    /* irradiance.* */
enum status evaluate_shell(struct evaluation *e, struct err *err);         /* shell.* */
enum status evaluate_textures(struct evaluation *e, struct err *err);      /* texture.* */
enum status evaluate_texture_cover(struct evaluation *e, struct err *err); /* texture.covered */
enum status evaluate_heldout_textures(struct evaluation *e, struct err *err); /* texture.heldout_* */

/* metric_add() of "PREFIX.NAME"; ST_INTERNAL: a longer name than a table holds. */
enum status evaluation_metric(struct evaluation *e, const char *view, const char *prefix, const char *name,
                              double value, struct err *err);

/* Sets e->white, the radiance that is white in 8 bits; 0: it is not given, and the scale of radiance is unknown. */
void evaluation_set_white(struct evaluation *e);

/* The path of a product of the scene. */
enum status evaluation_path(char path[FILE_PATH], const struct evaluation *e, enum product_id id,
                            const struct product_key *key, struct err *err);

/* The index in e->photos of a view's photograph. */
int evaluation_photo(const struct evaluation *e, const struct view_set *set, int view);

/* How a view sees the true picture of its photograph: through the lens with which it was rectified. */
struct picture_map map_of_view(const struct view_set *set, int view);

#endif
