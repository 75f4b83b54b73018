/* evaluation_parts.h - what the groups of metrics share. */
#ifndef REMODEL_EVALUATION_PARTS_H
#define REMODEL_EVALUATION_PARTS_H

#include <stdbool.h>

#include "common/base/file_path.h"
#include "common/base/provenance.h"
#include "common/capture/camera_alignment.h"
#include "common/capture/photo_camera.h"
#include "common/product/product.h"
#include "stages/evaluate/measure/metric_table.h"
#include "stages/evaluate/scene/evaluate_params.h"
#include "stages/evaluate/truth/linear_picture.h"
#include "stages/evaluate/truth/true_set.h"
#include "stages/evaluate/truth/truth.h"

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
struct picture_map evaluation_map_of_view(const struct view_set *set, int view);

#endif
