/* scene_text.h - the geometry of a walk as JavaScript: models and where their faces take their texture, cameras,
 * atlases, plans, tours. docs/formats/textures.md describes it. */
#ifndef REMODEL_SCENE_TEXT_H
#define REMODEL_SCENE_TEXT_H

#include <stdio.h>

#include "stages/walk/walk_scene.h"

/* Tiles and sizes of pages. */
void scene_text_atlas(FILE *to, const struct atlas *a);
/* vita_pages: of the scene's VITA, which the light on new surfaces is guessed from. */
enum status scene_text_write(FILE *to, const struct walk_scene *s, const struct atlas_page *vita_pages,
                             struct err *err);

/* The colour of a rule of colour, radiance; all 0: nothing is known of the light. */
enum status scene_text_colour(float colour[3], const struct texture_rule *rule, const struct atlas *vita,
                              const struct atlas_page *pages, struct err *err);

#endif
