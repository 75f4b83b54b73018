/* update.h - the texture of an edited model under the light that the edit makes [Colburn 2014, 5.5]. */
#ifndef REMODEL_UPDATE_H
#define REMODEL_UPDATE_H

#include "common/relight/light_change.h"
#include "stages/update_vita/update_params.h"

struct update_job {
    struct light_change_files files;
    struct update_params params;
    const char *out; /* folder: vita/, objects.txt and rounds.txt appear in it, vita/atlas.txt last */
    struct provenance prov;
};

/* ST_DATA: damaged files. Rounds that do not settle are said in rounds.txt and in the log. */
enum status update_vita(struct update_job *j, struct err *err);

#endif
