/* place_memory.h - walls that were placed by rectangles, kept for whoever builds a script again and again: to look
 * through all points takes longer than all else. */
#ifndef REMODEL_BUILD_MODEL_PLACE_MEMORY_H
#define REMODEL_BUILD_MODEL_PLACE_MEMORY_H

#include "stages/build_model/place/place.h"

/* A wall that was placed with the same rectangle of the same photo and wishes; NULL: none was. */
const struct placed_wall *place_memory_find(const struct place_memory *memory, const struct script_place *place,
                                            const struct place_direction *wanted);
/* Without memory for it the wall is not kept. */
void place_memory_add(struct place_memory *memory, const struct script_place *place,
                      const struct place_direction *wanted, const struct placed_wall *wall);

#endif
