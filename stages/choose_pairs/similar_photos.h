/* similar_photos.h - pairs of photographs whose largest features look alike. */
#ifndef REMODEL_SIMILAR_PHOTOS_H
#define REMODEL_SIMILAR_PHOTOS_H

#include <stdbool.h>

#include "common/capture/feature_list.h"

/* Whether photos i < j, in order of their names, are neighbours: at most ten apart, or 16, 32, 64, ..., 512. */
bool similar_by_name(int i, int j);

/* Sets shared[i * count + j] and shared[j * count + i] to the number of matches of photos i and j; the diagonal is not
 * set. lists: the largest features of `count` photos. Shows progress. The result is the same for any number of threads.
 * ST_NOMEM. */
enum status similar_count_matches(int *shared, const struct feature_list *lists, int count, struct err *err);

/* Sets similar[i * count + j], i < j, to true for similar photos; all are false on entry. Two photos are similar if
 * they have at least min_matches matches and one is among the max_similar photos with the most matches with the other;
 * ties go to the lower index. ST_NOMEM. */
enum status similar_choose(bool *similar, const int *shared, int count, int min_matches, int max_similar,
                           struct err *err);

#endif
