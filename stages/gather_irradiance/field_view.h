/* field_view.h - irradiance of the surfaces that a view shows. */
#ifndef REMODEL_GATHER_FIELD_VIEW_H
#define REMODEL_GATHER_FIELD_VIEW_H

#include "stages/gather_irradiance/gather_job.h"

/* Writes OUT/irradiance/VIEW.exr: R G B A float, A 1 where the view shows a face of the unedited model (furniture that
 * it does not hold is looked through); `error`, the luminance's standard error; `lamps` and `unknown`, shares of the
 * light; with `gloss`, specular.R G B and `material` (view_gloss.h). ST_DATA: the cameras have no view of that name. */
enum status gather_view(struct gather_job *j, const char *views, const char *name, bool gloss, struct err *err);

#endif
