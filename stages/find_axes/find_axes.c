/* find_axes.c - a room's canonical axes, floor, ceiling and scale, from oriented points.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt, lenses.txt   the cameras
 *         RECORDS/ID.txt                  which way up the photos are
 *         POINTS                          oriented points on which views agree
 *         SCALE, FIX                      with --scale, --fix: what a user marked (marks.h)
 *         VIEWS/VIEW.exr                  of the views that are drawn on
 * writes  axes/VIEW.png beside OUT        the axes and outlines of floor and ceiling, drawn on a few views
 *         OUT                             the axes, last */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/capture/upright.h"
#include "common/capture/view_image.h"
#include "common/image/photo.h"
#include "stages/find_axes/pictures.h"
#include "stages/find_axes/room.h"

#define PARAM_STRUCT struct axes_params
const struct param axes_param_table[] = {AXES_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

static const double MOST_LEANING = 20, MOST_TURNED = 10; /* degrees, from which on something is amiss */
static const double MOST_BEYOND = 0.2;                   /* part of the points that look up, below the floor */

struct files {
    const char *views, *records, *points, *scale, *fix, *out;
    struct provenance *prov;
};

static void tell(const struct room *room, const struct files *f, const struct camera_set *set)
{
    const struct model_axes *a = &room->axes;
    const char *unit = a->metric ? "m" : "scene units";
    const double turned = room->fix.turn * 180 / M_PI;
    log_note("normals along x, y and up: %.0f, %.0f and %.0f %%; up leans by %.1f degrees from the cameras' mean",
             100 * room->part[0], 100 * room->part[1], 100 * room->part[2], room->leaning);
    log_note("standard errors: up %.3f degrees, heading %.3f degrees, floor %.2g %s", a->tilt_error, a->heading_error,
             a->floor_error, unit);
    log_note("the origin lies on the floor below view %s, %.4g %s under its camera; %s", set->views[room->central].name,
             -room->floor.height * a->scale, unit,
             room->floor_marked ? "marked corners say so" : "most points that look up say so");
    if (turned > 0)
        log_note("%s turns the axes by %.2f degrees", f->fix, turned);
    else if (room->fix.edges)
        log_note("%s: the edges agree with the axes as well as marks can tell; the axes stay", f->fix);
    if (room->corner_height < 0 && !room->floor_marked)
        log_note("%s: the corners agree with the floor as well as marks can tell; the floor stays", f->fix);
    if (a->ceiling > 0)
        log_note("ceiling at %.4g +- %.2g %s, told by %zu points", a->ceiling, a->ceiling_error, unit,
                 room->ceiling.count);
    else
        log_note("no ceiling: only %zu points above the central camera look down ([find_axes] least_ceiling)",
                 room->ceiling.asked);
    if (a->metric) log_note("1 scene unit is %.6g m, +- %.2g %%", a->scale, 100 * a->scale_error);
    if (a->thickness > 0) log_note("walls are %.4g %s thick", a->thickness, unit);

    if (room->leaning > MOST_LEANING)
        log_warn("up leans by %.0f degrees from where the photos' upper sides point: look at the pictures of the axes",
                 room->leaning);
    if (turned > MOST_TURNED)
        log_warn("%s turns the axes by %.0f degrees, which is more than a correction: look at the pictures of the axes",
                 f->fix, turned);
    if (!room->floor_marked && (double)room->floor.beyond > MOST_BEYOND * (double)room->floor.asked)
        log_warn("%.0f %% of the points that look up lie below the floor that was found: it may be a table; a floor's "
                 "corner, marked in two views in axes_fix.txt, corrects it",
                 100.0 * (double)room->floor.beyond / (double)room->floor.asked);
}

/* axes/VIEW.png beside OUT. */
static enum status picture_path(char path[FILE_PATH], const char *out, const char *view, struct err *err)
{
    char folder[FILE_PATH];
    const char *slash = strrchr(out, '/');
    const int stem = slash ? (int)(slash - out) : 1;
    if ((size_t)snprintf(folder, sizeof folder, "%.*s/axes", stem, slash ? out : ".") >= sizeof folder)
        return err_set(err, ST_IO, "the name of the folder of %s is too long.", out);
    return file_path(path, folder, view, ".png", err);
}

static enum status draw_view(const struct view *view, const struct room *room, const struct vec3 *corners, int count,
                             const struct files *f, struct err *err)
{
    struct image im = {0};
    char path[FILE_PATH];
    unsigned char *pixels = NULL;
    enum status st = provenance_add_in(f->prov, "views", f->views, view->name, ".exr", path, err);
    if (!st) st = view_image_read(&im, f->views, view, err);
    if (!st && !(pixels = malloc(3 * (size_t)im.width * (size_t)im.height)))
        st = err_nomem(err, "a picture", 3 * (size_t)im.width * (size_t)im.height);
    if (!st) st = picture_to_look_at(pixels, &im, err);
    if (!st) draw_room(pixels, view, room, corners, count);
    if (!st) st = picture_path(path, f->out, view->name, err);
    if (!st) st = png_write(path, pixels, im.width, im.height, 3, err);
    free(pixels);
    image_release(&im);
    return st;
}

/* Where the marked corners are that lie on the floor: by their first mark. */
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

/* A view that an earlier run drew and this one does not is not shown any more. */
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
    enum status st = chosen && corners ? choose_pictures(chosen, pictures, in, err)
                                       : err_nomem(err, "views", (size_t)views * sizeof *chosen);
    if (!st) st = place_corners(corners, &count, room, in, err);
    for (int i = 0; !st && i < views; i++)
        st = chosen[i] ? draw_view(&in->set->views[i], room, corners, count, f, err)
                       : remove_picture(f->out, in->set->views[i].name, err);
    free(chosen);
    free(corners);
    return st;
}

static enum status read_marks(struct mark_list *list, const char *path, const char *name, enum mark_file file,
                              struct provenance *prov, struct err *err)
{
    return mark_list_read(list, path, file, err) ? err->status : provenance_add_file(prov, name, path, err);
}

static enum status find(const struct files *f, const struct axes_params *params, struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    struct point_cloud cloud = {0};
    struct mark_list scale = {0}, fix = {0};
    struct vec3 *ups = NULL;
    struct room room;
    char path[FILE_PATH];
    enum status st = camera_set_read(&set, f->views, err);
    if (!st) st = camera_set_add_inputs(f->prov, f->views, err);
    if (!st && !set.view_count) st = err_set(err, ST_DATA, "%s holds no view.", f->views);
    if (!st && !(ups = calloc((size_t)set.view_count, sizeof *ups)))
        st = err_nomem(err, "a direction a view", (size_t)set.view_count * sizeof *ups);
    if (!st) st = upright_read(ups, &set, f->views, f->records, f->prov, err);
    if (!st) st = file_path(path, f->views, "lenses.txt", "", err);
    if (!st) st = lens_list_read(&lenses, path, err);
    if (!st) st = point_cloud_read(&cloud, f->points, err);
    if (!st) st = provenance_add_file(f->prov, "points/points.ply", f->points, err);
    if (!st && f->scale) st = read_marks(&scale, f->scale, "scale.txt", MARKS_SCALE, f->prov, err);
    if (!st && f->fix) st = read_marks(&fix, f->fix, "axes_fix.txt", MARKS_FIX, f->prov, err);
    const struct room_inputs in = {&set, &lenses, ups, &cloud, f->scale ? &scale : NULL, f->fix ? &fix : NULL};
    if (!st) st = find_room(&room, &in, params, err);
    if (!st) tell(&room, f, &set);
    if (!st) st = draw(&room, &in, f, params->pictures, err);
    if (!st) st = model_axes_write(&room.axes, f->out, f->prov, err);
    mark_list_release(&fix);
    mark_list_release(&scale);
    point_cloud_release(&cloud);
    lens_list_release(&lenses);
    free(ups);
    camera_set_release(&set);
    return st;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct files f = {.prov = &prov};
    struct axes_params params = AXES_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds a room's axes, floor, ceiling and scale."),
        CLI_STR("views", &f.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("records", &f.records, CLI_REQUIRED, "folder of the photos' records: which way up they are"),
        CLI_STR("points", &f.points, CLI_REQUIRED, "oriented points, points.ply"),
        CLI_STR("scale", &f.scale, CLI_OPTIONAL, "file of marked points and the metres between them"),
        CLI_STR("fix", &f.fix, CLI_OPTIONAL, "file of marked corners of the floor, edges and a wall's thickness"),
        CLI_STR("out", &f.out, CLI_REQUIRED, "axes to write; pictures go to axes/ beside it"),
        CLI_PARAMS(axes_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_axes", opts, &prov, &err) != CLI_RUN || find(&f, &params, &err)) err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
