/* room_frame.c - reading and writing frame.txt. */
#include "common/capture/room_frame.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/sort.h"
#include "common/math/numbers.h"
#include "common/product/product.h"

#define UNIT_ERROR  1e-6
#define FEW_POINTS  25.0
#define MANY_POINTS 40.0

static enum status read_direction(struct textfile *t, struct vec3 *d, struct err *err)
{
    if (!textfile_double(t, "X", &d->x, err) && !textfile_double(t, "Y", &d->y, err) &&
        !textfile_double(t, "Z", &d->z, err) && !(fabs(vec3_length(*d) - 1) < UNIT_ERROR))
        textfile_wrong_number(t, vec3_length(*d), "a direction of length 1", err);
    return err->status;
}

static enum status read_heading(struct textfile *t, struct room_frame *f, struct err *err)
{
    struct frame_heading h = {.error = 0};
    if (read_direction(t, &h.along, err) || textfile_number(t, "error", 0, INFINITY, &h.error, err) ||
        textfile_number(t, "share", 0, 1, &h.share, err) || textfile_end(t, err))
        return err->status;
    if (!(fabs(vec3_dot(h.along, f->up)) < UNIT_ERROR))
        return textfile_wrong_number(t, vec3_dot(h.along, f->up), "a heading that is level, after up", err);
    if (!array_append(&f->headings, (size_t)f->heading_count, sizeof h, "headings", err))
        f->headings[f->heading_count++] = h;
    return err->status;
}

static enum status read_level(struct textfile *t, struct frame_level *l, struct err *err)
{
    l->known = true;
    return textfile_double(t, "height", &l->height, err) || textfile_number(t, "error", 0, INFINITY, &l->error, err) ||
                   textfile_end(t, err)
               ? err->status
               : ST_OK;
}

static enum status read_wall(struct textfile *t, struct room_frame *f, struct err *err)
{
    struct frame_wall w = {0};
    int64_t heading = 0, side = 0, support = 0;
    if (textfile_int(t, "heading", 0, f->heading_count - 1, &heading, err) ||
        textfile_int(t, "side", -1, 1, &side, err) || textfile_double(t, "offset", &w.offset, err) ||
        textfile_double(t, "from", &w.from, err) || textfile_double(t, "to", &w.to, err) ||
        textfile_int(t, "support", 0, 1000000, &support, err) || textfile_end(t, err))
        return err->status;
    if (!side || !(w.to > w.from)) return textfile_wrong_number(t, side ? w.to : 0, "side 1 or -1, and from < to", err);
    w.heading = (int)heading;
    w.side = (int)side;
    w.support = (int)support;
    if (!array_append(&f->walls, (size_t)f->wall_count, sizeof w, "walls", err)) f->walls[f->wall_count++] = w;
    return err->status;
}

enum status room_frame_read(struct room_frame *f, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    char *word;
    *f = (struct room_frame){0};
    product_open(&t, NULL, PRODUCT_ROOM_FRAME, path, prov, err);
    while (!err->status && textfile_next(&t)) {
        if (textfile_word(&t, "up, heading, floor, ceiling or wall", &word, err)) break;
        if (!strcmp(word, "up")) {
            f->known = true;
            if (!read_direction(&t, &f->up, err) && !textfile_number(&t, "error", 0, INFINITY, &f->up_error, err))
                textfile_end(&t, err);
        } else if (!strcmp(word, "heading"))
            read_heading(&t, f, err);
        else if (!strcmp(word, "floor"))
            read_level(&t, &f->floor, err);
        else if (!strcmp(word, "ceiling"))
            read_level(&t, &f->ceiling, err);
        else if (!strcmp(word, "wall"))
            read_wall(&t, f, err);
        else
            textfile_error(&t, err, word, "up, heading, floor, ceiling or wall");
    }
    textfile_release(&t);
    if (err->status) room_frame_release(f);
    return err->status;
}

enum status room_frame_write(const struct room_frame *f, const char *path, const struct provenance *prov,
                             struct err *err)
{
    struct outfile o = {0};
    if (!product_begin(&o, PRODUCT_ROOM_FRAME, path, prov, err)) {
        if (f->known) fprintf(o.fp, "up %.17g %.17g %.17g %.9g\n", f->up.x, f->up.y, f->up.z, f->up_error);
        for (int i = 0; i < f->heading_count; i++) {
            const struct frame_heading *h = &f->headings[i];
            fprintf(o.fp, "heading %.17g %.17g %.17g %.9g %.9g\n", h->along.x, h->along.y, h->along.z, h->error,
                    h->share);
        }
        if (f->floor.known) fprintf(o.fp, "floor %.17g %.9g\n", f->floor.height, f->floor.error);
        if (f->ceiling.known) fprintf(o.fp, "ceiling %.17g %.9g\n", f->ceiling.height, f->ceiling.error);
        for (int i = 0; i < f->wall_count; i++) {
            const struct frame_wall *w = &f->walls[i];
            fprintf(o.fp, "wall %d %d %.17g %.17g %.17g %d\n", w->heading, w->side, w->offset, w->from, w->to,
                    w->support);
        }
        outfile_commit(&o, err);
    }
    outfile_discard(&o);
    return err->status;
}

void room_frame_release(struct room_frame *f)
{
    if (!f) return;
    free(f->headings);
    free(f->walls);
    *f = (struct room_frame){0};
}

enum status room_frame_trust(double *trust, const struct sfm_model *model, struct err *err)
{
    double *counts = calloc((size_t)model->image_count + 1, sizeof *counts), median = 0;
    *trust = 0;
    if (!counts) return err_nomem(err, "points of views", (size_t)model->image_count * sizeof *counts);
    for (int i = 0; i < model->point_count; i++)
        for (int k = 0; k < model->points[i].track_count; k++)
            if (model->points[i].track[k].image_idx < model->image_count) counts[model->points[i].track[k].image_idx]++;
    if (model->image_count) median = sort_median(counts, (size_t)model->image_count);
    *trust = clamp((MANY_POINTS - median) / (MANY_POINTS - FEW_POINTS), 0, 1);
    free(counts);
    return ST_OK;
}
