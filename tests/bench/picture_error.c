/* picture_error.c - the relative error of a picture, for benches.
 *
 *   picture_error PICTURE.exr TRUTH.exr
 *
 * Prints "error E", "unit 1", "pixels N": E is the root mean square, over pixels and the channels R G B, of
 * (v - t) / (t + m / 100), with t the true value and m its mean over the picture, which bounds the error of black
 * pixels. */
#include <math.h>
#include <stdio.h>

#include "common/image/exr.h"

static enum status compare(const char *picture, const char *truth, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image a = {0}, b = {0};
    if (!exr_read(&a, picture, names, 3, err)) exr_read(&b, truth, names, 3, err);
    if (!err->status && (a.width != b.width || a.height != b.height))
        err_set(err, ST_DATA, "%s has %d x %d pixels, but %s has %d x %d; give pictures of one size.", picture, a.width,
                a.height, truth, b.width, b.height);
    if (!err->status) {
        const size_t pixels = (size_t)a.width * (size_t)a.height;
        double mean = 0, sum = 0;
        for (int c = 0; c < 3; c++)
            for (size_t i = 0; i < pixels; i++) mean += (double)b.planes[c].f[i] / (3 * (double)pixels);
        if (!(mean > 0))
            err_set(err, ST_DATA, "%s is black, so no relative error is defined; give another truth.", truth);
        for (int c = 0; !err->status && c < 3; c++) {
            const struct exr_plane *v = exr_find(&a, names[c]), *t = exr_find(&b, names[c]);
            for (size_t i = 0; i < pixels; i++) {
                double off = ((double)v->f[i] - (double)t->f[i]) / (fmax(t->f[i], 0) + mean / 100);
                sum += off * off;
            }
        }
        if (!err->status) printf("error %.5g\nunit 1\npixels %zu\n", sqrt(sum / (3 * (double)pixels)), pixels);
    }
    exr_image_release(&a);
    exr_image_release(&b);
    return err->status;
}

int main(int argc, char **argv)
{
    struct err err = ERR_INIT;
    log_set_name("picture_error");
    if (argc != 3)
        err_set(&err, ST_USAGE, "found %d arguments, wanted PICTURE TRUTH.", argc - 1);
    else
        compare(argv[1], argv[2], &err);
    err_report(&err);
    return err_exit_code(&err);
}
