/* suggest_model.c - suggests a model script of a scene's rooms from points and views, for a person to correct.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt   the cameras
 *         POINTS                                        oriented points
 *         FRAME                                         with --frame: walls that straight edges show
 *         AXES                                          the model's frame, ceiling, thickness of walls
 *         VIEWS/VIEW.exr, DEPTH/VIEW.exr, VIEW.txt      pictures and depth, for windows
 * writes  PICTURE, then OUT                             the plan for people; a script (docs/model-script.md), which no
 *                                                       other stage reads
 *
 * Nothing that was not found is an error: the script says what is missing. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/base/parallel.h"
#include "common/base/scan.h"
#include "common/base/sort.h"
#include "common/capture/view_image.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/suggest_model/frame_points.h"
#include "stages/suggest_model/openings.h"
#include "stages/suggest_model/suggest_script.h"
#include "stages/suggest_model/wall_joins.h"
#include "stages/suggest_model/windows.h"

#define PARAM_STRUCT struct suggest_params
const struct param suggest_param_table[] = {SUGGEST_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* As fractions of the ceiling's height: */
static const double FINE = 0.005;      /* edge of the cubes that keep one point, for openings */
static const double MIN_SIDE = 0.04;   /* of an opening */
static const double SCENE_CELL = 0.05; /* edge of the cubes in which mirror images are looked up */

static enum status write_script(const struct suggestion *s, const struct wall_names *names,
                                const struct model_axes *axes, const char *note, const char *path,
                                const struct provenance *prov, struct err *err)
{
    struct outfile out = {0};
    outfile_open(&out, path, err);
    if (!err->status) {
        const locale_t before = uselocale(scan_c_locale());
        fprintf(out.fp, "%s\n", products[PRODUCT_SUGGESTED_MODEL].head);
        suggest_script_print(out.fp, s, names, axes, note);
        fputs("\n# Made by:\n", out.fp);
        provenance_print(prov, out.fp);
        uselocale(before);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}

static enum status write_picture(const struct suggestion *s, const struct wall_names *names,
                                 const struct sights *sights, bool metric, const char *path, struct err *err)
{
    struct outfile out = {0};
    outfile_open(&out, path, err);
    if (!err->status) {
        const locale_t before = uselocale(scan_c_locale());
        suggest_picture_print(out.fp, s, names, sights, metric);
        uselocale(before);
        outfile_commit(&out, err);
    }
    outfile_discard(&out);
    return err->status;
}

struct files {
    const char *views, *depth, *points, *frame, *axes, *picture, *out;
};

/* Whether a wall has the outdoors, or nothing known, behind it. */
static bool may_have_windows(const struct suggested_wall *w) { return !w->between || w->guessed; }

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

/* Bounds of the walls, from the floor to the ceiling. */
static void walls_bounds(const struct suggestion *s, double low[3], double high[3])
{
    low[0] = low[1] = HUGE_VAL;
    high[0] = high[1] = -HUGE_VAL;
    low[2] = 0;
    high[2] = s->ceiling;
    for (int i = 0; i < 2 * s->wall_count; i++) {
        const struct suggested_wall *w = &s->walls[i / 2];
        double p[2];
        line_point(&w->line, i % 2 ? w->end : w->begin, 0, p);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], p[k]);
            high[k] = fmax(high[k], p[k]);
        }
    }
}

/* Adds the windows that pictures and depth of all views show. */
static enum status add_windows(struct suggestion *s, const struct files *f, const struct model_axes *axes,
                               const struct camera_set *set, const struct point_cloud *cloud,
                               const struct suggest_params *params, struct provenance *prov, struct err *err)
{
    struct wall_raster *rasters = calloc((size_t)s->wall_count, sizeof *rasters);
    struct occupancy scene = {0};
    double low[3], high[3];
    const double h = s->ceiling;
    walls_bounds(s, low, high);
    if (rasters)
        raster_occupancy_make(&scene, cloud, low, high, SCENE_CELL * h, err);
    else
        err_nomem(err, "walls", (size_t)s->wall_count * sizeof *rasters);
    for (int i = 0; !err->status && i < s->wall_count; i++) {
        const struct suggested_wall *w = &s->walls[i];
        if (may_have_windows(w)) wall_raster_init(&rasters[i], &w->line, w->begin, w->end, h, params->window * h, err);
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

/* The height below which nearly all points of walls lie; 0: there are none. */
static enum status guess_ceiling(double *height, const struct point_cloud *cloud, struct err *err)
{
    double *z = malloc((cloud->count + 1) * sizeof *z);
    size_t count = 0;
    if (!z) return err_nomem(err, "heights", cloud->count * sizeof *z);
    for (size_t i = 0; i < cloud->count; i++)
        if (fabs((double)cloud->points[i].normal[2]) < 0.3) z[count++] = cloud->points[i].position.z;
    sort_doubles(z, count);
    *height = count ? fmax(0, z[count - 1 - count / 50]) : 0;
    free(z);
    return ST_OK;
}

/* Adds openings, from points and from pictures. */
static enum status add_openings(struct suggestion *s, const struct files *f, const struct model_axes *axes,
                                const struct camera_set *set, const struct point_cloud *cloud,
                                const struct suggest_params *params, struct provenance *prov, struct err *err)
{
    struct sights sights = {0};
    if (!s->wall_count) return ST_OK;
    const struct opening_finder finder = {&sights, params, s->ceiling};
    sights_make(&sights, cloud, FINE * s->ceiling, set->views, set->view_count, err);
    for (int w = 0; !err->status && w < s->wall_count; w++) openings_find(s, &finder, w, err);
    sights_release(&sights);
    if (!err->status && !add_windows(s, f, axes, set, cloud, params, prov, err))
        wall_joins_cut_openings(s, suggested_thickness(axes->thickness, s->ceiling), MIN_SIDE * s->ceiling);
    return err->status;
}

static enum status write_suggestion(const struct suggestion *s, const struct sights *sights,
                                    const struct model_axes *axes, const struct files *f, const struct provenance *prov,
                                    struct err *err)
{
    struct wall_names names = {0};
    const char *note = s->wall_count ? NULL
                       : !sights->points.cloud.count
                           ? "points.ply has no points of walls; add photographs that overlap."
                           : "no points concentrate on upright planes; look at the axes and "
                             "heights in the pictures in model/axes, and add photographs of walls.";
    if (!suggest_names_make(&names, s, err) &&
        (!f->picture || !write_picture(s, &names, sights, axes->metric, f->picture, err)))
        write_script(s, &names, axes, note, f->out, prov, err);
    suggest_names_release(&names);
    return err->status;
}

static void log_summary(const struct suggestion *s, const char *out)
{
    int closed = 0;
    for (int i = 0; i < s->room_count; i++) closed += s->rooms[i].closed;
    log_note("%d walls, %d rooms of which %d are closed, %d openings, %d doubts", s->wall_count, s->room_count, closed,
             s->opening_count, s->doubt_count);
    log_note("%s is a suggestion that no stage reads: compare it with the photographs, correct it, and copy it to "
             "scenes/NAME/model.txt",
             out);
}

/* Adds points on walls that straight edges show, where photos match too little to have points. */
static enum status add_frame(struct point_cloud *cloud, const struct files *f, const struct scene_inputs *in,
                             double height, struct provenance *prov, struct err *err)
{
    struct room_frame frame = {0};
    double trust = 0;
    if (f->frame && height > 0 && !room_frame_trust(&trust, &in->set.model, err) && trust > 0 &&
        !room_frame_read(&frame, f->frame, prov, err))
        frame_points_add(cloud, &frame, &in->axes, height, SUGGEST_CUBE * height, err);
    room_frame_release(&frame);
    return err->status;
}

static enum status suggest(const struct files *f, const struct suggest_params *params, struct provenance *prov,
                           struct err *err)
{
    const struct scene_files files = {.views = f->views, .axes = f->axes};
    struct scene_inputs in = {0};
    struct point_cloud cloud = {0};
    struct sights sights = {0};
    struct suggestion s = {0};
    scene_inputs_read(&in, SCENE_POINTS | SCENE_AXES | SCENE_MODEL_VIEWS, &files, prov, err);
    const struct camera_set *set = &in.set;
    const struct model_axes *axes = &in.axes;
    double height = axes->ceiling;
    if (!err->status && !set->view_count)
        err_set(err, ST_DATA, "%s contains no views; run sfm_import again.", f->views);
    if (!err->status) point_cloud_read(&cloud, f->points, prov, err);
    for (size_t i = 0; !err->status && i < cloud.count; i++) {
        struct cloud_point *p = &cloud.points[i];
        p->position = model_from_world_point(axes, p->position);
        cloud_set_normal(p, model_from_world_direction(axes, cloud_normal(p)));
    }
    if (!err->status && !(height > 0)) guess_ceiling(&height, &cloud, err);
    if (!err->status) add_frame(&cloud, f, &in, height, prov, err);
    if (!(height > 0)) cloud.count = 0;
    if (!err->status &&
        !sights_make(&sights, &cloud, height > 0 ? SUGGEST_CUBE * height : 1, set->views, set->view_count, err) &&
        !suggest_plan(&s, &sights, height, axes->thickness, params, err) &&
        !add_openings(&s, f, axes, set, &cloud, params, prov, err) &&
        !write_suggestion(&s, &sights, axes, f, prov, err))
        log_summary(&s, f->out);
    suggest_release(&s);
    sights_release(&sights);
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
        CLI_STR("frame", &f.frame, CLI_OPTIONAL, "what straight edges say of the room: frame.txt"),
        CLI_STR("axes", &f.axes, CLI_REQUIRED, "the model's frame, axes.txt"),
        CLI_STR("picture", &f.picture, CLI_OPTIONAL, "SVG of the plan to write, with points, walls and doubts"),
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
