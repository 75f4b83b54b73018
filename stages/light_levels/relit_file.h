/* relit_file.h - relit.js: the light of photographs in parts, for the page of light levels and for single pictures.
 *
 * One call, remodelRelit(String.raw`...`), whose text has the lines that docs/formats/light.md describes. */
#ifndef REMODEL_LEVELS_RELIT_FILE_H
#define REMODEL_LEVELS_RELIT_FILE_H

#include "stages/light_levels/relit_light.h"

/* Without points of plans, which levels.js has. */
enum status relit_file_write(const struct relit_light *r, const char *path, struct err *err);
/* The caller releases r in each case. ST_DATA with file and line. */
enum status relit_file_read(struct relit_light *r, const char *path, struct err *err);

#endif
