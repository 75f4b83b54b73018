/* choose_effects.c - chooses the effects that suit a scene: one at random, or all; or checks the name of an effect.
 *
 * reads   SUBJECTS       the scene's subjects (find_subjects)
 * writes  OUT            EFFECTS := dolly_in dolly_in+dim ..., for make; nothing if a name is checked */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/film/subject_list.h"
#include "common/film/taxonomy.h"
#include "common/product/product.h"

/* name, type, default, min, max, unit, help */
#define CHOICE_PARAMS(X) X(seed, int, 1, 0, 1000000, "", "seed of the random choice of an effect for EFFECT=auto")

struct choice_params {
    CHOICE_PARAMS(PARAM_FIELD)
};
#define CHOICE_PARAMS_DEFAULT        \
    {                                \
        CHOICE_PARAMS(PARAM_DEFAULT) \
    }
#define PARAM_STRUCT struct choice_params
static const struct param choice_param_table[] = {CHOICE_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static enum status write_choice(const struct film_effect *list, int count, const char *path,
                                const struct provenance *prov, struct err *err)
{
    struct outfile f = {0};
    if (!product_begin(&f, PRODUCT_EFFECT_CHOICE, path, prov, err)) {
        fputs("EFFECTS :=", f.fp);
        for (int i = 0; i < count; i++) {
            char name[EFFECT_NAME_SIZE];
            film_effect_name(&list[i], name);
            fprintf(f.fp, " %s", name);
        }
        fputc('\n', f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    return err->status;
}

static enum status choose(const char *subjects, const char *which, const char *out, const struct choice_params *params,
                          struct provenance *prov, struct err *err)
{
    struct film_effect list[MAX_FILM_EFFECTS];
    struct subject_list found = {0};
    int count = 0;

    subject_list_read(&found, subjects, prov, err);
    const struct scene_subjects scene = film_scene_subjects(&found);
    if (!err->status && !strcmp(which, "all")) {
        count = film_effects_list(list, &scene);
        log_note("%d subject%s: %d effects", scene.count, scene.count == 1 ? "" : "s", count);
    } else if (!err->status) {
        char name[EFFECT_NAME_SIZE];
        list[count++] = film_effect_draw(&scene, (uint64_t)params->seed);
        film_effect_name(&list[0], name);
        log_note("%d subject%s: %s, chosen at random (seed %d)", scene.count, scene.count == 1 ? "" : "s", name,
                 params->seed);
    }
    if (!err->status) write_choice(list, count, out, prov, err);
    subject_list_release(&found);
    return err->status;
}

/* Checks that the effect suits some scene; nothing is known yet about this one. */
static enum status check_name(const char *name, struct err *err)
{
    const struct scene_subjects any = {2, 2 * DOF_DEPTH_RATIO};
    struct film_effect e;
    if (!strcmp(name, "auto") || !strcmp(name, "all"))
        return err_set(err, ST_USAGE,
                       "%s means the effects that suit the scene; it cannot be combined with other effects.", name);
    return film_effect_parse(&e, name, err) || film_effect_check(&e, &any, err) ? err->status : ST_OK;
}

int main(int argc, char **argv)
{
    const char *subjects = NULL, *which = NULL, *out = NULL;
    struct choice_params params = CHOICE_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Chooses the effects that suit a scene: one at random, or all; or checks the name of an effect."),
        CLI_STR("subjects", &subjects, CLI_OPTIONAL, "file of the scene's subjects, for auto and all"),
        CLI_STR("effect", &which, CLI_REQUIRED, "auto (one at random), all, or the name of an effect to check"),
        CLI_STR("out", &out, CLI_OPTIONAL, "file to write, for auto and all"),
        CLI_PARAMS(choice_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "choose_effects", opts, &prov, &err) == CLI_RUN) {
        if (!subjects && !out)
            check_name(which, &err);
        else if (!subjects || !out || (strcmp(which, "auto") && strcmp(which, "all")))
            err_set(&err, ST_USAGE,
                    "--effect %s: wanted auto or all with --subjects and --out, or a name without them.", which);
        else
            choose(subjects, which, out, &params, &prov, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
