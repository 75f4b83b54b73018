/* page_file.h - the page of a walk: one file, with its script and its style inside. */
#ifndef REMODEL_WALK_PAGE_FILE_H
#define REMODEL_WALK_PAGE_FILE_H

#include <stdint.h>

#include "common/base/err.h"

/* Writes OUT/index.html from FOLDER/index.html: lines `<script src="NAME"></script>` and
 * `<link rel="stylesheet" href="NAME">` that name a file of the folder are replaced by its contents, @NAME@ by the
 * scene's name. Adds the page's size to *bytes. */
enum status page_file_write(const char *folder, const char *out, const char *name, int64_t *bytes, struct err *err);

#endif
