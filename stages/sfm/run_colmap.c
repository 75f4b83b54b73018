/* run_colmap.c - see run_colmap.h. */
#include "stages/sfm/run_colmap.h"

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <signal.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/clock.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/base/process.h"
#include "common/base/textfile.h"
#include "common/capture/photo_mask.h"
#include "common/capture/photo_match.h"

#define PARAM_STRUCT struct sfm_params
const struct param sfm_param_table[] = {SFM_PARAMS(PARAM_ROW) PARAM_END};
#undef PARAM_STRUCT

enum { STEPS = 4, MANY_PHOTOS = 200, FEW_FEATURES = 200, MOST_ARGS = 40 };

static bool is_equisolid(const struct sfm_params *p) { return !strcmp(p->camera_model, "EQUISOLID"); }

/* How many numbers with commas in between; -1: it is no such list. */
static int read_numbers(double numbers[CAMERA_MAX_PARAMS], const char *at)
{
    for (int count = 0;; at++) {
        char *end;
        const double value = strtod(at, &end);
        if (end == at || (*end && *end != ',')) return -1;
        if (count < CAMERA_MAX_PARAMS) numbers[count] = value;
        count++;
        at = end;
        if (!*at) return count;
    }
}

enum status sfm_params_check(const void *values, struct err *err)
{
    const struct sfm_params *p = values;
    struct camera c = {.width = 1, .height = 1};
    if (!*p->camera_params) {
        if (!strcmp(p->refine_camera, "no"))
            return err_set(err, ST_USAGE, "[sfm] refine_camera = no needs the lens: give camera_params too.");
        return ST_OK;
    }
    const int count = read_numbers(c.params, p->camera_params);
    if (is_equisolid(p)) {
        if (count != 1 && count != 3)
            return err_set(
                err, ST_USAGE,
                "[sfm] camera_params is \"%s\", wanted F or F,CX,CY of EQUISOLID: the focal length in pixels, "
                "and the principal point if it is not the middle.",
                p->camera_params);
        c.model = CAMERA_SIMPLE_PINHOLE; /* the same numbers */
    } else {
        camera_model_from_name(p->camera_model, &c.model);
        const int wanted = camera_model_params(c.model);
        if (count != wanted)
            return err_set(err, ST_USAGE,
                           "[sfm] camera_params is \"%s\", wanted the %d numbers of %s with commas in between.",
                           p->camera_params, wanted, p->camera_model);
    }
    struct err why = ERR_INIT;
    if (camera_check(&c, &why)) return err_set(err, ST_USAGE, "[sfm] camera_params: %s", why.text);
    return ST_OK;
}

enum status sfm_single_camera(bool *single, const struct photo_list *photos, const struct sfm_params *params,
                              struct err *err)
{
    const struct photo_info *first = photos->count ? &photos->photos[0].info : NULL;
    int other = 0;
    bool same_size = true, same_lens = true;
    for (int i = 1; i < photos->count; i++) {
        const struct photo_info *info = &photos->photos[i].info;
        if (info->width != first->width || info->height != first->height) {
            if (same_size) other = i;
            same_size = false;
        }
        /* what a photo does not say is 0 or "": it must not say it either where others do */
        same_lens = same_lens && info->focal_mm == first->focal_mm && !strcmp(info->make, first->make) &&
                    !strcmp(info->model, first->model);
    }
    *single =
        !strcmp(params->single_camera, "yes") || (!strcmp(params->single_camera, "auto") && same_size && same_lens);
    if (*single && !same_size) {
        const struct photo_record *a = &photos->photos[0], *b = &photos->photos[other];
        return err_set(
            err, ST_USAGE,
            "[sfm] single_camera is yes, but photo \"%s\" is %d x %d px and \"%s\" %d x %d px; set it to auto or no.",
            a->file, a->info.width, a->info.height, b->file, b->info.width, b->info.height);
    }
    return ST_OK;
}

void sfm_png_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos, const struct sfm_params *params)
{
    const struct photo_info *first = photos->count ? &photos->photos[0].info : NULL;
    enum camera_model model = CAMERA_SIMPLE_RADIAL;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        const char *end = strrchr(p->file, '.');
        if (!end || strcasecmp(end, ".png") || !(p->info.focal35_mm > 0) || p->info.focal35_mm != first->focal35_mm ||
            p->info.width != first->width || p->info.height != first->height)
            return;
    }
    if (!first || !camera_model_from_name(params->camera_model, &model)) return;
    const int count = camera_model_params(model);
    const bool one = model == CAMERA_SIMPLE_PINHOLE || model == CAMERA_SIMPLE_RADIAL || model == CAMERA_RADIAL;
    /* COLMAP's own rule for JPEGs: the long side is 35 mm */
    const double focal = first->focal35_mm / 35 * fmax(first->width, first->height);
    int length = snprintf(text, SFM_LENS_TEXT, "%.9g", focal);
    if (!one) length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",%.9g", focal);
    length +=
        snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",%.9g,%.9g", first->width / 2.0, first->height / 2.0);
    for (int i = one ? 3 : 4; i < count; i++) length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",0");
}

enum status sfm_equisolid_lens(char text[SFM_LENS_TEXT], const struct photo_list *photos,
                               const struct sfm_params *params, struct err *err)
{
    static const double series[] = {-1 / 24.0, 1 / 1920.0, -1 / 322560.0, 1 / 92897280.0};
    const double film_diagonal = hypot(36, 24); /* mm; what EXIF's length for 35 mm film refers to */
    double numbers[CAMERA_MAX_PARAMS] = {0};
    const int given = *params->camera_params ? read_numbers(numbers, params->camera_params) : 0;
    const struct photo_record *first = photos->count ? &photos->photos[0] : NULL;
    *text = '\0';
    for (int i = 0; i < photos->count; i++) {
        const struct photo_record *p = &photos->photos[i];
        const bool same_size = p->info.width == first->info.width && p->info.height == first->info.height;
        if (!given && !(p->info.focal35_mm > 0))
            return err_set(err, ST_USAGE,
                           "[sfm] camera_model = EQUISOLID starts from the focal length, and EXIF of photo \"%s\" does "
                           "not state it for 35 mm film. Set camera_params = F in pixels: the lens' focal length over "
                           "the width of the sensor, both in mm, times %d, the photo's width.",
                           p->file, p->info.width);
        if (!same_size || (!given && p->info.focal35_mm != first->info.focal35_mm))
            return err_set(err, ST_USAGE,
                           "[sfm] camera_model = EQUISOLID starts from one lens for all photos, but \"%s\" and \"%s\" "
                           "differ in %s. Leave the odd ones out (EXCLUDE), or set camera_model = OPENCV_FISHEYE.",
                           first->file, p->file, same_size ? "focal length" : "size");
    }
    if (!first) return ST_OK;
    const double w = first->info.width, h = first->info.height;
    const double focal = given ? numbers[0] : first->info.focal35_mm / film_diagonal * hypot(w, h);
    int length = snprintf(text, SFM_LENS_TEXT, "%.9g,%.9g,%.9g,%.9g", focal, focal, given == 3 ? numbers[1] : w / 2,
                          given == 3 ? numbers[2] : h / 2);
    for (int i = 0; i < 4; i++) length += snprintf(text + length, SFM_LENS_TEXT - (size_t)length, ",%.12g", series[i]);
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------- COLMAP's log */

static const char *value_of(const char *line, const char *key)
{
    line += strspn(line, " \t");
    if (strncmp(line, key, strlen(key))) return NULL;
    line += strlen(key);
    return line + strspn(line, " \t");
}

enum status feature_counts_read(struct feature_counts *c, const char *log, struct err *err)
{
    struct textfile t = {0};
    int room = 0;
    *c = (struct feature_counts){0};
    enum status st = textfile_open(&t, log, err);
    while (!st && textfile_next_raw(&t)) {
        const char *name = value_of(t.cursor, "Name:"), *features = value_of(t.cursor, "Features:");
        if (features && c->count) c->list[c->count - 1].features = (int)strtol(features, NULL, 10);
        if (!name) continue;
        if (c->count == room) {
            int more = room ? 2 * room : 64;
            void *p = realloc(c->list, (size_t)more * sizeof *c->list);
            if (!p) {
                st = err_nomem(err, "feature counts", (size_t)more * sizeof *c->list);
                break;
            }
            c->list = p;
            room = more;
        }
        c->list[c->count] = (struct feature_count){strdup(name), -1};
        if (!c->list[c->count++].name) st = err_nomem(err, "a name", strlen(name) + 1);
    }
    textfile_release(&t);
    if (st) feature_counts_release(c);
    return st;
}

void feature_counts_release(struct feature_counts *c)
{
    if (!c) return;
    for (int i = 0; i < c->count; i++) free(c->list[i].name);
    free(c->list);
    *c = (struct feature_counts){0};
}

/* "Loading images... 11 in 0.000s (connected 9)": how many pictures match any other; -1 if the log does not say. */
static int connected_images(const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    int found = -1;
    if (textfile_open(&t, log, &ignored)) return -1;
    while (textfile_next_raw(&t)) {
        const char *at = strstr(t.cursor, "Loading images"), *connected = at ? strstr(at, "(connected ") : NULL;
        if (connected) found = (int)strtol(connected + strlen("(connected "), NULL, 10);
    }
    textfile_release(&t);
    return found;
}

/* The last line that says something, for the sentence about a step that failed. */
static void last_words(char *words, size_t size, const char *log)
{
    struct textfile t = {0};
    struct err ignored = ERR_INIT;
    *words = '\0';
    if (textfile_open(&t, log, &ignored)) return;
    while (textfile_next_raw(&t)) {
        const char *p = t.cursor + strspn(t.cursor, " \t");
        if (isalpha((unsigned char)*p)) snprintf(words, size, "%s", p);
    }
    textfile_release(&t);
}

/* ---------------------------------------------------------------------------------------------------- one run */

struct run {
    const struct sfm_folder *folder;
    double started;
    const struct photo_list *photos;
    const struct sfm_params *params;
    char *images, *masks, *database, *sparse; /* in the work folder; masks NULL without any */
    char *logs[STEPS];
    char threads[16], most_features[16], most_size[16], lens[SFM_LENS_TEXT];
    bool single;
};

static void run_release(struct run *r)
{
    free(r->images);
    free(r->masks);
    free(r->database);
    free(r->sparse);
    for (int i = 0; i < STEPS; i++) free(r->logs[i]);
}

/* The extension of a file name if it is plain, so that the link's name is safe; COLMAP looks at the content. */
static const char *safe_extension(const char *file)
{
    const char *dot = strrchr(file, '.');
    if (!dot || !dot[1] || strlen(dot) > 6) return ".img";
    for (const char *p = dot + 1; *p; p++)
        if (!isalnum((unsigned char)*p) || (unsigned char)*p > 127) return ".img";
    return dot;
}

static enum status link_file(const char *target, const char *link, struct err *err)
{
    return symlink(target, link) ? err_errno(err, "make the link", link) : ST_OK;
}

/* The photo's mask as COLMAP wants it, black where nothing is to be found, behind `images`. */
static enum status write_mask(struct run *r, const struct sfm_input *in, const struct photo_record *p, int *count,
                              struct err *err)
{
    struct photo_mask mask = {0};
    enum status st = photo_mask_read(&mask, in->masks, in->records, p, NULL, err);
    if (!st && mask.masked) {
        const size_t pixels = (size_t)mask.width * (size_t)mask.height;
        for (size_t i = 0; i < pixels; i++) mask.masked[i] = mask.masked[i] ? 0 : 255;
        if (!r->masks) {
            r->masks = text_format(err, "%s.masks", r->images);
            st = r->masks ? make_folders(r->masks, err) : err->status;
        }
        char *path = st ? NULL : text_format(err, "%s/%s%s.png", r->masks, p->id, safe_extension(p->file));
        if (!st) st = path ? png_write(path, mask.masked, mask.width, mask.height, 1, err) : err->status;
        free(path);
        ++*count;
    }
    photo_mask_release(&mask);
    return st;
}

static enum status link_photos(struct run *r, const struct sfm_input *in, struct err *err)
{
    char *from = realpath(in->photos, NULL);
    enum status st = from ? ST_OK : err_errno(err, "open", in->photos);
    int mask_count = 0;
    if (!st) st = make_folders(r->images, err);
    for (int i = 0; !st && i < r->photos->count; i++) {
        const struct photo_record *p = &r->photos->photos[i];
        char *target = text_format(err, "%s/%s", from, p->file);
        char *link = text_format(err, "%s/%s%s", r->images, p->id, safe_extension(p->file));
        st = target && link ? link_file(target, link, err) : err->status;
        if (!st) st = write_mask(r, in, p, &mask_count, err);
        free(target);
        free(link);
    }
    if (!st && mask_count) log_note("%d photos have a mask", mask_count);
    free(from);
    return st;
}

static enum status run_prepare(struct run *r, const struct sfm_folder *f, const struct sfm_input *in,
                               const struct sfm_params *params, struct err *err)
{
    *r = (struct run){.folder = f, .started = clock_seconds(), .photos = in->list, .params = params};
    const char *work = r->folder->work;
    enum status st = sfm_single_camera(&r->single, r->photos, r->params, err);
    if (st) return st;
    if (is_equisolid(params))
        st = sfm_equisolid_lens(r->lens, r->photos, params, err);
    else if (*params->camera_params)
        snprintf(r->lens, sizeof r->lens, "%s", params->camera_params);
    else
        sfm_png_lens(r->lens, r->photos, params);
    if (st) return st;
    snprintf(r->threads, sizeof r->threads, "%d", parallel_threads());
    snprintf(r->most_features, sizeof r->most_features, "%d", r->params->max_features);
    snprintf(r->most_size, sizeof r->most_size, "%d", r->params->max_image_size);
    r->images = text_format(err, "%s/images", work);
    r->database = text_format(err, "%s/database.db", work);
    r->sparse = text_format(err, "%s/sparse", work);
    if (!r->images || !r->database || !r->sparse) return err->status;
    for (int i = 0; i < STEPS; i++)
        if (!(r->logs[i] = text_format(err, "%s/colmap-%d.log", work, i + 1))) return err->status;
    st = make_folders(r->sparse, err);
    if (!st) st = link_photos(r, in, err);
    return st;
}

static enum status colmap_exit(int *status, const struct run *r, int step, const char *const args[], struct err *err)
{
    static const char *const env[] = {"QT_QPA_PLATFORM=offscreen", NULL};
    const char *argv[MOST_ARGS + 2] = {"colmap"};
    for (int n = 1; args[n - 1]; n++) argv[n] = args[n - 1];
    return process_run(argv, env, r->logs[step - 1], status, err);
}

static enum status colmap_failed(const struct run *r, int step, const char *command, int status, struct err *err)
{
    char words[512];
    last_words(words, sizeof words, r->logs[step - 1]);
    return err_set(err, ST_IO, "colmap %s failed with exit status %d%s; its last words are \"%s\", its log is %s.",
                   command, status, status == 137 ? " (killed: out of memory?)" : "", words, r->logs[step - 1]);
}

/* One command of COLMAP. An exit status above `most` is an error. */
static enum status colmap(const struct run *r, int step, const char *const args[], int most, struct err *err)
{
    int status = 0;
    enum status st = colmap_exit(&status, r, step, args, err);
    return st || status <= most ? st : colmap_failed(r, step, args[0], status, err);
}

static enum status extract(const struct run *r, struct err *err)
{
    const struct sfm_params *p = r->params;
    const char *args[MOST_ARGS] = {"feature_extractor",
                                   "--database_path",
                                   r->database,
                                   "--image_path",
                                   r->images,
                                   "--ImageReader.camera_model",
                                   is_equisolid(p) ? "OPENCV_FISHEYE" : p->camera_model,
                                   r->single ? "--ImageReader.single_camera" : "--ImageReader.single_camera_per_image",
                                   "1",
                                   "--SiftExtraction.use_gpu",
                                   "0",
                                   "--SiftExtraction.num_threads",
                                   r->threads,
                                   "--SiftExtraction.max_num_features",
                                   r->most_features,
                                   "--SiftExtraction.max_image_size",
                                   r->most_size};
    int n = 0;
    while (args[n]) n++;
    if (*r->lens) {
        args[n++] = "--ImageReader.camera_params";
        args[n++] = r->lens;
    }
    if (r->masks) {
        args[n++] = "--ImageReader.mask_path";
        args[n++] = r->masks;
    }
    return colmap(r, 1, args, 0, err);
}

static enum status match(const struct run *r, struct err *err)
{
    const char *which = r->params->matcher;
    bool all = !strcmp(which, "exhaustive") || (!strcmp(which, "auto") && r->photos->count <= MANY_PHOTOS);
    const char *args[] = {all ? "exhaustive_matcher" : "sequential_matcher",
                          "--database_path",
                          r->database,
                          "--SiftMatching.use_gpu",
                          "0",
                          "--SiftMatching.num_threads",
                          r->threads,
                          NULL};
    return colmap(r, 2, args, 0, err);
}

static bool is_folder(const char *path)
{
    struct stat info;
    return !stat(path, &info) && S_ISDIR(info.st_mode);
}

/* relaxed: starts from a pair that is closer together and shares less than COLMAP wants by default. */
static enum status map(const struct run *r, bool relaxed, struct err *err)
{
    const char *refine = strcmp(r->params->refine_camera, "no") ? "1" : "0";
    const char *args[MOST_ARGS] = {"mapper",    "--database_path",
                                   r->database, "--image_path",
                                   r->images,   "--output_path",
                                   r->sparse,   "--Mapper.num_threads",
                                   r->threads,  "--Mapper.ba_refine_focal_length",
                                   refine,      "--Mapper.ba_refine_extra_params",
                                   refine};
    int n = 0;
    while (args[n]) n++;
    if (relaxed) {
        static const char *const easier[] = {"--Mapper.init_min_tri_angle",       "4",
                                             "--Mapper.init_min_num_inliers",     "50",
                                             "--Mapper.abs_pose_min_num_inliers", "20"};
        for (size_t i = 0; i < sizeof easier / sizeof *easier; i++) args[n++] = easier[i];
    }
    /* it exits with 1 when it finds no model: the models are counted instead, and the reason is told by photo */
    return colmap(r, 3, args, 1, err);
}

/* A list of photos by name in one sentence, not longer than its room. */
static void list_photos(char *text, size_t size, const struct run *r, const struct feature_counts *c, int most)
{
    size_t used = 0;
    int named = 0, left = 0;
    *text = '\0';
    for (int i = 0; i < r->photos->count; i++) {
        const struct photo_record *p = &r->photos->photos[i];
        size_t stem = strlen(p->id);
        int features = -1;
        for (int k = 0; k < c->count; k++)
            if (!strncmp(c->list[k].name, p->id, stem) && c->list[k].name[stem] == '.') features = c->list[k].features;
        if (features >= most) continue;
        if (used + strlen(p->file) + 40 > size) {
            left++;
            continue;
        }
        used += (size_t)snprintf(text + used, size - used, features < 0 ? "%s%s (unreadable)" : "%s%s (%d)",
                                 named++ ? ", " : "", p->file, features);
    }
    if (left) snprintf(text + used, size - used, " and %d more", left);
}

static enum status note_features(long long *found, const struct run *r, struct err *err)
{
    struct feature_counts c = {0};
    char few[1024];
    long long total = 0;
    enum status st = feature_counts_read(&c, r->logs[0], err);
    if (st) return st;
    for (int i = 0; i < c.count; i++) total += c.list[i].features > 0 ? c.list[i].features : 0;
    log_note("%lld features in %d photos", total, r->photos->count);
    list_photos(few, sizeof few, r, &c, FEW_FEATURES);
    if (*few) log_warn("few features (too blurred, dark or plain to be placed well, or masked): %s", few);
    *found = total;
    feature_counts_release(&c);
    return st;
}

static enum status tell_why_nothing(const struct run *r, struct err *err)
{
    struct feature_counts c = {0};
    char few[700];
    int connected = connected_images(r->logs[2]);
    enum status st = feature_counts_read(&c, r->logs[0], err);
    if (st) return st;
    list_photos(few, sizeof few, r, &c, FEW_FEATURES);
    if (connected == 0)
        st = err_set(err, ST_DATA,
                     "COLMAP placed none of the %d photos: no two of them match. They must show the same things from "
                     "places a step "
                     "apart%s%s.",
                     r->photos->count, *few ? "; few features: " : "", few);
    else
        st = err_set(err, ST_DATA,
                     "COLMAP placed none of the %d photos, though %d match another one: they may be taken from one "
                     "spot (turning is "
                     "not enough, take steps aside) or share too little%s%s. Its log is %s.",
                     r->photos->count, connected, *few ? "; few features: " : "", few, r->logs[2]);
    feature_counts_release(&c);
    return st;
}

/* Names the model's images by the photos' files; a name that a text model cannot hold stays ID.EXT. */
static enum status name_images(struct sfm_model *m, const struct photo_list *photos, struct err *err)
{
    for (int i = 0; i < m->image_count; i++) {
        char *name = m->images[i].name, *dot = strrchr(name, '.');
        if (dot) *dot = '\0';
        int at = photo_list_find_id(photos, name);
        if (dot) *dot = '.';
        if (at < 0) return err_set(err, ST_INTERNAL, "COLMAP's model has an image \"%s\" that it was not given.", name);
        const char *file = photos->photos[at].file;
        size_t n = strlen(file);
        if (strpbrk(file, "\r\n") || strchr(" \t", file[0]) || strchr(" \t", file[n - 1])) continue;
        if (!(name = strdup(file))) return err_nomem(err, "a name", n + 1);
        free(m->images[i].name);
        m->images[i].name = name;
    }
    return ST_OK;
}

/* Model number k as text, checked, into the folder. */
static enum status add_model(const struct run *r, struct sfm_folder *f, int k, const struct provenance *prov,
                             struct err *err)
{
    struct sfm_model m = {0};
    char *from = text_format(err, "%s/%d", r->sparse, k), *text = text_format(err, "%s/text/%d", f->work, k);
    const char *args[] = {"model_converter", "--input_path", from, "--output_path", text, "--output_type", "TXT", NULL};
    enum status st = from && text ? make_folders(text, err) : err->status;
    if (!st) st = colmap(r, 4, args, 0, err);
    if (!st) st = sfm_model_read_text(&m, text, err);
    if (!st) log_note("model %d: %d of %d photos, %d points", k, m.image_count, r->photos->count, m.point_count);
    if (!st) st = name_images(&m, r->photos, err);
    if (!st) st = sfm_folder_add(f, &m, prov, err);
    sfm_model_release(&m);
    free(from);
    free(text);
    return st;
}

static int count_models(const struct run *r, struct err *err)
{
    for (int k = 0;; k++) {
        char *path = text_format(err, "%s/%d", r->sparse, k);
        bool there = path && is_folder(path);
        free(path);
        if (!there) return k;
    }
}

/* *features: how many there are in all photos; matches are looked for if there are any. */
static enum status features_and_matches(long long *features, const struct run *r, struct err *err)
{
    log_note("step 1 of %d: features of %d photos, %s", STEPS, r->photos->count,
             r->single ? "one lens for all" : "a lens each");
    enum status st = extract(r, err);
    if (!st) st = note_features(features, r, err);
    if (st || !*features) return st;
    log_note("step 2 of %d: matches (%.1f s so far)", STEPS, clock_seconds() - r->started);
    return match(r, err);
}

static enum status keep_logs(const struct run *r, struct err *err)
{
    enum status st = ST_OK;
    for (int i = 0; !st && i < STEPS; i++) {
        char *kept = text_format(err, "%s/colmap-%d.log", r->folder->made, i + 1);
        if (!kept) st = err->status;
        if (!st && rename(r->logs[i], kept) && errno != ENOENT) st = err_errno(err, "keep", r->logs[i]);
        free(kept);
    }
    return st;
}

enum status run_colmap(struct sfm_folder *f, const struct sfm_input *in, const struct provenance *prov, struct err *err)
{
    struct run r = {0};
    long long features = 0;
    int models = 0;
    if (in->list->count < 2)
        return err_set(err, ST_DATA,
                       "there %s; structure from motion needs at least 2, better 8 or more, taken from places a step "
                       "apart.",
                       in->list->count ? "is only 1 photo" : "are no photos");
    enum status st = run_prepare(&r, f, in, in->params, err);
    if (!st) st = features_and_matches(&features, &r, err);
    if (!st && !features)
        st = err_set(err, ST_DATA,
                     "COLMAP found no feature in any of the %d photos; they are blank, masked, or cannot be read; its "
                     "log is %s.",
                     in->list->count, r.logs[0]);
    if (!st) log_note("step 3 of %d: poses and points (%.1f s so far)", STEPS, clock_seconds() - r.started);
    if (!st) st = map(&r, false, err);
    if (!st && !(models = count_models(&r, err))) {
        log_note("no pair of photos is a good start; trying again with pairs that are closer together");
        st = map(&r, true, err);
        if (!st) models = count_models(&r, err);
    }
    if (!st && !models) st = tell_why_nothing(&r, err);
    if (!st) log_note("step 4 of %d: text of %d models (%.1f s so far)", STEPS, models, clock_seconds() - r.started);
    for (int k = 0; !st && k < models; k++) st = add_model(&r, f, k, prov, err);
    if (!st) st = keep_logs(&r, err);
    run_release(&r);
    return st;
}

/* ------------------------------------------------------------------------------------------------- known cameras */

/* The lens that COLMAP should check matches with: the model's, where there is but one. */
static void params_of_model(struct sfm_params *params, const struct sfm_model *m)
{
    if (m->camera_count != 1) {
        if (!is_equisolid(params)) return;
        strcpy(params->camera_model, "OPENCV_FISHEYE"); /* the lenses are known: no start is needed */
        *params->camera_params = '\0';
        return;
    }
    const struct camera *c = &m->cameras[0].camera;
    char text[PARAM_TEXT_SIZE] = "";
    size_t used = 0;
    for (int i = 0; i < camera_model_params(c->model) && used < sizeof text; i++)
        used += (size_t)snprintf(text + used, sizeof text - used, "%s%.12g", i ? "," : "", c->params[i]);
    if (used >= sizeof text) return;
    snprintf(params->camera_model, sizeof params->camera_model, "%s", camera_model_name(c->model));
    memcpy(params->camera_params, text, sizeof text);
}

/* COLMAP's id of a picture: its place among those that feature extraction's log says were read; 0 if it was not. */
static int id_in_database(const struct feature_counts *c, const char *name)
{
    int id = 0;
    for (int i = 0; i < c->count; i++) {
        id += c->list[i].features >= 0;
        if (!strcmp(c->list[i].name, name)) return c->list[i].features >= 0 ? id : 0;
    }
    return 0;
}

/* The model's cameras and poses into a folder, its images with the names and ids that they have in the database. */
static enum status write_known(const struct run *r, const struct sfm_model *m, const char *folder, struct err *err)
{
    struct sfm_model known = {.cameras = m->cameras, .camera_count = m->camera_count};
    struct feature_counts c = {0};
    enum status st = feature_counts_read(&c, r->logs[0], err);
    known.images = calloc((size_t)m->image_count + 1, sizeof *known.images);
    if (!st && !known.images) st = err_nomem(err, "images", (size_t)m->image_count * sizeof *known.images);
    for (int i = 0; !st && i < m->image_count; i++) {
        int at = photo_list_match(r->photos, m->images[i].name);
        if (at < 0) continue;
        const struct photo_record *p = &r->photos->photos[at];
        char *name = text_format(err, "%s%s", p->id, safe_extension(p->file));
        int id = name ? id_in_database(&c, name) : 0;
        if (!id) {
            free(name);
            if (!name) st = err->status;
            continue;
        }
        known.images[known.image_count++] =
            (struct sfm_image){id, m->images[i].cam_from_world, m->images[i].camera_idx, name, NULL, 0};
    }
    if (!st && known.image_count < 2)
        st = err_set(err, ST_DATA,
                     "the model has no points, and only %d of its %d images are among the photos and can be read, so "
                     "that none can "
                     "be triangulated; give the model of these photos.",
                     known.image_count, m->image_count);
    if (!st) st = sfm_model_write_text(&known, folder, NULL, err);
    for (int i = 0; i < known.image_count; i++) free(known.images[i].name);
    free(known.images);
    feature_counts_release(&c);
    return st;
}

static bool sizes_match(const struct sfm_model *m, const struct photo_list *photos)
{
    for (int i = 0; i < m->image_count; i++) {
        int at = photo_list_match(photos, m->images[i].name);
        const struct camera *c = &m->cameras[m->images[i].camera_idx].camera;
        if (at >= 0 && (c->width != photos->photos[at].info.width || c->height != photos->photos[at].info.height))
            return false;
    }
    return true;
}

/* Runs COLMAP's triangulator on the cameras in `known`. It aborts in its bundle adjustment if it has found no point, or none
 * that it keeps: nothing it made, and no failure. By itself it looks at points of at least three photos; those of two, of
 * which more are false, are looked at only if there are no others. *points: whether it made a model. */
static enum status find_points(bool *points, const struct run *r, const char *known, const char *made, struct err *err)
{
    enum status st = ST_OK;
    *points = false;
    for (int two = 0; !st && !*points && two < 2; two++) {
        const char *args[] = {"point_triangulator",
                              "--database_path",
                              r->database,
                              "--image_path",
                              r->images,
                              "--input_path",
                              known,
                              "--output_path",
                              made,
                              "--Mapper.num_threads",
                              r->threads,
                              "--Mapper.tri_ignore_two_view_tracks",
                              two ? "0" : "1",
                              NULL};
        const int aborted = 128 + SIGABRT;
        char words[512];
        int status = 0;
        st = colmap_exit(&status, r, 3, args, err);
        last_words(words, sizeof words, r->logs[2]);
        *points = !st && !status;
        if (!st && status && !(status == aborted && strstr(words, "bundle_adjuster.Solve")))
            st = colmap_failed(r, 3, args[0], status, err);
    }
    return st;
}

enum status triangulate(struct sfm_model *m, const struct sfm_folder *f, const struct sfm_input *in, struct err *err)
{
    struct run r = {0};
    struct sfm_model found = {0};
    struct sfm_params params = *in->params;
    long long features = 0;
    bool points = false;
    if (!sizes_match(m, in->list)) {
        log_warn("the model has no points, and none can be found: it is of pictures of another size than the photos");
        return ST_OK;
    }
    params_of_model(&params, m);
    char *known = text_format(err, "%s/known", f->work), *made = text_format(err, "%s/triangulated", f->work);
    char *text = text_format(err, "%s/triangulated-text", f->work);
    enum status st = known && made && text ? run_prepare(&r, f, in, &params, err) : err->status;
    const char *converter[] = {"model_converter", "--input_path", made, "--output_path", text,
                               "--output_type",   "TXT",          NULL};
    if (!st) st = make_folders(made, err);
    if (!st) st = make_folders(text, err);
    if (!st) st = features_and_matches(&features, &r, err);
    if (!st) st = write_known(&r, m, known, err);
    if (!st && features) {
        log_note("step 3 of %d: points (%.1f s so far)", STEPS, clock_seconds() - r.started);
        st = find_points(&points, &r, known, made, err);
    }
    if (!st && points) st = colmap(&r, 4, converter, 0, err);
    if (!st && points) st = sfm_model_read_text(&found, text, err);
    if (!st && points) st = name_images(&found, in->list, err);
    if (!st) st = keep_logs(&r, err);
    if (!st && found.point_count) {
        log_note("%d points are triangulated from the model's cameras", found.point_count);
        sfm_model_release(m);
        *m = found;
        found = (struct sfm_model){0};
    } else if (!st) {
        log_warn(
            "the model has no points, and none can be found: %s. Its cameras are taken as they are; depth is looked "
            "for between [segment_depth] near and far, or wherever neighbours can tell it if they are not set",
            features ? "no two photos show the same features where its cameras see them"
                     : "the photos have no features");
    }
    sfm_model_release(&found);
    run_release(&r);
    free(known);
    free(made);
    free(text);
    return st;
}
