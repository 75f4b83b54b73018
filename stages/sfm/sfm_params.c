/* sfm_params.c - the stage's parameters and their checks. */
#include "stages/sfm/sfm_params.h"

#include <stdlib.h>
#include <string.h>

#define PARAM_STRUCT struct sfm_params
const struct param sfm_param_table[] = {SFM_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

bool sfm_is_equisolid(const struct sfm_params *params) { return !strcmp(params->camera_model, "EQUISOLID"); }

int sfm_parse_numbers(double numbers[CAMERA_MAX_PARAMS], const char *text)
{
    for (int count = 0;; text++) {
        char *end;
        const double value = strtod(text, &end);
        if (end == text || (*end && *end != ',')) return -1;
        if (count < CAMERA_MAX_PARAMS) numbers[count] = value;
        count++;
        text = end;
        if (!*text) return count;
    }
}

enum status sfm_params_check(const void *values, struct err *err)
{
    const struct sfm_params *p = values;
    struct camera c = {.width = 1, .height = 1};
    if (!*p->camera_params) {
        if (!strcmp(p->refine_camera, "no"))
            return err_set(err, ST_USAGE, "[sfm] refine_camera = no needs the lens: set camera_params too.");
        return ST_OK;
    }
    const int count = sfm_parse_numbers(c.params, p->camera_params);
    if (sfm_is_equisolid(p)) {
        if (count != 1 && count != 3)
            return err_set(
                err, ST_USAGE,
                "[sfm] camera_params is \"%s\", wanted F or F,CX,CY of EQUISOLID: the focal length in pixels, "
                "and the principal point if it is not the centre of the photo.",
                p->camera_params);
        c.model = CAMERA_SIMPLE_PINHOLE; /* the same numbers */
    } else {
        camera_model_from_name(p->camera_model, &c.model);
        const int wanted = camera_model_params(c.model);
        if (count != wanted)
            return err_set(err, ST_USAGE,
                           "[sfm] camera_params is \"%s\", wanted the %d numbers of %s, separated by commas.",
                           p->camera_params, wanted, p->camera_model);
    }
    struct err why = ERR_INIT;
    if (camera_check(&c, &why)) return err_set(err, ST_USAGE, "[sfm] camera_params: %s", why.text);
    return ST_OK;
}
