/* model_pixels.h - which pixels of a picture show a surface that a model has, and which show another one. */
#ifndef REMODEL_MODEL_PIXELS_H
#define REMODEL_MODEL_PIXELS_H

#include "stages/evaluate/scene/traced_model.h"

enum picture_part { PART_ALL, PART_MODEL, PART_OTHER, PICTURE_PARTS };
extern const char *const picture_part_suffixes[PICTURE_PARTS]; /* of metrics: "", "_model", "_other" */

struct model_pixels {
    struct model_rays model;
    struct model_frame frame;
    bool known; /* there is such a model, and the truth knows its place */
};

/* Reads FOLDER/WHERE/model.txt. If there is none, or the cameras are not aligned, m->known is false, and a note says
 * that WHAT on surfaces of the model are skipped. The caller releases m in each case. ST_DATA: a damaged file. */
enum status model_pixels_read(struct model_pixels *m, struct evaluation *e, const char *where, const char *what,
                              struct err *err);
void model_pixels_release(struct model_pixels *m);

/* Allocates part[PART_MODEL] and part[PART_OTHER], which are NULL, of `count` pixels: part[PART_ALL] divided. A pixel
 * is on the model if the first face that its true ray meets lies in a plane within [evaluate] surface_distance of the
 * true point; one without a true depth is in neither. of: the true picture; depth: the file of its depth; index: of the
 * true pixel of each pixel, -1 none. The caller frees the parts in each case. */
enum status model_pixels_find(uint8_t *part[PICTURE_PARTS], const struct model_pixels *m, struct evaluation *e,
                              const struct true_picture *of, const char *depth, const int32_t *index, size_t count,
                              struct err *err);

#endif
