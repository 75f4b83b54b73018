/* prepare.c - preparation of a morph: photos, cameras, geometry, matching, and the path.
 *
 * Overview. View morphing [Colburn 2014, 3.4.5] moves the pixels of two photos towards each other along a dense
 * flow. The flow must be right where the photos overlap, so it is found under as much geometry as is known:
 *   1. both photos are made linear, upright, and of the film's size, that of the first photo
 *   2. features are matched in grey pictures, with a fundamental matrix by RANSAC (opencv_features.h)
 *   3. epipolar lines come, best first, from: the cameras, if structure from motion found both and each photo is one
 *      view; the fundamental matrix; nothing. Features on one plane, or a camera that only turned, fit any epipolar
 *      geometry whose plane or rotation is right: if a homography explains nine tenths of what the fundamental
 *      matrix explains, epipolar lines are not used
 *   4. the flow is found in both directions (flow_match.h), and the pair is refused if fewer pixels than min_matched
 *      agree
 *   5. one gain for each colour, from matched pixels, says how the photos' exposures differ
 *
 * With cameras, the search along an epipolar line is limited to depths between the 2nd and 98th percentile of the
 * sparse points that lie in front, with a factor of 1.5 at either end; without points, to more than three baselines.
 *
 * The path. A film needs cameras: position, focal length and principal point are linear between the two, rotations
 * are the normalized linear mix of the quaternions, by the shorter way. The rays of a mirrored photo fit no
 * rotation, so such a pair and one without cameras get a camera that stands still. */
#include "stages/morph_views/prepare.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/file_path.h"
#include "common/base/log.h"
#include "common/base/outfile.h"
#include "common/base/sort.h"
#include "common/capture/camera_path.h"
#include "common/capture/lens_list.h"
#include "common/capture/linear_photo.h"
#include "common/image/luminance.h"
#include "common/product/product.h"
#include "stages/morph_views/morph.h"

#define DEFAULT_FOCAL  1.2 /* of the longer side, without EXIF */
#define TOLERANCE      1.0 /* px, max distance of a feature from its epipolar line */
#define PLANE_PART     0.9 /* homography inliers / epipolar inliers from which on the epipolar geometry is degenerate */
#define DEPTH_TRIM     0.02 /* fraction of the sparse points left out at either end of the depth range */
#define DEPTH_MARGIN   1.5  /* factor that extends the depth range at either end */
#define NEAR_BASELINES 3    /* min depth without sparse points, in baselines */

/* --------------------------------------------------------------------------------------------------------- photos */

struct photo_pair {
    struct photo_record records[2];
    struct film_picture films[2];
    double focal; /* of the first photo, px of the film; may be a guess */
};

static enum status read_pair(struct photo_pair *pair, struct morph *m, const struct morph_job *job,
                             const struct morph_params *params, struct provenance *prov, struct err *err)
{
    int width = 0, height = 0;
    for (int i = 0; !err->status && i < 2; i++) {
        const char *id = i ? job->second : job->first;
        struct photo_record *record = &pair->records[i];
        struct image linear = {0};
        if (!photo_record_read(record, job->records, id, prov, err))
            linear_photo_read(&linear, NULL, m->radiometry, job->photos, record, NULL, prov, err);
        const int turned = record->info.orientation;
        if (!err->status && !i) {
            int w, h;
            film_upright_size(&w, &h, linear.width, linear.height, turned);
            film_size(&width, &height, w, h, params->max_side, err);
        }
        if (!err->status && !film_picture_make(&pair->films[i], &linear, turned, width, height, err))
            m->pictures[i] = pair->films[i].rgb;
        if (err->status == ST_DATA) err_context(err, "photo %s", id);
        image_release(&linear);
    }
    if (err->status) return err->status;
    const struct photo_info *info = &pair->records[0].info;
    pair->focal = DEFAULT_FOCAL * (width > height ? width : height);
    if (info->focal35_mm > 0) pair->focal *= info->focal35_mm / 36 / DEFAULT_FOCAL;
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- cameras */

/* Depth range of the sparse points in a photo, with margin; without points, from NEAR_BASELINES to infinity. */
static enum status depth_range(struct posed_photo *p, const struct sfm_model *model, double baseline, struct err *err)
{
    double *z = malloc(((size_t)model->point_count + 1) * sizeof *z);
    size_t count = 0;
    if (!z) return err_nomem(err, "depths", (size_t)model->point_count * sizeof *z);
    for (int i = 0; i < model->point_count; i++) {
        double depth = vec3_add(mat3_apply(p->photo_from_world, model->points[i].position), p->translation).z;
        if (depth > 0) z[count++] = depth;
    }
    sort_doubles(z, count);
    p->near = count ? z[(size_t)(DEPTH_TRIM * (double)(count - 1))] / DEPTH_MARGIN : NEAR_BASELINES * baseline;
    p->far = count ? z[(size_t)((1 - DEPTH_TRIM) * (double)(count - 1))] * DEPTH_MARGIN : INFINITY;
    free(z);
    return ST_OK;
}

/* The photo's only view; NULL: none, *lens unchanged, or several. */
static const struct view *find_view(const struct lens **lens, const struct camera_set *set,
                                    const struct lens_list *lenses, const char *photo)
{
    const struct view *found = NULL;
    int count = 0;
    for (int i = 0; i < lenses->count; i++) {
        int at = strcmp(lenses->lenses[i].photo, photo) ? -1 : camera_set_find(set, lenses->lenses[i].view);
        if (at < 0) continue;
        count++;
        found = &set->views[at];
        *lens = &lenses->lenses[i];
    }
    return count == 1 ? found : NULL;
}

/* Sets g to the photos' cameras if both have one (*known). */
static enum status read_cameras(struct pair_geometry *g, bool *known, const struct morph_job *job,
                                const struct photo_pair *pair, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct lens_list lenses = {0};
    char path[FILE_PATH];
    *known = false;
    if (!job->views) return ST_OK;
    if (!camera_set_read(&set, job->views, prov, err) && !product_path_in(path, job->views, PRODUCT_LENSES, NULL, err))
        lens_list_read(&lenses, path, prov, err);
    bool all = !err->status;
    for (int i = 0; all && i < 2; i++) {
        const struct lens *lens = NULL;
        const struct view *view = find_view(&lens, &set, &lenses, pair->records[i].id);
        if (!view) {
            log_warn("photo %s has %s in %s: epipolar lines are estimated from features", pair->records[i].id,
                     lens ? "several views" : "no camera", job->views);
            all = false;
            break;
        }
        if (lens->camera.width != pair->films[i].stored_width || lens->camera.height != pair->films[i].stored_height)
            err_set(err, ST_DATA,
                    "photo %s has %d x %d pixels, but its camera has %d x %d: the photo was replaced after "
                    "its camera was given. Give the new one (SFM), or restore the old photo.",
                    pair->records[i].id, pair->films[i].stored_width, pair->films[i].stored_height, lens->camera.width,
                    lens->camera.height);
        struct mat3 turn = mat3_transpose(mat3_from_quat(lens->view_from_photo));
        g->photos[i] = (struct posed_photo){.lens = lens->camera,
                                            .photo_from_world = mat3_multiply(turn, view->cam_from_world),
                                            .translation = mat3_apply(turn, view->translation)};
        g->films[i] = &pair->films[i];
        all = !err->status;
    }
    if (all) {
        struct vec3 centers[2];
        for (int i = 0; i < 2; i++)
            centers[i] =
                vec3_scale(mat3_apply(mat3_transpose(g->photos[i].photo_from_world), g->photos[i].translation), -1);
        double baseline = vec3_length(vec3_sub(centers[1], centers[0]));
        for (int i = 0; !err->status && i < 2; i++) depth_range(&g->photos[i], &set.model, baseline, err);
        g->kind = EPIPOLAR_POSED;
        *known = true;
    }
    lens_list_release(&lenses);
    camera_set_release(&set);
    return err->status;
}

static void geometry_from_features(struct pair_geometry *g, const struct two_view *found, const struct photo_pair *pair)
{
    if (!found->inliers) {
        log_warn("photos %s and %s share only %d features: they are matched without epipolar lines, by colour and "
                 "smoothness",
                 pair->records[0].id, pair->records[1].id, found->count);
        return;
    }
    if (found->plane_inliers >= PLANE_PART * found->inliers) {
        log_note("%d of %d features lie on one plane, or the camera only turned: matching without epipolar lines",
                 found->plane_inliers, found->count);
        return;
    }
    g->kind = EPIPOLAR_FUNDAMENTAL;
    memcpy(g->fundamental, found->fundamental, sizeof g->fundamental);
    memcpy(g->rotation, found->rotation, sizeof g->rotation);
    memcpy(g->translation, found->translation, sizeof g->translation);
    log_note("%d of %d matched features agree on the epipolar geometry", found->inliers, found->count);
}

static enum status find_features(struct two_view *found, const struct image images[2], double focal, struct err *err)
{
    const size_t n = (size_t)images[0].width * (size_t)images[0].height;
    unsigned char *grey = malloc(2 * n);
    if (!grey) return err_nomem(err, "grey pictures", 2 * n);
    for (size_t i = 0; i < 2; i++)
        for (size_t p = 0; p < n; p++) {
            const float *rgb = images[i].data + 3 * p;
            float v = 255 * luminance_of(rgb);
            grey[i * n + p] = (unsigned char)lrintf(fminf(fmaxf(v, 0), 255));
        }
    features_find(found, grey, grey + n, images[0].width, images[0].height, focal, TOLERANCE, err);
    free(grey);
    return err->status;
}

/* ----------------------------------------------------------------------------------------------------------- path */

double morph_time(int frame, int count, const struct morph_params *params)
{
    double t = count > 1 ? (double)frame / (count - 1) : 0;
    return strcmp(params->ease, "smooth") ? t : t * t * (3 - 2 * t);
}

/* The film's camera at one photo. False: the photo is stored mirrored, which a rotation cannot undo. */
static bool film_camera(struct view *v, const struct posed_photo *p, const struct film_picture *film)
{
    const double(*m)[3] = film->film_from_photo;
    double fx, fy, cx, cy, det = m[0][0] * m[1][1] - m[0][1] * m[1][0], scale = sqrt(fabs(det));
    if (det <= 0) return false;
    camera_focal(&p->lens, &fx, &fy, &cx, &cy);
    struct mat3 turn = {{{m[0][0] / scale, m[0][1] / scale, 0}, {m[1][0] / scale, m[1][1] / scale, 0}, {0, 0, 1}}};
    bool swapped = fabs(turn.m[0][1]) > 0.5;
    v->fx = scale * (swapped ? fy : fx);
    v->fy = scale * (swapped ? fx : fy);
    film_map(m, cx, cy, &v->cx, &v->cy);
    v->cam_from_world = mat3_multiply(turn, p->photo_from_world);
    v->translation = mat3_apply(turn, p->translation);
    v->center = vec3_scale(mat3_apply(mat3_transpose(v->cam_from_world), v->translation), -1);
    return true;
}

static double mix(double a, double b, double t) { return a + t * (b - a); }

static void camera_between(struct view *v, const struct view ends[2], double t)
{
    struct quat a = quat_from_mat3(ends[0].cam_from_world), b = quat_from_mat3(ends[1].cam_from_world);
    double sign = a.w * b.w + a.x * b.x + a.y * b.y + a.z * b.z < 0 ? -1 : 1;
    struct quat q = {mix(a.w, sign * b.w, t), mix(a.x, sign * b.x, t), mix(a.y, sign * b.y, t),
                     mix(a.z, sign * b.z, t)};
    double length = sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
    q = (struct quat){q.w / length, q.x / length, q.y / length, q.z / length};
    v->fx = mix(ends[0].fx, ends[1].fx, t);
    v->fy = mix(ends[0].fy, ends[1].fy, t);
    v->cx = mix(ends[0].cx, ends[1].cx, t);
    v->cy = mix(ends[0].cy, ends[1].cy, t);
    v->cam_from_world = mat3_from_quat(q);
    v->center = vec3_add(ends[0].center, vec3_scale(vec3_sub(ends[1].center, ends[0].center), t));
    v->translation = vec3_scale(mat3_apply(v->cam_from_world, v->center), -1);
}

static enum status write_path(const struct morph *m, const struct view ends[2], double matched, const char *out,
                              const struct morph_params *params, const struct provenance *prov, struct err *err)
{
    struct camera_path path = {0};
    struct outfile f = {0};
    char name[FILE_PATH];
    double length = 0;
    const size_t n = (size_t)m->flows[0].width * (size_t)m->flows[0].height;
    for (size_t p = 0; p < n; p++) length += hypot(m->flows[0].uv[2 * p], m->flows[0].uv[2 * p + 1]) / (double)n;
    if (!camera_path_init(&path, "morph", params->fps, (int)floor(params->seconds * params->fps + 0.5), err) &&
        !camera_path_add_score(&path, "matched", matched, "", err))
        camera_path_add_score(&path, "way", length, "px", err);
    for (int i = 0; !err->status && i < path.frame_count; i++) {
        struct view *v = &path.frames[i].camera;
        v->width = m->pictures[0].width;
        v->height = m->pictures[0].height;
        camera_between(v, ends, morph_time(i, path.frame_count, params));
    }
    if (!err->status && !camera_path_write(&path, out, prov, err) &&
        !product_path_in(name, out, PRODUCT_FRAMES_MK, NULL, err))
        outfile_open(&f, name, err);
    if (!err->status) {
        fputs("MORPH_FRAMES :=", f.fp);
        for (int i = 0; i < path.frame_count; i++) fprintf(f.fp, " %s", path.frames[i].camera.name);
        fputc('\n', f.fp);
        outfile_commit(&f, err);
    }
    outfile_discard(&f);
    camera_path_release(&path);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- whole */

static double matched_fraction(const struct morph *m)
{
    const size_t n = (size_t)m->flows[0].width * (size_t)m->flows[0].height;
    size_t matched = 0;
    for (int i = 0; i < 2; i++)
        for (size_t p = 0; p < n; p++) matched += m->flows[i].confidence[p] >= 0.5f;
    return (double)matched / (double)(2 * n);
}

enum status morph_prepare(const struct morph_job *job, const char *out, const struct morph_params *params,
                          struct provenance *prov, struct err *err)
{
    struct photo_pair pair = {0};
    struct morph m = {0};
    struct pair_geometry geometry = {0};
    struct two_view found = {0};
    struct image images[2] = {0};
    struct view ends[2] = {0};
    bool posed = false;
    double matched = 0;
    read_pair(&pair, &m, job, params, prov, err);
    for (int i = 0; !err->status && i < 2; i++) match_image(&images[i], &m.pictures[i], err);
    if (!err->status && !find_features(&found, images, pair.focal, err)) {
        geometry.width = images[0].width;
        geometry.height = images[0].height;
        geometry.focal = pair.focal;
        read_cameras(&geometry, &posed, job, &pair, prov, err);
    }
    if (!err->status && !posed) geometry_from_features(&geometry, &found, &pair);
    if (!err->status && !match_pictures(m.flows, images, &geometry, found.matches, found.count, params, err)) {
        matched = matched_fraction(&m);
        if (matched < params->min_matched)
            err_set(err, ST_DATA,
                    "only %.0f %% of the pixels of photos %s and %s match (wanted %.0f %%): they show different "
                    "things, or their viewpoints are too far apart. Choose other photos, or lower min_matched.",
                    100 * matched, pair.records[0].id, pair.records[1].id, 100 * params->min_matched);
    }
    if (!err->status) {
        morph_find_gain(&m);
        posed = posed && film_camera(&ends[0], &geometry.photos[0], &pair.films[0]) &&
                film_camera(&ends[1], &geometry.photos[1], &pair.films[1]);
        for (int i = 0; !posed && i < 2; i++) /* a static camera, because a path needs cameras */
            ends[i] = (struct view){.fx = pair.focal,
                                    .fy = pair.focal,
                                    .cx = geometry.width / 2.0,
                                    .cy = geometry.height / 2.0,
                                    .cam_from_world = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}};
        morph_write(&m, posed ? ends : NULL, out, prov, err);
    }
    if (!err->status && !write_path(&m, ends, matched, out, params, prov, err))
        log_note("%.0f %% of the pixels have consistent matches", 100 * matched);
    m.pictures[0] = m.pictures[1] = (struct image){0}; /* owned by pair.films */
    for (int i = 0; i < 2; i++) {
        film_picture_release(&pair.films[i]);
        photo_record_release(&pair.records[i]);
        image_release(&images[i]);
    }
    features_release(&found);
    morph_release(&m);
    return err->status;
}
