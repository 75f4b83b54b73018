/* objects.h - the synthetic objects of an edited model as a list for other stages (common/light/object_list.h). */
#ifndef REMODEL_BUILD_MODEL_OBJECTS_H
#define REMODEL_BUILD_MODEL_OBJECTS_H

#include "common/light/object_list.h"
#include "stages/build_model/plan/plan.h"

/* The objects that the plan's statements place and do not remove, in the order in which they were placed first. Reads
 * each mesh below `scene`, the scene's folder (NULL: it is unknown), to check and hash it, and logs where the object
 * is. list is empty on entry; the caller releases it in each case. ST_DATA with file and line of the statement: the
 * mesh is missing or damaged. */
enum status objects_make(struct object_list *list, const struct plan *plan, const char *scene, struct err *err);

/* The map from a mesh to the model's frame: its scale, then its turn about z, then its shift. */
void object_matrix(double m[3][4], const struct script_object *placed);

#endif
