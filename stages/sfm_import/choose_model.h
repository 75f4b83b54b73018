/* choose_model.h - which of several models is used, and whether it still belongs to the photos. */
#ifndef REMODEL_CHOOSE_MODEL_H
#define REMODEL_CHOOSE_MODEL_H

#include "common/capture/photo_list.h"
#include "common/capture/sfm_model.h"

/* What the user gave of a model: it is not adjusted unless asked for. */
enum given_cameras { GIVEN_NOTHING, GIVEN_LENS, GIVEN_MODEL };

/* Reads SFM/models.txt and the model with the most images that are photos of the scene, at equality the one with the
 * most points. Logs all models. *name is its folder inside SFM; the caller frees it. *given: what the user gave of
 * it. */
enum status import_choose(struct sfm_model *model, char **name, enum given_cameras *given, const char *sfm,
                          const struct photo_list *photos, struct provenance *prov, struct err *err);

/* Warns about photos that have changed, or are new, since SFM/photos.txt was written. */
enum status import_check_photos(const char *sfm, const struct photo_list *photos, struct err *err);

#endif
