/* residual_table.h - reprojection errors of the imported cameras, by photo and by distance from the picture's
 * centre. */
#ifndef REMODEL_RESIDUAL_TABLE_H
#define REMODEL_RESIDUAL_TABLE_H

#include "common/base/provenance.h"
#include "common/capture/photo_list.h"
#include "stages/sfm_import/lens_fit.h"

enum { RESIDUAL_RINGS = 10 };

struct residual_row {
    int observations;   /* with a reprojected pixel; with none, all else is 0 */
    double median, p90; /* px, of the errors */
    double radial;      /* px, median of their components away from the centre */
};

struct residual_table {
    struct residual_row *photos; /* owned; of each photo of the scene */
    int photo_count;
    struct residual_row rings[RESIDUAL_RINGS]; /* of equal width, from the centre to the corner */
};

/* photo[i]: the photo of residual i. ST_NOMEM. */
enum status residual_table_make(struct residual_table *t, const struct lens_residual *residuals, const int *photo,
                                size_t count, int photo_count, struct err *err);
void residual_table_release(struct residual_table *t);

/* Writes "remodel-residuals 1" (docs/formats.md). */
enum status residual_table_write(const struct residual_table *t, const struct photo_list *photos, const char *path,
                                 const struct provenance *prov, struct err *err);

#endif
