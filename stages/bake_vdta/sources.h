/* sources.h - which views a viewpoint takes texels from. */
#ifndef REMODEL_SOURCES_H
#define REMODEL_SOURCES_H

#include "stages/bake_vdta/bake_viewpoint.h"

/* The viewpoint's own views, and at most [bake_vdta] max_sources others that show the faces of its tiles well: from
 * near the viewpoint's direction, at a fine resolution, with little in front. Reads IDS/index.txt. *views: indices of
 * views in ascending order; the caller frees it in each case. */
enum status sources_choose(int **views, int *count, const struct bake_scene *scene, const int *own, int own_count,
                           const struct bake *b, struct provenance *prov, struct err *err);

#endif
