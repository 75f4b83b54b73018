/* outfile.h - outputs that appear whole or not at all.
 *
 * A temporary file in the same folder (".NAME.XXXXXX.tmp") is written, fsynced and renamed. What is not committed is
 * removed by outfile_discard() or at exit, also after SIGINT, SIGTERM and SIGHUP; SIGKILL leaves a dot file that
 * nothing takes for a product. */
#ifndef REMODEL_OUTFILE_H
#define REMODEL_OUTFILE_H

#include <stdio.h>

#include "common/base/err.h"

struct outfile {
    FILE *fp;   /* open for writing; a library that writes by name may write to `temp` instead and leave fp alone */
    char *path; /* owned */
    char *temp; /* owned */
};

/* Makes missing parent folders. {0} is the empty state. */
enum status outfile_open(struct outfile *f, const char *path, struct err *err);

/* Flushes, checks for write errors (a full disk), fsyncs, renames, fsyncs the folder. On failure the temporary file is
 * gone and an older product of that name is untouched. */
enum status outfile_commit(struct outfile *f, struct err *err);

void outfile_discard(struct outfile *f); /* idempotent; harmless after a commit */

/* Writes a file only if its text is new, so that its time tells Make when it last changed. */
enum status outfile_write_new(const char *path, const char *text, size_t size, struct err *err);

/* mkdir -p */
enum status make_folders(const char *path, struct err *err);

#endif
