/* similar_photos.h - pairs of photographs whose largest features look alike. */
#ifndef REMODEL_SIMILAR_PHOTOS_H
#define REMODEL_SIMILAR_PHOTOS_H

#include <stdbool.h>

#include "common/capture/feature_list.h"

/* Whether photos i < j, in order of their names, are neighbours: at most ten apart, or 16, 32, 64, ..., 512. */
bool similar_by_name(int i, int j);

/* Sets similar[i * count + j] for i < j: whether photos i and j share at least min_matches matching features. lists:
 * the largest features of `count` photos. Shows progress. ST_NOMEM. */
enum status similar_by_features(bool *similar, const struct feature_list *lists, int count, int min_matches,
                                struct err *err);

#endif
