/* bake_inputs.h - what every bake reads of a scene: cameras, which of them are of one photo, and the model's frame. */
#ifndef REMODEL_BAKE_INPUTS_H
#define REMODEL_BAKE_INPUTS_H

#include "common/base/provenance.h"
#include "common/capture/camera_set.h"
#include "common/capture/lens_list.h"
#include "common/model/model_axes.h"

/* Reads VIEWS/cameras.txt, images.txt and lenses.txt and the file of axes, and records them as inputs. The cameras come
 * in the frame of the model. All three are empty before; the caller releases set and lenses in each case. */
enum status bake_inputs_read(struct camera_set *set, struct lens_list *lenses, struct model_axes *axes,
                             const char *views, const char *axes_file, struct provenance *prov, struct err *err);

#endif
