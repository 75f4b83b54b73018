/* shell.h - draws the model under its texture atlases, without clutter [Colburn 2014, 4.6].
 *
 * A pixel's texture is that of the two viewpoints' atlases (VDTA), blended by t where both have a texel, else of the one
 * that has; the view-independent atlas (VITA) fills what remains. Which place of the unedited model an edited face shows
 * says the texture map; without one every face shows itself. Panes of glass are looked through. */
#ifndef REMODEL_RENDER_SHELL_H
#define REMODEL_RENDER_SHELL_H

#include "common/texture/model_picture.h"
#include "common/texture/outdoors.h"
#include "common/texture/texture_map.h"

struct shell_scene; /* a model, ready to be drawn; pages of atlases are read when they are needed */

struct shell_files {
    const char *model; /* model.txt: unedited, or edited */
    const char *map;   /* texture.txt of an edited model; NULL: none */
    const char *vdta;  /* folder of the viewpoints' atlases */
    const char *vita;  /* folder of the VITA */
    int memory;        /* MiB of pages that are kept; the ones that were not used longest are dropped first */
};

/* The files that are read are added to prov (may be NULL), the atlases' when they are. The caller closes the scene. */
enum status shell_open(struct shell_scene **scene, const struct shell_files *files, struct provenance *prov,
                       struct err *err);
void shell_close(struct shell_scene *scene); /* NULL is allowed */

/* camera: in the model's frame. photos: ids of viewpoints; NULL: none, and the other one has all the weight; both NULL:
 * the VITA alone. t: share of photos[1]. outdoors: NULL leaves pixels outside of the model MADE_NOTHING.
 * Same bits for any number of threads. */
enum status shell_draw(struct model_picture *out, struct shell_scene *scene, const struct view *camera,
                       const char *const photos[2], double t, const struct outdoors *outdoors, struct err *err);

/* Reads the pages that shell_draw() needs for these viewpoints ahead of the first picture. */
enum status shell_prepare(struct shell_scene *scene, const char *const photos[2], struct err *err);

const struct texture_map *shell_map(const struct shell_scene *scene); /* empty without a texture map */

#endif
