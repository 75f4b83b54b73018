/* depth_rounds.c - rounds by need: only what still changes is estimated again.
 *
 * A round starts from a view's planes of the round before and from its neighbours' depth then [Zitnick 2007]. Where
 * none of these has changed since the view was estimated last, another estimate would begin where that one ended. So
 * each round records the change of each view: with z the depth on the plane of the pixel's segment, then and now,
 *   changed = |{pixels: |z_now - z_before| > CHANGED_PART z_before}| / |{pixels with depth}|
 * which is 1 in the first round, and 0 in a round that the view did not take part in. A view takes part in the next
 * round if its own change, or the mean of its neighbours' changes, is at least min_change; otherwise its files are
 * copied. The mean, because the neighbours' evidence in the energy is a mean over them (cross_view.c). The rule reads
 * records of the previous round only, so that it does not depend on the order of views.
 *
 * A view that was carried over is estimated again as soon as its neighbours change enough. Changes below min_change do
 * not add up over rounds: they are compared with the round before. What differs from the source: all its views take
 * part in all rounds. */
#include "stages/segment_depth/depth_rounds.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "common/product/product.h"

enum status round_record_write(const struct round_record *r, const char *path, const struct provenance *prov,
                               struct err *err)
{
    struct outfile file = {0};
    if (!product_begin(&file, PRODUCT_DEPTH_ROUND, path, prov, err)) {
        fprintf(file.fp, "changed %.6g\nestimated %s\n", r->changed, r->estimated ? "yes" : "no");
        outfile_commit(&file, err);
    }
    outfile_discard(&file);
    return err->status;
}

static enum status read_changed(double *changed, struct textfile *t, struct err *err)
{
    if (textfile_expect_line(t, "changed", err) || textfile_number(t, "share of pixels", 0, 1, changed, err))
        return err->status;
    return textfile_end(t, err);
}

static enum status read_estimated(bool *estimated, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_expect_line(t, "estimated", err) || textfile_word(t, "yes or no", &word, err)) return err->status;
    *estimated = !strcmp(word, "yes");
    if (!*estimated && strcmp(word, "no")) return textfile_error(t, err, word, "yes or no");
    return textfile_end(t, err);
}

enum status round_record_read(struct round_record *r, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *r = (struct round_record){0};
    if (!product_open(&t, NULL, PRODUCT_DEPTH_ROUND, path, prov, err) && !read_changed(&r->changed, &t, err) &&
        !read_estimated(&r->estimated, &t, err))
        textfile_end_of_file(&t, err);
    textfile_release(&t);
    if (err->status) *r = (struct round_record){0};
    return err->status;
}

static double inverse_at(const struct depth_segment *g, int x, int y)
{
    return g->plane[0] * (x + 0.5) + g->plane[1] * (y + 0.5) + g->plane[2];
}

double round_change(const struct layered_depth *now, const struct layered_depth *before)
{
    size_t changed = 0, known = 0;
    for (int y = 0; y < now->height; y++)
        for (int x = 0; x < now->width; x++) {
            const size_t i = (size_t)y * (size_t)now->width + (size_t)x;
            if (!now->interior.id[i]) continue;
            known++;
            if (!before->interior.id[i]) {
                changed++;
                continue;
            }
            /* |z_now - z_before| > part z_before, in inverse depths, which are positive where there is depth */
            const double a = inverse_at(&now->segments[now->interior.id[i] - 1], x, y),
                         b = inverse_at(&before->segments[before->interior.id[i] - 1], x, y);
            changed += !(fabs(b - a) <= CHANGED_PART * a);
        }
    return known ? (double)changed / (double)known : 0;
}

static enum status read_change(double *changed, const char *folder, const char *view, struct provenance *prov,
                               struct err *err)
{
    struct round_record r = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, folder, PRODUCT_DEPTH_ROUND, &(struct product_key){.view = view}, err))
        round_record_read(&r, path, prov, err);
    *changed = r.changed;
    return err->status;
}

enum status round_is_settled(bool *settled, const char *folder, const struct camera_set *set, const int *views,
                             int count, double min_change, struct provenance *prov, struct err *err)
{
    double own = 0, sum = 0;
    read_change(&own, folder, set->views[views[0]].name, prov, err);
    for (int i = 1; !err->status && i < count; i++) {
        double changed;
        read_change(&changed, folder, set->views[views[i]].name, prov, err);
        sum += changed;
    }
    *settled = !err->status && own < min_change && (count < 2 || sum / (count - 1) < min_change);
    return err->status;
}

enum status round_file(char path[FILE_PATH], const char *exr, const char *suffix, struct err *err)
{
    const size_t n = strlen(exr), suffix_size = strlen(suffix) + 1;
    if (n < 5 || strcmp(exr + n - 4, ".exr"))
        return err_set(err, ST_USAGE, "%s: the name of a depth map must end in .exr.", exr);
    if (n - 4 + suffix_size > FILE_PATH) return err_set(err, ST_IO, "%s: the path is too long.", exr);
    memcpy(path, exr, n - 4);
    memcpy(path + n - 4, suffix, suffix_size);
    return ST_OK;
}

enum status round_carry_over(const char *folder, const char *view, const char *out, struct err *err)
{
    const struct product_key key = {.view = view};
    char from[FILE_PATH], to[FILE_PATH];
    if (!product_path_in(from, folder, PRODUCT_SEGMENTS, &key, err) && !round_file(to, out, ".txt", err) &&
        !outfile_copy(to, from, err) && !product_path_in(from, folder, PRODUCT_DEPTH, &key, err))
        outfile_copy(out, from, err);
    return err->status;
}
