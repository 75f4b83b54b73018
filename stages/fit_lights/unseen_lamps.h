/* unseen_lamps.h - says where light is that no lamp explains, and adds the lamps that explain it. */
#ifndef REMODEL_FIT_LIGHTS_UNSEEN_LAMPS_H
#define REMODEL_FIT_LIGHTS_UNSEEN_LAMPS_H

#include "common/gather/model_field.h"
#include "stages/fit_lights/fit_lights_params.h"
#include "stages/fit_lights/lit_scene.h"
#include "stages/fit_lights/unseen_fit.h"

/* {0} is the empty state; everything is owned. */
struct unseen_lamps {
    struct unseen_lamp lamps[MAX_UNSEEN];
    int count;
    struct unseen_lamp standing; /* on a stand or a wall; it is said, not used */
    bool stands;                 /* there is one */
    double side;                 /* of each lamp below a ceiling, model units */
    bool are_used;
    struct atlas_squares squares;
    double (*without_lamps)[3]; /* irradiance of the squares from all but lamps */
};

/* Gathers the light of the textured faces without lamps. field: of the unedited model, its lamps off. ST_NOMEM. */
enum status unseen_lamps_gather(struct unseen_lamps *u, const struct model_field *field, struct err *err);
/* Looks for lamps. scene: with lamps fitted; furnished: what throws shadows. */
enum status unseen_lamps_find(struct unseen_lamps *u, const struct model_field *field, const struct lit_scene *scene,
                              const struct lit_model *model, const struct model_rays *furnished, const char *views,
                              const struct fit_lights_params *params, struct provenance *prov, struct err *err);
/* Adds their light to that of the scene's points. */
void unseen_lamps_light(const struct unseen_lamps *u, double (*indirect)[3], const struct lit_scene *scene,
                        const struct model_rays *furnished);
/* Says what was found, with the photograph that shows it best, and what to write into lights.txt. */
void unseen_lamps_report(const struct unseen_lamps *u, const struct lit_model *model);
/* Lines of fit.txt. */
void unseen_lamps_print(const struct unseen_lamps *u, const struct lit_model *model, const struct light_list *lights,
                        FILE *to);
/* Adds them to the list as unseen1, unseen2 and so on. */
enum status unseen_lamps_add(const struct unseen_lamps *u, struct light_list *lights, struct err *err);
void unseen_lamps_release(struct unseen_lamps *u);

#endif
