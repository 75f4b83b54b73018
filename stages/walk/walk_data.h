/* walk_data.h - the data of a walk: scripts beside its page, of which the page loads what it needs. */
#ifndef REMODEL_WALK_DATA_H
#define REMODEL_WALK_DATA_H

#include "stages/walk/walk_scene.h"

/* Writes all of them. Adds their sizes to *bytes. */
enum status walk_data_write(const struct walk_scene *s, struct provenance *prov, int64_t *bytes, struct err *err);

#endif
