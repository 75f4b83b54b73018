/* start_photos.h - photos from which the mapper is started again, where its own start placed too few. */
#ifndef REMODEL_START_PHOTOS_H
#define REMODEL_START_PHOTOS_H

#include "common/base/err.h"
#include "stages/sfm/colmap_database.h"

/* Chooses at most `max` photos to start from, and writes COLMAP's ids of them, best first. Photos that are not placed
 * come before those that are; among them, the one with the most verified matches comes first. Photos with a verified
 * pair to one chosen before come after all others, so that starts are far apart. placed: ids of the placed photos.
 * *linked: the number of photos with a verified pair. */
enum status start_photos_choose(int *ids, int *chosen, int max, int *linked, const struct verified_pair *pairs,
                                int count, const int *placed, int placed_count, struct err *err);

#endif
