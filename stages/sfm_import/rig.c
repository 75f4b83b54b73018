/* rig.c - the captures and lenses of a multi-lens camera among the images of a model.
 *
 * Photos of such a camera are split into pictures ID_cXrY.png: ID names the capture, X and Y the lens. In all captures
 * a lens has the same pose in the camera's body, its mount. The body's frame is that of the reference lens, the one
 * placed in most captures.
 *
 *   cam_from_world(capture, lens) = mount(lens) o body_from_world(capture)
 *
 * Two captures that share two lenses are the least that this says anything about. A lens belongs to the rig if one of
 * its captures has the reference lens, a capture if it has such a lens.
 *
 * Mounts start as the mean of the lens's poses relative to the reference lens: of rotations that of the quaternions, of
 * places the median of each coordinate, which single pictures placed wrongly do not move. A capture's body starts where
 * the reference lens, or another one with its mount, says. */
#include "stages/sfm_import/rig.h"

#include <stdlib.h>
#include <string.h>

#include "common/base/sort.h"

/* ------------------------------------------------------------------------------------------------ names of pictures */

/* Images by capture and cell of the grid. */
struct cells {
    int *image; /* of each capture, of each cell; -1: none */
    int captures, count;
};

static int image_of(const struct cells *c, int capture, int cell) { return c->image[capture * c->count + cell]; }

/* Sorts the images, which are in order of name, into captures and cells; captures are numbered in the same order. The
 * second of two images with the same photo and cell stays alone. */
static void fill_cells(struct cells *c, struct rig *rig, const struct sfm_model *m, const struct bundle *b,
                       struct split_size split)
{
    struct split_name name, other;
    for (int i = 0; i < m->image_count; i++) {
        const struct bundle_image *im = &b->images[i];
        if (im->fixed || b->stations[im->station].fixed || !split_name_read(&name, m->images[i].name, split)) continue;
        int capture = c->captures;
        for (int k = i - 1; k >= 0 && !strncmp(m->images[k].name, m->images[i].name, name.photo_length + 2); k--)
            if (rig->capture[k] >= 0 && split_name_read(&other, m->images[k].name, split) &&
                other.photo_length == name.photo_length)
                capture = rig->capture[k];
        const int cell = (name.row - 1) * split.columns + name.column - 1;
        int *at = &c->image[capture * c->count + cell];
        if (capture == c->captures)
            for (int k = 0; k < c->count; k++) c->image[capture * c->count + k] = -1;
        if (*at >= 0) continue;
        *at = i;
        rig->capture[i] = capture;
        rig->lens[i] = cell;
        c->captures += capture == c->captures;
    }
}

/* The cell with most images, the first of several. */
static int reference_of(const struct cells *c)
{
    int best = 0, most = 0;
    for (int cell = 0; cell < c->count; cell++) {
        int images = 0;
        for (int i = 0; i < c->captures; i++) images += image_of(c, i, cell) >= 0;
        if (images <= most) continue;
        most = images;
        best = cell;
    }
    return best;
}

/* Numbers the lenses of cells that share a capture with the reference, into lens[cell]; other cells have -1. */
static int number_lenses(int *lens, const struct cells *c, int reference)
{
    int count = 1;
    for (int cell = 0; cell < c->count; cell++) {
        bool reached = false;
        for (int i = 0; i < c->captures; i++)
            reached = reached || (image_of(c, i, cell) >= 0 && image_of(c, i, reference) >= 0);
        lens[cell] = !reached ? -1 : cell == reference ? 0 : count++;
    }
    return count;
}

/* Whether two captures share two lenses of the rig. */
static bool shares_lenses(const struct cells *c, const int *lens)
{
    for (int i = 0; i < c->captures; i++)
        for (int k = 0; k < i; k++) {
            int shared = 0;
            for (int cell = 0; cell < c->count; cell++)
                shared += lens[cell] >= 0 && image_of(c, i, cell) >= 0 && image_of(c, k, cell) >= 0;
            if (shared > 1) return true;
        }
    return false;
}

/* Numbers the captures that have a lens of the rig, and leaves the images of others alone. */
static void number_captures(struct rig *rig, const struct cells *c, const int *lens)
{
    for (int i = 0; i < c->captures; i++) {
        bool any = false;
        for (int cell = 0; cell < c->count; cell++) {
            const int image = image_of(c, i, cell);
            if (image < 0) continue;
            rig->capture[image] = lens[cell] < 0 ? -1 : rig->capture_count;
            rig->lens[image] = lens[cell];
            any = any || lens[cell] >= 0;
        }
        rig->capture_count += any;
    }
}

enum status rig_find(struct rig *rig, const struct sfm_model *m, const struct bundle *b, struct split_size split,
                     struct err *err)
{
    const size_t images = (size_t)m->image_count;
    struct cells c = {.count = split.columns * split.rows};
    *rig = (struct rig){.capture = malloc((images + 1) * sizeof *rig->capture),
                        .lens = malloc((images + 1) * sizeof *rig->lens)};
    c.image = malloc((images + 1) * (size_t)c.count * sizeof *c.image);
    int *lens = malloc(((size_t)c.count + 1) * sizeof *lens);
    if (!rig->capture || !rig->lens || !c.image || !lens) {
        rig_release(rig);
        err_nomem(err, "a rig", images * (size_t)c.count * sizeof *c.image);
    } else {
        for (int i = 0; i < m->image_count; i++) rig->capture[i] = rig->lens[i] = -1;
        fill_cells(&c, rig, m, b, split);
        const int count = number_lenses(lens, &c, reference_of(&c));
        if (shares_lenses(&c, lens)) {
            rig->lens_count = count;
            number_captures(rig, &c, lens);
        }
    }
    free(c.image);
    free(lens);
    return err->status;
}

void rig_release(struct rig *rig)
{
    if (!rig) return;
    free(rig->capture);
    free(rig->lens);
    *rig = (struct rig){0};
}

/* ----------------------------------------------------------------------------------------------------------- frames */

static struct quat quat_from(const double q[4]) { return (struct quat){q[0], q[1], q[2], q[3]}; }
static struct vec3 vec3_from(const double c[3]) { return vec3_make(c[0], c[1], c[2]); }

static struct bundle_frame frame_make(struct quat q, struct vec3 c)
{
    return (struct bundle_frame){{q.w, q.x, q.y, q.z}, {c.x, c.y, c.z}};
}

static struct bundle_frame frame_of_image(const struct bundle *b, int image)
{
    const struct bundle_image *im = &b->images[image];
    return frame_make(quat_from(im->rotation), vec3_from(b->stations[im->station].center));
}

/* The mount of a lens, from its pose and that of the capture's body. */
static struct bundle_frame mount_of(const struct bundle_frame *lens, const struct bundle_frame *body)
{
    const struct quat q = quat_from(body->rotation);
    const struct vec3 offset = vec3_sub(vec3_from(lens->center), vec3_from(body->center));
    return frame_make(quat_multiply(quat_from(lens->rotation), quat_conjugate(q)),
                      mat3_apply(mat3_from_quat(q), offset));
}

/* The pose of a capture's body, from that of a lens and its mount. */
static struct bundle_frame body_of(const struct bundle_frame *lens, const struct bundle_frame *mount)
{
    const struct quat q = quat_multiply(quat_conjugate(quat_from(mount->rotation)), quat_from(lens->rotation));
    const struct vec3 offset = mat3_apply(mat3_transpose(mat3_from_quat(q)), vec3_from(mount->center));
    return frame_make(q, vec3_sub(vec3_from(lens->center), offset));
}

/* The mean of `count` mounts of one lens; numbers: `count` of scratch. */
static struct bundle_frame mean_mount(const struct bundle_frame *mounts, int count, double *numbers)
{
    const double *first = mounts[0].rotation;
    struct bundle_frame mean = {{0}, {0}};
    for (int i = 0; i < count; i++) {
        const double *q = mounts[i].rotation;
        const double dot = q[0] * first[0] + q[1] * first[1] + q[2] * first[2] + q[3] * first[3];
        for (int k = 0; k < 4; k++) mean.rotation[k] += dot < 0 ? -q[k] : q[k];
    }
    for (int k = 0; k < 3; k++) {
        for (int i = 0; i < count; i++) numbers[i] = mounts[i].center[k];
        mean.center[k] = sort_median(numbers, (size_t)count);
    }
    return frame_make(quat_normalize(quat_from(mean.rotation)), vec3_from(mean.center));
}

/* base[capture]: the image with its reference lens, or that with its first lens. */
static void find_bases(int *base, const struct bundle *b, const struct rig *rig)
{
    for (int i = 0; i < rig->capture_count; i++) base[i] = -1;
    for (int i = 0; i < b->image_count; i++) {
        const int capture = rig->capture[i];
        if (capture >= 0 && (base[capture] < 0 || rig->lens[i] < rig->lens[base[capture]])) base[capture] = i;
    }
}

/* Sets the mounts; mounts: image_count of scratch. */
static void place_mounts(struct bundle *b, const struct rig *rig, const int *base, struct bundle_frame *mounts,
                         double *numbers)
{
    b->mounts[0] = (struct bundle_frame){{1, 0, 0, 0}, {0}};
    for (int lens = 1; lens < rig->lens_count; lens++) {
        int count = 0;
        for (int i = 0; i < b->image_count; i++) {
            if (rig->lens[i] != lens || rig->lens[base[rig->capture[i]]]) continue;
            const struct bundle_frame image = frame_of_image(b, i), body = frame_of_image(b, base[rig->capture[i]]);
            mounts[count++] = mount_of(&image, &body);
        }
        b->mounts[lens] = mean_mount(mounts, count, numbers);
    }
}

enum status rig_apply(double *angle, struct bundle *b, const struct rig *rig, struct err *err)
{
    const size_t images = (size_t)b->image_count + 1;
    int *base = malloc(images * sizeof *base);
    double *numbers = malloc(images * sizeof *numbers);
    struct bundle_frame *mounts = malloc(images * sizeof *mounts);
    if (!base || !numbers || !mounts) {
        err_nomem(err, "a rig", images * sizeof *mounts);
    } else {
        size_t count = 0;
        find_bases(base, b, rig);
        place_mounts(b, rig, base, mounts, numbers);
        for (int i = 0; i < rig->capture_count; i++) {
            const struct bundle_frame image = frame_of_image(b, base[i]);
            b->captures[i] = body_of(&image, &b->mounts[rig->lens[base[i]]]);
        }
        for (int i = 0; i < b->image_count; i++) {
            struct bundle_image *im = &b->images[i];
            im->capture = rig->capture[i];
            im->mount = rig->lens[i];
            if (im->capture < 0 || base[im->capture] == i) continue;
            const struct bundle_frame image = frame_of_image(b, i), mount = mount_of(&image, &b->captures[im->capture]);
            numbers[count++] = quat_angle(quat_from(mount.rotation), quat_from(b->mounts[im->mount].rotation));
        }
        *angle = sort_median(numbers, count);
    }
    free(base);
    free(numbers);
    free(mounts);
    return err->status;
}
