/* scene_exposure.c - one exposure for a scene; see scene_exposure.h.
 *
 * Source: [Colburn 2014, 4.6] exposes each view as a camera would. Different here: a scene has one exposure, and it is
 * that of its photographs as they are, so that an edit, or a step along a room, changes no brightness. The median is
 * that of cameras which chose well, whatever a few dark or overexposed photographs say. It is rounded to thirds of a
 * stop, as cameras step, so that a changed photograph seldom changes it, and every picture with it. */
#include "common/texture/scene_exposure.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common/base/memory_text.h"
#include "common/product/product.h"

enum { STEPS = 3 }; /* in a stop, a factor of 2 */

static int compare_doubles(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

double scene_exposure_of(double *of_views, int count)
{
    if (count < 1) return 1;
    qsort(of_views, (size_t)count, sizeof *of_views, compare_doubles);
    const double stops = 0.5 * (log2(of_views[(count - 1) / 2]) + log2(of_views[count / 2]));
    return exp2(round(STEPS * stops) / STEPS);
}

enum status scene_exposure_write(double exposure, const char *path, const struct provenance *prov, struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "an exposure", err)) return err->status;
    fprintf(m.to, "%s\n", products[PRODUCT_EXPOSURE].head);
    if (prov) provenance_print(prov, m.to);
    fprintf(m.to, "exposure %.17g\n", exposure);
    if (!memory_text_close(&m, "an exposure", err)) outfile_write_if_changed(path, m.text, m.size, err);
    memory_text_release(&m);
    return err->status;
}

enum status scene_exposure_read(double *exposure, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *exposure = 1;
    if (product_open(&t, NULL, PRODUCT_EXPOSURE, path, prov, err)) return err->status;
    if (!textfile_expect_line(&t, "exposure", err) && !textfile_double(&t, "an exposure", exposure, err) &&
        !(*exposure > 0))
        textfile_wrong_number(&t, *exposure, "an exposure above 0", err);
    if (!err->status && !textfile_end(&t, err)) textfile_end_of_file(&t, err);
    textfile_release(&t);
    return err->status;
}
