/* stereo_score.c - errors of the left view's depth against the truth of a rectified pair.
 *
 * reads   TRUTH/depth/left.exr, right.exr     from stereo_pair; the right one is optional
 *         VIEWS/cameras.txt, images.txt       the view `left` of that depth, of the truth's size or smaller
 *         DEPTH                               layered depth, or a picture with a channel Z; 0 unknown
 * prints  "error E", "unit %"                 bad-2: pixels with an error above 2 px, unknown ones included
 *         "bad1 E", "bad05 E"                 above 1 px, 0.5 px
 *         "bad2_all E"                        bad-2 with occluded pixels included
 *         "known P", "pixels N"               share of the N evaluated pixels with a depth
 *
 * Disparities are in pixels of the truth, whatever the size of the view. A pixel is evaluated if its disparity is
 * known and the right picture sees the point: if both truths agree there within 1 px, or, with the left one alone,
 * if no other point with a disparity larger by more than 1 px projects to the same pixel. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "common/base/cli.h"
#include "common/capture/camera_set.h"
#include "common/image/exr.h"
#include "common/layers/layered_depth.h"
#include "tests/bench/stereo_pair.h"

struct truth {
    int width, height;
    float *left, *right; /* disparities, px; 0 unknown */
    bool *seen;          /* also by the right picture */
};

struct result {
    struct layered_depth layers; /* either layers or a picture */
    struct exr_image plain;
    struct view view;
};

static double disparity_of(double z) { return z > 0 ? PAIR_FOCAL * PAIR_BASELINE / z : 0; }

/* *disparity stays NULL if an optional file is missing. */
static enum status read_side(struct truth *t, float **disparity, const char *folder, const char *side, bool optional,
                             struct err *err)
{
    static const char *const names[] = {"Z"};
    struct exr_image im = {0};
    char path[1000];
    snprintf(path, sizeof path, "%s/depth/%s.exr", folder, side);
    if (optional && access(path, F_OK)) return ST_OK;
    exr_read(&im, path, names, 1, err);
    const size_t pixels = (size_t)im.width * (size_t)im.height;
    if (!err->status && t->width && (im.width != t->width || im.height != t->height))
        err_set(err, ST_DATA, "%s: found %d x %d pixels, wanted %d x %d as on the other side.", path, im.width,
                im.height, t->width, t->height);
    if (!err->status && !(*disparity = malloc(pixels * sizeof(float)))) err_nomem(err, "disparities", pixels * 4);
    for (size_t i = 0; !err->status && i < pixels; i++)
        (*disparity)[i] = (float)disparity_of((double)im.planes[0].f[i]);
    t->width = im.width;
    t->height = im.height;
    exr_image_release(&im);
    return err->status;
}

/* The pixel of the right picture for a left one; -1: outside. */
static int partner(const struct truth *t, int x, int y)
{
    const float d = t->left[y * t->width + x];
    const int other = (int)floor(x + 0.5 - (double)d);
    return d > 0 && other >= 0 && other < t->width ? y * t->width + other : -1;
}

static enum status find_seen(struct truth *t, struct err *err)
{
    const size_t pixels = (size_t)t->width * (size_t)t->height;
    float *nearest = calloc(pixels, sizeof *nearest);
    t->seen = calloc(pixels, sizeof *t->seen);
    if (!nearest || !t->seen) {
        free(nearest);
        return err_nomem(err, "visibility", pixels * 5);
    }
    for (int pass = 0; pass < 2; pass++)
        for (int y = 0; y < t->height; y++)
            for (int x = 0; x < t->width; x++) {
                const int i = y * t->width + x, k = partner(t, x, y);
                if (k < 0) continue;
                if (!pass)
                    nearest[k] = fmaxf(nearest[k], t->left[i]);
                else if (t->right) /* slightly more than 1, because of rounded thirds of a pixel */
                    t->seen[i] = t->right[k] > 0 && fabsf(t->right[k] - t->left[i]) < 1.01f;
                else
                    t->seen[i] = nearest[k] < t->left[i] + 1.01f;
            }
    free(nearest);
    return ST_OK;
}

static enum status read_result(struct result *r, struct camera_set *set, const char *views, const char *depth,
                               struct err *err)
{
    struct exr_image header = {0};
    camera_set_read(set, views, NULL, err);
    const int left = err->status ? -1 : camera_set_find(set, "left");
    if (!err->status && left < 0) err_set(err, ST_DATA, "%s/images.txt has no view left.", views);
    if (!err->status) r->view = set->views[left];
    if (!err->status) exr_read(&header, depth, NULL, 0, err);
    if (!err->status && exr_find(&header, "Z"))
        r->plain = header;
    else if (!err->status) {
        exr_image_release(&header);
        layered_depth_read(&r->layers, depth, NULL, err);
    }
    const int width = r->plain.width ? r->plain.width : r->layers.width,
              height = r->plain.width ? r->plain.height : r->layers.height;
    if (!err->status && (width != r->view.width || height != r->view.height))
        err_set(err, ST_DATA, "%s: found %d x %d pixels, wanted %d x %d as the view has.", depth, width, height,
                r->view.width, r->view.height);
    return err->status;
}

/* Disparity of the result at a position in the true picture; 0 unknown. */
static double result_at(const struct result *r, const struct truth *t, double x, double y)
{
    const struct view *v = &r->view;
    const double u = (x - t->width / 2.0) * v->fx / PAIR_FOCAL + v->cx,
                 w = (y - t->height / 2.0) * v->fy / PAIR_FOCAL + v->cy;
    if (!(u >= 0 && w >= 0 && u < v->width && w < v->height)) return 0;
    const size_t i = (size_t)w * (size_t)v->width + (size_t)u;
    if (r->plain.width) return disparity_of((double)exr_find(&r->plain, "Z")->f[i]);
    const struct layered_depth *d = &r->layers;
    const struct layer *l = d->interior.rgba[4 * i + 3] >= d->boundary.rgba[4 * i + 3] ? &d->interior : &d->boundary;
    if (!l->id[i]) return 0;
    const double *plane = d->segments[l->id[i] - 1].plane;
    return PAIR_FOCAL * PAIR_BASELINE * (plane[0] * u + plane[1] * w + plane[2]);
}

static enum status score(const struct truth *t, const struct result *r, struct err *err)
{
    long evaluated = 0, known = 0, all = 0, all2 = 0, off[3] = {0};
    for (int i = 0; i < t->width * t->height; i++) {
        if (!(t->left[i] > 0)) continue;
        const double d = result_at(r, t, i % t->width + 0.5, i / t->width + 0.5);
        const double e = d > 0 ? fabs(d - (double)t->left[i]) : INFINITY;
        all++;
        all2 += e > 2;
        if (!t->seen[i]) continue;
        evaluated++;
        known += d > 0;
        for (int k = 0; k < 3; k++) off[k] += e > (double[]){0.5, 1, 2}[k];
    }
    if (!evaluated) return err_set(err, ST_DATA, "the truth has no pixel that is visible in both pictures.");
    printf("error %.4f\nunit %%\nbad1 %.4f\nbad05 %.4f\nbad2_all %.4f\nknown %.4f\npixels %ld\n",
           100.0 * (double)off[2] / (double)evaluated, 100.0 * (double)off[1] / (double)evaluated,
           100.0 * (double)off[0] / (double)evaluated, 100.0 * (double)all2 / (double)all,
           100.0 * (double)known / (double)evaluated, evaluated);
    return ST_OK;
}

int main(int argc, char **argv)
{
    const char *truth = NULL, *views = NULL, *depth = NULL;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Measures the errors of the left view's depth against the truth of a rectified pair."),
        CLI_STR("truth", &truth, CLI_REQUIRED, "folder of the truth"),
        CLI_STR("views", &views, CLI_REQUIRED, "folder of the cameras of the views"),
        CLI_STR("depth", &depth, CLI_REQUIRED, "depth of the left view"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct camera_set set = {0};
    struct truth t = {0};
    struct result r = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "stereo_score", opts, &prov, &err) != CLI_RUN ||
        read_side(&t, &t.left, truth, "left", false, &err) || read_side(&t, &t.right, truth, "right", true, &err) ||
        find_seen(&t, &err) || read_result(&r, &set, views, depth, &err) || score(&t, &r, &err))
        err_report(&err);
    free(t.left);
    free(t.right);
    free(t.seen);
    layered_depth_release(&r.layers);
    exr_image_release(&r.plain);
    camera_set_release(&set);
    provenance_release(&prov);
    return err_exit_code(&err);
}
