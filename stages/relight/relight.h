/* relight.h - relights pictures of an edited model. */
#ifndef REMODEL_RELIGHT_H
#define REMODEL_RELIGHT_H

#include <stdbool.h>

#include "common/base/cli.h"
#include "common/relight/light_change.h"
#include "stages/relight/relight_params.h"

struct relight_job {
    struct light_change_files files;
    const char *relit;               /* folder that update_vita wrote: vita/, objects.txt */
    const char *pictures;            /* folder of the pictures, NAME.exr and NAME.txt */
    const char *views, *ids, *depth; /* of original views; NULL: furniture is lit like the shell behind it */
    const char *materials;           /* materials.txt; NULL: all surfaces are matt */
    struct cli_list names;           /* of the pictures */
    bool frames;                     /* write frames of a film: NAME.exr alone, R G B A times the exposure */
    bool list;                       /* instead: all of PICTURES/pictures.txt; OUT/pictures.txt is written last */
    const char *from, *changes;      /* instead of all else: folder of relit pictures with integrals, file of changes */
    struct relight_params params;
    const char *out;
    struct provenance prov;
};

/* Makes all pictures of the job; what one of them reads does not count as input of the next. */
enum status relight(struct relight_job *j, struct err *err);

#endif
