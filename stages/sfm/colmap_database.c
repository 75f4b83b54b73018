/* colmap_database.c - features and verified pairs of the photos in COLMAP's database.
 *
 * COLMAP itself makes the database, with cameras and images; only three of its tables are named here. A keypoint is a
 * row of four floats: x, y, scale, orientation; a match is a row of two 32-bit numbers. The id of a pair is
 * (2^31 - 1) times the lower id of its images, plus the higher one. */
#include "stages/sfm/colmap_database.h"

#include <sqlite3.h>
#include <stdint.h>
#include <stdlib.h>

struct colmap_database {
    sqlite3 *sql;
};

static enum status failed(struct colmap_database *db, const char *what, struct err *err)
{
    const char *path = db->sql ? sqlite3_db_filename(db->sql, "main") : NULL;
    return err_set(err, ST_IO, "COLMAP's database %s: SQLite could not %s: %s.", path ? path : "", what,
                   sqlite3_errmsg(db->sql));
}

static enum status run_text(struct colmap_database *db, const char *text, struct err *err)
{
    return sqlite3_exec(db->sql, text, NULL, NULL, NULL) == SQLITE_OK ? ST_OK : failed(db, text, err);
}

/* Opens it; changes are kept at once. */
static enum status open_plain(struct colmap_database **out, const char *path, struct err *err)
{
    struct colmap_database *db = calloc(1, sizeof *db);
    *out = db;
    if (!db) return err_nomem(err, "a database", sizeof *db);
    return sqlite3_open_v2(path, &db->sql, SQLITE_OPEN_READWRITE, NULL) == SQLITE_OK ? ST_OK
                                                                                     : failed(db, "open it", err);
}

enum status colmap_database_open(struct colmap_database **out, const char *path, struct err *err)
{
    if (!open_plain(out, path, err)) run_text(*out, "BEGIN", err);
    if (err->status) {
        colmap_database_close(*out);
        *out = NULL;
    }
    return err->status;
}

static enum status attach(struct colmap_database *db, const char *path, struct err *err)
{
    sqlite3_stmt *statement = NULL;
    if (sqlite3_prepare_v2(db->sql, "ATTACH ? AS part", -1, &statement, NULL) != SQLITE_OK ||
        sqlite3_bind_text(statement, 1, path, -1, SQLITE_STATIC) != SQLITE_OK || sqlite3_step(statement) != SQLITE_DONE)
        failed(db, "open a part of it", err);
    sqlite3_finalize(statement);
    return err->status;
}

enum status colmap_database_take_pairs(const char *to, const char *from, struct err *err)
{
    static const char text[] = "INSERT INTO two_view_geometries SELECT * FROM part.two_view_geometries ORDER BY 1";
    struct colmap_database *db = NULL;
    if (!open_plain(&db, to, err) && !attach(db, from, err)) run_text(db, text, err);
    colmap_database_close(db);
    return err->status;
}

void colmap_database_close(struct colmap_database *db)
{
    if (!db) return;
    sqlite3_close(db->sql);
    free(db);
}

enum status colmap_database_commit(struct colmap_database *db, struct err *err) { return run_text(db, "COMMIT", err); }

enum status colmap_database_image_id(int *id, struct colmap_database *db, const char *name, struct err *err)
{
    sqlite3_stmt *find = NULL;
    *id = 0;
    if (sqlite3_prepare_v2(db->sql, "SELECT image_id FROM images WHERE name = ?", -1, &find, NULL) != SQLITE_OK ||
        sqlite3_bind_text(find, 1, name, -1, SQLITE_STATIC) != SQLITE_OK)
        failed(db, "look for an image", err);
    else {
        const int step = sqlite3_step(find);
        if (step == SQLITE_ROW)
            *id = sqlite3_column_int(find, 0);
        else if (step != SQLITE_DONE)
            failed(db, "look for an image", err);
    }
    sqlite3_finalize(find);
    return err->status;
}

enum status colmap_database_set_features(struct colmap_database *db, int image, const struct feature_list *list,
                                         struct err *err)
{
    sqlite3_stmt *set = NULL;
    const size_t size = (size_t)list->count * 4 * sizeof(float);
    float *rows = malloc(size + 1);
    if (!rows) return err_nomem(err, "features", size);
    for (int i = 0; i < list->count; i++) {
        const struct feature *f = &list->features[i];
        const float row[4] = {f->x, f->y, f->scale, f->angle};
        for (int k = 0; k < 4; k++) rows[4 * (size_t)i + (size_t)k] = row[k];
    }
    if (sqlite3_prepare_v2(db->sql, "REPLACE INTO keypoints (image_id, rows, cols, data) VALUES (?, ?, 4, ?)", -1, &set,
                           NULL) != SQLITE_OK ||
        sqlite3_bind_int(set, 1, image) != SQLITE_OK || sqlite3_bind_int(set, 2, list->count) != SQLITE_OK ||
        sqlite3_bind_blob64(set, 3, rows, size, SQLITE_STATIC) != SQLITE_OK || sqlite3_step(set) != SQLITE_DONE)
        failed(db, "write features", err);
    sqlite3_finalize(set);
    free(rows);
    return err->status;
}

enum status colmap_database_pairs(struct verified_pair **pairs, int *count, struct colmap_database *db, struct err *err)
{
    static const char text[] = "SELECT pair_id / 2147483647, pair_id % 2147483647, rows FROM two_view_geometries "
                               "WHERE rows > 0 ORDER BY pair_id";
    sqlite3_stmt *find = NULL;
    int step, capacity = 0;
    *pairs = NULL;
    *count = 0;
    if (sqlite3_prepare_v2(db->sql, text, -1, &find, NULL) != SQLITE_OK) return failed(db, "look for pairs", err);
    while ((step = sqlite3_step(find)) == SQLITE_ROW) {
        if (*count == capacity) {
            capacity = capacity ? 2 * capacity : 256;
            struct verified_pair *more = realloc(*pairs, (size_t)capacity * sizeof *more);
            if (!more) {
                err_nomem(err, "pairs", (size_t)capacity * sizeof *more);
                break;
            }
            *pairs = more;
        }
        (*pairs)[(*count)++] = (struct verified_pair){{sqlite3_column_int(find, 0), sqlite3_column_int(find, 1)},
                                                      sqlite3_column_int(find, 2)};
    }
    if (!err->status && step != SQLITE_DONE) failed(db, "look for pairs", err);
    sqlite3_finalize(find);
    return err->status;
}

enum status colmap_database_inliers(struct index_match **matches, int *count, struct colmap_database *db,
                                    const struct verified_pair *pair, struct err *err)
{
    sqlite3_stmt *find = NULL;
    const sqlite3_int64 id = 2147483647 * (sqlite3_int64)pair->images[0] + pair->images[1];
    *matches = NULL;
    *count = 0;
    if (sqlite3_prepare_v2(db->sql, "SELECT rows, data FROM two_view_geometries WHERE pair_id = ?", -1, &find, NULL) !=
            SQLITE_OK ||
        sqlite3_bind_int64(find, 1, id) != SQLITE_OK || sqlite3_step(find) != SQLITE_ROW)
        failed(db, "look for matches", err);
    else {
        const int rows = sqlite3_column_int(find, 0);
        const uint32_t *data = sqlite3_column_blob(find, 1);
        if (rows < 0 || !data || (size_t)sqlite3_column_bytes(find, 1) != (size_t)rows * 2 * sizeof *data)
            err_set(err, ST_DATA, "COLMAP's database: a pair has %d matches, but not as many rows of data.", rows);
        else if (!(*matches = malloc(((size_t)rows + 1) * sizeof **matches)))
            err_nomem(err, "matches", (size_t)rows * sizeof **matches);
        for (; !err->status && *count < rows; (*count)++)
            (*matches)[*count] = (struct index_match){(int)data[2 * *count], (int)data[2 * *count + 1]};
    }
    sqlite3_finalize(find);
    return err->status;
}
