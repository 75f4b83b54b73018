/* fit_response.c - finds the response curve of bracketed photos, one for the whole scene.
 *
 * reads   RECORDS/list.txt, ID.txt   the views and the exposures of their photos
 *         PHOTOS/FILE                the photos of some of the views
 * writes  OUT                        response.txt: the sRGB curve or a recovered table (docs/formats.md)
 *
 * OUT is rewritten only if its text changes, so that Make merges the views again only then. Its provenance therefore
 * leaves out the photos. */
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/memory_text.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/capture/photo_list.h"
#include "common/product/product.h"
#include "stages/fit_response/recover.h"

struct sample_job {
    const struct photo_record *record;
    const char *photos;
    int max_patches;
    struct patches patches;
    struct err err;
};

/* Skips views with linear photos, which need no curve. */
static enum status sample_view(struct sample_job *job)
{
    const struct photo_record *r = job->record;
    const int count = r->bracket_count < RECOVER_MAX_EXPOSURES ? r->bracket_count : RECOVER_MAX_EXPOSURES;
    struct photo *photos = calloc((size_t)count + 1, sizeof *photos);
    double exposures[RECOVER_MAX_EXPOSURES];
    bool linear = false;
    if (!photos) err_nomem(&job->err, "photos", (size_t)count * sizeof *photos);
    for (int k = 0; !job->err.status && !linear && k < count; k++) {
        char path[FILE_PATH];
        if (!file_path(path, job->photos, r->brackets[k].file, "", &job->err))
            (r->info.bits == 32 ? photo_read_hdr : photo_read_any)(&photos[k], path, &job->err);
        if (!job->err.status &&
            (photos[k].info.width != photos[0].info.width || photos[k].info.height != photos[0].info.height))
            err_set(&job->err, ST_DATA,
                    "%s differs in size from the other exposures of view %s; import the photos again.", path, r->id);
        linear |= photos[k].values != NULL;
        exposures[k] = r->brackets[k].exposure;
    }
    if (!job->err.status && !linear)
        recover_add_patches(&job->patches, photos, exposures, count, job->max_patches, &job->err);
    for (int k = 0; photos && k < count; k++) photo_release(&photos[k]);
    free(photos);
    return job->err.status;
}

static void sample_views(void *ctx, size_t begin, size_t end, int thread)
{
    struct sample_job *jobs = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) sample_view(&jobs[i]);
}

static enum status append(struct patches *all, const struct patches *p, struct err *err)
{
    struct patch_sample *samples = realloc(all->samples, (all->sample_count + p->sample_count + 1) * sizeof *samples);
    if (samples) all->samples = samples;
    int *counts = realloc(all->counts, (all->count + p->count + 1) * sizeof *counts);
    if (counts) all->counts = counts;
    if (!samples || !counts) return err_nomem(err, "samples of photos", p->sample_count * sizeof *samples);
    if (p->sample_count) memcpy(samples + all->sample_count, p->samples, p->sample_count * sizeof *samples);
    if (p->count) memcpy(counts + all->count, p->counts, p->count * sizeof *counts);
    all->sample_count += p->sample_count;
    all->count += p->count;
    return ST_OK;
}

/* Samples up to params->views bracketed views, spread evenly over the list. */
static enum status gather(struct patches *all, const struct photo_list *list, const char *photos,
                          const struct fit_params *params, struct err *err)
{
    int bracketed = 0, n = 0;
    for (int i = 0; i < list->count; i++) bracketed += list->photos[i].bracket_count > 1;
    const int count = bracketed < params->views ? bracketed : params->views;
    struct sample_job *jobs = calloc((size_t)count + 1, sizeof *jobs);
    if (!jobs) err_nomem(err, "views", (size_t)count * sizeof *jobs);
    for (int i = 0, seen = 0; !err->status && i < list->count; i++) {
        if (list->photos[i].bracket_count < 2) continue;
        if (n < count && seen++ * count >= n * bracketed)
            jobs[n++] = (struct sample_job){&list->photos[i], photos, params->max_patches, {0}, ERR_INIT};
    }
    if (!err->status) parallel_for((size_t)n, 1, sample_views, jobs);
    for (int i = 0; i < n; i++) {
        if (!err->status && jobs[i].err.status) err_set(err, jobs[i].err.status, "%s", jobs[i].err.text);
        if (!err->status) append(all, &jobs[i].patches, err);
        recover_release_patches(&jobs[i].patches);
    }
    free(jobs);
    return err->status;
}

static enum status write_response(const struct response *r, const char *path, const struct provenance *prov,
                                  struct err *err)
{
    struct memory_text m = {0};
    if (memory_text_open(&m, "a response", err)) return err->status;
    provenance_print(prov, m.to);
    fprintf(m.to, "%s\ncurve %s\n", products[PRODUCT_RESPONSE].head, r->table ? "table 256" : "srgb");
    for (int i = 0; r->table && i < RESPONSE_LEVELS; i++)
        fprintf(m.to, "%.9g %.9g %.9g\n", (double)r->light[0][i], (double)r->light[1][i], (double)r->light[2][i]);
    if (!memory_text_close(&m, "a response", err)) outfile_write_if_changed(path, m.text, m.size, err);
    memory_text_release(&m);
    return err->status;
}

static enum status fit_response(const char *photos, const char *records, const char *out,
                                const struct fit_params *params, const struct provenance *prov, struct err *err)
{
    struct photo_list list = {0};
    struct patches patches = {0};
    struct response response;
    char summary[RESPONSE_SUMMARY];
    if (!photo_list_read(&list, records, err) && !gather(&patches, &list, photos, params, err) &&
        !recover_decide(&response, summary, &patches, params, err) && !write_response(&response, out, prov, err))
        log_note("response curve: %s", summary);
    recover_release_patches(&patches);
    photo_list_release(&list);
    return err->status;
}

int main(int argc, char **argv)
{
    const char *photos = NULL, *records = NULL, *out = NULL;
    struct fit_params params = FIT_PARAMS_DEFAULT;
    const struct cli_opt opts[] = {
        CLI_ABOUT("Finds the response curve of bracketed photos, one for the whole scene."),
        CLI_STR("photos", &photos, CLI_REQUIRED, "folder of photographs"),
        CLI_STR("records", &records, CLI_REQUIRED, "folder of the photos' records"),
        CLI_STR("out", &out, CLI_REQUIRED, "response.txt to write; left alone if its text does not change"),
        CLI_PARAMS(fit_param_table, &params, NULL),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "fit_response", opts, &prov, &err) != CLI_RUN ||
        fit_response(photos, records, out, &params, &prov, &err))
        err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
