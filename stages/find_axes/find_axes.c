/* find_axes.c - finds a room's axes, floor, ceiling and scale from oriented points.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt, lenses.txt   the cameras
 *         RECORDS/ID.txt                  the photos' orientations
 *         POINTS                          oriented points on which views agree
 *         FRAME                           with --frame: directions, floor and ceiling that straight edges show
 *         SCALE, FIX                      with --scale, --fix: the user's marks (marks.h)
 *         VIEWS/VIEW.exr                  of the views that are drawn on
 * writes  axes/VIEW.png beside OUT        the axes and outlines of floor and ceiling, drawn on a few views
 *         OUT                             the axes, last */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/capture/upright.h"
#include "common/capture/view_image.h"
#include "common/image/photo.h"
#include "common/model/scene_inputs.h"
#include "common/product/product.h"
#include "stages/find_axes/axes_pictures.h"
#include "stages/find_axes/room_axes.h"

#define PARAM_STRUCT struct axes_params
const struct param axes_param_table[] = {AXES_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

/* warnings beyond these */
static const double MAX_LEANING = 20, MAX_TURN = 10; /* degrees */
static const double MAX_BEYOND = 0.2;                /* fraction of the upward normals that are below the floor */

struct files {
    const char *views, *records, *points, *frame, *scale, *fix, *out;
    struct provenance *prov;
};

static void log_summary(const struct room *room, const struct files *f, const struct camera_set *set)
{
    const struct model_axes *a = &room->axes;
    const char *unit = a->metric ? "m" : "scene units";
    const double turned = room->fix.turn * 180 / M_PI;
    static const char *const sources[] = {"straight edges", "the points' normals", "marked edges"};
    log_note("axes of %s; normals along x, y and up: %.0f, %.0f and %.0f %%; up is %.1f degrees off the cameras' mean",
             sources[room->source], 100 * room->part[0], 100 * room->part[1], 100 * room->part[2], room->leaning);
    log_note("standard errors: up %.3f degrees, heading %.3f degrees, floor %.2g %s", a->tilt_error, a->heading_error,
             a->floor_error, unit);
    log_note("the origin lies on the floor below view %s, %.4g %s under its camera; %s", set->views[room->central].name,
             -room->floor.height * a->scale, unit,
             room->floor_marked     ? "its height is that of the marked corners"
             : room->floor.of_edges ? "its height is that of straight edges"
                                    : "its height is that of the points");
    if (turned > 0)
        log_note("%s turns the axes by %.2f degrees", f->fix, turned);
    else if (room->fix.edges)
        log_note("%s: the marked edges agree with the axes within their errors; the axes are unchanged", f->fix);
    if (room->corner_height < 0 && !room->floor_marked)
        log_note("%s: the marked corners agree with the floor within their errors; the floor is unchanged", f->fix);
    if (a->ceiling > 0 && !room->ceiling.count)
        log_note("ceiling at %.4g %s, the height in %s: no points show it", a->ceiling, unit, f->scale);
    else if (a->ceiling > 0)
        log_note("ceiling at %.4g +- %.2g %s, from %s", a->ceiling, a->ceiling_error, unit,
                 room->ceiling.of_edges ? "straight edges" : "points");
    else
        log_note("no ceiling: only %zu points above the central camera have downward normals ([find_axes] min_ceiling)",
                 room->ceiling.candidates);
    if (a->metric) log_note("1 scene unit is %.6g m, +- %.2g %%", a->scale, 100 * a->scale_error);
    if (a->thickness > 0) log_note("walls are %.4g %s thick", a->thickness, unit);

    if (room->leaning > MAX_LEANING)
        log_warn("up is %.0f degrees off the mean of the photos' upper sides: check the pictures of the axes",
                 room->leaning);
    if (turned > MAX_TURN)
        log_warn("%s turns the axes by %.0f degrees, more than a usual correction: check the pictures of the axes",
                 f->fix, turned);
    if (!room->floor_marked && (double)room->floor.beyond > MAX_BEYOND * (double)room->floor.candidates)
        log_warn("%.0f %% of the points with upward normals lie below the floor, which may be a table; if so, mark a "
                 "corner of the floor in two views in axes_fix.txt",
                 100.0 * (double)room->floor.beyond / (double)room->floor.candidates);
}

/* axes/VIEW.png beside OUT. */
static enum status picture_path(char path[FILE_PATH], const char *out, const char *view, struct err *err)
{
    char folder[FILE_PATH];
    const char *slash = strrchr(out, '/');
    const int stem = slash ? (int)(slash - out) : 1;
    if ((size_t)snprintf(folder, sizeof folder, "%.*s", stem, slash ? out : ".") >= sizeof folder)
        return err_set(err, ST_IO, "the name of the folder of %s is too long.", out);
    return product_path_in(path, folder, PRODUCT_AXES_PICTURE, &(struct product_key){.view = view}, err);
}

static enum status draw_view(const struct view *view, const struct room *room, const struct vec3 *corners, int count,
                             const struct files *f, struct err *err)
{
    struct image im = {0};
    char path[FILE_PATH];
    unsigned char *pixels = NULL;
    view_image_read(&im, f->views, view, f->prov, err);
    if (!err->status && !(pixels = malloc(3 * (size_t)im.width * (size_t)im.height)))
        err_nomem(err, "a picture", 3 * (size_t)im.width * (size_t)im.height);
    if (!err->status && !pictures_expose(pixels, &im, err)) pictures_draw_room(pixels, view, room, corners, count);
    if (!err->status && !picture_path(path, f->out, view->name, err))
        png_write(path, pixels, im.width, im.height, 3, err);
    free(pixels);
    image_release(&im);
    return err->status;
}

/* The positions on the floor of the marked corners, one for each mark. */
static enum status place_corners(struct vec3 *corners, int *count, const struct room *room,
                                 const struct room_inputs *in, struct err *err)
{
    const struct vec3 up = world_from_model_direction(&room->axes, vec3_make(0, 0, 1));
    const struct mark_scene scene = {in->set, in->lenses, in->cloud, up,
                                     vec3_dot(up, world_from_model_point(&room->axes, (struct vec3){0}))};
    *count = 0;
    for (int i = 0; in->fix && i < in->fix->count; i++) {
        const struct mark *m = &in->fix->marks[i];
        struct photo_camera camera;
        struct vec3 ray;
        if (m->kind != MARK_CORNER) continue;
        if (mark_ray(m, in->fix, &scene, &camera, &ray, err)) return err->status;
        const double above = vec3_dot(camera.center, up) - scene.floor, down = -vec3_dot(ray, up);
        if (above > 0 && down > 0) corners[(*count)++] = vec3_add(camera.center, vec3_scale(ray, above / down));
    }
    return ST_OK;
}

/* Removes the picture of a view that an earlier run may have chosen and this one did not. */
static enum status remove_picture(const char *out, const char *view, struct err *err)
{
    char path[FILE_PATH];
    if (picture_path(path, out, view, err)) return err->status;
    return unlink(path) && errno != ENOENT ? err_errno(err, "remove", path) : ST_OK;
}

static enum status draw(const struct room *room, const struct room_inputs *in, const struct files *f, int pictures,
                        struct err *err)
{
    const int views = in->set->view_count;
    bool *chosen = calloc((size_t)views + 1, sizeof *chosen);
    struct vec3 *corners = calloc((size_t)(in->fix ? in->fix->count : 0) + 1, sizeof *corners);
    int count = 0;
    if (chosen && corners)
        pictures_choose(chosen, pictures, in, err);
    else
        err_nomem(err, "views", (size_t)views * sizeof *chosen);
    if (!err->status) place_corners(corners, &count, room, in, err);
    for (int i = 0; !err->status && i < views; i++) {
        if (chosen[i])
            draw_view(&in->set->views[i], room, corners, count, f, err);
        else
            remove_picture(f->out, in->set->views[i].name, err);
    }
    free(chosen);
    free(corners);
    return err->status;
}

static enum status find(const struct files *f, const struct axes_params *params, struct err *err)
{
    const struct scene_files files = {.views = f->views};
    struct scene_inputs scene = {0};
    struct point_cloud cloud = {0};
    struct mark_list scale = {0}, fix = {0};
    struct room_frame frame = {0};
    struct vec3 *ups = NULL;
    struct room room;
    scene_inputs_read(&scene, SCENE_POINTS | SCENE_LENSES, &files, f->prov, err);
    const struct camera_set *set = &scene.set;
    if (!err->status && !set->view_count)
        err_set(err, ST_DATA, "%s contains no views; run sfm_import again.", f->views);
    if (!err->status && !(ups = calloc((size_t)set->view_count, sizeof *ups)))
        err_nomem(err, "up directions of views", (size_t)set->view_count * sizeof *ups);
    if (!err->status && !upright_read(ups, set, f->views, f->records, f->prov, err))
        point_cloud_read(&cloud, f->points, f->prov, err);
    if (!err->status && f->frame) room_frame_read(&frame, f->frame, f->prov, err);
    if (!err->status && f->scale) mark_list_read(&scale, f->scale, MARKS_SCALE, f->prov, err);
    if (!err->status && f->fix) mark_list_read(&fix, f->fix, MARKS_FIX, f->prov, err);
    const struct room_inputs in = {.set = set,
                                   .lenses = &scene.lenses,
                                   .ups = ups,
                                   .cloud = &cloud,
                                   .frame = f->frame ? &frame : NULL,
                                   .scale = f->scale ? &scale : NULL,
                                   .fix = f->fix ? &fix : NULL};
    if (!err->status && !room_find(&room, &in, params, err)) log_summary(&room, f, set);
    if (!err->status && !draw(&room, &in, f, params->pictures, err)) model_axes_write(&room.axes, f->out, f->prov, err);
    mark_list_release(&fix);
    mark_list_release(&scale);
    point_cloud_release(&cloud);
    room_frame_release(&frame);
    free(ups);
    scene_inputs_release(&scene);
    return err->status;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct files f = {.prov = &prov};
    struct axes_params params = AXES_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds a room's axes, floor, ceiling and scale."),
        CLI_STR("views", &f.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("records", &f.records, CLI_REQUIRED, "folder of the photos' records, for their orientations"),
        CLI_STR("points", &f.points, CLI_REQUIRED, "oriented points, points.ply"),
        CLI_STR("frame", &f.frame, CLI_OPTIONAL, "what straight edges say of the room: frame.txt"),
        CLI_STR("scale", &f.scale, CLI_OPTIONAL, "file of marked points and the distances between them in metres"),
        CLI_STR("fix", &f.fix, CLI_OPTIONAL, "file of marked corners of the floor, edges and a wall's thickness"),
        CLI_STR("out", &f.out, CLI_REQUIRED, "axes to write; pictures go to the folder axes beside them"),
        CLI_PARAMS(axes_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_axes", opts, &prov, &err) != CLI_RUN || find(&f, &params, &err)) err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
