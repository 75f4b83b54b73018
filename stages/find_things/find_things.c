/* find_things.c - the things of a scene, furniture before its walls, with one id across all views.
 *
 * reads   MODEL, PLAN, AXES                             the solid model, its plan and its frame
 *         VIEWS/cameras.txt, images.txt, lenses.txt     the cameras
 *         VIEWS/VIEW.exr                                pictures of things
 *         DEPTH/VIEW.exr, VIEW.txt                      the views' layered depth
 *         IDS/VIEW.exr                                  faces of the model, and clutter
 *         MARKS                                         names, and places that users marked
 * writes  OUT/masks/VIEW.exr                            the things that each pixel shows, and its ray meets
 *         OUT/volume.exr                                the thing that each place of the rooms belongs to
 *         OUT/sheet.svg                                 a picture of all things
 *         OUT/plan.svg                                  all things on the plan
 *         OUT/things.txt                                the list of things */
#include "common/base/cli.h"
#include "stages/find_things/things.h"

#define PARAM_STRUCT struct things_params
const struct param things_param_table[] = {THINGS_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct options {
    const char *model, *plan, *axes, *marks;
    struct things_job job;
};

static enum status run(struct options *o, struct err *err)
{
    const struct scene_files files = {.views = o->job.views, .axes = o->axes, .plan = o->plan};
    struct scene_inputs in = {0};
    struct model_rays model = {0};
    struct thing_marks marks = {0};
    if (!scene_inputs_read(&in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES | SCENE_PLAN, &files, o->job.prov, err) &&
        !model_rays_read(&model, o->model, MODEL_WITHOUT_GLASS, o->job.prov, err) &&
        (!o->marks || !thing_marks_read(&marks, o->marks, &in.set, &in.lenses, o->job.prov, err))) {
        o->job.in = &in;
        o->job.model = &model;
        o->job.marks = &marks;
        things_find(&o->job, err);
    }
    thing_marks_release(&marks);
    model_rays_release(&model);
    scene_inputs_release(&in);
    return err->status;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct things_params params = THINGS_PARAMS_DEFAULT;
    struct options o = {.job = {.params = &params, .prov = &prov}};
    const struct cli_opt opts[] = {
        CLI_ABOUT("The things of a scene, furniture before its walls, with one id across all views."),
        CLI_STR("model", &o.model, CLI_REQUIRED, "model.txt of the unedited model"),
        CLI_STR("plan", &o.plan, CLI_REQUIRED, "its walls and rooms, plan.txt"),
        CLI_STR("axes", &o.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &o.job.views, CLI_REQUIRED, "folder of views and cameras"),
        CLI_STR("depth", &o.job.depth, CLI_REQUIRED, "folder of the views' depth"),
        CLI_STR("ids", &o.job.ids, CLI_REQUIRED, "folder of the faces that the views see"),
        CLI_STR("marks", &o.marks, CLI_OPTIONAL, "things that a user named and marked, scenes/NAME/things.txt"),
        CLI_STR("out", &o.job.out, CLI_REQUIRED, "folder to write"),
        CLI_PARAMS(things_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_things", opts, &prov, &err) != CLI_RUN || run(&o, &err)) err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
