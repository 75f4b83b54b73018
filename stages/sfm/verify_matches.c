/* verify_matches.c - verifies the matches of pairs of photos in blocks, side by side.
 *
 * COLMAP's matches_importer verifies in one thread, in the order of its list, and its random numbers carry on from
 * pair to pair. So the pairs, in the order of the photos, are divided into blocks of a fixed size. Each block is
 * verified by a process of its own in a copy of the database. The table of verified pairs has them in the order of the
 * photos, whichever block ends first; only the log has them as the blocks end. */
#include "stages/sfm/verify_matches.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_bytes.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/capture/match_list.h"
#include "common/product/product.h"
#include "stages/sfm/colmap_database.h"
#include "stages/sfm/colmap_options.h"
#include "stages/sfm/still_matches.h"

enum { MIN_MATCHES = 15 };  /* COLMAP rejects pairs with fewer verified matches */
enum { BLOCK_PAIRS = 500 }; /* about 12 s of one core */

struct block {
    char *list, *database, *log; /* paths; owned */
    struct err err;
};

struct verification {
    const struct colmap_job *job;
    struct colmap_options options;
    struct block *blocks; /* owned */
    int count;
    long long pairs;
    struct outfile list; /* of the block that is being written */
    char *unverified;    /* path of the database without pairs; owned */
    pthread_mutex_t joining;
    struct still_places still;
    struct progress progress;
    atomic_bool failed;
};

static enum status finish_list(struct verification *v, struct err *err)
{
    return v->count ? outfile_commit(&v->list, err) : ST_OK;
}

static enum status start_block(struct verification *v, struct err *err)
{
    const struct colmap_job *job = v->job;
    struct block *more = realloc(v->blocks, ((size_t)v->count + 1) * sizeof *more);
    if (!more) return err_nomem(err, "blocks of pairs", ((size_t)v->count + 1) * sizeof *more);
    v->blocks = more;
    if (finish_list(v, err)) return err->status;
    struct block *b = &more[v->count];
    const int k = ++v->count;
    *b = (struct block){.list = sfm_text_format(err, "%s.matches-%d.txt", job->images, k),
                        .database = sfm_text_format(err, "%s.%d", job->database, k),
                        .log = sfm_text_format(err, "%s.%d", job->logs[1], k)};
    return err->status ? err->status : outfile_open(&v->list, b->list, err);
}

/* Writes the pairs of a photo in COLMAP's form: the names of both, a line for each match, a blank line. */
static enum status write_pairs(struct verification *v, int photo, struct err *err)
{
    const struct colmap_job *job = v->job;
    const struct photo_record *p = &job->photos->photos[photo];
    struct match_list list = {0};
    char path[FILE_PATH];
    if (!product_path_in(path, job->in->matches, PRODUCT_MATCHES, &(struct product_key){.photo = p->id}, err))
        match_list_read(&list, path, job->in->prov, err);
    for (int i = 0; !err->status && i < list.count; i++) {
        struct matched_pair *pair = &list.pairs[i];
        const int other = photo_list_find_id(job->photos, pair->other);
        if (other < 0 || job->features[other] < 0) continue;
        still_places_drop(&v->still, pair, photo, other);
        if (pair->count < MIN_MATCHES) continue;
        if (v->pairs % BLOCK_PAIRS == 0 && start_block(v, err)) break;
        fprintf(v->list.fp, "%s%s %s%s\n", p->id, colmap_extension(p->file), pair->other,
                colmap_extension(job->photos->photos[other].file));
        for (int k = 0; k < pair->count; k++)
            fprintf(v->list.fp, "%d %d\n", pair->matches[k].first, pair->matches[k].second);
        fputc('\n', v->list.fp);
        v->pairs++;
    }
    match_list_release(&list);
    return err->status;
}

/* Names what stands still in the picture, and writes a mask of it. */
static enum status report_still(const struct verification *v, const struct still_group *g, struct err *err)
{
    const struct colmap_job *job = v->job;
    const char *id = job->photos->photos[g->first].id;
    char where[256], mask[FILE_PATH], shown[FILE_PATH];
    const struct product_key key = {.photo = id};
    if (product_path_in(mask, job->folder->made, PRODUCT_SFM_STILL, &key, err) ||
        product_path_in(shown, job->folder->out, PRODUCT_SFM_STILL, &key, err) || still_places_write_mask(g, mask, err))
        return err->status;
    still_places_describe(where, sizeof where, g);
    log_warn(
        "something stands still in %d of %d photos while the scene moves (%d matches), at %s: a watermark, a date "
        "stamp, or dirt on the lens? Matches there are left out. To keep it out of depth and films, too, copy %s to "
        "masks/PHOTO.png in the scene's folder for each of these photos.",
        g->photos, g->count, g->matches, where, shown);
    return ST_OK;
}

/* Names photos that show the same picture as others. */
static void report_copies(const struct verification *v)
{
    enum { NAMED = 4 };
    const struct photo_list *photos = v->job->photos;
    char names[400] = "", ids[600] = "";
    int count = 0;
    for (int i = 0; i < photos->count; i++) {
        const int first = v->still.copy_of[i];
        const size_t n = strlen(names), k = strlen(ids);
        if (first < 0) continue;
        if (count++ < NAMED)
            snprintf(names + n, sizeof names - n, "%s%s that of %s", n ? ", " : "", photos->photos[i].file,
                     photos->photos[first].file);
        snprintf(ids + k, sizeof ids - k, " %s", photos->photos[i].id);
    }
    if (count)
        log_warn(
            "%d photos show the same picture as another one (%s%s). They add nothing, and take places of photos that "
            "show depth; leave them out: EXCLUDE =%s",
            count, names, count > NAMED ? ", ..." : "", ids);
}

static enum status find_still(struct verification *v, struct err *err)
{
    const struct sfm_input *in = v->job->in;
    still_places_find(&v->still, v->job->photos, in->features, in->matches, err);
    if (!err->status) report_copies(v);
    for (int k = 0; !err->status && k < v->still.count; k++)
        if (v->still.groups[k].places) report_still(v, &v->still.groups[k], err);
    return err->status;
}

static enum status append_log(const struct verification *v, struct block *b)
{
    struct file_bytes text = {0};
    FILE *log = fopen(v->job->logs[1], "ab");
    if (!log) return err_errno(&b->err, "write", v->job->logs[1]);
    if (!file_bytes_read(&text, b->log, &b->err)) fwrite(text.bytes, 1, text.size, log);
    file_bytes_release(&text);
    return fclose(log) ? err_errno(&b->err, "write", v->job->logs[1]) : b->err.status;
}

static void verify_block(struct verification *v, struct block *b)
{
    const char *args[] = {"matches_importer",
                          "--database_path",
                          b->database,
                          "--match_list_path",
                          b->list,
                          "--match_type",
                          "raw",
                          v->options.use_gpu,
                          "0",
                          v->options.num_threads,
                          "1",
                          NULL};
    struct colmap_progress progress;
    if (outfile_copy(b->database, v->unverified, &b->err)) return;
    colmap_progress_start(&progress, &v->progress, b->log, " - ", false);
    if (colmap_run_long(b->log, args, 0, &progress, &b->err)) return;
    pthread_mutex_lock(&v->joining);
    if (!colmap_database_take_pairs(v->job->database, b->database, &b->err)) append_log(v, b);
    pthread_mutex_unlock(&v->joining);
    remove(b->database); /* at once, since it is as large as all features */
}

static void verify_blocks(void *ctx, size_t begin, size_t end, int thread)
{
    struct verification *v = ctx;
    (void)thread;
    for (size_t i = begin; i < end && !atomic_load(&v->failed); i++) {
        verify_block(v, &v->blocks[i]);
        if (v->blocks[i].err.status) atomic_store(&v->failed, true);
    }
}

static void remove_block(struct block *b)
{
    if (!b->err.status) { /* what a failed block leaves says why */
        if (b->list) remove(b->list);
        if (b->database) remove(b->database);
        if (b->log) remove(b->log);
    }
    free(b->list);
    free(b->database);
    free(b->log);
}

enum status verify_matches(const struct colmap_job *job, struct err *err)
{
    struct verification v = {.job = job, .joining = PTHREAD_MUTEX_INITIALIZER};
    find_still(&v, err);
    for (int i = 0; !err->status && i < job->photos->count; i++)
        if (job->features[i] >= 0) write_pairs(&v, i, err);
    if (!err->status) finish_list(&v, err);
    outfile_discard(&v.list);
    v.unverified = sfm_text_format(err, "%s.unverified", job->database);
    char *help = sfm_text_format(err, "%s.help", job->database);
    if (!err->status && v.count) colmap_options_ask(&v.options, help, err);
    if (!err->status && !outfile_copy(v.unverified, job->database, err)) {
        progress_start(&v.progress, "verifying", v.pairs, "pairs");
        parallel_for((size_t)v.count, 1, verify_blocks, &v);
        progress_end(&v.progress);
    }
    for (int i = 0; !err->status && i < v.count; i++)
        if (v.blocks[i].err.status) *err = v.blocks[i].err;
    for (int i = 0; i < v.count; i++) remove_block(&v.blocks[i]);
    if (v.unverified) remove(v.unverified);
    free(help);
    still_places_release(&v.still);
    free(v.unverified);
    free(v.blocks);
    return err->status;
}
