/* integrals.h - the light of a relit picture, kept so that materials and lamps can be changed without a new gather
 * [Colburn 2014, 5.5]: OUT/NAME-integrals.exr (docs/formats.md). */
#ifndef REMODEL_INTEGRALS_H
#define REMODEL_INTEGRALS_H

#include "common/image/exr.h"
#include "stages/relight/lamp_light.h"
#include "stages/relight/relit.h"

/* A surface whose reflectance may be changed: a synthetic object, a fitted material, a face with a gloss or a
 * colour. */
enum surface_kind { SURFACE_OBJECT, SURFACE_MATERIAL, SURFACE_FACE };

/* Writes the file. camera: scene frame, for its attributes. */
enum status integrals_write(const struct relit *r, const struct pixels *p, const struct light_change *c,
                            const struct lamp_light *lamps, const struct view *camera, const char *path,
                            const struct provenance *prov, struct err *err);

/* Changes a relit picture by a file of changes:
 *   lamp NAME scale R G B            the lamp's radiance, as the picture has it, is multiplied; direct light only
 *   material NAME k_d R G B          the diffuse reflectance (albedo / pi) of an object, a material or a face: absolute
 *                                    of objects and colours; of a material with texture its mean becomes that
 *   material NAME k_s KS             the strength of its gloss
 * integrals: read from the file that integrals_write() wrote; picture: the relit one, which is changed. ST_DATA with
 * file and line: names that the picture does not have (the message lists those), n, alpha, beta and other words, which
 * need a new gather. */
enum status integrals_change(struct model_picture *picture, const struct exr_image *integrals, const char *path,
                             struct err *err);

#endif
