/* importer.h - the state of one import, shared by its steps. Not for other modules. */
#ifndef REMODEL_IMPORTER_H
#define REMODEL_IMPORTER_H

#include "stages/sfm_import/import_model.h"
#include "stages/sfm_import/view_cameras.h"

struct input_image {
    int photo;               /* index of the scene's photo; -1: none */
    struct camera lens;      /* at the photo's size */
    double scale_u, scale_v; /* from the model's pixels to the photo's */
    struct mat3 cam_from_world;
    struct vec3 translation;
    int views[MAX_PHOTO_VIEWS], view_count; /* into importer.views */
};

struct output_view {
    char *name; /* owned */
    int image, photo;
    struct photo_view view;
    double fx, fy, cx, cy;
    struct mat3 view_from_photo;
};

struct importer {
    const struct sfm_model *in;
    const struct photo_list *photos;
    const struct sfm_import_params *params;
    struct input_image *images;
    struct output_view *views;
    int view_count;
    double *errors; /* of each track entry, in order; INFINITY: behind the camera or outside its lens; -1: no photo */
};

/* Matches images to photos by name. ST_DATA: two images of one photo, fewer than two photos placed. */
enum status importer_match_photos(struct importer *imp, struct import_stats *stats, struct err *err);

/* Scales the cameras to the photos' sizes. ST_DATA: the aspect ratio differs. */
enum status importer_fit_lenses(struct importer *imp, struct err *err);

/* Computes all reprojection errors and their statistics, in all and by photo and radius. */
enum status importer_measure_errors(struct importer *imp, struct import_stats *stats, struct residual_table *table,
                                    struct err *err);

/* Logs the errors and warns about models that do not fit. ST_DATA: no observation fits. */
enum status importer_judge_errors(const struct importer *imp, const struct import_stats *stats, struct err *err);

#endif
