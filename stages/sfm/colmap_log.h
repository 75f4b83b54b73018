/* colmap_log.h - what COLMAP's logs say about the photos. */
#ifndef REMODEL_COLMAP_LOG_H
#define REMODEL_COLMAP_LOG_H

#include "common/capture/photo_list.h"

/* One picture in the log of `colmap feature_extractor`. */
struct feature_count {
    char *name;   /* owned */
    int features; /* -1: COLMAP could not read the picture */
};
struct feature_counts {
    struct feature_count *list; /* in the log's order; owned */
    int count;
};
enum status colmap_counts_read(struct feature_counts *c, const char *log, struct err *err);
void colmap_counts_release(struct feature_counts *c);

/* Lists the photos with fewer than min_features, "a.jpg (12), b.jpg (unreadable) and 3 more", as far as `size` allows.
 * "" if there are none. */
void colmap_counts_list_poor(char *text, size_t size, const struct feature_counts *c, const struct photo_list *photos,
                             int min_features);

/* Number of pictures that match another one, from the log of `colmap mapper`; -1 if the log does not state it. */
int colmap_log_connected(const char *log);

/* The last line that begins with a letter, for error messages; "" if there is none. */
void colmap_log_last_line(char *text, size_t size, const char *log);

#endif
