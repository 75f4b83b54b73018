/* scene_file.c - see scene_file.h. Each kind of line has its own function; scene_reader.h lists them. */
#include "stages/simulate/scene_file.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "stages/simulate/scene_reader.h"

/* --------------------------------------------------------------------------------------------------------- outdoors */

static enum status read_sun(struct reader *r, struct err *err)
{
    struct sun *sun = &r->scene->sky.sun;
    if (r->scene->sky.has_sun) return textfile_error(&r->file, err, "a second sun", "at most one");
    if (!textfile_number(&r->file, "the sun's azimuth in degrees", -360, 360, &sun->azimuth, err) &&
        !textfile_number(&r->file, "the sun's elevation in degrees", -90, 90, &sun->elevation, err) &&
        !textfile_number(&r->file, "the sun's angular radius in degrees", 0.05, 30, &sun->angular_radius, err) &&
        !scene_read_colour(r, "a radiance", MAX_RADIANCE, &sun->radiance, err))
        textfile_end(&r->file, err);
    r->scene->sky.has_sun = !err->status;
    if (r->in_base) r->sun_line = r->file.line;
    return err->status;
}

static enum status read_panorama(struct reader *r, struct err *err)
{
    struct panorama *p = &r->scene->sky.panorama;
    if (r->scene->sky.has_panorama) return textfile_error(&r->file, err, "a second panorama", "at most one");
    if (!scene_read_seed(r, &p->seed, err) && !scene_read_colour(r, "the sky's radiance", MAX_RADIANCE, &p->sky, err) &&
        !scene_read_colour(r, "the ground's radiance", MAX_RADIANCE, &p->ground, err))
        textfile_end(&r->file, err);
    r->scene->sky.has_panorama = !err->status;
    if (r->in_base) r->panorama_line = r->file.line;
    return err->status;
}

/* sky TYPE|perez A B C D E  R G B  R G B: in place of a panorama. */
static enum status read_shape(struct reader *r, struct panorama *p, struct err *err)
{
    char *word;
    double type = 0, *const numbers[] = {&p->shape.a, &p->shape.b, &p->shape.c, &p->shape.d, &p->shape.e};
    p->has_shape = true;
    if (textfile_word(&r->file, "a type of sky, 1 to 16, or perez", &word, err)) return err->status;
    if (!strcmp(word, "perez")) {
        for (int i = 0; !err->status && i < 5; i++)
            textfile_number(&r->file, "a coefficient of the sky", -1000, 1000, numbers[i], err);
        return err->status;
    }
    if (textfile_number_of(&r->file, word, "a type of sky", 1, SKY_TRADITIONAL, &type, err)) return err->status;
    if (type != floor(type)) return textfile_wrong_number(&r->file, type, "a whole number", err);
    p->shape = sky_standard_shape((int)type);
    return ST_OK;
}

static enum status read_sky(struct reader *r, struct err *err)
{
    struct panorama *p = &r->scene->sky.panorama;
    if (r->scene->sky.has_panorama) return textfile_error(&r->file, err, "a sky beside a panorama", "at most one");
    *p = (struct panorama){.seed = 0};
    if (!read_shape(r, p, err) && !scene_read_colour(r, "the zenith's radiance", MAX_RADIANCE, &p->sky, err) &&
        !scene_read_colour(r, "the ground's radiance", MAX_RADIANCE, &p->ground, err))
        textfile_end(&r->file, err);
    r->scene->sky.has_panorama = !err->status;
    if (r->in_base) r->panorama_line = r->file.line;
    return err->status;
}

/* ------------------------------------------------------------------------------------------------------------- file */

static enum status read_file(struct reader *r, const char *file, struct err *err);

/* base FILE: everything that FILE beside this one describes. */
static enum status read_base(struct reader *r, struct err *err)
{
    struct scene *s = r->scene;
    char *file = NULL;
    if (r->in_base) return textfile_error(&r->file, err, "base", "a complete description, because it is a base itself");
    if (r->statements) return textfile_error(&r->file, err, "base", "it on the first line below the header");
    if (!textfile_word(&r->file, "the base's file, such as scene.txt", &file, err) &&
        (strchr(file, '/') || *file == '.'))
        textfile_error(&r->file, err, file, "the name of a file beside this one, without a folder");
    if (!err->status && !textfile_end(&r->file, err) && !(s->base = strdup(file)))
        err_nomem(err, "a file name", strlen(file));
    if (err->status) return err->status;
    struct reader outer = *r;
    r->file = (struct textfile){0};
    r->in_base = true;
    if (read_file(r, s->base, err)) err_context(err, "%s:%d", outer.file.path, outer.file.line);
    outer.base_items = s->item_count;
    outer.sun_line = r->sun_line, outer.panorama_line = r->panorama_line;
    *r = outer;
    return err->status;
}

static enum status read_furniture(struct reader *r, struct err *err)
{
    static const char *const words[] = {"off", "on"};
    int word = 0;
    if (!scene_read_choice(r, words, 2, "the state of furniture", &word, err)) textfile_end(&r->file, err);
    r->furniture = word;
    return err->status;
}

static enum status read_line(struct reader *r, struct err *err)
{
    static const char *const words[] = {"texture", "material",  "glow", "sun",  "panorama", "base",
                                        "drop",    "furniture", "sky",  "wall", "opening",  "window",
                                        "box",     "quad",      "mesh", "room", "lamp"};
    static enum status (*const lines[])(struct reader *, struct err *) = {
        scene_read_texture, scene_read_material, scene_read_glow, read_sun, read_panorama,
        read_base,          scene_read_drop,     read_furniture,  read_sky};
    enum { LINES = sizeof lines / sizeof *lines, WORDS = sizeof words / sizeof *words, FIRST_OF_2 = 5 };
    int word = 0;
    scene_read_choice(r, words, WORDS, "a line of a scene", &word, err);
    if (!err->status && word >= FIRST_OF_2 && word < LINES && r->version < 2)
        textfile_error(&r->file, err, words[word], "the header `remodel-scene 2` above a line of this kind");
    if (err->status) return err->status;
    return word < LINES ? lines[word](r, err) : scene_read_item(r, (enum item_kind)(word - LINES), err);
}

static enum status read_file(struct reader *r, const char *file, struct err *err)
{
    char *path = NULL;
    if (asprintf(&path, "%s/%s", r->folder, file) < 0) return err_nomem(err, "a file name", strlen(file));
    if (!textfile_open(&r->file, path, err)) description_header(&r->file, "remodel-scene", 2, &r->version, err);
    for (r->statements = 0; !err->status && textfile_next(&r->file); r->statements++) read_line(r, err);
    if (!err->status && r->prov) provenance_add_file(r->prov, file, path, err);
    textfile_release(&r->file);
    free(path);
    return err->status;
}

static bool emits(struct rgb c) { return rgb_max(c) > 0; }

static bool has_light(const struct scene *s)
{
    if (s->sky.has_sun && emits(s->sky.sun.radiance)) return true;
    if (s->sky.has_panorama && (emits(s->sky.panorama.sky) || emits(s->sky.panorama.ground))) return true;
    for (int i = 0; i < s->item_count; i++)
        if (emits(s->items[i].radiance)) return true;
    for (int i = 0; i < s->material_count; i++)
        if (emits(s->materials[i].glow)) return true;
    return false;
}

enum status scene_read(struct scene *s, const char *folder, const char *file, struct provenance *prov, struct err *err)
{
    struct reader r = {.scene = s, .folder = folder, .prov = prov};
    *s = (struct scene){0};
    read_file(&r, file, err);
    textfile_release(&r.file);
    if (!err->status && !s->item_count)
        err_set(err, ST_DATA, "%s/%s has no surfaces; add a room, a box or a quad.", folder, file);
    if (!err->status && !has_light(s))
        err_set(err, ST_DATA,
                "%s/%s has no light: every photo would be black; add a lamp, a sun, a sky or a panorama with a "
                "positive radiance.",
                folder, file);
    if (err->status) scene_release(s);
    return err->status;
}

void scene_release(struct scene *s)
{
    if (!s) return;
    for (int i = 0; i < s->texture_count; i++) free(s->textures[i].name);
    for (int i = 0; i < s->material_count; i++) free(s->materials[i].name);
    for (int i = 0; i < s->item_count; i++) scene_item_release(&s->items[i]);
    free(s->textures);
    free(s->materials);
    free(s->items);
    free(s->base);
    free(s->dropped);
    *s = (struct scene){0};
}
