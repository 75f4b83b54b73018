/* colmap_database.c - what is read from COLMAP's database; COLMAP itself is not needed. */
#include "tests/unit/scratch.h"

#include <sqlite3.h>
#include <stdlib.h>

#include "common/base/outfile.h"
#include "stages/sfm/colmap_database.h"

#define PAIRS "CREATE TABLE two_view_geometries (pair_id INTEGER PRIMARY KEY, rows INTEGER);"

/* A database with the statements in `text`. */
static const char *database_of(const char *text)
{
    const char *path = scratch_write("database.db", "");
    sqlite3 *sql = NULL;
    assert_int_equal(sqlite3_open(path, &sql), SQLITE_OK);
    assert_int_equal(sqlite3_exec(sql, text, NULL, NULL, NULL), SQLITE_OK);
    sqlite3_close(sql);
    return path;
}

static void verified_pairs_are_read_in_order_of_their_images(void **state)
{
    (void)state;
    /* (2^31 - 1) a + b: the pairs 2 and 3, 1 and 2; 1 and 3 did not pass */
    const char *path = database_of(PAIRS "INSERT INTO two_view_geometries VALUES (4294967297, 40), (2147483649, 20),"
                                         " (2147483650, 0);");
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    struct err err = ERR_INIT;
    int count = 0;
    assert_ok(colmap_database_open(&db, path, &err), err);
    assert_ok(colmap_database_pairs(&pairs, &count, db, &err), err);
    assert_int_equal(count, 2);
    assert_int_equal(pairs[0].images[0], 1);
    assert_int_equal(pairs[0].images[1], 2);
    assert_int_equal(pairs[0].matches, 20);
    assert_int_equal(pairs[1].images[0], 2);
    assert_int_equal(pairs[1].images[1], 3);
    assert_int_equal(pairs[1].matches, 40);
    free(pairs);
    colmap_database_close(db);
}

static void a_database_of_another_kind_is_an_error(void **state)
{
    (void)state;
    const char *path = database_of("CREATE TABLE other (id INTEGER);");
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    struct err err = ERR_INIT;
    int count = 0;
    assert_ok(colmap_database_open(&db, path, &err), err);
    assert_int_equal(colmap_database_pairs(&pairs, &count, db, &err), ST_IO);
    assert_non_null(strstr(err.text, "no such table"));
    free(pairs);
    colmap_database_close(db);
}

static void pairs_of_a_copy_are_added(void **state)
{
    (void)state;
    char whole[256], part[300];
    snprintf(whole, sizeof whole, "%s", database_of(PAIRS));
    snprintf(part, sizeof part, "%s.part", whole);
    struct colmap_database *db = NULL;
    struct verified_pair *pairs = NULL;
    struct err err = ERR_INIT;
    sqlite3 *sql = NULL;
    int count = 0;
    assert_ok(outfile_copy(part, whole, &err), err);
    assert_int_equal(sqlite3_open(whole, &sql), SQLITE_OK);
    assert_int_equal(sqlite3_exec(sql, "INSERT INTO two_view_geometries VALUES (4294967297, 40)", 0, 0, 0), SQLITE_OK);
    sqlite3_close(sql);
    assert_int_equal(sqlite3_open(part, &sql), SQLITE_OK);
    assert_int_equal(sqlite3_exec(sql, "INSERT INTO two_view_geometries VALUES (2147483649, 20)", 0, 0, 0), SQLITE_OK);
    sqlite3_close(sql);
    assert_ok(colmap_database_take_pairs(whole, part, &err), err);
    assert_ok(colmap_database_open(&db, whole, &err), err);
    assert_ok(colmap_database_pairs(&pairs, &count, db, &err), err);
    assert_int_equal(count, 2);
    assert_int_equal(pairs[0].matches, 20);
    assert_int_equal(pairs[1].matches, 40);
    free(pairs);
    colmap_database_close(db);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(verified_pairs_are_read_in_order_of_their_images),
        cmocka_unit_test(pairs_of_a_copy_are_added),
        cmocka_unit_test(a_database_of_another_kind_is_an_error),
    };
    return cmocka_run_group_tests(tests, scratch_make, scratch_remove);
}
