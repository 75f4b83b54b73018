/* outfile.h - output files that appear complete or not at all.
 *
 * A temporary file in the same folder (".NAME.XXXXXX.tmp") is written, fsynced and renamed. Without a commit it is
 * removed by outfile_discard() or at exit, also after SIGINT, SIGTERM and SIGHUP, and when the program is ended by a
 * fault (SIGABRT, SIGSEGV, SIGBUS). SIGKILL leaves a dot file, which nothing reads as a product. */
#ifndef REMODEL_OUTFILE_H
#define REMODEL_OUTFILE_H

#include <stdio.h>

#include "common/base/err.h"

struct outfile {
    FILE *fp;   /* open for writing; a library that opens files by name writes to `temp` and ignores fp */
    char *path; /* owned */
    char *temp; /* owned */
};

/* Makes missing parent folders. {0} is the empty state. ST_IO: path exists and is not a regular file, or cannot be
 * made. */
enum status outfile_open(struct outfile *f, const char *path, struct err *err);

/* Flushes, checks for write errors (full disk), fsyncs, says it in the ledger of the run (ledger.h), renames, fsyncs
 * the folder. On failure the temporary file is removed and an older file at the path is unchanged. */
enum status outfile_commit(struct outfile *f, struct err *err);

void outfile_discard(struct outfile *f); /* idempotent; does nothing after a commit */

/* Writes the file only if its text changes, so that Make rebuilds what depends on it only then. */
enum status outfile_write_if_changed(const char *path, const char *text, size_t size, struct err *err);

/* Copies a file. ST_IO. */
enum status outfile_copy(const char *to, const char *from, struct err *err);

/* Makes a folder and its missing parents, like mkdir -p. */
enum status outfile_make_folders(const char *path, struct err *err);

#endif
