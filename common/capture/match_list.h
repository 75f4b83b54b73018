/* match_list.h - features of a photograph that look like those of other photographs: out/SCENE/matches/PHOTO.txt.
 *
 *   remodel-matches 1
 *   limits RATIO ANGLE           of matches: [match_photos] max_ratio, max_angle
 *   photo HASH
 *   pair OTHER HASH COUNT
 *   match I J                    COUNT lines, ascending in I; features from 0, of the photo and of the other
 *
 * A pair is in the file of the photo that comes first in the list of photos. HASH is that of the photo's features
 * (feature_list.h): it shows whether a pair is up to date. */
#ifndef REMODEL_MATCH_LIST_H
#define REMODEL_MATCH_LIST_H

#include "common/base/hash.h"
#include "common/base/provenance.h"

struct index_match {
    int first, second;
};

struct matched_pair {
    char *other; /* id of the second photo; owned */
    char hash[HASH_TEXT];
    struct index_match *matches; /* owned */
    int count;
};

struct match_list {
    double max_ratio, max_angle;
    char hash[HASH_TEXT];       /* of the first photo's features */
    struct matched_pair *pairs; /* owned */
    int count;
};

/* Adds a pair without matches and returns it, or NULL without memory. The pointer is valid until the next call. */
struct matched_pair *match_list_add(struct match_list *list, const char *other, const char *hash, struct err *err);
/* The pair with this photo; NULL: there is none. */
const struct matched_pair *match_list_find(const struct match_list *list, const char *other);

/* On failure the list is empty. */
enum status match_list_read(struct match_list *list, const char *path, struct provenance *prov, struct err *err);
enum status match_list_write(const struct match_list *list, const char *path, const struct provenance *prov,
                             struct err *err);
void match_list_release(struct match_list *list);

#endif
