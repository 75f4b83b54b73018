/* true_photo.c - a merged photograph with its true radiance in place of what the exposures gave.
 *
 *   true_photo --truth FILE --merged FILE --scale S --out FILE
 *
 * --merged is hdr/ID.exr of the products, --truth hdr/ID.exr of the truth, of the same size; true radiance is S times
 * that of the products. In --out nothing is clipped, and the noise is small everywhere; all else is that of
 * --merged. */
#include <stdlib.h>

#include "common/base/cli.h"
#include "common/image/exr.h"

static const float VARIANCE = 1e-6f; /* of the logarithm of a pixel's luminance */

static enum status replace(struct exr_image *merged, const struct exr_image *truth, double scale, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    const size_t pixels = (size_t)merged->width * (size_t)merged->height;
    struct exr_plane *clipped = exr_find(merged, "clipped"), *variance = exr_find(merged, "variance");
    if (merged->width != truth->width || merged->height != truth->height || !clipped || !variance)
        return err_set(err, ST_DATA, "the photographs differ in size, or one has no channels clipped and variance.");
    for (int c = 0; c < 3; c++)
        for (size_t i = 0; i < pixels; i++)
            exr_find(merged, names[c])->f[i] = (float)((double)exr_find(truth, names[c])->f[i] / scale);
    for (size_t i = 0; i < pixels; i++) {
        clipped->u[i] = 0;
        variance->f[i] = VARIANCE;
    }
    return ST_OK;
}

int main(int argc, char **argv)
{
    static const char *const rgb[] = {"R", "G", "B"};
    const char *truth_path = NULL, *merged_path = NULL, *scale = NULL, *out = NULL;
    struct provenance prov = {0};
    struct exr_image truth = {0}, merged = {0};
    struct err err = ERR_INIT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("A merged photograph with its true radiance."),
        CLI_STR("truth", &truth_path, CLI_REQUIRED, "true radiance"),
        CLI_STR("merged", &merged_path, CLI_REQUIRED, "what the exposures gave"),
        CLI_STR("scale", &scale, CLI_REQUIRED, "true over merged radiance"),
        CLI_STR("out", &out, CLI_REQUIRED, "EXR to write"),
        CLI_END,
    };
    if (cli_parse(argc, argv, "true_photo", opts, &prov, &err) == CLI_RUN) {
        if (!(atof(scale) > 0)) err_set(&err, ST_USAGE, "--scale %s: must be a number above 0.", scale);
        (void)(err.status || exr_read(&truth, truth_path, rgb, 3, &err) ||
               exr_read(&merged, merged_path, NULL, 0, &err) || replace(&merged, &truth, atof(scale), &err) ||
               exr_write(&merged, out, &prov, &err));
    }
    err_report(&err);
    exr_image_release(&truth);
    exr_image_release(&merged);
    provenance_release(&prov);
    return err_exit_code(&err);
}
