/* relit_file.c - see relit_file.h. Names are percent-encoded, so that no byte of them ends a word or the text. */
#include "stages/light_levels/relit_file.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/base64.h"
#include "common/base/outfile.h"
#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "stages/light_levels/light_codes.h"

static const char FIRST[] = "remodelRelit(String.raw`", LAST[] = "`);";
static const char *const lamp_words[] = {"lamp", "rest", "planned"};
static const char *const field_words[] = {"texture", "lamp", "window", "level", "part"};
static const char *const sky_words[] = {[STATE_SKY_OVERCAST] = "overcast", [STATE_SKY_WEATHER] = "weather"};
static const char *const cover_words[] = {"clear", "partly", "cloudy"};
enum { MOST = 1 << 24, MOST_SIDE = 16384, NAME = 1024 };

/* ---------------------------------------------------------------------------------------------------------- writing */

/* An empty name is a point, which encoded names are not. */
static void put_name(FILE *to, const char *name)
{
    fputc(' ', to);
    if (!*name) fputc('.', to);
    for (const unsigned char *c = (const unsigned char *)name; *c; c++)
        if (isalnum(*c) || *c == '-' || *c == '_')
            fputc(*c, to);
        else
            fprintf(to, "%%%02X", *c);
}

static enum status put_field(FILE *to, const struct relit_light *r, const struct relit_field *f, struct err *err)
{
    const size_t count = 3 * (size_t)r->places;
    const bool is_signed = f->kind == RELIT_PART;
    const double most = is_signed ? light_codes_most(f->values, count) : light_codes_highest(f->values, count);
    fprintf(to, "field %s %d %.9g ", field_words[f->kind], f->of, most);
    if (is_signed)
        light_codes_put_signed(to, f->values, count, most, err);
    else
        light_codes_put(to, f->values, count, most, err);
    fputc('\n', to);
    return err->status;
}

static void put_sky(FILE *to, const struct relit_light *r, const struct relit_sky *s)
{
    const struct light_state *is = &s->state;
    fprintf(to, "sky %s", is->sky == STATE_SKY_TIME ? cover_words[is->cover] : sky_words[is->sky]);
    if (is->sky == STATE_SKY_OVERCAST)
        fprintf(to, " 0 0 %.9g", is->horizontal);
    else
        fprintf(to, " %d %d %.9g", is->time.month, is->time.day, is->time.hour);
    fprintf(to, " %.6g %.6g %.6f %.6f %.6f %d", s->horizontal, s->sun, s->to_sun.x, s->to_sun.y, s->to_sun.z, s->shade);
    for (int k = 0; k < r->part_count; k++) fprintf(to, " %.6g", s->mixes[k]);
    fputc('\n', to);
}

static enum status put_face(FILE *to, const struct relit_face *f, struct err *err)
{
    const int cells = f->columns * f->rows;
    int *places = malloc(((size_t)cells + 1) * sizeof *places);
    if (!places) return err_nomem(err, "cells", (size_t)cells * sizeof *places);
    for (int i = 0; i < cells; i++) places[i] = 1 + f->places[i];
    fprintf(to, "face %.9g %.9g %.9g %.9g", f->normal.x, f->normal.y, f->normal.z, f->offset);
    fprintf(to, " %.9g %.9g %.9g %.9g %.9g %.9g", f->u.x, f->u.y, f->u.z, f->v.x, f->v.y, f->v.z);
    fprintf(to, " %.9g %.9g %.9g %.9g %d %d ", f->low[0], f->low[1], f->step[0], f->step[1], f->columns, f->rows);
    light_codes_put_runs(to, places, (size_t)cells, err);
    fputc('\n', to);
    free(places);
    return err->status;
}

static enum status put_normals(FILE *to, const struct relit_light *r, struct err *err)
{
    const size_t count = 3 * (size_t)(r->places - r->things);
    float *values = malloc((count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "normals", count * sizeof *values);
    for (int i = 0; i < r->places - r->things; i++) {
        values[3 * i] = (float)r->normals[i].x;
        values[3 * i + 1] = (float)r->normals[i].y;
        values[3 * i + 2] = (float)r->normals[i].z;
    }
    if (count) {
        fputs("normals ", to);
        light_codes_put_signed(to, values, count, 1, err);
        fputc('\n', to);
    }
    free(values);
    return err->status;
}

static enum status put_photo(FILE *to, const struct relit_light *r, const struct relit_photo *p, struct err *err)
{
    const size_t rays = (size_t)relit_light_lens_size(p->width) * (size_t)relit_light_lens_size(p->height);
    fputs("photo", to);
    put_name(to, p->name);
    fprintf(to, " %d %d %.9g %.9g %.9g ", p->width, p->height, p->from.x, p->from.y, p->from.z);
    light_codes_put_signed(to, p->rays, 3 * rays, 1, err);
    fputs("\npixels ", to);
    light_codes_put_runs(to, p->pixels, (size_t)p->width * (size_t)p->height, err);
    fputc('\n', to);
    for (int k = 0; !err->status && k < r->shade_count; k++) {
        fprintf(to, "shade %d ", k);
        light_codes_put_runs(to, p->shades[k], (size_t)(p->width / 2) * (size_t)(p->height / 2), err);
        fputc('\n', to);
    }
    fputs("picture ", to);
    base64_write(to, p->jpeg, p->jpeg_size);
    fputc('\n', to);
    return err->status;
}

enum status relit_file_write(const struct relit_light *r, const char *path, struct err *err)
{
    struct outfile f = {0};
    if (outfile_open(&f, path, err)) return err->status;
    const locale_t was = uselocale(scan_c_locale());
    fprintf(f.fp, "%s\nremodel-relit 1\n", FIRST);
    fprintf(f.fp, "places %d %d %d\nscale %.9g\nhorizontal %.9g\n", r->places, r->things, r->shade_count, r->scale,
            r->horizontal);
    for (int i = 0; i < r->lamp_count; i++) {
        fputs(lamp_words[r->lamps[i].kind], f.fp);
        put_name(f.fp, r->lamps[i].name);
        fputs(r->lamps[i].on ? " on\n" : "\n", f.fp);
    }
    for (int i = 0; i < r->window_count; i++) {
        fputs("window", f.fp);
        put_name(f.fp, r->windows[i]);
        fputc('\n', f.fp);
    }
    for (int i = 0; !err->status && i < r->field_count; i++) put_field(f.fp, r, &r->fields[i], err);
    for (int i = 0; i < r->sky_count; i++) put_sky(f.fp, r, &r->skies[i]);
    for (int i = 0; !err->status && i < r->face_count; i++) put_face(f.fp, &r->faces[i], err);
    if (!err->status) put_normals(f.fp, r, err);
    for (int i = 0; !err->status && i < r->photo_count; i++) put_photo(f.fp, r, &r->photos[i], err);
    fprintf(f.fp, "%s\n", LAST);
    uselocale(was);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

struct reading {
    struct relit_light *r;
    struct textfile *t;
    unsigned char *bytes; /* of the last word in base64 */
    size_t size;
};

static int digit(int c) { return isdigit(c) ? c - '0' : isxdigit(c) ? toupper(c) - 'A' + 10 : -1; }

static enum status read_name(char **name, struct reading *in, struct err *err)
{
    char *word, *to;
    if (textfile_word(in->t, "a name", &word, err)) return err->status;
    if (!(*name = to = calloc(strlen(word) + 1, 1))) return err_nomem(err, "a name", strlen(word));
    for (const char *c = strcmp(word, ".") ? word : ""; *c; c++) {
        const int high = *c == '%' ? digit((unsigned char)c[1]) : -1, low = high < 0 ? -1 : digit((unsigned char)c[2]);
        *to++ = low < 0 ? *c : (char)(16 * high + low);
        if (low >= 0) c += 2;
    }
    return ST_OK;
}

static enum status read_bytes(struct reading *in, const char *what, struct err *err)
{
    char *word;
    if (textfile_word(in->t, what, &word, err)) return err->status;
    free(in->bytes);
    in->bytes = malloc(strlen(word) + 1);
    if (!in->bytes) return err_nomem(err, what, strlen(word));
    if (base64_read(in->bytes, &in->size, word)) return ST_OK;
    return textfile_error(in->t, err, "other characters", "%s in base64", what);
}

/* Signed numbers, or light. */
static enum status read_values(struct reading *in, float *to, size_t count, double most, bool is_signed,
                               struct err *err)
{
    if (read_bytes(in, "numbers", err)) return err->status;
    if (in->size != 2 * count) return textfile_error(in->t, err, "another count of them", "%zu numbers", count);
    if (is_signed)
        light_codes_take_signed(to, in->bytes, count, most);
    else
        light_codes_take(to, in->bytes, count, most);
    return ST_OK;
}

static enum status read_runs(struct reading *in, int *to, size_t count, int most, struct err *err)
{
    if (read_bytes(in, "runs of numbers", err)) return err->status;
    if (!light_codes_take_runs(to, in->bytes, in->size, count))
        return textfile_error(in->t, err, "other runs", "runs of %zu numbers", count);
    for (size_t i = 0; i < count; i++)
        if (to[i] > most) return textfile_wrong_number(in->t, to[i], "a number of what the file has", err);
    return ST_OK;
}

static enum status read_whole(struct reading *in, const char *what, int most, int *to, struct err *err)
{
    int64_t value;
    if (!textfile_int(in->t, what, 0, most, &value, err)) *to = (int)value;
    return err->status;
}

static enum status read_vector(struct reading *in, struct vec3 *v, struct err *err)
{
    double c[3];
    for (int k = 0; k < 3; k++)
        if (textfile_double(in->t, "a coordinate", &c[k], err)) return err->status;
    *v = vec3_make(c[0], c[1], c[2]);
    return ST_OK;
}

static enum status read_head(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    if (textfile_expect_line(in->t, FIRST, err) || textfile_expect_line(in->t, "remodel-relit", err) ||
        textfile_expect(in->t, "1", err) || textfile_expect_line(in->t, "places", err) ||
        read_whole(in, "a count of places", MOST, &r->places, err) ||
        read_whole(in, "the first place of furniture", r->places, &r->things, err) ||
        read_whole(in, "a count of suns", MOST_SIDE, &r->shade_count, err) ||
        textfile_expect_line(in->t, "scale", err) || textfile_number(in->t, "a scale", 0, INFINITY, &r->scale, err) ||
        textfile_expect_line(in->t, "horizontal", err))
        return err->status;
    r->normals = calloc((size_t)(r->places - r->things) + 1, sizeof *r->normals);
    if (!r->normals) return err_nomem(err, "normals", (size_t)r->places * sizeof *r->normals);
    return textfile_number(in->t, "an illuminance", 0, INFINITY, &r->horizontal, err);
}

static enum status read_lamp(struct reading *in, enum relit_lamp_kind kind, struct err *err)
{
    struct relit_light *r = in->r;
    if (array_append(&r->lamps, (size_t)r->lamp_count, sizeof *r->lamps, "lamps", err)) return err->status;
    struct relit_lamp *lamp = &r->lamps[r->lamp_count++];
    *lamp = (struct relit_lamp){kind, NULL, false};
    if (read_name(&lamp->name, in, err)) return err->status;
    lamp->on = kind == RELIT_PLANNED && textfile_more(in->t);
    return lamp->on ? textfile_expect(in->t, "on", err) : ST_OK;
}

static enum status read_window(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    if (array_append(&r->windows, (size_t)r->window_count, sizeof *r->windows, "windows", err)) return err->status;
    r->windows[r->window_count++] = NULL;
    return read_name(&r->windows[r->window_count - 1], in, err);
}

static enum status read_field(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    const size_t count = 3 * (size_t)r->places;
    char *word;
    double most;
    int kind = 0;
    if (textfile_word(in->t, "a kind of light", &word, err)) return err->status;
    while (kind < RELIT_PART && strcmp(word, field_words[kind]) != 0) kind++;
    if (strcmp(word, field_words[kind]) != 0)
        return textfile_error(in->t, err, word, "texture, lamp, window, level or part");
    const int of = kind == RELIT_LAMP ? r->lamp_count : kind == RELIT_TEXTURE ? 1 : r->window_count;
    if (array_append(&r->fields, (size_t)r->field_count, sizeof *r->fields, "fields", err)) return err->status;
    struct relit_field *f = &r->fields[r->field_count++];
    *f = (struct relit_field){(enum relit_kind)kind, 0, malloc((count + 1) * sizeof *f->values)};
    if (!f->values) return err_nomem(err, "light of places", count * sizeof *f->values);
    if (read_whole(in, "a lamp or window that the file has", of - 1, &f->of, err) ||
        textfile_number(in->t, "the most of the light", 0, INFINITY, &most, err))
        return err->status;
    r->part_count += kind == RELIT_PART;
    return read_values(in, f->values, count, most, kind == RELIT_PART, err);
}

static enum status read_sky(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    char *word;
    int64_t shade;
    if (textfile_word(in->t, "a sky", &word, err) ||
        array_append(&r->skies, (size_t)r->sky_count, sizeof *r->skies, "skies", err))
        return err->status;
    struct relit_sky *s = &r->skies[r->sky_count++];
    *s = (struct relit_sky){.mixes = calloc((size_t)r->part_count + 1, sizeof *s->mixes)};
    if (!s->mixes) return err_nomem(err, "a sky", (size_t)r->part_count * sizeof *s->mixes);
    s->state.sky = STATE_SKY_NONE;
    for (int k = 0; k < 3; k++)
        if (!strcmp(word, cover_words[k])) {
            s->state.sky = STATE_SKY_TIME;
            s->state.cover = (enum sky_cover)k;
        }
    if (!strcmp(word, "overcast")) s->state.sky = STATE_SKY_OVERCAST;
    if (!strcmp(word, "weather")) s->state.sky = STATE_SKY_WEATHER;
    if (s->state.sky == STATE_SKY_NONE)
        return textfile_error(in->t, err, word, "overcast, clear, partly, cloudy or weather");
    if (read_whole(in, "a month", 12, &s->state.time.month, err) ||
        read_whole(in, "a day", 31, &s->state.time.day, err) ||
        textfile_double(in->t, "an hour", &s->state.time.hour, err) ||
        textfile_number(in->t, "an illuminance", 0, INFINITY, &s->horizontal, err) ||
        textfile_number(in->t, "an illuminance", 0, INFINITY, &s->sun, err) || read_vector(in, &s->to_sun, err) ||
        textfile_int(in->t, "the number of a sun", -1, r->shade_count - 1, &shade, err))
        return err->status;
    s->shade = (int)shade;
    if (s->state.sky == STATE_SKY_OVERCAST) s->state.horizontal = s->state.time.hour;
    for (int k = 0; !err->status && k < r->part_count; k++) textfile_double(in->t, "a part", &s->mixes[k], err);
    return err->status;
}

static enum status read_face(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    if (array_append(&r->faces, (size_t)r->face_count, sizeof *r->faces, "faces", err)) return err->status;
    struct relit_face *f = &r->faces[r->face_count++];
    *f = (struct relit_face){.places = NULL};
    if (read_vector(in, &f->normal, err) || textfile_double(in->t, "an offset", &f->offset, err) ||
        read_vector(in, &f->u, err) || read_vector(in, &f->v, err) ||
        textfile_double(in->t, "a place", &f->low[0], err) || textfile_double(in->t, "a place", &f->low[1], err) ||
        textfile_number(in->t, "a step", 0, INFINITY, &f->step[0], err) ||
        textfile_number(in->t, "a step", 0, INFINITY, &f->step[1], err) ||
        read_whole(in, "columns", MOST_SIDE, &f->columns, err) || read_whole(in, "rows", MOST_SIDE, &f->rows, err))
        return err->status;
    const size_t cells = (size_t)f->columns * (size_t)f->rows;
    if (!cells) return textfile_error(in->t, err, "a face without cells", "one with cells");
    f->places = malloc((cells + 1) * sizeof *f->places);
    if (!f->places) return err_nomem(err, "cells", cells * sizeof *f->places);
    read_runs(in, f->places, cells, r->places, err);
    for (size_t i = 0; !err->status && i < cells; i++) f->places[i]--;
    return err->status;
}

static enum status read_normals(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    const size_t count = 3 * (size_t)(r->places - r->things);
    float *values = malloc((count + 1) * sizeof *values);
    if (!values) return err_nomem(err, "normals", count * sizeof *values);
    if (!read_values(in, values, count, 1, true, err))
        for (int i = 0; i < r->places - r->things; i++)
            r->normals[i] = vec3_make((double)values[3 * i], (double)values[3 * i + 1], (double)values[3 * i + 2]);
    free(values);
    return err->status;
}

static enum status read_photo(struct reading *in, struct err *err)
{
    struct relit_light *r = in->r;
    if (array_append(&r->photos, (size_t)r->photo_count, sizeof *r->photos, "photos", err)) return err->status;
    struct relit_photo *p = &r->photos[r->photo_count++];
    *p = (struct relit_photo){.name = NULL};
    if (read_name(&p->name, in, err) || read_whole(in, "a width", MOST_SIDE, &p->width, err) ||
        read_whole(in, "a height", MOST_SIDE, &p->height, err) || read_vector(in, &p->from, err))
        return err->status;
    if (p->width < 2 || p->height < 2)
        return textfile_wrong_number(in->t, p->width < p->height ? p->width : p->height, "at least 2 px", err);
    const size_t rays = (size_t)relit_light_lens_size(p->width) * (size_t)relit_light_lens_size(p->height);
    p->rays = malloc(3 * rays * sizeof *p->rays);
    p->pixels = calloc((size_t)p->width * (size_t)p->height, sizeof *p->pixels);
    p->shades = calloc((size_t)r->shade_count + 1, sizeof *p->shades);
    if (!p->rays || !p->pixels || !p->shades) return err_nomem(err, "a photo", 3 * rays * sizeof *p->rays);
    return read_values(in, p->rays, 3 * rays, 1, true, err);
}

/* Lines after that of a photo. */
static enum status read_of_photo(struct reading *in, const char *word, struct err *err)
{
    struct relit_light *r = in->r;
    struct relit_photo *p = &r->photos[r->photo_count - 1];
    const size_t pixels = (size_t)p->width * (size_t)p->height, half = (size_t)(p->width / 2) * (size_t)(p->height / 2);
    int shade = 0;
    if (!strcmp(word, "pixels"))
        return read_runs(in, p->pixels, pixels, r->window_count + r->lamp_count + r->face_count + r->places - r->things,
                         err);
    if (!strcmp(word, "picture")) {
        if (read_bytes(in, "a JPEG", err)) return err->status;
        free(p->jpeg);
        p->jpeg = in->bytes;
        p->jpeg_size = in->size;
        in->bytes = NULL;
        return ST_OK;
    }
    if (read_whole(in, "the number of a sun", r->shade_count - 1, &shade, err)) return err->status;
    if (p->shades[shade]) return textfile_error(in->t, err, "a sun twice", "each sun once");
    if (!(p->shades[shade] = calloc(half + 1, sizeof **p->shades)))
        return err_nomem(err, "a photo", half * sizeof **p->shades);
    return read_runs(in, p->shades[shade], half, r->window_count, err);
}

static enum status read_line(struct reading *in, struct err *err)
{
    char *word;
    if (textfile_word(in->t, "a statement", &word, err)) return err->status;
    for (int k = 0; k < 3; k++)
        if (!strcmp(word, lamp_words[k])) return read_lamp(in, (enum relit_lamp_kind)k, err);
    if (!strcmp(word, "window")) return read_window(in, err);
    if (!strcmp(word, "field")) return read_field(in, err);
    if (!strcmp(word, "sky")) return read_sky(in, err);
    if (!strcmp(word, "face")) return read_face(in, err);
    if (!strcmp(word, "normals")) return read_normals(in, err);
    if (!strcmp(word, "photo")) return read_photo(in, err);
    if (in->r->photo_count && (!strcmp(word, "pixels") || !strcmp(word, "shade") || !strcmp(word, "picture")))
        return read_of_photo(in, word, err);
    return textfile_error(in->t, err, word, "lamp, rest, planned, window, field, sky, face, normals or photo");
}

enum status relit_file_read(struct relit_light *r, const char *path, struct err *err)
{
    struct textfile t = {0};
    struct reading in = {.r = r, .t = &t};
    bool ended = false;
    *r = (struct relit_light){.places = 0};
    if (!textfile_open(&t, path, err)) read_head(&in, err);
    while (!err->status && !ended && textfile_next(&t)) {
        ended = !strncmp(t.cursor, LAST, strlen(LAST));
        if (!ended && !read_line(&in, err)) textfile_end(&t, err);
    }
    if (!err->status && !ended) textfile_error(&t, err, NULL, "%s", LAST);
    if (!err->status && r->sky_count && !r->part_count && !r->field_count)
        textfile_error(&t, err, "skies without light", "lines of light");
    free(in.bytes);
    textfile_release(&t);
    return err->status;
}
