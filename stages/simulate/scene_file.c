/* scene_file.c - see scene_file.h. One function reads one kind of line. */
#include "stages/simulate/scene_file.h"

#include <ctype.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/scan.h"
#include "common/base/textfile.h"
#include "stages/simulate/mesh_file.h"

#define MOST_METRES   1e5
#define LEAST_METRES  1e-6
#define MOST_RADIANCE 1e9
#define MOST_PER_KIND 100000
#define PERPENDICULAR 1e-6 /* cosine of a right angle, at most */

struct reader {
    struct scene *scene;
    struct textfile file;
    const char *folder;
    struct provenance *prov;
};

/* ----------------------------------------------------------------------------------------------------- words, numbers */

static enum status number(struct reader *r, const char *what, double least, double most, double *value, struct err *err)
{
    char *word = NULL;
    enum status st = textfile_word(&r->file, what, &word, err);
    if (st) return st;
    if (!scan_double(word, value) || *value < least || *value > most)
        return textfile_error(&r->file, err, word, "%s, a number from %g to %g", what, least, most);
    return ST_OK;
}

static enum status place(struct reader *r, const char *what, struct vec3 *p, struct err *err)
{
    enum status st = number(r, what, -MOST_METRES, MOST_METRES, &p->x, err);
    if (!st) st = number(r, what, -MOST_METRES, MOST_METRES, &p->y, err);
    if (!st) st = number(r, what, -MOST_METRES, MOST_METRES, &p->z, err);
    return st;
}

/* Two numbers, the second one larger. */
static enum status range(struct reader *r, const char *what, double *from, double *to, struct err *err)
{
    enum status st = number(r, what, -MOST_METRES, MOST_METRES, from, err);
    if (!st) st = number(r, what, *from + LEAST_METRES, MOST_METRES, to, err);
    return st;
}

static enum status colour(struct reader *r, const char *what, double most, struct rgb *c, struct err *err)
{
    enum status st = number(r, what, 0, most, &c->r, err);
    if (!st) st = number(r, what, 0, most, &c->g, err);
    if (!st) st = number(r, what, 0, most, &c->b, err);
    return st;
}

static enum status seed(struct reader *r, uint32_t *value, struct err *err)
{
    int64_t n = 0;
    enum status st = textfile_int(&r->file, "a seed", 0, UINT32_MAX, &n, err);
    *value = (uint32_t)n;
    return st;
}

/* A word of a list; *index is its place there. */
static enum status choice(struct reader *r, const char *const *words, int count, const char *what, int *index,
                          struct err *err)
{
    char *word = NULL, known[300] = "";
    enum status st = textfile_word(&r->file, what, &word, err);
    if (st) return st;
    for (int i = 0; i < count; i++) {
        if (!strcmp(word, words[i])) {
            *index = i;
            return ST_OK;
        }
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", i ? ", " : "", words[i]);
    }
    return textfile_error(&r->file, err, word, "%s: one of %s", what, known);
}

/* A new name: letters, digits, _ and -. The caller frees it. */
static enum status new_name(struct reader *r, char **name, struct err *err)
{
    char *word = NULL;
    enum status st = textfile_word(&r->file, "a name", &word, err);
    if (st) return st;
    bool good = *word && strlen(word) <= 64;
    for (const char *p = word; *p; p++) good = good && (isalnum((unsigned char)*p) || *p == '_' || *p == '-');
    if (!good) return textfile_error(&r->file, err, word, "a name of at most 64 letters, digits, _ and -");
    *name = strdup(word);
    return *name ? ST_OK : err_nomem(err, "a name", strlen(word) + 1);
}

static enum status taken(struct reader *r, const char *name, const char *what, struct err *err)
{
    return textfile_error(&r->file, err, name, "a name that no other %s of the scene has", what);
}

static enum status unknown(struct reader *r, const char *found, const char *what,
                           const char *(*next)(const void *ctx, int i), struct err *err)
{
    const char *near = scan_nearest(found, next, r->scene);
    if (near) return textfile_error(&r->file, err, found, "the name of a %s above; did you mean %s", what, near);
    return textfile_error(&r->file, err, found, "the name of a %s above", what);
}

static const char *next_texture(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->texture_count ? s->textures[i].name : NULL;
}

static const char *next_material(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->material_count ? s->materials[i].name : NULL;
}

static const char *next_item(const void *ctx, int i)
{
    const struct scene *s = ctx;
    return i < s->item_count ? s->items[i].name : NULL;
}

static int find(const struct scene *s, const char *name, const char *(*next)(const void *ctx, int i))
{
    const char *other;
    for (int i = 0; (other = next(s, i)); i++)
        if (!strcmp(name, other)) return i;
    return -1;
}

static enum status known(struct reader *r, const char *what, const char *(*next)(const void *ctx, int i), int *index,
                         struct err *err)
{
    char *word = NULL, wanted[80];
    snprintf(wanted, sizeof wanted, "the name of a %s", what);
    enum status st = textfile_word(&r->file, wanted, &word, err);
    if (!st && (*index = find(r->scene, word, next)) < 0) st = unknown(r, word, what, next, err);
    return st;
}

/* Room for one more element, zeroed. */
static enum status add(struct reader *r, void **list, int count, size_t size, struct err *err)
{
    if (count == MOST_PER_KIND) return textfile_error(&r->file, err, "one more", "at most %d lines of a kind", count);
    if (!(count & (count - 1))) { /* a power of two, or none: full */
        void *grown = realloc(*list, (size_t)(count ? 2 * count : 1) * size);
        if (!grown) return err_nomem(err, "a scene", (size_t)(count ? 2 * count : 1) * size);
        *list = grown;
    }
    memset((char *)*list + (size_t)count * size, 0, size);
    return ST_OK;
}

/* ------------------------------------------------------------------------------------------------ textures, materials */

static const char *const texture_words[TEXTURE_KINDS] = {"rgb",     "checker", "wood", "brick",
                                                         "plaster", "print",   "books"};

static enum status size_of(struct reader *r, const char *what, double *value, struct err *err)
{
    return number(r, what, 1e-4, 1e4, value, err);
}

static enum status read_texture(struct reader *r, struct err *err)
{
    struct scene *s = r->scene;
    struct scene_texture made = {0};
    struct texture *t = &made.texture;
    int kind = 0;
    void *list = s->textures;
    enum status st = new_name(r, &made.name, err);
    if (!st && find(s, made.name, next_texture) >= 0) st = taken(r, made.name, "texture", err);
    if (!st) st = choice(r, texture_words, TEXTURE_KINDS, "a kind of texture", &kind, err);
    if (!st) {
        t->kind = (enum texture_kind)kind;
        const bool two = t->kind == TEXTURE_CHECKER || t->kind == TEXTURE_WOOD || t->kind == TEXTURE_BRICK;
        const bool made_up = t->kind == TEXTURE_PRINT || t->kind == TEXTURE_BOOKS;
        if (t->kind == TEXTURE_CHECKER) st = size_of(r, "the size of a square", &t->size[0], err);
        if (t->kind == TEXTURE_WOOD || t->kind == TEXTURE_PLASTER) st = size_of(r, "a scale", &t->size[0], err);
        if (t->kind == TEXTURE_PLASTER) st = st ? st : number(r, "an amount", 0, 1, &t->size[1], err);
        if (t->kind == TEXTURE_BRICK) {
            st = size_of(r, "the width of a brick", &t->size[0], err);
            if (!st) st = size_of(r, "the height of a brick", &t->size[1], err);
            if (!st) st = number(r, "the width of the mortar", 0, fmin(t->size[0], t->size[1]), &t->size[2], err);
        }
        if (!st && t->kind != TEXTURE_RGB && t->kind != TEXTURE_CHECKER) st = seed(r, &t->seed, err);
        if (made_up) {
            if (!st) st = size_of(r, "a width", &t->size[0], err);
            if (!st) st = size_of(r, "a height", &t->size[1], err);
        } else {
            if (!st) st = colour(r, "a colour from 0 to 1", 1, &t->colour[0], err);
            if (!st && two) st = colour(r, "the second colour, from 0 to 1", 1, &t->colour[1], err);
        }
    }
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = add(r, &list, s->texture_count, sizeof made, err);
    if (!st) {
        s->textures = list;
        s->textures[s->texture_count++] = made;
    } else {
        free(made.name);
    }
    return st;
}

static enum status read_material(struct reader *r, struct err *err)
{
    static const char *const words[] = {"lambert", "phong", "ward"};
    struct scene *s = r->scene;
    struct scene_material made = {0};
    int kind = 0;
    void *list = s->materials;
    enum status st = new_name(r, &made.name, err);
    if (!st && find(s, made.name, next_material) >= 0) st = taken(r, made.name, "material", err);
    if (!st) st = choice(r, words, 3, "a kind of material", &kind, err);
    if (!st) st = known(r, "texture", next_texture, &made.texture, err);
    made.kind = (enum brdf_kind)kind;
    if (!st && made.kind != BRDF_LAMBERT) {
        st = number(r, "a strength of the gloss", 0, 1e6, &made.ks, err);
        if (!st && made.kind == BRDF_PHONG) st = number(r, "an exponent", 1, 1e6, &made.shape, err);
        if (!st && made.kind == BRDF_WARD) st = number(r, "a roughness", 0.01, 1, &made.shape, err);
    }
    if (!st) {
        const double albedo = texture_bound(&s->textures[made.texture].texture);
        made.gloss = brdf_gloss_albedo(made.kind, made.ks, made.shape);
        if (albedo + made.gloss > 1 + 1e-9) {
            char found[100];
            snprintf(found, sizeof found, "albedo up to %.3g and gloss of %.3g", albedo, made.gloss);
            st = textfile_error(&r->file, err, found, "no more than 1 together");
        }
    }
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = add(r, &list, s->material_count, sizeof made, err);
    if (!st) {
        s->materials = list;
        s->materials[s->material_count++] = made;
    } else {
        free(made.name);
    }
    return st;
}

static enum status read_glow(struct reader *r, struct err *err)
{
    int material = 0;
    struct rgb glow;
    enum status st = known(r, "material", next_material, &material, err);
    if (!st) st = colour(r, "a radiance", MOST_RADIANCE, &glow, err);
    if (!st) st = textfile_end(&r->file, err);
    if (!st) r->scene->materials[material].glow = glow;
    return st;
}

/* --------------------------------------------------------------------------------------------------------------- items */

static enum status material_of(struct reader *r, int *material, struct err *err)
{
    return known(r, "material", next_material, material, err);
}

static enum status read_wall(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = number(r, "x of the wall's begin", -MOST_METRES, MOST_METRES, &it->x0, err);
    if (!st) st = number(r, "y of the wall's begin", -MOST_METRES, MOST_METRES, &it->y0, err);
    if (!st) st = number(r, "x of the wall's end", -MOST_METRES, MOST_METRES, &it->x1, err);
    if (!st) st = number(r, "y of the wall's end", -MOST_METRES, MOST_METRES, &it->y1, err);
    if (!st && hypot(it->x1 - it->x0, it->y1 - it->y0) < LEAST_METRES)
        st = textfile_error(&r->file, err, "the same place twice", "a wall with a length");
    if (!st) st = range(r, "the wall's height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (!st) st = number(r, "a thickness", LEAST_METRES, 100, &it->thickness, err);
    if (!st) st = material_of(r, &it->material, err);
    return st;
}

static enum status read_opening(struct reader *r, struct scene_item *it, struct err *err)
{
    const struct scene *s = r->scene;
    int wall = 0;
    enum status st = known(r, "wall", next_item, &wall, err);
    if (!st && s->items[wall].kind != ITEM_WALL)
        st = textfile_error(&r->file, err, s->items[wall].name, "the name of a wall above");
    if (!st) st = range(r, "the place along the wall: S0, then a larger S1", &it->s0, &it->s1, err);
    if (!st) st = range(r, "the height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (st) return st;
    const struct scene_item *w = &s->items[wall];
    const double length = hypot(w->x1 - w->x0, w->y1 - w->y0);
    it->wall = wall;
    it->material = w->material;
    if (it->s0 < 0 || it->s1 > length + LEAST_METRES || it->z0 < w->z0 || it->z1 > w->z1) {
        char found[160];
        snprintf(found, sizeof found, "%g to %g m along, %g to %g m high", it->s0, it->s1, it->z0, it->z1);
        return textfile_error(&r->file, err, found, "a place inside wall %s: 0 to %g m along, %g to %g m high", w->name,
                              length, w->z0, w->z1);
    }
    for (int i = 0; i < s->item_count; i++) {
        const struct scene_item *o = &s->items[i];
        if ((o->kind != ITEM_OPENING && o->kind != ITEM_WINDOW) || o->wall != wall) continue;
        if (it->s0 < o->s1 && o->s0 < it->s1 && it->z0 < o->z1 && o->z0 < it->z1)
            return textfile_error(&r->file, err, it->name, "an opening that does not reach into %s", o->name);
    }
    return ST_OK;
}

static enum status read_turn(struct reader *r, struct scene_item *it, struct err *err)
{
    return number(r, "an angle in degrees", -360, 360, &it->turn, err);
}

static enum status read_box(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"turn"};
    struct vec3 a, b;
    int word = 0;
    enum status st = place(r, "a corner of the box", &a, err);
    if (!st) st = number(r, "X1, larger than X0", a.x + LEAST_METRES, MOST_METRES, &b.x, err);
    if (!st) st = number(r, "Y1, larger than Y0", a.y + LEAST_METRES, MOST_METRES, &b.y, err);
    if (!st) st = number(r, "Z1, larger than Z0", a.z + LEAST_METRES, MOST_METRES, &b.z, err);
    if (!st) st = material_of(r, &it->material, err);
    if (!st && textfile_more(&r->file)) {
        st = choice(r, words, 1, "what follows a box", &word, err);
        if (!st) st = read_turn(r, it, err);
    }
    if (st) return st;
    it->x0 = a.x, it->y0 = a.y, it->z0 = a.z;
    it->x1 = b.x, it->y1 = b.y, it->z1 = b.z;
    return ST_OK;
}

static enum status read_edges(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = place(r, "a corner", &it->at, err);
    if (!st) st = place(r, "the first edge", &it->u, err);
    if (!st) st = place(r, "the second edge", &it->v, err);
    if (!st && vec3_length(vec3_cross(it->u, it->v)) < LEAST_METRES * LEAST_METRES)
        st = textfile_error(&r->file, err, "edges without an area between them", "two edges that span one");
    return st;
}

static enum status read_quad(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = read_edges(r, it, err);
    if (!st) st = material_of(r, &it->material, err);
    return st;
}

static enum status read_room(struct reader *r, struct scene_item *it, struct err *err)
{
    enum status st = number(r, "X0", -MOST_METRES, MOST_METRES, &it->x0, err);
    if (!st) st = number(r, "Y0", -MOST_METRES, MOST_METRES, &it->y0, err);
    if (!st) st = number(r, "X1, larger than X0", it->x0 + LEAST_METRES, MOST_METRES, &it->x1, err);
    if (!st) st = number(r, "Y1, larger than Y0", it->y0 + LEAST_METRES, MOST_METRES, &it->y1, err);
    if (!st) st = range(r, "the room's height: Z0, then a larger Z1", &it->z0, &it->z1, err);
    if (!st) st = material_of(r, &it->material, err);
    if (!st) st = material_of(r, &it->ceiling, err);
    return st;
}

static enum status read_mesh(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"at", "scale", "turn"};
    char *file = NULL, *path = NULL;
    it->scale = 1;
    enum status st = textfile_word(&r->file, "a mesh file, .obj", &file, err);
    if (!st && (strchr(file, '/') || *file == '.'))
        st = textfile_error(&r->file, err, file, "the name of a file beside the scene, without a folder");
    if (!st && asprintf(&path, "%s/%s", r->folder, file) < 0) {
        path = NULL;
        st = err_nomem(err, "a file name", strlen(r->folder) + strlen(file));
    }
    if (!st && (st = mesh_file_read(&it->triangles, &it->triangle_count, path, err)))
        err_context(err, "%s:%d", r->file.path, r->file.line);
    if (!st && r->prov) st = provenance_add_file(r->prov, file, path, err);
    if (!st) st = material_of(r, &it->material, err);
    while (!st && textfile_more(&r->file)) {
        int word = 0;
        st = choice(r, words, 3, "what follows a mesh", &word, err);
        if (!st && word == 0) st = place(r, "where the mesh stands", &it->at, err);
        if (!st && word == 1) st = number(r, "a scale", 1e-6, 1e6, &it->scale, err);
        if (!st && word == 2) st = read_turn(r, it, err);
    }
    free(path);
    return st;
}

static enum status read_lamp(struct reader *r, struct scene_item *it, struct err *err)
{
    static const char *const words[] = {"quad", "disk"};
    int kind = 0;
    it->material = -1;
    enum status st = choice(r, words, 2, "a kind of lamp", &kind, err);
    if (st) return st;
    it->kind = kind ? ITEM_LAMP_DISK : ITEM_LAMP_QUAD;
    if (it->kind == ITEM_LAMP_QUAD) {
        st = read_edges(r, it, err);
        if (!st && fabs(vec3_dot(vec3_normalize(it->u), vec3_normalize(it->v))) > PERPENDICULAR)
            st = textfile_error(&r->file, err, "slanted edges", "edges at a right angle");
        if (!st) st = colour(r, "a radiance", MOST_RADIANCE, &it->radiance, err);
        return st;
    }
    st = place(r, "the centre", &it->at, err);
    if (!st) st = place(r, "the direction", &it->u, err);
    if (!st && !(vec3_length(it->u) > 0)) st = textfile_error(&r->file, err, "0 0 0", "a direction");
    if (!st) st = number(r, "a radius", 1e-4, 1e3, &it->radius, err);
    if (!st) st = colour(r, "a radiance", MOST_RADIANCE, &it->radiance, err);
    if (!st) st = number(r, "half the angle of the cone, in degrees", 0.5, 90, &it->half_angle, err);
    if (!st && textfile_more(&r->file)) st = number(r, "an exponent", 0, 1000, &it->exponent, err);
    return st;
}

typedef enum status item_reader(struct reader *r, struct scene_item *it, struct err *err);

static enum status read_item(struct reader *r, enum item_kind kind, item_reader *read, struct err *err)
{
    struct scene *s = r->scene;
    struct scene_item made = {.kind = kind};
    void *list = s->items;
    enum status st = new_name(r, &made.name, err);
    if (!st && find(s, made.name, next_item) >= 0)
        st = taken(r, made.name, "wall, opening, window, box, quad, mesh, room or lamp", err);
    if (!st) st = read(r, &made, err);
    if (!st) st = textfile_end(&r->file, err);
    if (!st) st = add(r, &list, s->item_count, sizeof made, err);
    if (!st) {
        s->items = list;
        s->items[s->item_count++] = made;
    } else {
        free(made.name);
        free(made.triangles);
    }
    return st;
}

/* ------------------------------------------------------------------------------------------------------------ outdoors */

static enum status read_sun(struct reader *r, struct err *err)
{
    struct sun *sun = &r->scene->sky.sun;
    if (r->scene->sky.has_sun) return textfile_error(&r->file, err, "a second sun", "one at most");
    enum status st = number(r, "the sun's azimuth in degrees", -360, 360, &sun->azimuth, err);
    if (!st) st = number(r, "the sun's elevation in degrees", -90, 90, &sun->elevation, err);
    if (!st) st = number(r, "the sun's angular radius in degrees", 0.05, 30, &sun->angular_radius, err);
    if (!st) st = colour(r, "a radiance", MOST_RADIANCE, &sun->radiance, err);
    if (!st) st = textfile_end(&r->file, err);
    r->scene->sky.has_sun = !st;
    return st;
}

static enum status read_panorama(struct reader *r, struct err *err)
{
    struct panorama *p = &r->scene->sky.panorama;
    if (r->scene->sky.has_panorama) return textfile_error(&r->file, err, "a second panorama", "one at most");
    enum status st = seed(r, &p->seed, err);
    if (!st) st = colour(r, "the sky's radiance", MOST_RADIANCE, &p->sky, err);
    if (!st) st = colour(r, "the ground's radiance", MOST_RADIANCE, &p->ground, err);
    if (!st) st = textfile_end(&r->file, err);
    r->scene->sky.has_panorama = !st;
    return st;
}

/* ---------------------------------------------------------------------------------------------------------------- file */

static enum status read_line(struct reader *r, struct err *err)
{
    static const char *const words[] = {"texture", "material", "glow", "sun",  "panorama", "wall", "opening",
                                        "window",  "box",      "quad", "mesh", "room",     "lamp"};
    static enum status (*const lines[])(struct reader *, struct err *) = {read_texture, read_material, read_glow,
                                                                          read_sun, read_panorama};
    static item_reader *const items[] = {read_wall, read_opening, read_opening, read_box,
                                         read_quad, read_mesh,    read_room,    read_lamp};
    enum { LINES = sizeof lines / sizeof *lines, WORDS = sizeof words / sizeof *words };
    int word = 0;
    enum status st = choice(r, words, WORDS, "a line of a scene", &word, err);
    if (st) return st;
    return word < LINES ? lines[word](r, err) : read_item(r, (enum item_kind)(word - LINES), items[word - LINES], err);
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

static enum status read_header(struct reader *r, struct err *err)
{
    char *word = NULL;
    int64_t version = 0;
    if (!textfile_next(&r->file))
        return err_set(err, ST_DATA, "%s is empty, wanted a scene, which begins with the line: remodel-scene 1.",
                       r->file.path);
    enum status st = textfile_word(&r->file, "remodel-scene", &word, err);
    if (!st && strcmp(word, "remodel-scene")) st = textfile_error(&r->file, err, word, "remodel-scene");
    if (!st) st = textfile_int(&r->file, "the format's version", 1, 1, &version, err);
    if (!st) st = textfile_end(&r->file, err);
    return st;
}

enum status scene_read(struct scene *s, const char *folder, const char *file, struct provenance *prov, struct err *err)
{
    struct reader r = {.scene = s, .folder = folder, .prov = prov};
    char *path = NULL;
    *s = (struct scene){0};
    if (asprintf(&path, "%s/%s", folder, file) < 0) return err_nomem(err, "a file name", strlen(folder) + strlen(file));
    enum status st = textfile_open(&r.file, path, err);
    if (!st) st = read_header(&r, err);
    while (!st && textfile_next(&r.file)) st = read_line(&r, err);
    if (!st && !s->item_count)
        st = err_set(err, ST_DATA, "%s has nothing in it to look at; add a room, a box or a quad.", path);
    if (!st && !has_light(s))
        st = err_set(
            err, ST_DATA,
            "%s has no light, and every photo would be black; add a lamp, a sun or a panorama of positive radiance.",
            path);
    if (!st && prov) st = provenance_add_file(prov, file, path, err);
    textfile_release(&r.file);
    free(path);
    if (st) scene_release(s);
    return st;
}

void scene_release(struct scene *s)
{
    if (!s) return;
    for (int i = 0; i < s->texture_count; i++) free(s->textures[i].name);
    for (int i = 0; i < s->material_count; i++) free(s->materials[i].name);
    for (int i = 0; i < s->item_count; i++) {
        free(s->items[i].name);
        free(s->items[i].triangles);
    }
    free(s->textures);
    free(s->materials);
    free(s->items);
    *s = (struct scene){0};
}
