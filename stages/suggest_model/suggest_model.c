/* suggest_model.c - suggests a model script of a scene's rooms from points and views, for a person to correct.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         POINTS                                        oriented points
 *         AXES                                          the model's frame, ceiling, thickness of walls
 *         VIEWS/VIEW.exr, DEPTH/VIEW.exr, VIEW.txt      pictures and depth, for windows
 * writes  OUT                                           a script (docs/model-script.md); no other stage reads it */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/capture/view_image.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/suggest_model/windows.h"

#define PARAM_STRUCT struct suggest_params
const struct param suggest_param_table[] = {SUGGEST_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static const double SCENE_CELL = 0.05;       /* edge of the cubes in which mirror images are looked up, likewise */
static const double GLASS_THICKNESS = 0.008; /* as a fraction of the ceiling's height */

static void name_of(char name[32], int wall)
{
    static const char *const OUTER[] = {"south", "west", "north", "east"};
    if (wall < 4)
        snprintf(name, 32, "%s", OUTER[wall]);
    else
        snprintf(name, 32, "wall%d", wall - 3);
}

static void write_wall(FILE *fp, const struct suggestion *s, int wall)
{
    const struct suggested_wall *w = &s->walls[wall];
    char name[32];
    name_of(name, wall);
    if (w->guessed) fputs("# seen from one side only: its thickness is a guess\n", fp);
    /* the inside is to the right of the direction from start to end */
    const bool falls = (w->axis ? -1 : 1) * w->inward < 0;
    const double from = falls ? w->end : w->begin, to = falls ? w->begin : w->end;
    if (w->axis)
        fprintf(fp, "wall %s from %.4f %.4f to %.4f %.4f", name, from, w->face, to, w->face);
    else
        fprintf(fp, "wall %s from %.4f %.4f to %.4f %.4f", name, w->face, from, w->face, to);
    if (w->thickness > 0) fprintf(fp, " thickness %.4f", w->thickness);
    fputc('\n', fp);
    for (int end = 0; wall >= 4 && end < 2; end++) {
        char side[32];
        name_of(side, w->sides[falls ? 1 - end : end]);
        fprintf(fp, "extend %s %s to %s\n", name, end ? "end" : "start", side);
    }
}

static void write_script(FILE *fp, const struct suggestion *s, const struct model_axes *axes)
{
    char name[32], on[32];
    int doors = 0, windows = 0, rooms = 0;
    fputs("# A suggestion, made from points: compare it with the photographs, correct it, and keep it as\n"
          "# scenes/NAME/model.txt; nothing reads it here. Lengths are those of axes.txt.\n",
          fp);
    fprintf(fp, "set ceiling %.4f\n", s->ceiling);
    if (!(axes->thickness > 0))
        fprintf(fp, "# nobody saw the outer walls' other faces: a guess\nset thickness %.4f\n",
                WALL_THICKNESS * s->ceiling);
    fprintf(fp, "set glass %.4f\n\n", GLASS_THICKNESS * s->ceiling);
    for (int w = 0; w < 4; w++) write_wall(fp, s, w);
    fputs("join south west north east south\n", fp);
    for (int w = 4; w < s->wall_count; w++) write_wall(fp, s, w);
    fputc('\n', fp);
    for (int r = 0; r < s->room_count; r++) {
        if (!s->rooms[r].free) continue;
        fprintf(fp, "room room%d", ++rooms);
        for (int k = 0; k < 4; k++) {
            name_of(name, s->rooms[r].walls[k]);
            fprintf(fp, " %s", name);
        }
        fputc('\n', fp);
    }
    fputc('\n', fp);
    for (int i = 0; i < s->opening_count; i++) {
        const struct suggested_opening *o = &s->openings[i];
        name_of(on, o->wall);
        fprintf(fp, "%s %s%d on %s from %.4f %.4f to %.4f %.4f\n", o->window ? "window" : "passage",
                o->window ? "window" : "doorway", o->window ? ++windows : ++doors, on, o->begin, o->foot, o->end,
                o->top);
    }
}

static enum status write_suggestion(const struct suggestion *s, const struct model_axes *axes, const char *path,
                                    const struct provenance *prov, struct err *err)
{
    struct outfile out = {0};
    outfile_open(&out, path, err);
    if (!err->status) {
        fprintf(out.fp, "%s\n", products[PRODUCT_SUGGESTED_MODEL].head);
        provenance_print(prov, out.fp);
        write_script(out.fp, s, axes);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}

struct files {
    const char *views, *depth, *points, *axes, *out;
};

/* Whether a wall has the outdoors, or nothing known, behind it. */
static bool may_have_windows(const struct suggested_wall *w) { return !(w->thickness > 0) || w->guessed; }

struct walls { /* what the views show of them */
    struct wall_raster *rasters;
    int count;
    const struct view *view;
    const struct image *picture;
    const struct layered_depth *depth;
    const struct occupancy *scene;
    double scale;
};

static void add_to_walls(void *ctx, size_t begin, size_t end, int thread)
{
    const struct walls *w = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        if (w->rasters[i].cells) wall_raster_add(&w->rasters[i], w->view, w->picture, w->depth, w->scale, w->scene);
}

/* Adds a view, in the model's frame, to the walls' rasters. */
static enum status add_view(struct walls *walls, const struct files *f, const struct view *view,
                            struct provenance *prov, struct err *err)
{
    struct image picture = {0};
    struct layered_depth depth = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, f->depth, PRODUCT_DEPTH, &(struct product_key){.view = view->name}, err) &&
        !view_image_read(&picture, f->views, view, prov, err))
        layered_depth_read_interior(&depth, path, prov, err);
    if (!err->status && (depth.width != view->width || depth.height != view->height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but its camera %d x %d; make the depth again.", path, depth.width,
                depth.height, view->width, view->height);
    walls->view = view;
    walls->picture = &picture;
    walls->depth = &depth;
    if (!err->status) parallel_for((size_t)walls->count, 1, add_to_walls, walls);
    image_release(&picture);
    layered_depth_release(&depth);
    return err->status;
}

/* Adds the windows that pictures and depth of all views show. */
static enum status add_windows(struct suggestion *s, const struct files *f, const struct model_axes *axes,
                               const struct camera_set *set, const struct point_cloud *cloud,
                               const struct suggest_params *params, struct provenance *prov, struct err *err)
{
    struct wall_raster *rasters = calloc((size_t)s->wall_count, sizeof *rasters);
    struct occupancy scene = {0};
    const double low[3] = {s->walls[1].face, s->walls[0].face, 0}, h = s->ceiling;
    const double high[3] = {s->walls[3].face, s->walls[2].face, h};
    if (rasters)
        raster_occupancy_make(&scene, cloud, low, high, SCENE_CELL * h, err);
    else
        err_nomem(err, "walls", (size_t)s->wall_count * sizeof *rasters);
    for (int i = 0; !err->status && i < s->wall_count; i++) {
        const struct suggested_wall *w = &s->walls[i];
        if (may_have_windows(w))
            wall_raster_init(&rasters[i], w->axis, w->inward, w->face, w->begin, w->end, h, params->window * h, err);
    }
    struct walls walls = {.rasters = rasters, .count = s->wall_count, .scene = &scene, .scale = axes->scale};
    for (int v = 0; !err->status && v < set->view_count; v++) add_view(&walls, f, &set->views[v], prov, err);
    for (int i = 0; !err->status && i < s->wall_count; i++)
        if (rasters[i].cells) windows_suggest(s, i, &rasters[i], params, err);
    for (int i = 0; rasters && i < s->wall_count; i++) wall_raster_release(&rasters[i]);
    free(rasters);
    raster_occupancy_release(&scene);
    return err->status;
}

static enum status suggest(const struct files *f, const struct suggest_params *params, struct provenance *prov,
                           struct err *err)
{
    const struct scene_files files = {.views = f->views, .axes = f->axes};
    struct scene_inputs in = {0};
    struct point_cloud cloud = {0};
    struct suggestion s = {0};
    scene_inputs_read(&in, SCENE_POINTS | SCENE_AXES | SCENE_MODEL_VIEWS, &files, prov, err);
    const struct camera_set *set = &in.set;
    const struct model_axes *axes = &in.axes;
    if (!err->status && !set->view_count)
        err_set(err, ST_DATA, "%s contains no views; run sfm_import again.", f->views);
    if (!err->status) point_cloud_read(&cloud, f->points, prov, err);
    for (size_t i = 0; !err->status && i < cloud.count; i++) {
        struct cloud_point *p = &cloud.points[i];
        p->position = model_from_world_point(axes, p->position);
        cloud_set_normal(p, model_from_world_direction(axes, cloud_normal(p)));
    }
    if (!err->status && suggest_plan(&s, &cloud, set->views, set->view_count, axes->ceiling, params, err) == ST_DATA)
        err_context(err, "%s", f->points);
    if (!err->status && !add_windows(&s, f, axes, set, &cloud, params, prov, err) &&
        !write_suggestion(&s, axes, f->out, prov, err)) {
        int rooms = 0;
        for (int i = 0; i < s.room_count; i++) rooms += s.rooms[i].free;
        log_note("%d walls, %d rooms, %d openings", s.wall_count, rooms, s.opening_count);
        log_note("%s is a suggestion that no stage reads: compare it with the photographs, correct it, and copy it to "
                 "scenes/NAME/model.txt",
                 f->out);
    }
    suggest_release(&s);
    point_cloud_release(&cloud);
    scene_inputs_release(&in);
    return err->status;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct files f = {0};
    struct suggest_params params = SUGGEST_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Suggests a model script of a scene's rooms, for you to correct by hand."),
        CLI_STR("views", &f.views, CLI_REQUIRED, "folder of cameras"),
        CLI_STR("depth", &f.depth, CLI_REQUIRED, "folder of the views' depth"),
        CLI_STR("points", &f.points, CLI_REQUIRED, "oriented points, points.ply"),
        CLI_STR("axes", &f.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("out", &f.out, CLI_REQUIRED, "script to write"),
        CLI_PARAMS(suggest_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "suggest_model", opts, &prov, &err) != CLI_RUN || suggest(&f, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
