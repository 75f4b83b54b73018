/* hdr_views.c - one sample of the bench `hdr`: from exposures to rectified views, with the code of the stages.
 *
 * Several photographs run at once, one thread each, as under `make -j`. The photos are the exposures that the
 * program hdr painted (FOLDER/eK.jpg), taken as pictures of an equisolid fisheye lens; sfm_import decides their
 * views. A sample prints one value per line:
 *   seconds, cpu_s          wall and CPU time of merging and rectifying
 *   merge_s                 hdr_merge: reading the JPEGs, hashes, shifts, noise, radiance
 *   rectify_s               rectify: reading the radiance, resampling all views (with noise and marks) of each photo
 *   write_s                 the EXRs of the radiance and of the views; not part of seconds
 *   mpixels                 of all exposures
 *   views, view_mpixels     of all photos
 * Times are medians of as many runs as fit in two seconds, after one that does not count. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/cli.h"
#include "common/base/clock.h"
#include "common/base/file_path.h"
#include "common/base/parallel.h"
#include "common/base/sort.h"
#include "common/capture/linear_photo.h"
#include "common/capture/view_image.h"
#include "stages/hdr_merge/bracketed_view.h"
#include "stages/rectify/resample.h"
#include "stages/sfm_import/view_cameras.h"

enum { MAX_PHOTOS = 16, MAX_RUNS = 64 };
#define RUN_SECONDS 2.0

struct request {
    const char *folder;
    int width, height, exposures, photos, max_megapixels;
};

struct work { /* one photo */
    char id[16];
    struct bracketed_view merged;
    struct image linear, views[MAX_PHOTO_VIEWS];
    struct photo_quality quality, view_quality[MAX_PHOTO_VIEWS];
    struct provenance prov;
    struct err err;
};

struct bench {
    const struct request *request;
    struct camera lens;
    struct photo_view views[MAX_PHOTO_VIEWS];
    int view_count;
    struct work work[MAX_PHOTOS];
};

enum phase { MERGE, WRITE_RADIANCE, RECTIFY, WRITE_VIEWS, PHASES };

static double middle_of(double *values, int count)
{
    sort_doubles(values, (size_t)count);
    return values[count / 2];
}

static void release_work(struct work *w)
{
    bracketed_view_release(&w->merged);
    image_release(&w->linear);
    photo_quality_release(&w->quality);
    for (int k = 0; k < MAX_PHOTO_VIEWS; k++) {
        image_release(&w->views[k]);
        photo_quality_release(&w->view_quality[k]);
    }
    provenance_release(&w->prov);
}

static enum status write_record(const struct request *r, char *id, struct err *err)
{
    char file[32], names[MERGE_MAX_EXPOSURES][32];
    struct bracket brackets[MERGE_MAX_EXPOSURES] = {0};
    struct photo_record record = {.id = id, .file = file, .white = 1, .brackets = brackets, .middle = r->exposures / 2};
    record.info = (struct photo_info){.width = r->width, .height = r->height, .bits = 8, .orientation = 1};
    record.bracket_count = r->exposures;
    snprintf(file, sizeof file, "%s.jpg", id);
    strcpy(record.hash, "0123456789abcdef0123456789abcdef"); /* unused here */
    for (int k = 0; k < r->exposures; k++) {
        snprintf(names[k], sizeof names[k], "e%d.jpg", k);
        brackets[k] = (struct bracket){.file = names[k], .exposure = pow(4, k - r->exposures / 2)};
        strcpy(brackets[k].hash, record.hash);
    }
    return photo_record_write(&record, r->folder, err);
}

static struct view camera_of(const struct photo_view *v, const char *name)
{
    struct view view = {.name = name, .width = v->camera.width, .height = v->camera.height};
    view.cam_from_world = mat3_from_quat((struct quat){1, 0, 0, 0});
    camera_focal(&v->camera, &view.fx, &view.fy, &view.cx, &view.cy);
    return view;
}

static enum status run_phase(const struct bench *b, struct work *w, enum phase phase, struct err *err)
{
    const struct merge_params params = MERGE_PARAMS_DEFAULT;
    const char *folder = b->request->folder;
    struct photo_record record = {0};
    char radiometry[RADIOMETRY_SIZE], path[FILE_PATH], name[32];
    size_t beyond;
    switch (phase) {
    case MERGE:
        bracketed_view_read(&w->merged, w->id, folder, folder, NULL, &w->prov, err);
        if (!err->status) bracketed_view_merge(&w->merged, &params, err);
        return err->status;
    case WRITE_RADIANCE:
        return bracketed_view_write_radiance(&w->merged, folder, &w->prov, &beyond, err);
    case RECTIFY:
        photo_record_read(&record, folder, w->id, NULL, err);
        if (!err->status) linear_photo_read(&w->linear, &w->quality, radiometry, folder, &record, NULL, &w->prov, err);
        photo_record_release(&record);
        for (int k = 0; !err->status && k < b->view_count; k++) {
            const struct mat3 photo_from_view = mat3_transpose(mat3_from_quat(b->views[k].view_from_photo));
            const struct view view = camera_of(&b->views[k], "view");
            const struct resample_source source = {.linear = &w->linear, .quality = &w->quality};
            resample_photo(&w->views[k], &w->view_quality[k], &source, &b->lens, &photo_from_view, &view, err);
        }
        return err->status;
    case WRITE_VIEWS:
        for (int k = 0; !err->status && k < b->view_count; k++) {
            const struct view view = camera_of(&b->views[k], "view");
            snprintf(name, sizeof name, "%s-%d", w->id, k);
            if (!file_path(path, folder, name, ".exr", err))
                view_image_write(&w->views[k], &w->view_quality[k], path, &view, &w->prov, "exact", err);
        }
        return err->status;
    default:
        return ST_INTERNAL;
    }
}

struct phase_job {
    struct bench *bench;
    enum phase phase;
};

static void run_photos(void *ctx, size_t begin, size_t end, int thread)
{
    const struct phase_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++) {
        struct work *w = &job->bench->work[i];
        run_phase(job->bench, w, job->phase, &w->err);
    }
}

static enum status run_once(struct bench *b, double seconds[PHASES], double *cpu, struct err *err)
{
    const int photos = b->request->photos;
    for (int i = 0; i < photos; i++) release_work(&b->work[i]);
    for (enum phase phase = 0; phase < PHASES; phase++) {
        struct phase_job job = {b, phase};
        const double begun = clock_seconds(), cpu_begun = clock_cpu_seconds();
        parallel_for((size_t)photos, 1, run_photos, &job);
        seconds[phase] = clock_seconds() - begun;
        if (phase == MERGE || phase == RECTIFY) *cpu += clock_cpu_seconds() - cpu_begun;
        for (int i = 0; i < photos; i++)
            if (b->work[i].err.status) return err_set(err, b->work[i].err.status, "%s", b->work[i].err.text);
    }
    return ST_OK;
}

static enum status sample(const struct request *r, struct err *err)
{
    double total[MAX_RUNS], merge[MAX_RUNS], rectify[MAX_RUNS], wrote[MAX_RUNS], cpu[MAX_RUNS];
    double view_pixels = 0;
    struct bench *b = calloc(1, sizeof *b);
    int runs = -1; /* the first run does not count */
    if (!b) err_nomem(err, "photos", sizeof *b);
    if (!err->status) {
        const double focal = r->width * 16 / 36.0;
        b->request = r;
        b->lens = (struct camera){
            CAMERA_OPENCV_FISHEYE,
            r->width,
            r->height,
            {focal, focal, r->width / 2.0, r->height / 2.0, -1 / 24.0, 1 / 1920.0, -1 / 322560.0, 1 / 92897280.0}};
        view_cameras_of_photo(b->views, &b->view_count, &b->lens, r->max_megapixels, 110, err);
    }
    for (int i = 0; !err->status && i < r->photos; i++) {
        snprintf(b->work[i].id, sizeof b->work[i].id, "p%d", i);
        b->work[i].err = (struct err)ERR_INIT;
        write_record(r, b->work[i].id, err);
    }
    for (double begun = clock_seconds();
         !err->status && runs < MAX_RUNS && (runs < 1 || clock_seconds() - begun < RUN_SECONDS); runs++) {
        double seconds[PHASES], used = 0;
        run_once(b, seconds, &used, err);
        if (runs < 0) begun = clock_seconds();
        if (err->status || runs < 0) continue;
        merge[runs] = seconds[MERGE];
        rectify[runs] = seconds[RECTIFY];
        total[runs] = merge[runs] + rectify[runs];
        cpu[runs] = used;
        wrote[runs] = seconds[WRITE_RADIANCE] + seconds[WRITE_VIEWS];
    }
    for (int k = 0; !err->status && k < b->view_count; k++)
        view_pixels += 1.0 * b->views[k].camera.width * b->views[k].camera.height;
    if (!err->status)
        printf("seconds %.6f\ncpu_s %.6f\nmerge_s %.6f\nrectify_s %.6f\nwrite_s %.6f\nmpixels %.6g\nviews "
               "%d\nview_mpixels %.6g\n",
               middle_of(total, runs), middle_of(cpu, runs), middle_of(merge, runs), middle_of(rectify, runs),
               middle_of(wrote, runs), 1e-6 * r->width * r->height * r->exposures * r->photos,
               b->view_count * r->photos, 1e-6 * view_pixels * r->photos);
    for (int i = 0; b && i < MAX_PHOTOS; i++) release_work(&b->work[i]);
    free(b);
    return err->status;
}

int main(int argc, char **argv)
{
    struct request r = {.width = 3000, .height = 2000, .exposures = 3, .photos = 1, .max_megapixels = 2};
    const struct cli_opt opts[] = {
        CLI_ABOUT("One sample of the bench hdr: from exposures to rectified views."),
        CLI_STR("folder", &r.folder, CLI_REQUIRED, "folder of the exposures; products are written there too"),
        CLI_INT("width", &r.width, CLI_OPTIONAL, "width of a photo, px (default 3000)"),
        CLI_INT("height", &r.height, CLI_OPTIONAL, "height of a photo, px (default 2000)"),
        CLI_INT("exposures", &r.exposures, CLI_OPTIONAL, "exposures per photo (default 3)"),
        CLI_INT("photos", &r.photos, CLI_OPTIONAL, "number of concurrent photos, one thread each (default 1)"),
        CLI_INT("max-megapixels", &r.max_megapixels, CLI_OPTIONAL,
                "maximum size of a view, larger ones are scaled down; 0: no limit (default 2)"),
        CLI_END,
    };
    struct provenance prov = {0};
    struct err err = ERR_INIT;
    if (cli_parse(argc, argv, "bench_hdr_views", opts, &prov, &err) == CLI_RUN) {
        if (r.width < 64 || r.height < 64 || r.width > 30000 || r.height > 30000 || r.exposures < 1 ||
            r.exposures > MERGE_MAX_EXPOSURES || r.photos < 1 || r.photos > MAX_PHOTOS || r.max_megapixels < 0)
            err_set(&err, ST_USAGE,
                    "found %d photos of %d x %d px and %d exposures, wanted 1 to %d photos of 64 to 30000 px and 1 to "
                    "%d exposures.",
                    r.photos, r.width, r.height, r.exposures, (int)MAX_PHOTOS, (int)MERGE_MAX_EXPOSURES);
        else
            sample(&r, &err);
    }
    err_report(&err);
    provenance_release(&prov);
    return err_exit_code(&err);
}
