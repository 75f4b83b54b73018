/* start_photos.h - photos from which the mapper is started again, where its own start placed too few. */
#ifndef REMODEL_START_PHOTOS_H
#define REMODEL_START_PHOTOS_H

#include "common/base/err.h"
#include "stages/sfm/colmap_database.h"

/* Chooses photos to start from. ids: room for `max` image ids, best first; *chosen: their number. pairs[count]: the
 * verified pairs. placed[placed_count]: image ids of the largest model. *linked: photos of the largest group that
 * verified pairs connect. Photos of groups that have no more photos than are placed are left out. Order: first photos
 * without a verified pair to one already chosen, so that starts are far apart; then photos that are not placed; then
 * those with more verified matches; then the lower id. ST_NOMEM. */
enum status start_photos_choose(int *ids, int *chosen, int max, int *linked, const struct verified_pair *pairs,
                                int count, const int *placed, int placed_count, struct err *err);

#endif
