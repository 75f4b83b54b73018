/* viewpoint_pairs.h - which viewpoints' textures each frame of a film blends: pairs.txt beside a film's path.txt.
 *
 *   remodel-pairs 1
 *   frame 0001 PHOTO PHOTO T      in order; the share of the second viewpoint is T, in [0, 1] */
#ifndef REMODEL_VIEWPOINT_PAIRS_H
#define REMODEL_VIEWPOINT_PAIRS_H

#include "common/base/provenance.h"

struct viewpoint_pair {
    char *frame;     /* owned */
    char *photos[2]; /* ids of photos; owned */
    double t;
};

/* {0} is the empty state. */
struct viewpoint_pairs {
    struct viewpoint_pair *list; /* owned */
    int count;
};

void viewpoint_pairs_release(struct viewpoint_pairs *pairs);
/* The strings are copied. */
enum status viewpoint_pairs_add(struct viewpoint_pairs *pairs, const char *frame, const char *from, const char *to,
                                double t, struct err *err);
enum status viewpoint_pairs_write(const struct viewpoint_pairs *pairs, const char *path, const struct provenance *prov,
                                  struct err *err);
/* ST_DATA with file and line. A failure leaves pairs empty. */
enum status viewpoint_pairs_read(struct viewpoint_pairs *pairs, const char *path, struct provenance *prov,
                                 struct err *err);
/* The pair of a frame, by its name; NULL: none. */
const struct viewpoint_pair *viewpoint_pairs_find(const struct viewpoint_pairs *pairs, const char *frame);

#endif
