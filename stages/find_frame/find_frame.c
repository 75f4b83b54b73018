/* find_frame.c - finds the directions, the floor, the ceiling and the walls of a room from the straight edges of all
 * views.
 *
 * reads   VIEWS/cameras.txt, images.txt, points3D.txt, lenses.txt   the cameras
 *         RECORDS/ID.txt                  the photos' orientations
 *         LINES/VIEW.txt                  the straight edges of each view
 * writes  OUT                             the frame
 *
 * A scene whose lines have no common directions gets an empty frame, and the stage succeeds. */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/capture/upright.h"
#include "common/math/numbers.h"
#include "common/product/product.h"
#include "stages/find_frame/frame_params.h"
#include "stages/find_frame/frame_room.h"
#include "stages/find_frame/line_directions.h"

#define PARAM_STRUCT struct frame_params
const struct param frame_param_table[] = {FRAME_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define STATION 0.1 /* of the scene's size: views as near to each other stand at one place */

struct files {
    const char *views, *records, *lines, *out;
    struct provenance *prov;
};

static enum status read_lines(struct world_lines *w, const struct camera_set *set, const struct files *f,
                              struct err *err)
{
    for (int i = 0; !err->status && i < set->view_count; i++) {
        struct line_list list = {0};
        char path[FILE_PATH];
        if (!product_path_in(path, f->lines, PRODUCT_LINES, &(struct product_key){.view = set->views[i].name}, err) &&
            !line_list_read(&list, path, f->prov, err))
            world_lines_add(w, &set->views[i], i, &list, err);
        line_list_release(&list);
    }
    return err->status;
}

static void log_frame(const struct room_frame *f, const struct world_lines *w)
{
    if (!f->known) {
        log_note("the %d lines of all views have no common directions", w->count);
        return;
    }
    log_note("of %d lines, %.0f and %.0f %% run along two perpendicular headings; standard errors: up %.3f degrees, "
             "heading %.3f degrees; %d further headings",
             w->count, 100 * f->headings[0].share, 100 * f->headings[1].share, f->up_error / DEGREE,
             f->headings[0].error / DEGREE, f->heading_count - 2);
    if (f->floor.known) log_note("floor at %.4g +- %.2g", f->floor.height, f->floor.error);
    if (f->ceiling.known) log_note("ceiling at %.4g +- %.2g", f->ceiling.height, f->ceiling.error);
    log_note("%d walls seen from %d places", f->wall_count, w->stations);
}

static enum status find_frame(const struct files *f, const struct frame_params *params, struct err *err)
{
    struct camera_set set = {0};
    struct world_lines w = {0};
    struct room_frame frame = {0};
    struct vec3 *ups = NULL;
    camera_set_read(&set, f->views, f->prov, err);
    if (!err->status && !(ups = calloc((size_t)set.view_count + 1, sizeof *ups)))
        err_nomem(err, "up directions of views", (size_t)set.view_count * sizeof *ups);
    if (!err->status && !upright_read(ups, &set, f->views, f->records, f->prov, err)) read_lines(&w, &set, f, err);
    const double size = err->status ? 0 : world_lines_size(&set);
    if (!err->status && size > 0 && !world_lines_place(&w, &set, STATION * size, err) &&
        !line_directions_find(&frame, &w, upright_mean(&set, ups), params, err) && frame.known)
        frame_room_find(&frame, &w, &set, size, err);
    if (!err->status && !room_frame_write(&frame, f->out, f->prov, err)) log_frame(&frame, &w);
    room_frame_release(&frame);
    world_lines_release(&w);
    free(ups);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    struct provenance prov = {0};
    struct files f = {.prov = &prov};
    struct frame_params params = FRAME_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the directions, the floor, the ceiling and the walls of a room from straight edges."),
        CLI_STR("views", &f.views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("records", &f.records, CLI_REQUIRED, "folder of the photos' records, for their orientations"),
        CLI_STR("lines", &f.lines, CLI_REQUIRED, "folder of the straight edges of all views"),
        CLI_STR("out", &f.out, CLI_REQUIRED, "frame to write"),
        CLI_PARAMS(frame_param_table, &params, NULL),
        CLI_END,
    };
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_frame", opts, &prov, &err) != CLI_RUN || find_frame(&f, &params, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
