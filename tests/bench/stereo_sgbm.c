/* stereo_sgbm.c - depth of a rectified pair by OpenCV's semi-global matching, left-right checked and filled.
 *
 * reads   VIEWS/cameras.txt, images.txt, left.exr, right.exr      linear RGBA; matched as 8-bit sRGB
 * writes  OUT                                                     Z of the left view
 * prints  "seconds S", "cpu_seconds S": both matches, the check and the filling, without files
 *
 * Each picture is matched with the other one as reference; a disparity is kept if the two agree within one pixel. Other
 * pixels take the more distant of the nearest two kept ones in their row, because hidden surfaces are background. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/capture/camera_set.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "tests/bench/depth_sgbm.h"

/* The defaults have the best mean bad-2 over the pairs of the bench, of block 1, 3, 5, 7, p1 2 to 32, p2 16 to 96 and
 * uniqueness 0, 5 and 10. widen = no is OpenCV's plain call: columns without a partner at the maximum disparity are
 * filled, not matched. */
#define SGBM_PARAMS(X)                                                                                            \
    X(near, double, 1, 1e-30, 1e30, "scene units", "minimum depth of the search")                                 \
    X(block, int, 1, 1, 31, "px", "width of what is compared; odd")                                               \
    X(p1, int, 16, 1, 1000, "", "cost of a change of disparity by one, for every pixel and channel of the block") \
    X(p2, int, 32, 2, 1000, "", "cost of a larger change")                                                        \
    X(uniqueness, int, 0, 0, 100, "%", "by how much the best disparity must win")                                 \
    X(check, double, 1, 0, 1000, "px", "by how much the two pictures' disparities may differ")                    \
    X(widen, choice, "yes", 0, 0, "yes|no", "pictures are widened on the left, so that all columns are matched")

struct sgbm_params {
    SGBM_PARAMS(PARAM_FIELD)
};
#define PARAM_STRUCT struct sgbm_params
static const struct param sgbm_param_table[] = {SGBM_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

struct pair {
    struct view view;
    double baseline;
    unsigned char *rgb[2]; /* left, right */
    float *disparity[2];
};

static enum status read_pair(struct pair *p, struct camera_set *set, const char *views, struct err *err)
{
    camera_set_read(set, views, NULL, err);
    for (int side = 0; !err->status && side < 2; side++) {
        const char *const name = side ? "right" : "left";
        const int idx = camera_set_find(set, name);
        struct image im = {0};
        if (idx < 0) return err_set(err, ST_DATA, "%s/images.txt has no view %s.", views, name);
        const struct view *view = &set->views[idx];
        const size_t pixels = (size_t)view->width * (size_t)view->height;
        if (!side) p->view = *view;
        if (side && (view->width != p->view.width || view->height != p->view.height || view->fx != p->view.fx))
            return err_set(err, ST_DATA,
                           "the views left and right of %s have different cameras; they must be a rectified pair.",
                           views);
        if (side) p->baseline = vec3_length(vec3_sub(view->center, p->view.center));
        p->rgb[side] = malloc(3 * pixels);
        p->disparity[side] = malloc(pixels * sizeof(float));
        if (!p->rgb[side] || !p->disparity[side]) return err_nomem(err, "a pair", 7 * pixels);
        if (!view_image_read(&im, views, view, NULL, err)) image_to_srgb8(&im, p->rgb[side]);
        image_release(&im);
    }
    return err->status;
}

static void mirror(void *pixels, int width, int height, size_t size)
{
    unsigned char *row = pixels, t;
    for (int y = 0; y < height; y++, row += (size_t)width * size)
        for (size_t a = 0, b = (size_t)width - 1; a < b; a++, b--)
            for (size_t k = 0; k < size; k++)
                t = row[a * size + k], row[a * size + k] = row[b * size + k], row[b * size + k] = t;
}

/* Disparities of the right picture: those of the left one of the mirrored pair. The pictures are restored. */
static enum status match_right(struct pair *p, const struct sgbm_settings *settings, struct err *err)
{
    const int w = p->view.width, h = p->view.height;
    for (int side = 0; side < 2; side++) mirror(p->rgb[side], w, h, 3);
    sgbm_match(p->disparity[1], p->rgb[1], p->rgb[0], w, h, settings, err);
    mirror(p->disparity[1], w, h, sizeof(float));
    for (int side = 0; side < 2; side++) mirror(p->rgb[side], w, h, 3);
    return err->status;
}

static void keep_what_agrees(struct pair *p, double apart)
{
    for (int y = 0; y < p->view.height; y++) {
        float *left = p->disparity[0] + (size_t)y * (size_t)p->view.width;
        const float *right = p->disparity[1] + (size_t)y * (size_t)p->view.width;
        for (int x = 0; x < p->view.width; x++) {
            const int other = (int)lroundf((float)x - left[x]);
            if (other < 0 || !(right[other] > 0) || fabs((double)(right[other] - left[x])) > apart) left[x] = 0;
        }
    }
}

/* A row without a kept disparity is a copy of the nearest row with one, above first. */
static void fill(struct pair *p)
{
    const int w = p->view.width, h = p->view.height;
    float *before = p->disparity[1]; /* the row before filling; this buffer is no longer needed */
    for (int y = 0; y < h; y++) {
        float *d = p->disparity[0] + (size_t)y * (size_t)w, last = 0;
        for (int x = 0; x < w; x++) before[x] = last = d[x] > 0 ? d[x] : last;
        last = 0;
        for (int x = w - 1; x >= 0; x--) {
            const float after = last = d[x] > 0 ? d[x] : last;
            d[x] = before[x] > 0 && after > 0 ? fminf(before[x], after) : fmaxf(before[x], after);
        }
    }
    for (int pass = 0; pass < 2; pass++)
        for (int k = 1; k < h; k++) {
            float *d = p->disparity[0] + (size_t)(pass ? h - 1 - k : k) * (size_t)w;
            for (int x = 0; x < w; x++)
                if (!(d[x] > 0)) d[x] = pass ? d[x + w] : d[x - w];
        }
}

static enum status write_depth(const struct pair *p, const char *out, const struct provenance *prov, struct err *err)
{
    struct exr_image im = {0};
    struct exr_plane *z = NULL;
    if (!exr_image_init(&im, p->view.width, p->view.height, err)) exr_add_plane(&im, "Z", EXR_FLOAT, &z, err);
    for (size_t i = 0; !err->status && i < (size_t)p->view.width * (size_t)p->view.height; i++)
        if (p->disparity[0][i] > 0) z->f[i] = (float)(p->view.fx * p->baseline / (double)p->disparity[0][i]);
    if (!err->status) exr_write(&im, out, prov, err);
    exr_image_release(&im);
    return err->status;
}

static enum status solve(struct pair *p, const struct sgbm_params *params, struct err *err)
{
    const struct sgbm_settings settings = {
        .disparities = (int)ceil(p->view.fx * p->baseline / params->near / 16) * 16,
        .block = params->block,
        .p1 = params->p1,
        .p2 = params->p2,
        .uniqueness = params->uniqueness,
        .widen = strcmp(params->widen, "no") != 0,
    };
    if (settings.disparities < 16 || settings.disparities > 4096)
        return err_set(err, ST_USAGE, "near = %g asks for %d disparities, wanted 16 to 4096.", params->near,
                       settings.disparities);
    if (sgbm_match(p->disparity[0], p->rgb[0], p->rgb[1], p->view.width, p->view.height, &settings, err) ||
        match_right(p, &settings, err))
        return err->status;
    keep_what_agrees(p, params->check);
    fill(p);
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *views = NULL, *out = NULL;
    struct sgbm_params params = {SGBM_PARAMS(PARAM_DEFAULT)};
    const struct cli_opt opts[] = {
        CLI_ABOUT(
            "Computes depth of a rectified pair by OpenCV's semi-global matching, left-right checked and filled."),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of the views left and right"),
        CLI_STR("out", &out, CLI_REQUIRED, "EXR to write"),
        CLI_PARAMS(sgbm_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct camera_set set = {0};
    struct pair p = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "stereo_sgbm", opts, &prov, &err) == CLI_RUN && !read_pair(&p, &set, views, &err)) {
        const double wall = clock_seconds(), cpu = clock_cpu_seconds();
        if (!solve(&p, &params, &err)) {
            printf("seconds %.6f\ncpu_seconds %.6f\n", clock_seconds() - wall, clock_cpu_seconds() - cpu);
            write_depth(&p, out, &prov, &err);
        }
    }
    err_report(&err);
    for (int side = 0; side < 2; side++) {
        free(p.rgb[side]);
        free(p.disparity[side]);
    }
    camera_set_release(&set);
    provenance_release(&prov);
    return err_exit_code(&err);
}
