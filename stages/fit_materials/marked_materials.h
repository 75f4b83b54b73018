/* marked_materials.h - scenes/NAME/materials.txt: regions of materials that a person marks in photographs.
 *
 * The first line is `remodel-marked-materials 1`. VIEW is a photo's id or a view's name; pixels are those of the
 * photograph as it is stored, as in docs/model-script.md:
 *   material NAME in VIEW X Y X Y X Y ... [in VIEW X Y X Y X Y ...] [model lambert|phong|ward]
 * Each `in` is a polygon of three corners or more, on one material and free of clutter. */
#ifndef REMODEL_MARKED_MATERIALS_H
#define REMODEL_MARKED_MATERIALS_H

#include <stdbool.h>

#include "common/gather/materials.h"

/* {0} is the empty state. */
struct marked_materials {
    struct material_list list; /* names and regions; kind where it is declared */
    bool *declared;            /* the model of each */
};

/* ST_DATA with file and line: no materials, a damaged line, a name twice. */
enum status marked_materials_read(struct marked_materials *m, const char *path, struct provenance *prov,
                                  struct err *err);
void marked_materials_release(struct marked_materials *m);

#endif
