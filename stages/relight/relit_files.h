/* relit_files.h - the files of a relit picture (docs/formats.md, O/relight/E). */
#ifndef REMODEL_RELIT_FILES_H
#define REMODEL_RELIT_FILES_H

#include "stages/relight/relit.h"

/* Writes OUT/NAME-ratio.exr, NAME-ratio.png, NAME.exr, NAME.jpg, and NAME.txt last.
 * unlit: the exposure of the picture before it was relit. camera: scene frame, for the EXR's attributes. */
enum status relit_write(const struct relit *r, const struct model_picture *picture, const struct relight_params *params,
                        double unlit, const struct view *camera, const char *out, const char *name,
                        const struct provenance *prov, struct err *err);

/* The exposure that NAME.txt states. ST_DATA with file and line. */
enum status relit_read_exposure(double *exposure, const char *path, struct provenance *prov, struct err *err);
/* Writes a picture whose materials or lamps were changed: OUT/NAME.exr, NAME.jpg. */
enum status relit_changed_write(const struct model_picture *picture, double exposure, const char *out, const char *name,
                                const struct provenance *prov, struct err *err);

#endif
