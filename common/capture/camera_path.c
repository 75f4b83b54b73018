/* camera_path.c - reading and writing camera moves.
 *
 * A path is two things on disk. path/ is COLMAP's text model with a camera a frame, which COLMAP and other viewers
 * open; path.txt has what COLMAP's model cannot say: frames per second, scores, and time, aperture and focus of each
 * frame. It is written last.
 *
 * Frames are named by their number, with as many digits as keep the order of names that of frames: 4, 5 or 7.
 * Numbers have 17 digits, so that frames rendered from a file are those rendered from memory, to the bit; rotations
 * go through quaternions, which is what COLMAP's format holds.
 *
 * The two parts are checked against each other: the same frames, in the same order. */
#include "common/capture/camera_path.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/product/product.h"

enum { MAX_FRAMES = 1000000, LINE_SIZE = 256 };

enum status camera_path_init(struct camera_path *p, const char *effect, double fps, int frames, struct err *err)
{
    *p = (struct camera_path){.fps = fps};
    if (frames < 1 || frames > MAX_FRAMES)
        return err_set(err, ST_DATA, "the path has %d frames, wanted 1 to %d.", frames, MAX_FRAMES);
    if (!(fps > 0)) return err_set(err, ST_DATA, "the path has %g frames per second, wanted more than 0.", fps);
    if (strlen(effect) >= sizeof p->effect)
        return err_set(err, ST_DATA, "the name of the effect \"%s\" is longer than %zu bytes.", effect,
                       sizeof p->effect - 1);
    strcpy(p->effect, effect);
    p->frames = calloc((size_t)frames, sizeof *p->frames);
    if (!p->frames) return err_nomem(err, "a path", (size_t)frames * sizeof *p->frames);
    int digits = frames < 10000 ? 4 : frames < 100000 ? 5 : 7;
    for (int i = 0; i < frames; i++) {
        char name[16];
        snprintf(name, sizeof name, "%0*d", digits, i + 1);
        p->frames[i].time = i / fps;
        p->frames[i].camera.name = strdup(name);
        p->frame_count = i + 1;
        if (!p->frames[i].camera.name) {
            camera_path_release(p);
            return err_nomem(err, "a path", sizeof name);
        }
    }
    return ST_OK;
}

enum status camera_path_add_score(struct camera_path *p, const char *name, double value, const char *unit,
                                  struct err *err)
{
    struct path_score s = {.value = value};
    if (strlen(name) >= sizeof s.name || strlen(unit) >= sizeof s.unit)
        return err_set(err, ST_DATA,
                       "the name of the score \"%s\" or its unit \"%s\" is too long; wanted at most %zu and %zu bytes.",
                       name, unit, sizeof s.name - 1, sizeof s.unit - 1);
    if (!isfinite(value)) return err_set(err, ST_INTERNAL, "the score %s is not a finite number.", name);
    strcpy(s.name, name);
    strcpy(s.unit, unit);
    if (array_append(&p->scores, (size_t)p->score_count, sizeof *p->scores, "scores", err)) return err->status;
    p->scores[p->score_count++] = s;
    return ST_OK;
}

void camera_path_release(struct camera_path *p)
{
    if (!p) return;
    for (int i = 0; i < p->frame_count; i++) free((char *)p->frames[i].camera.name);
    free(p->frames);
    free(p->scores);
    *p = (struct camera_path){0};
}

/* The folder of the poses, and path.txt. */
static enum status find_files(char poses[FILE_PATH], char list[FILE_PATH], const char *folder, struct err *err)
{
    if (product_path_in(list, folder, PRODUCT_PATH, NULL, err)) return err->status;
    return file_path(poses, folder, "path", "", err);
}

/* -------------------------------------------------------------------------------------------------------- writing */

static enum status write_poses(const struct camera_path *p, const char *folder, const struct provenance *prov,
                               struct err *err)
{
    struct sfm_model m = {0};
    size_t n = (size_t)p->frame_count;
    m.cameras = calloc(n, sizeof *m.cameras);
    m.images = calloc(n, sizeof *m.images);
    if (!m.cameras || !m.images) err_nomem(err, "a path's cameras", n * sizeof *m.images);
    for (int i = 0; !err->status && i < p->frame_count; i++) {
        const struct view *v = &p->frames[i].camera;
        char name[32];
        snprintf(name, sizeof name, "%s.exr", v->name);
        m.cameras[i].id = i + 1;
        m.cameras[i].camera = (struct camera){CAMERA_PINHOLE, v->width, v->height, {v->fx, v->fy, v->cx, v->cy}};
        m.images[i].id = i + 1;
        m.images[i].camera_idx = i;
        m.images[i].cam_from_world = (struct pose){quat_from_mat3(v->cam_from_world), v->translation};
        m.images[i].name = strdup(name);
        m.camera_count = m.image_count = i + 1;
        if (!m.images[i].name) err_nomem(err, "a path's cameras", sizeof name);
    }
    if (!err->status) sfm_model_write_text(&m, folder, prov, err);
    sfm_model_release(&m);
    return err->status;
}

static enum status write_list(const struct camera_path *p, const char *path, const struct provenance *prov,
                              struct err *err)
{
    struct outfile f = {0};
    char effect[LINE_SIZE], name[LINE_SIZE], unit[LINE_SIZE];
    if (!product_begin(&f, PRODUCT_PATH, path, prov, err) && !textfile_quote(p->effect, effect, sizeof effect, err))
        fprintf(f.fp, "effect %s\nfps %.17g\n", effect, p->fps);
    for (int i = 0; !err->status && i < p->score_count; i++) {
        const struct path_score *s = &p->scores[i];
        if (!textfile_quote(s->name, name, sizeof name, err) && !textfile_quote(s->unit, unit, sizeof unit, err))
            fprintf(f.fp, "score %s %.17g %s\n", name, s->value, unit);
    }
    if (!err->status) fprintf(f.fp, "frames %d\n", p->frame_count);
    for (int i = 0; !err->status && i < p->frame_count; i++) {
        const struct path_frame *fr = &p->frames[i];
        fprintf(f.fp, "frame %s %.17g %.17g %.17g\n", fr->camera.name, fr->time, fr->aperture, fr->focus);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

enum status camera_path_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err)
{
    char poses[FILE_PATH], list[FILE_PATH];
    if (find_files(poses, list, folder, err) || write_poses(p, poses, prov, err) || write_list(p, list, prov, err))
        return err->status;
    return ST_OK;
}

/* -------------------------------------------------------------------------------------------------------- reading */

static enum status next_line(struct textfile *t, const char *word, struct err *err)
{
    if (!textfile_next(t)) return textfile_error(t, err, NULL, "a line \"%s ...\"", word);
    return textfile_expect(t, word, err);
}

/* A number of 0 or more. */
static enum status read_amount(struct textfile *t, const char *what, double *value, struct err *err)
{
    if (textfile_double(t, what, value, err)) return err->status;
    if (*value >= 0) return ST_OK;
    char found[32];
    snprintf(found, sizeof found, "%.9g", *value);
    return textfile_error(t, err, found, "%s of 0 or more", what);
}

static enum status read_score(struct textfile *t, struct camera_path *p, struct err *err)
{
    struct path_score s = {0};
    if (textfile_word_into(t, "a score's name", s.name, sizeof s.name, err) ||
        textfile_double(t, "a score's value", &s.value, err) ||
        textfile_word_into(t, "a score's unit", s.unit, sizeof s.unit, err) || textfile_end(t, err))
        return err->status;
    return camera_path_add_score(p, s.name, s.value, s.unit, err);
}

/* Everything before the frames. */
static enum status read_head(struct textfile *t, struct camera_path *p, int64_t *frames, struct err *err)
{
    if (next_line(t, "effect", err) || textfile_word_into(t, "the effect's name", p->effect, sizeof p->effect, err) ||
        textfile_end(t, err) || next_line(t, "fps", err) || read_amount(t, "frames per second", &p->fps, err) ||
        textfile_end(t, err))
        return err->status;
    if (!(p->fps > 0)) return textfile_error(t, err, "0", "frames per second above 0");
    for (;;) {
        char *word;
        if (!textfile_next(t)) return textfile_error(t, err, NULL, "a line \"frames N\"");
        if (textfile_word(t, "\"score\" or \"frames\"", &word, err)) return err->status;
        if (!strcmp(word, "frames")) break;
        if (strcmp(word, "score")) return textfile_error(t, err, word, "\"score\" or \"frames\"");
        if (read_score(t, p, err)) return err->status;
    }
    return textfile_int(t, "number of frames", 1, MAX_FRAMES, frames, err) || textfile_end(t, err) ? err->status
                                                                                                   : ST_OK;
}

static enum status check_camera(const struct textfile *t, const struct view *v, const struct view *first,
                                struct err *err)
{
    char found[128];
    if (!(v->fx > 0) || !(v->fy > 0)) {
        snprintf(found, sizeof found, "focal lengths %.9g %.9g of frame %.16s", v->fx, v->fy, v->name);
        return textfile_error(t, err, found, "numbers above 0 in path/cameras.txt");
    }
    snprintf(found, sizeof found, "a size of %d x %d of frame %.16s", v->width, v->height, v->name);
    if (v->width % 2 || v->height % 2) return textfile_error(t, err, found, "even numbers in path/cameras.txt");
    if (v->width != first->width || v->height != first->height)
        return textfile_error(t, err, found, "%d x %d, the size of the first frame", first->width, first->height);
    return ST_OK;
}

static enum status read_frame(struct textfile *t, struct path_frame *f, const struct camera_set *set,
                              const struct view *first, struct err *err)
{
    char *name;
    const char *wanted = f->camera.name;
    if (next_line(t, "frame", err) || textfile_word(t, "a frame's name", &name, err)) return err->status;
    if (strcmp(name, wanted)) return textfile_error(t, err, name, "frame %s", wanted);
    if (read_amount(t, "time in seconds", &f->time, err) || read_amount(t, "aperture", &f->aperture, err) ||
        read_amount(t, "focus", &f->focus, err) || textfile_end(t, err))
        return err->status;
    int at = camera_set_find(set, wanted);
    if (at < 0) return textfile_error(t, err, name, "a frame in path/images.txt, as %s.exr", wanted);
    f->camera = set->views[at];
    f->camera.name = wanted;
    return check_camera(t, &f->camera, first, err);
}

enum status camera_path_read(struct camera_path *p, const char *folder, struct provenance *prov, struct err *err)
{
    struct camera_set set = {0};
    struct textfile t = {0};
    struct camera_path head = {0};
    char poses[FILE_PATH], list[FILE_PATH];
    int64_t frames = 0;
    *p = (struct camera_path){0};
    if (!find_files(poses, list, folder, err) && !camera_set_read(&set, poses, prov, err) &&
        !product_open(&t, NULL, PRODUCT_PATH, list, prov, err))
        read_head(&t, &head, &frames, err);
    if (!err->status && frames != set.view_count) {
        char found[32];
        snprintf(found, sizeof found, "%d", (int)frames);
        textfile_error(&t, err, found, "%d frames as in %s/images.txt", set.view_count, poses);
    }
    if (!err->status && !camera_path_init(p, head.effect, head.fps, (int)frames, err)) {
        p->scores = head.scores;
        p->score_count = head.score_count;
        head.scores = NULL;
    }
    for (int i = 0; !err->status && i < p->frame_count; i++)
        read_frame(&t, &p->frames[i], &set, &p->frames[0].camera, err);
    if (!err->status) textfile_end_of_file(&t, err);
    free(head.scores);
    textfile_release(&t);
    camera_set_release(&set);
    if (err->status) camera_path_release(p);
    return err->status;
}
