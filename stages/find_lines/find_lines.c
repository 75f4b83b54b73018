/* find_lines.c - finds the straight edges of a view.
 *
 * reads   VIEWS/cameras.txt, images.txt   the view's camera
 *         VIEWS/VIEW.exr                  the view
 * writes  OUT                             its straight edges, a line each
 *
 * Views are pinhole pictures, so what is straight in the scene is straight in them. Edges of blank walls have little
 * contrast; local contrast is raised first. Edges beside pixels that the view does not have are left out. */
#include <math.h>
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/base/log.h"
#include "common/capture/line_list.h"
#include "common/capture/view_image.h"
#include "common/image/draw.h"
#include "stages/find_lines/lines_params.h"
#include "stages/find_lines/opencv_lines.h"

#define PARAM_STRUCT struct lines_params
static const struct param lines_param_table[] = {LINES_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

#define BESIDE       3.0 /* px from a line at which the view must have pixels */
#define BRIGHT_SHARE 0.99
#define BRIGHT_LEVEL 0.9

/* Whether the view has pixels on both sides of a line. */
static bool is_inside(const struct picture_line *l, const struct image *im)
{
    const double length = hypot(l->u1 - l->u0, l->v1 - l->v0);
    const double across_u = -(l->v1 - l->v0) / length * BESIDE, across_v = (l->u1 - l->u0) / length * BESIDE;
    for (int k = 0; k < 9; k++)
        for (int side = -1; side <= 1; side += 2) {
            const double u = l->u0 + k / 8.0 * (l->u1 - l->u0) + side * across_u,
                         v = l->v0 + k / 8.0 * (l->v1 - l->v0) + side * across_v;
            if (!(u >= 0 && v >= 0 && u < im->width && v < im->height)) continue;
            if (!(im->data[4 * ((size_t)v * (size_t)im->width + (size_t)u) + 3] > 0.99f)) return false;
        }
    return true;
}

/* The view in grey levels as people see it. */
static enum status grey_picture(unsigned char **grey, struct image *im, struct err *err)
{
    const size_t pixels = (size_t)im->width * (size_t)im->height;
    if (image_expose(im, BRIGHT_SHARE, BRIGHT_LEVEL, err)) return err->status;
    *grey = malloc(pixels + 1);
    if (!*grey) return err_nomem(err, "a grey picture", pixels);
    for (size_t i = 0; i < pixels; i++) {
        const float *p = im->data + 4 * i;
        (*grey)[i] = (unsigned char)lrintf(255 * srgb_from_linear(0.2126f * p[0] + 0.7152f * p[1] + 0.0722f * p[2]));
    }
    return ST_OK;
}

static enum status find_lines(const char *views, const char *name, const char *out, const struct lines_params *params,
                              struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct image im = {0};
    struct picture_line *found = NULL;
    struct line_list list = {0};
    unsigned char *grey = NULL;
    int count = 0, at = -1;
    camera_set_read_cameras(&set, views, NULL, err);
    if (!err->status && (at = camera_set_find(&set, name)) < 0)
        err_set(err, ST_USAGE, "view %s is not in %s/images.txt; the views are listed in %s/views.mk.", name, views,
                views);
    if (!err->status && !view_image_read(&im, views, &set.views[at], prov, err) && !grey_picture(&grey, &im, err))
        lines_detect(&found, &count, grey, im.width, im.height,
                     params->min_length * (im.width > im.height ? im.width : im.height), params->contrast, err);
    for (int i = 0; !err->status && i < count; i++)
        if (is_inside(&found[i], &im))
            line_list_add(&list, &(struct view_line){found[i].u0, found[i].v0, found[i].u1, found[i].v1}, err);
    if (!err->status && !line_list_write(&list, out, prov, err)) log_note("%s: %d straight edges", name, list.count);
    free(found);
    free(grey);
    line_list_release(&list);
    image_release(&im);
    camera_set_release(&set);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *view = NULL, *out = NULL;
    struct lines_params params = LINES_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the straight edges of a view."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of cameras and rectified views"),
        CLI_STR("view", &view, CLI_REQUIRED, "view to work on"),
        CLI_STR("out", &out, CLI_REQUIRED, "text file to write"),
        CLI_PARAMS(lines_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "find_lines", opts, &prov, &err) != CLI_RUN ||
        find_lines(views, view, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
