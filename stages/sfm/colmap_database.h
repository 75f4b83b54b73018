/* colmap_database.h - features and verified pairs of the photos in COLMAP's database (SQLite). */
#ifndef REMODEL_COLMAP_DATABASE_H
#define REMODEL_COLMAP_DATABASE_H

#include "common/base/err.h"
#include "common/capture/feature_list.h"
#include "common/capture/match_list.h"

struct colmap_database;

/* Two images whose matches agree with one geometry. */
struct verified_pair {
    int images[2]; /* ids, ascending */
    int matches;   /* that agree with the geometry */
};

/* Opens a database that COLMAP made. Changes are kept only after colmap_database_commit(). ST_IO, with SQLite's words.
 */
enum status colmap_database_open(struct colmap_database **db, const char *path, struct err *err);
/* Adds the verified pairs of `from`, which has the same images, to `to`, which has none of these pairs. ST_IO. */
enum status colmap_database_take_pairs(const char *to, const char *from, struct err *err);
/* The id of an image; 0: COLMAP did not take it. */
enum status colmap_database_image_id(int *id, struct colmap_database *db, const char *name, struct err *err);
/* Replaces the features of an image. Descriptors are left out: nothing that follows reads them. */
enum status colmap_database_set_features(struct colmap_database *db, int image, const struct feature_list *list,
                                         struct err *err);
/* Reads the verified pairs, ascending by image ids. The caller frees *pairs, also after an error. ST_IO, ST_NOMEM. */
enum status colmap_database_pairs(struct verified_pair **pairs, int *count, struct colmap_database *db,
                                  struct err *err);
/* Reads the matches of a verified pair that agree with its geometry: indices of features. The caller frees *matches,
 * also after an error. ST_IO, ST_NOMEM, and ST_DATA if the rows are not as COLMAP writes them. */
enum status colmap_database_inliers(struct index_match **matches, int *count, struct colmap_database *db,
                                    const struct verified_pair *pair, struct err *err);
/* Keeps the changes; closing without it drops them. ST_IO. */
enum status colmap_database_commit(struct colmap_database *db, struct err *err);
void colmap_database_close(struct colmap_database *db); /* NULL: nothing */

#endif
