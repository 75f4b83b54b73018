/* scratch_name.h - names for temporary files and folders of tests, in $TMPDIR or the system's folder for them. */
#ifndef REMODEL_TESTS_SCRATCH_NAME_H
#define REMODEL_TESTS_SCRATCH_NAME_H

#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

/* Sets path to a template for mkstemp() or mkdtemp(). False: size is too small. */
static inline bool scratch_name(char *path, size_t size, const char *kind)
{
    const char *folder = getenv("TMPDIR");
    return snprintf(path, size, "%s/remodel-%s-XXXXXX", folder && *folder ? folder : P_tmpdir, kind) < (int)size;
}

#endif
