/* scratch_name.h - where tests make files and folders: in $TMPDIR, or where the system has its temporary files. */
#ifndef REMODEL_TESTS_SCRATCH_NAME_H
#define REMODEL_TESTS_SCRATCH_NAME_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* path: a template for mkstemp and mkdtemp; false where size is too small. */
static inline bool scratch_name(char *path, size_t size, const char *kind)
{
    const char *folder = getenv("TMPDIR");
    return snprintf(path, size, "%s/remodel-%s-XXXXXX", folder && *folder ? folder : P_tmpdir, kind) < (int)size;
}

#endif
