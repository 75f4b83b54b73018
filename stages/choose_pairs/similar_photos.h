/* similar_photos.h - pairs of photographs whose largest features look alike. */
#ifndef REMODEL_SIMILAR_PHOTOS_H
#define REMODEL_SIMILAR_PHOTOS_H

#include <stdbool.h>

#include "common/capture/feature_list.h"

/* Whether photos i < j, in order of their names, are neighbours: at most ten apart, or 16, 32, 64, ..., 512. */
bool similar_by_name(int i, int j);

/* similar[i * count + j], i < j: whether at least `least` of the features of i and j match each other; the other
 * entries are not set. lists: of `count` photos, in which the largest features are kept. ST_NOMEM. */
enum status similar_by_features(bool *similar, const struct feature_list *lists, int count, int least, struct err *err);

#endif
