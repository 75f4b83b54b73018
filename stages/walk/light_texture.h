/* light_texture.h - how an edit changes the light on each face: factors of radiance, as a small atlas. */
#ifndef REMODEL_LIGHT_TEXTURE_H
#define REMODEL_LIGHT_TEXTURE_H

#include <stdio.h>

#include "stages/walk/walk_scene.h"

#define LIGHT_MOST 4.0 /* the factor that is white in the pictures */

/* Writes {atlas, most, textures} of an edited model that has a relit atlas. vita_pages: of the scene's VITA. */
enum status light_texture_write(FILE *to, const struct walk_scene *s, const struct walk_model *m,
                                const struct atlas_page *vita_pages, struct provenance *prov, struct err *err);

#endif
