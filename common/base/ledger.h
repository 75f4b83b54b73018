/* ledger.h - what a run made, so that `make verify` can tell later whether each product is still as it was made.
 *
 * A run sets REMODEL_LEDGER to a folder. Each process adds a file of its own there, so that nodes of a cluster do not
 * share one, with a line "HASH STAGE PATH" for each product. The run's end puts them together (stages/verify). */
#ifndef REMODEL_LEDGER_H
#define REMODEL_LEDGER_H

#include "common/base/err.h"

/* Says that the product at `path` will have the bytes that the file `content` has now. Does nothing without
 * REMODEL_LEDGER. Several threads may call it. ST_IO: the line cannot be written. */
enum status ledger_add(const char *path, const char *content, struct err *err);

#endif
