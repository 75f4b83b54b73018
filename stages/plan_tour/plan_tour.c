/* plan_tour.c - plans a walk through the rooms of a model, from viewpoint to viewpoint [Colburn 2014, 4.7.1].
 *
 * reads   MODEL/model.txt, plan.txt                     the model, edited or not, and its rooms
 *         AXES                                          its frame in the scene
 *         VIEWS/cameras.txt, images.txt, lenses.txt     the viewpoints
 *         SCRIPT                                        with --script: where the tour stops, tour.txt
 *         MAP, THINGS/things.txt                        of an edit without a script: what it changed
 * writes  OUT/plan.svg                                  the tour drawn on the plan
 *         OUT/path/, path.txt                           the cameras of the frames
 *         OUT/pairs.txt                                 the viewpoints that each frame blends */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/plan_tour/tour_frames.h"
#include "stages/plan_tour/tour_picture.h"
#include "stages/plan_tour/tour_stops.h"
#include "stages/plan_tour/tour_walk.h"

static const struct param tour_param_table[] = {
#define PARAM_STRUCT struct tour_params
    TOUR_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct job {
    const char *model, *axes_file, *views, *script, *map, *things, *out;
    struct tour_params params;
    struct model_rays rays;
    struct scene_inputs in;
};

static enum status check_params(const void *values, struct err *err)
{
    const struct tour_params *p = values;
    if (p->width % 2 == 0 && p->height % 2 == 0) return ST_OK;
    return err_set(err, ST_USAGE,
                   "[plan_tour] width and height are %d and %d, wanted even numbers, as videos need them.", p->width,
                   p->height);
}

static enum status read_inputs(struct job *j, struct provenance *prov, struct err *err)
{
    char model[FILE_PATH], plan[FILE_PATH];
    const struct scene_files files = {.views = j->views, .axes = j->axes_file, .plan = plan};
    if (product_path_in(model, j->model, PRODUCT_MODEL, NULL, err) ||
        product_path_in(plan, j->model, PRODUCT_PLAN, NULL, err) ||
        model_rays_read(&j->rays, model, MODEL_WITH_GLASS, prov, err))
        return err->status;
    return scene_inputs_read(&j->in, SCENE_CAMERAS | SCENE_LENSES | SCENE_AXES | SCENE_PLAN, &files, prov, err);
}

static void release_inputs(struct job *j)
{
    scene_inputs_release(&j->in);
    model_rays_release(&j->rays);
}

/* pairs.txt goes first: path.txt is the product that the graph of products looks at. */
static enum status write_tour(const struct camera_path *path, const struct viewpoint_pairs *pairs, const char *out,
                              const struct provenance *prov, struct err *err)
{
    char file[FILE_PATH];
    return product_path_in(file, out, PRODUCT_TOUR_PAIRS, NULL, err) || viewpoint_pairs_write(pairs, file, prov, err) ||
                   camera_path_write(path, out, prov, err)
               ? err->status
               : ST_OK;
}

/* Where the tour stops: as the script says, else around what the edit changed, else in each room. */
static enum status find_stops(struct tour_stop **stops, int *count, const struct job *j, const struct tour_graph *g,
                              struct provenance *prov, struct err *err)
{
    struct texture_map map = {0};
    struct thing_list things = {0};
    struct tour_change *changes = NULL;
    int change_count = 0;
    char path[FILE_PATH];
    *count = 0;
    if (!j->script && j->map && !texture_map_read(&map, j->map, prov, err) &&
        (!j->things || (!product_path_in(path, j->things, PRODUCT_THINGS, NULL, err) &&
                        !thing_list_read(&things, path, prov, err))) &&
        !tour_changes_find(&changes, &change_count, &map, &things, &j->in.plan, err))
        tour_walk_find(stops, count, g, &j->rays, &j->in.plan, changes, change_count, j->params.speed, err);
    if (!err->status && !*count) tour_stops_find(stops, count, g, &j->in.plan, j->params.speed, j->script, prov, err);
    free(changes);
    thing_list_release(&things);
    texture_map_release(&map);
    return err->status;
}

static enum status plan_tour(struct job *j, struct provenance *prov, struct err *err)
{
    struct tour_graph g = {0};
    struct camera_path path = {0};
    struct viewpoint_pairs pairs = {0};
    struct tour_key *keys = NULL;
    struct tour_stop *stops = NULL;
    int stop_count = 0, key_count = 0;
    char file[FILE_PATH];
    if (!read_inputs(j, prov, err) &&
        !tour_graph_make(&g, &j->in.set, &j->in.lenses, &j->in.axes, &j->rays, &j->params, err) &&
        !find_stops(&stops, &stop_count, j, &g, prov, err) &&
        !tour_keys_make(&keys, &key_count, &g, stops, stop_count, &j->params, err))
        tour_frames_make(&path, &pairs, keys, key_count, &g, &j->in.axes, &j->rays, &j->params, err);
    if (!err->status && !product_path_in(file, j->out, PRODUCT_TOUR_PLAN, NULL, err) &&
        !tour_picture_write(&path, &g, stops, stop_count, &j->in.plan, &j->in.axes, file, err))
        write_tour(&path, &pairs, j->out, prov, err);
    if (!err->status)
        log_note("a tour of %d stop%s, %.1f s, %d frames", stop_count, stop_count == 1 ? "" : "s",
                 keys[key_count - 1].time, path.frame_count);
    free(stops);
    free(keys);
    viewpoint_pairs_release(&pairs);
    camera_path_release(&path);
    tour_graph_release(&g);
    return err->status;
}

int main(int argc, char **argv)
{
    struct job j = {.params = TOUR_PARAMS_DEFAULT};
    const struct cli_opt opts[] = {
        CLI_ABOUT("Plans a walk through the rooms of a model, from viewpoint to viewpoint."),
        CLI_STR("model", &j.model, CLI_REQUIRED, "folder of the model: model.txt and plan.txt"),
        CLI_STR("axes", &j.axes_file, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("views", &j.views, CLI_REQUIRED, "folder of the views' cameras"),
        CLI_STR("script", &j.script, CLI_OPTIONAL,
                "where the tour stops, tour.txt; default: around what the edit changed, or in each room"),
        CLI_STR("map", &j.map, CLI_OPTIONAL, "what an edit changed, texture.txt"),
        CLI_STR("things", &j.things, CLI_OPTIONAL, "folder of the scene's things"),
        CLI_STR("out", &j.out, CLI_REQUIRED, "folder to write to"),
        CLI_PARAMS(tour_param_table, &j.params, check_params),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "plan_tour", opts, &prov, &err) == CLI_RUN) plan_tour(&j, &prov, &err);
    err_report(&err);
    release_inputs(&j);
    provenance_release(&prov);
    return err_exit_code(&err);
}
