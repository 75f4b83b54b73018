/* bracketed_view.c - reads, merges and writes a view of several exposures.
 *
 * Overview. The steps, with the file that has the algorithm of each:
 *   1. read the record, the response and all exposures, these in parallel
 *   2. align the exposures to the middle one by whole pixels (align.c); [hdr_merge] align decides whether the shifts
 *      are used or only reported
 *   3. compare stated exposures with the photos: the ratio of light that two neighbouring exposures show against the
 *      ratio of their exposures. Off by more than 15 %: the radiometry is called approximate. Off by more than
 *      max_disagreement: an error that names the pair, because all radiance would be wrong
 *   4. find the noise: measured from the differences between exposures (bracket_noise.c), or given in electrons
 *   5. merge (merge.c)
 *
 * A lighting reference image is also placed: by marks (marked_pose.c), or by its camera in a model. One in an opening
 * is turned by what photos show outdoors (outdoors_turn.c), after it is merged.
 *
 * Exposures are divided by the `white` of the record, so that radiance 1 is white in the exposure that was meant to
 * be looked at. JPEG, TIFF and EXR all arrive as struct photo.
 *
 * Two files leave here. VIEW.exr has half floats, the mask of clipped pixels, and the variance rounded to eight
 * binary digits, because noise is not known better and the rest would not compress. VIEW.jpg is for structure from
 * motion: the bytes of the middle exposure where it is a JPEG already, else an encoded copy, or on request a
 * tone-mapped picture, which shows features in both lamps and shadows (tone.c).
 *
 * Memory: all exposures at once, and the result. */
#include "stages/hdr_merge/bracketed_view.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/outfile.h"
#include "common/base/parallel.h"
#include "common/capture/photo_match.h"
#include "common/capture/sfm_model.h"
#include "common/capture/view_image.h"
#include "common/image/exr.h"
#include "common/product/product.h"
#include "stages/hdr_merge/tone.h"

#define MAX_HALF 65504.0f

enum { QUALITY = 95 }; /* of JPEGs */

/* The caller frees it. */
static enum status join(char **path, const char *folder, const char *name, const char *ending, struct err *err)
{
    if (asprintf(path, "%s/%s%s", folder, name, ending) >= 0) return ST_OK;
    *path = NULL;
    return err_nomem(err, "a file name", strlen(folder) + strlen(name));
}

struct photo_job {
    struct photo *photos;
    bool hdr; /* gain maps were applied when the photos were imported */
    char *paths[MERGE_MAX_EXPOSURES];
    struct err errs[MERGE_MAX_EXPOSURES];
};

static void read_some(void *ctx, size_t begin, size_t end, int thread)
{
    struct photo_job *job = ctx;
    (void)thread;
    for (size_t i = begin; i < end; i++)
        (job->hdr ? photo_read_hdr : photo_read_any)(&job->photos[i], job->paths[i], &job->errs[i]);
}

static enum status read_photos(struct bracketed_view *v, const char *photos, struct provenance *prov, struct err *err)
{
    const int count = v->record.bracket_count;
    struct photo_job *job = calloc(1, sizeof *job);
    if (!job) err_nomem(err, "photos", sizeof *job);
    for (int i = 0; !err->status && i < count; i++) join(&job->paths[i], photos, v->record.brackets[i].file, "", err);
    if (!err->status) {
        job->photos = v->photos;
        job->hdr = v->record.info.bits == 32;
        parallel_for((size_t)count, 1, read_some, job);
    }
    for (int i = 0; !err->status && i < count; i++) {
        const struct bracket *b = &v->record.brackets[i];
        char *input = NULL;
        if (job->errs[i].status) err_set(err, job->errs[i].status, "%s", job->errs[i].text);
        if (!err->status && !join(&input, "photos", b->file, "", err))
            provenance_add_file(prov, input, job->paths[i], err);
        v->exposures[i] = b->exposure / v->record.white;
        free(input);
    }
    for (int i = 0; job && i < count; i++) free(job->paths[i]);
    free(job);
    return err->status;
}

/* All exposures have one colour space. Its curve is the response, unless one is given; its matrix is applied to what is
 * merged. */
static enum status use_colour_space(struct bracketed_view *v, struct err *err)
{
    const struct colour_space *space = v->photos[0].space;
    for (int i = 1; i < v->record.bracket_count; i++)
        if (strcmp(v->photos[i].info.colour, v->photos[0].info.colour) != 0 ||
            (v->photos[i].info.bits == v->photos[0].info.bits && !colour_space_same(space, v->photos[i].space)))
            return err_set(err, ST_DATA,
                           "view %s: %s and %s are in different colour spaces; save all exposures of a view in one.",
                           v->record.id, v->record.brackets[0].file, v->record.brackets[i].file);
    if (space && space->light) v->response.space = space;
    return ST_OK;
}

enum status bracketed_view_read(struct bracketed_view *v, const char *id, const char *photos, const char *records,
                                const char *response, struct provenance *prov, struct err *err)
{
    photo_record_read(&v->record, records, id, prov, err);
    if (!err->status && !v->record.bracket_count)
        err_set(err, ST_DATA,
                "%s/%s.txt is the record of a single photo, wanted that of a view of several exposures; run "
                "import_photos again.",
                records, id);
    if (!err->status && v->record.bracket_count > MERGE_MAX_EXPOSURES)
        err_set(err, ST_DATA, "view %s has %d exposures, wanted at most %d; exclude some of them (EXCLUDE).", id,
                v->record.bracket_count, (int)MERGE_MAX_EXPOSURES);
    if (!err->status && response) response_read(&v->response, response, prov, err);
    if (!err->status && !read_photos(v, photos, prov, err)) use_colour_space(v, err);
    v->brackets = (struct brackets){v->photos, v->exposures, v->record.bracket_count, &v->response, NULL};
    return err->status;
}

static enum status place_by_model(struct bracketed_view *v, const char *model, const struct reference_frame *frame,
                                  const struct merge_params *params, struct provenance *prov, struct err *err)
{
    static const char *const files[] = {"cameras", "images"};
    const struct photo_list self = {&v->record, 1};
    struct sfm_model m = {0};
    char path[FILE_PATH];
    sfm_model_read_cameras(&m, model, NULL, err);
    for (int i = 0; !err->status && i < 2; i++) provenance_add_in(prov, "cameras", model, files[i], ".txt", path, err);
    for (int i = 0; !err->status && !v->placed && i < m.image_count; i++) {
        if (photo_list_match(&self, m.images[i].name) < 0) continue;
        v->placed = true;
        v->lens = m.cameras[m.images[i].camera_idx].camera;
        v->cam_from_world = m.images[i].cam_from_world;
    }
    const struct photo_info *info = &v->record.info;
    if (!err->status && v->placed && (v->lens.width != info->width || v->lens.height != info->height))
        err_set(
            err, ST_DATA,
            "view %s has %d x %d pixels, but its camera in %s/cameras.txt %d x %d; give the cameras of these photos.",
            v->record.id, info->width, info->height, model, v->lens.width, v->lens.height);
    if (!err->status && v->placed)
        reference_pose_find(&v->cam_from_world, &v->frame, &m, model, frame, params, prov, err);
    sfm_model_release(&m);
    return err->status;
}

enum status bracketed_view_place(struct bracketed_view *v, bool *known, const char *model,
                                 const struct reference_frame *frame, const struct merge_params *params,
                                 struct provenance *prov, struct err *err)
{
    if (frame->marks)
        marked_pose_find(&v->marked, &v->lens, &v->cam_from_world, &v->placed, &v->record, model, frame, params, prov,
                         err);
    else
        place_by_model(v, model, frame, params, prov, err);
    *known = v->placed;
    return err->status;
}

/* Measured noise applies to all exposures; given noise includes the quantization of each photo's bits. */
static enum status find_noise(struct bracketed_view *v, const struct merge_params *params, struct err *err)
{
    struct noise measured;
    if (!strcmp(params->noise, "measured") && noise_measure(&measured, &v->noise_measured, &v->brackets, err))
        return err->status;
    for (int k = 0; k < v->record.bracket_count; k++)
        v->noise[k] = v->noise_measured
                          ? measured
                          : noise_given(params->electrons, params->read_noise, &v->response, v->photos[k].info.bits);
    return ST_OK;
}

/* Compares the stated exposures with the photos. Wrong exposures or a wrong response give wrong radiance. */
static enum status check_agreement(struct bracketed_view *v, const struct merge_params *params, struct err *err)
{
    const double tolerance = 1.15; /* JPEG, noise and clipped colours change it by a few percent */
    const struct exposure_agreement *a = &v->agreement;
    const struct photo_record *r = &v->record;
    struct brackets aligned = v->brackets; /* compare aligned, even if shifts are only reported */
    if (strcmp(params->align, "no")) aligned.shifts = v->alignment.shifts;
    if (merge_agreement(&v->agreement, &aligned, err)) return err->status;
    const double off = fmax(a->measured / a->stated, a->stated / a->measured);
    v->agree = off <= tolerance;
    if (!a->pair || off <= params->max_disagreement) return ST_OK;
    return err_set(err, ST_DATA,
                   "%s should have %.3g times the light of %s, but shows %.3g times as much; the exposures in EXIF or "
                   "exposures.txt are wrong, or the photos are not of one view. Correct exposures.txt or brackets.txt, "
                   "exclude one of the photos (EXCLUDE), or raise [hdr_merge] max_disagreement.",
                   r->brackets[a->pair].file, a->stated, r->brackets[a->pair - 1].file, a->measured);
}

enum status bracketed_view_merge(struct bracketed_view *v, const struct merge_params *params, struct err *err)
{
    if (strcmp(params->align, "no"))
        align_brackets(&v->alignment, &v->brackets, v->record.middle, params->max_shift, err);
    if (!strcmp(params->align, "correct")) v->brackets.shifts = v->alignment.shifts;
    if (!err->status && !check_agreement(v, params, err) && !find_noise(v, params, err))
        merge_brackets(&v->merged, &v->brackets, v->noise, params, err);
    const struct image *merged = &v->merged.radiance;
    if (!err->status && v->photos[0].space)
        colour_space_to_rec709(v->photos[0].space, merged->data, (size_t)merged->width * (size_t)merged->height);
    return err->status && err->status != ST_NOMEM ? err_context(err, "view %s", v->record.id) : err->status;
}

enum status bracketed_view_turn(struct bracketed_view *v, const struct reference_frame *frame,
                                const struct merge_params *params, struct provenance *prov, struct err *err)
{
    struct marked_pose *m = &v->marked;
    const struct outdoors_image image = {v->record.id, &v->merged.radiance, &v->lens, m->opening_idx, m->stated};
    if (!m->in_window || !frame->outdoors || !strcmp(params->outdoors, "no")) return ST_OK;
    if (outdoors_turn_find(&v->turn, &m->found.poses[0].cam_from_world, &image, frame, params, prov, err))
        return err->status;
    return marked_pose_to_scene(m, &v->cam_from_world, frame, params, prov, err);
}

static bool is_jpeg(const char *path)
{
    unsigned char begin[3] = {0};
    FILE *f = fopen(path, "rb");
    bool jpeg = f && fread(begin, 1, sizeof begin, f) == sizeof begin && begin[0] == 0xff && begin[1] == 0xd8;
    if (f) fclose(f);
    return jpeg;
}

static enum status copy_file(const char *from, const char *to, struct err *err)
{
    struct outfile out = {0};
    char bytes[1 << 14];
    size_t n;
    FILE *in = fopen(from, "rb");
    if (in)
        outfile_open(&out, to, err);
    else
        err_errno(err, "open", from);
    while (!err->status && (n = fread(bytes, 1, sizeof bytes, in)) > 0)
        if (fwrite(bytes, 1, n, out.fp) != n) err_errno(err, "write", to);
    if (!err->status && ferror(in)) err_errno(err, "read", from);
    if (!err->status) outfile_commit(&out, err);
    outfile_discard(&out);
    if (in) fclose(in);
    return err->status;
}

static enum status encode_photo(const struct photo *p, const char *path, struct err *err)
{
    size_t samples = (size_t)p->info.width * (size_t)p->info.height * 3;
    struct image linear = {0};
    unsigned char *rgb = malloc(samples);
    if (!rgb) return err_nomem(err, "a photo", samples);
    if (p->space && !photo_to_linear(&linear, p, err)) image_to_srgb8(&linear, rgb);
    for (size_t i = 0; !p->space && i < samples; i++)
        rgb[i] = (unsigned char)(p->info.bits == 16 ? p->samples[i] >> 8 : p->samples[i]);
    if (!err->status) photo_write_jpeg(path, rgb, p->info.width, p->info.height, QUALITY, &p->info, err);
    image_release(&linear);
    free(rgb);
    return err->status;
}

static enum status write_toned(const struct bracketed_view *v, const char *path, struct err *err)
{
    const struct image *im = &v->merged.radiance;
    const size_t samples = (size_t)im->width * (size_t)im->height * 3;
    unsigned char *rgb = malloc(samples);
    if (rgb)
        tone_map(rgb, im, err);
    else
        err_nomem(err, "a picture", samples);
    if (!err->status) photo_write_jpeg(path, rgb, im->width, im->height, QUALITY, &v->record.info, err);
    free(rgb);
    return err->status;
}

enum status bracketed_view_write_picture(const struct bracketed_view *v, const char *photos, const char *out,
                                         const struct merge_params *params, struct err *err)
{
    const struct photo_record *r = &v->record;
    const struct photo *middle = &v->photos[r->middle];
    char *from = NULL, *to = NULL;
    if (!join(&from, photos, r->brackets[r->middle].file, "", err)) join(&to, out, r->id, ".jpg", err);
    const bool jpeg = !err->status && is_jpeg(from); /* with a gain map it also has values */
    if (!err->status && (!strcmp(params->picture, "tone") || (middle->values && !jpeg)))
        write_toned(v, to, err);
    else if (jpeg)
        copy_file(from, to, err);
    else if (!err->status)
        encode_photo(middle, to, err);
    free(from);
    free(to);
    return err->status;
}

static enum status set_attributes(struct exr_image *im, const struct bracketed_view *v, struct err *err)
{
    const struct photo_record *r = &v->record;
    char name[64], text[64];
    const char *radiometry = r->bracket_count < 2 ? "one exposure" : v->agree ? "exact" : "approximate";
    if (!exr_set_attribute(im, "remodel:radiometry", radiometry, err) &&
        !exr_set_attribute(im, "remodel:response",
                           v->response.table   ? "table"
                           : v->response.space ? "profile"
                                               : "srgb",
                           err))
        exr_set_number(im, "remodel:white", r->white, err);
    for (int i = 0; !err->status && i < r->bracket_count; i++) {
        snprintf(name, sizeof name, "remodel:exposure.%d", i + 1);
        exr_set_number(im, name, r->brackets[i].exposure, err);
        const struct shift *s = &v->alignment.shifts[i];
        if (!v->brackets.shifts || (!s->dx && !s->dy)) continue;
        snprintf(name, sizeof name, "remodel:shift.%d", i + 1);
        snprintf(text, sizeof text, "%d %d", s->dx, s->dy);
        if (!err->status) exr_set_attribute(im, name, text, err);
    }
    return err->status;
}

static void set_window(char *text, size_t size, const struct bracketed_view *v)
{
    const struct outdoors_rotation *r = &v->turn.found;
    const int used = snprintf(text, size, "window %s", v->marked.level ? "level" : "horizon");
    if (v->turn.tried && r->verdict == OUTDOORS_TURNED)
        snprintf(text + used, size - (size_t)used, " outdoors %d %d %d %.4g %.4g", r->sights, r->agree, r->photos,
                 r->turned, r->error);
}

/* How the pose was found (docs/formats.md, S/lri). */
static enum status set_frame(struct exr_image *im, const struct bracketed_view *v, struct err *err)
{
    const struct camera_errors *e = &v->frame.errors;
    const struct resection_pose *p = &v->marked.found.poses[v->marked.chosen];
    char text[256];
    if (v->marked.marks)
        snprintf(text, sizeof text, "marks %d %.4g %.4g %.4g %.4g %.4g %.4g %d", v->marked.marks, p->rms, p->max,
                 p->error.x, p->error.y, p->error.z, p->turn_error, v->marked.found.count);
    else if (v->marked.in_window)
        set_window(text, sizeof text, v);
    else if (v->frame.photos)
        snprintf(text, sizeof text, "%d %.4g %.4g %.4g %.4g", v->frame.photos, e->center_median, e->center_max,
                 e->rotation_median, e->rotation_max);
    else
        return ST_OK;
    return exr_set_attribute(im, "remodel:frame", text, err);
}

/* Writes the lens as in lenses.txt, and the pose as a view's. */
static enum status set_camera(struct exr_image *im, const struct bracketed_view *v, struct err *err)
{
    const struct camera *c = &v->lens;
    const struct pose *p = &v->cam_from_world;
    const struct view view = {.cam_from_world = mat3_from_quat(p->rotation), .translation = p->translation};
    char text[256];
    if (!v->placed) return ST_OK;
    int used = snprintf(text, sizeof text, "%s %d %d", camera_model_name(c->model), c->width, c->height);
    for (int i = 0; i < camera_model_params(c->model); i++)
        used += snprintf(text + used, sizeof text - (size_t)used, " %.9g", c->params[i]);
    view_image_set_camera(im, &view);
    return exr_set_attribute(im, "remodel:lens", text, err) || set_frame(im, v, err) ? err->status : ST_OK;
}

/* Rounds to eight binary digits: noise is not known more precisely, and the rest would not compress. */
static float rounded(float v)
{
    uint32_t bits;
    memcpy(&bits, &v, sizeof bits);
    bits = (bits + 0x4000u) & ~0x7fffu;
    memcpy(&v, &bits, sizeof bits);
    return v;
}

enum status bracketed_view_write_radiance(const struct bracketed_view *v, const char *out,
                                          const struct provenance *prov, size_t *clamped, struct err *err)
{
    static const char *const names[] = {"R", "G", "B"};
    struct exr_image im = {0};
    struct exr_plane *plane = NULL;
    char path[FILE_PATH];
    const struct image *radiance = &v->merged.radiance;
    size_t pixels = (size_t)radiance->width * (size_t)radiance->height;
    *clamped = 0;
    if (!product_path_in(path, out, PRODUCT_HDR, &(struct product_key){.photo = v->record.id}, err))
        exr_image_init(&im, radiance->width, radiance->height, err);
    for (size_t c = 0; !err->status && c < 3; c++) {
        exr_add_plane(&im, names[c], EXR_HALF, &plane, err);
        for (size_t i = 0; !err->status && i < pixels; i++)
            *clamped += (plane->f[i] = radiance->data[3 * i + c]) > MAX_HALF;
    }
    if (!err->status) exr_add_plane(&im, "clipped", EXR_UINT, &plane, err);
    for (size_t i = 0; !err->status && i < pixels; i++) plane->u[i] = v->merged.marks[i];
    if (!err->status) exr_add_plane(&im, "variance", EXR_FLOAT, &plane, err);
    for (size_t i = 0; !err->status && i < pixels; i++) plane->f[i] = rounded(v->merged.variance[i]);
    if (!err->status && !set_attributes(&im, v, err) && !set_camera(&im, v, err)) exr_write(&im, path, prov, err);
    exr_image_release(&im);
    return err->status;
}

void bracketed_view_release(struct bracketed_view *v)
{
    if (!v) return;
    for (int i = 0; i < MERGE_MAX_EXPOSURES; i++) photo_release(&v->photos[i]);
    photo_record_release(&v->record);
    merge_release(&v->merged);
    *v = (struct bracketed_view){0};
}
