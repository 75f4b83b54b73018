/* still_matches.h - what stands still in the picture while the scene moves: watermarks, date stamps, dirt on the lens,
 * a drone's legs. Its matches agree with a camera that does not move, and would place photos wrong.
 *
 * Places are cells of the picture, 64 along its longer side. A place stands still if matches of some pairs begin and
 * end there at the same pixel, although the rest of these pairs moves, in three photos or more and in a fifth of all
 * photos of that size. Pairs of which nothing moves (a tripod) are no evidence. Places that many matches just about
 * miss are the far background of a camera that does not turn, and so is what covers more than STILL_SHARE of the
 * picture: they stay. */
#ifndef REMODEL_STILL_MATCHES_H
#define REMODEL_STILL_MATCHES_H

#include "common/capture/feature_list.h"
#include "common/capture/match_list.h"
#include "common/capture/photo_list.h"

#define STILL_SHARE 0.3 /* of the blocks of 4 x 4 places where there are matches */

/* Photos of one size. */
struct still_group {
    int width, height;
    int first, count;     /* index of the first photo; number of photos */
    int columns, rows;    /* of cells */
    float cell;           /* side in px */
    unsigned char *still; /* of each cell; owned */
    int places;           /* that stand still */
    int matches, photos;  /* between equal pixels there, of pairs that move; photos they are in */
};

struct still_places {
    struct still_group *groups;
    int count;
    int *group_of;            /* of each photo; owned */
    int *copy_of;             /* of each photo: the first one that shows the same picture, or -1; owned */
    unsigned char **features; /* of each photo, of each feature: it is in such a place; NULL: none is; owned */
    int photos;
};

/* features, matches: folders; a photo may have no file there. {0} is the empty state. */
enum status still_places_find(struct still_places *s, const struct photo_list *photos, const char *features,
                              const char *matches, struct err *err);
/* Removes the pair's matches that begin or end in such a place. The features are those that were searched. */
void still_places_drop(const struct still_places *s, struct matched_pair *pair, int first, int second);
/* Where it is, for people: "x 10 to 200, y 440 to 470 px", at most three places. */
void still_places_describe(char *text, size_t size, const struct still_group *g);
/* The mask of a group, black where it stands still and a cell around. */
enum status still_places_write_mask(const struct still_group *g, const char *path, struct err *err);
void still_places_release(struct still_places *s);

#endif
