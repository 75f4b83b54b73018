/* similar_photos.h - pairs of photographs whose largest features look alike. */
#ifndef REMODEL_SIMILAR_PHOTOS_H
#define REMODEL_SIMILAR_PHOTOS_H

#include <stdbool.h>

#include "common/capture/feature_list.h"

/* Whether photos i < j, in order of their names, are neighbours: at most ten apart, or 16, 32, 64, ..., 512. */
bool similar_by_name(int i, int j);

/* Sets shared[i * count + j] and shared[j * count + i] to the number of matches of photos i and j. lists: the largest
 * features of `count` photos. Shows progress. ST_NOMEM. */
enum status similar_count_matches(int *shared, const struct feature_list *lists, int count, struct err *err);

/* Sets similar[i * count + j] for i < j: whether photos i and j share at least min_matches, and one of them is among
 * the max_similar photos that share most with the other; of equal ones the first. ST_NOMEM. */
enum status similar_choose(bool *similar, const int *shared, int count, int min_matches, int max_similar,
                           struct err *err);

#endif
