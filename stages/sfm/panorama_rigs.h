/* panorama_rigs.h - views of a panorama have one centre, and known directions from each other. */
#ifndef REMODEL_PANORAMA_RIGS_H
#define REMODEL_PANORAMA_RIGS_H

#include "common/capture/sfm_model.h"

/* Gives the views of each panorama (panorama_name.h, by their images' names) the pose that they have in common, and
 * moves the points that they see. Other images stay. ST_NOMEM. */
enum status panorama_rigs_join(struct sfm_model *m, struct err *err);

#endif
