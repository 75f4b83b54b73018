/* colmap_matches.h - COLMAP's database of photos, lenses, features and verified matches. */
#ifndef REMODEL_COLMAP_MATCHES_H
#define REMODEL_COLMAP_MATCHES_H

#include "common/capture/feature_list.h"
#include "stages/sfm/colmap_job.h"

enum { MIN_FEATURES = 200 }; /* photos with fewer are reported */

/* Steps 1 and 2: the database of photos, lenses, features and verified matches. *features: number of features in all
 * photos; nothing is verified if it is 0. */
enum status colmap_take_matches(long long *features, const struct colmap_job *job, struct err *err);

/* Reads the features of a photo of the job, by its place in the list of photos. The caller releases the list. */
enum status colmap_matches_features(struct feature_list *list, const struct colmap_job *job, int photo,
                                    struct err *err);

/* Lists the photos with fewer than MIN_FEATURES, "a.jpg (12), b.jpg (unreadable) and 3 more", as far as `size` allows.
 * "" if there are none. features: of each photo, -1: unreadable. */
void colmap_list_poor(char *text, size_t size, const int *features, const struct photo_list *photos);

#endif
