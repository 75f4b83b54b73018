/* shell.h - draws the model under its texture atlases, without clutter [Colburn 2014, 4.6].
 *
 * A pixel's texture is that of the two viewpoints' atlases (VDTA), blended by t where both have a texel, else of the
 * one that has; the view-independent atlas (VITA) fills what remains. Which place of the unedited model an edited face
 * shows says the texture map; faces that it does not list, and all without one, show themselves. Panes of glass are
 * looked through, unless the map gives them a texture.
 *
 * A colour of an edit is its albedo under the light that the map names: until irradiance is known, albedo / 0.6 times
 * the median radiance, channel by channel, of the texels of the VITA on those faces that some view shows. */
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

/* The files that are used are added to prov (may be NULL), the atlases' when a picture needs them, whether they are
 * read for it or were read before: a picture's inputs do not depend on the pictures that were drawn before it. The
 * caller closes the scene. */
enum status shell_open(struct shell_scene **scene, const struct shell_files *files, struct provenance *prov,
                       struct err *err);
void shell_close(struct shell_scene *scene); /* NULL is allowed */

/* Colours are the mean of samples x samples places in each pixel, at least 1 and at most 16; 1 at first. z, id and made
 * are always those of the pixel's centre. */
void shell_set_samples(struct shell_scene *scene, int samples);

/* camera: in the model's frame. photos: ids of viewpoints; NULL: none, and the other one has all the weight; both NULL:
 * the VITA alone. t: share of photos[1]. outdoors: NULL leaves pixels outside of the model MADE_NOTHING.
 * Same bits for any number of threads. ST_DATA: a viewpoint without an atlas, t outside of [0, 1]. */
enum status shell_draw(struct model_picture *out, struct shell_scene *scene, const struct view *camera,
                       const char *const photos[2], double t, const struct outdoors *outdoors, struct err *err);

/* Reads all pages of these viewpoints' atlases ahead of the first picture. */
enum status shell_prepare(struct shell_scene *scene, const char *const photos[2], struct err *err);

const struct texture_map *shell_map(const struct shell_scene *scene); /* empty without a texture map */

#endif
