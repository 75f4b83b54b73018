/* make_deps.h - prerequisites that only a run finds out, as a makefile. */
#ifndef REMODEL_MAKE_DEPS_H
#define REMODEL_MAKE_DEPS_H

#include "common/base/err.h"

/* Writes "TARGET: FILES", and an empty rule for each file, so that make does not stop at one that has been removed. */
enum status make_deps_write(const char *path, const char *target, const char *const *files, int count, struct err *err);

#endif
