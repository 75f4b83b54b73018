/* integrals.c - see integrals.h.
 *
 * A pixel's radiance is L = a E / pi + k_s I_s, with the albedo a that picture and light imply. E, I_s and the direct
 * light E_l of each lamp are kept. With factors s_l of the lamps' radiance, and new reflectances,
 *   L' = a' (E + sum_l (s_l - 1) E_l) / pi + k_s' I_s,
 * which needs no ray. What the changed light does after it was reflected once, and lamps in reflections, is left out; n
 * and alpha are inside the integral I_s, beta inside E_l. */
#include "stages/relight/integrals.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/textfile.h"
#include "common/capture/view_image.h"
#include "common/math/numbers.h"

enum { NAME_SIZE = 128, MAX_LAMPS = 1000 };
#define MAX_FACTOR 1e6
static const char channels[3] = {'R', 'G', 'B'};

/* --------------------------------------------------------------------------------------------------------- surfaces */

struct surface {
    enum surface_kind kind;
    char name[NAME_SIZE];
    double k_d[3], ks; /* k_d: albedo / pi; of a material with texture, what was fitted */
};

struct surfaces {
    struct surface *list;
    int count;
};

static enum status add_surface(struct surfaces *s, enum surface_kind kind, const char *name, const struct brdf *b,
                               struct err *err)
{
    if (array_append(&s->list, (size_t)s->count, sizeof *s->list, "surfaces", err)) return err->status;
    struct surface *to = &s->list[s->count++];
    *to = (struct surface){.kind = kind, .k_d = {b->albedo.r / PI, b->albedo.g / PI, b->albedo.b / PI}, .ks = b->ks};
    snprintf(to->name, sizeof to->name, "%s", name);
    return ST_OK;
}

/* The first of a face's rules that is a colour; NULL: none. */
static const struct texture_rule *colour_of(const struct texture_face *face)
{
    for (int k = 0; k < face->rule_count; k++)
        if (face->rules[k].kind == TEXTURE_COLOUR) return &face->rules[k];
    return NULL;
}

static const struct texture_face *listed_face(const struct light_change *c, int face)
{
    const struct solid_face *f = &c->after.model.mesh.faces[face];
    return texture_map_find(&c->map, solid_face_id(&c->after.model.mesh, face), vec3_scale(f->normal, f->offset));
}

/* Objects, then materials, then faces to which the edit gives a gloss or a colour; surface_of_face[f] is the surface of
 * face f, or -1. */
static enum status list_surfaces(struct surfaces *s, int *surface_of_face, const struct light_change *c,
                                 struct err *err)
{
    const struct material_list *materials = &c->before.materials.list;
    const struct solid_mesh *mesh = &c->after.model.mesh;
    for (int i = 0; !err->status && i < c->objects.list.count; i++)
        add_surface(s, SURFACE_OBJECT, c->objects.list.items[i].name, &c->objects.list.items[i].brdf, err);
    for (int i = 0; !err->status && i < materials->count; i++)
        add_surface(s, SURFACE_MATERIAL, materials->items[i].name, &c->before.materials.brdfs[i], err);
    for (int i = 0; !err->status && i < mesh->face_count; i++) {
        const struct texture_face *face = listed_face(c, i);
        const struct texture_rule *colour = face ? colour_of(face) : NULL;
        struct brdf b = {.kind = BRDF_LAMBERT};
        surface_of_face[i] = -1;
        if (!face || !(colour || face->has_gloss)) continue;
        if (colour)
            b.albedo = rgb_make((double)colour->albedo[0], (double)colour->albedo[1], (double)colour->albedo[2]);
        b.ks = face->has_gloss ? face->gloss.ks : 0;
        add_surface(s, SURFACE_FACE, face->name, &b, err);
        surface_of_face[i] = s->count - 1;
    }
    return err->status;
}

/* Sets numbers[i] to 1 + the surface of each pixel, 0 where it has none. */
static void number_pixels(uint32_t *numbers, const struct pixels *p, const struct light_change *c,
                          const int *surface_of_face)
{
    const int objects = c->objects.list.count;
    for (size_t i = 0; i < (size_t)p->width * (size_t)p->height; i++) {
        if (p->face[i] < 0 || p->kind[i] == PIXEL_CLUTTER || p->kind[i] == PIXEL_LAMP) continue;
        const struct vec3 at = vec3_make((double)p->texel[i][0], (double)p->texel[i][1], (double)p->texel[i][2]);
        const int material = p->kind[i] == PIXEL_TEXTURE ? model_field_material(&c->before, p->from[i], at) : -1;
        if (material >= 0) numbers[i] = (uint32_t)(1 + objects + material);
        if (surface_of_face[p->face[i]] >= 0) numbers[i] = (uint32_t)(1 + surface_of_face[p->face[i]]);
    }
    for (int k = 0; k < p->object_count; k++)
        if (p->objects[k].cover >= 0.5f) numbers[p->objects[k].pixel] = (uint32_t)(1 + p->objects[k].object);
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static enum status add_rgb(struct exr_image *im, const char *name, int *first, struct err *err)
{
    char text[EXR_NAME_SIZE];
    *first = im->count;
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, "%s.%c", name, channels[k]);
        if (exr_add_plane(im, text, EXR_FLOAT, NULL, err)) return err->status;
    }
    return ST_OK;
}

static void put(struct exr_image *im, int first, size_t i, struct rgb v)
{
    im->planes[first].f[i] = (float)v.r;
    im->planes[first + 1].f[i] = (float)v.g;
    im->planes[first + 2].f[i] = (float)v.b;
}

static enum status add_light(struct exr_image *im, const struct relit *r, struct err *err)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    int before, after, specular;
    if (add_rgb(im, "before", &before, err) || add_rgb(im, "after", &after, err) ||
        add_rgb(im, "specular", &specular, err))
        return err->status;
    for (size_t i = 0; i < n; i++) {
        put(im, before, i, r->before[i].value);
        put(im, after, i, r->after[i].value);
        const float *s = r->specular ? r->specular[i][1] : NULL;
        if (s) put(im, specular, i, rgb_make((double)s[0], (double)s[1], (double)s[2]));
    }
    return ST_OK;
}

static enum status add_lamps(struct exr_image *im, const struct lamp_light *lamps, size_t n, struct err *err)
{
    char name[32];
    for (int l = 0; l < lamps->count; l++) {
        int first;
        snprintf(name, sizeof name, "lamp%d", l);
        if (add_rgb(im, name, &first, err)) return err->status;
        for (size_t i = 0; i < n; i++)
            for (int k = 0; k < 3; k++) im->planes[first + k].f[i] = lamps->light[l][i][k];
        snprintf(name, sizeof name, "remodel:lamp%d", l);
        if (exr_set_attribute(im, name, lamps->names[l], err)) return err->status;
    }
    return ST_OK;
}

static enum status add_surfaces(struct exr_image *im, const struct surfaces *s, struct err *err)
{
    static const char *const kinds[] = {"object", "material", "face"};
    char name[32], text[256];
    for (int i = 0; i < s->count; i++) {
        const struct surface *f = &s->list[i];
        snprintf(name, sizeof name, "remodel:surface%d", i);
        snprintf(text, sizeof text, "%s %.9g %.9g %.9g %.9g %s", kinds[f->kind], f->ks, f->k_d[0], f->k_d[1], f->k_d[2],
                 f->name);
        if (exr_set_attribute(im, name, text, err)) return err->status;
    }
    return ST_OK;
}

enum status integrals_write(const struct relit *r, const struct pixels *p, const struct light_change *c,
                            const struct lamp_light *lamps, const struct view *camera, const char *path,
                            const struct provenance *prov, struct err *err)
{
    const size_t n = (size_t)r->width * (size_t)r->height;
    struct exr_image im = {0};
    struct surfaces surfaces = {0};
    int *surface_of_face = calloc((size_t)c->after.model.mesh.face_count + 1, sizeof *surface_of_face);
    if (surface_of_face)
        exr_image_init(&im, r->width, r->height, err);
    else
        err_nomem(err, "faces", (size_t)c->after.model.mesh.face_count);
    if (!err->status && !add_light(&im, r, err) && !add_lamps(&im, lamps, n, err) &&
        !list_surfaces(&surfaces, surface_of_face, c, err) && !add_surfaces(&im, &surfaces, err) &&
        !exr_add_plane(&im, "surface", EXR_UINT, NULL, err)) {
        number_pixels(im.planes[im.count - 1].u, p, c, surface_of_face);
        view_image_set_camera(&im, camera);
        exr_write(&im, path, prov, err);
    }
    free(surface_of_face);
    free(surfaces.list);
    exr_image_release(&im);
    return err->status;
}

/* ---------------------------------------------------------------------------------------------------------- changes */

struct changes {
    struct surfaces surfaces;
    bool *has_k_d, *has_ks;
    double (*k_d)[3], *ks, *lamps; /* lamps: 3 each */
    int lamp_count;
    bool any_lamp;
};

static void release_changes(struct changes *c)
{
    free(c->surfaces.list);
    free(c->has_k_d);
    free(c->has_ks);
    free(c->k_d);
    free(c->ks);
    free(c->lamps);
}

static const char *numbered(const struct exr_image *im, const char *what, int i)
{
    char name[32];
    snprintf(name, sizeof name, "remodel:%s%d", what, i);
    return exr_attribute(im, name);
}

/* What the attributes of the integrals list. */
static enum status read_names(struct changes *c, const struct exr_image *im, struct err *err)
{
    const char *text;
    while ((text = numbered(im, "surface", c->surfaces.count))) {
        struct surface s = {.kind = SURFACE_FACE};
        char kind[16];
        int at = 0;
        if (sscanf(text, "%15s %lf %lf %lf %lf %n", kind, &s.ks, &s.k_d[0], &s.k_d[1], &s.k_d[2], &at) != 5 || !at)
            return err_set(err, ST_DATA,
                           "the integrals' attribute remodel:surface%d is '%s'; relight the picture again.",
                           c->surfaces.count, text);
        s.kind = !strcmp(kind, "object") ? SURFACE_OBJECT : !strcmp(kind, "material") ? SURFACE_MATERIAL : SURFACE_FACE;
        snprintf(s.name, sizeof s.name, "%s", text + at);
        if (array_append(&c->surfaces.list, (size_t)c->surfaces.count, sizeof s, "surfaces", err)) return err->status;
        c->surfaces.list[c->surfaces.count++] = s;
    }
    while (c->lamp_count < MAX_LAMPS && numbered(im, "lamp", c->lamp_count)) c->lamp_count++;
    const size_t n = (size_t)c->surfaces.count + 1;
    c->has_k_d = calloc(n, sizeof *c->has_k_d);
    c->has_ks = calloc(n, sizeof *c->has_ks);
    c->k_d = calloc(n, sizeof *c->k_d);
    c->ks = calloc(n, sizeof *c->ks);
    c->lamps = calloc(3 * (size_t)c->lamp_count + 3, sizeof *c->lamps);
    if (!c->has_k_d || !c->has_ks || !c->k_d || !c->ks || !c->lamps) return err_nomem(err, "changes", n * 32);
    for (int i = 0; i < 3 * c->lamp_count; i++) c->lamps[i] = 1;
    return ST_OK;
}

static enum status read_rgb(double rgb[3], struct textfile *t, const char *what, double max, struct err *err)
{
    for (int k = 0; k < 3; k++)
        if (textfile_number(t, what, 0, max, &rgb[k], err)) return err->status;
    return ST_OK;
}

static enum status unknown_name(const struct textfile *t, const char *name, const char *what, const char *known,
                                struct err *err)
{
    return textfile_error(t, err, name, "%s of the picture: %s", what, *known ? known : "it has none");
}

static enum status read_lamp(struct changes *c, const struct exr_image *im, struct textfile *t, struct err *err)
{
    char *name, *word, known[1024] = "";
    int i = 0;
    if (textfile_word(t, "a lamp's name", &name, err)) return err->status;
    for (i = 0; i < c->lamp_count && strcmp(numbered(im, "lamp", i), name) != 0; i++) {
        const size_t used = strlen(known);
        snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", numbered(im, "lamp", i));
    }
    if (i == c->lamp_count) return unknown_name(t, name, "a lamp that is on", known, err);
    if (textfile_word(t, "scale", &word, err)) return err->status;
    if (strcmp(word, "scale") != 0)
        return textfile_error(t, err, word,
                              "scale R G B; a lamp's cone (beta, exponent) needs a new gather: change "
                              "lights.txt and relight the picture again");
    c->any_lamp = true;
    return read_rgb(c->lamps + 3 * i, t, "a factor", MAX_FACTOR, err);
}

static enum status read_surface(struct changes *c, struct textfile *t, struct err *err)
{
    char *name, *word, known[1024] = "";
    bool found = false;
    double k_d[3] = {0}, ks = 0;
    if (textfile_word(t, "a material's name", &name, err) || textfile_word(t, "k_d or k_s", &word, err))
        return err->status;
    const bool is_diffuse = !strcmp(word, "k_d");
    if (!is_diffuse && strcmp(word, "k_s") != 0)
        return textfile_error(t, err, word,
                              "k_d R G B or k_s KS; n and alpha are inside the integrals and need a new "
                              "gather: change the material and relight the picture again");
    if (is_diffuse ? read_rgb(k_d, t, "a reflectance of at most 1 / pi", 1 / PI, err)
                   : textfile_number(t, "a strength", 0, 1, &ks, err))
        return err->status;
    for (int i = 0; i < c->surfaces.count; i++) {
        const struct surface *s = &c->surfaces.list[i];
        const size_t used = strlen(known);
        if (strcmp(s->name, name) != 0) {
            snprintf(known + used, sizeof known - used, "%s%s", used ? ", " : "", s->name);
            continue;
        }
        found = true;
        if (!is_diffuse && !(s->ks > 0))
            return textfile_error(t, err, name, "a glossy material: nothing was gathered for the gloss of a matt one");
        if (is_diffuse)
            memcpy(c->k_d[i], k_d, sizeof k_d), c->has_k_d[i] = true;
        else
            c->ks[i] = ks, c->has_ks[i] = true;
    }
    return found ? ST_OK : unknown_name(t, name, "a material, an object or a painted face", known, err);
}

static enum status read_changes(struct changes *c, const struct exr_image *im, const char *path, struct err *err)
{
    struct textfile t = {0};
    if (textfile_open(&t, path, err)) return err->status;
    while (!err->status && textfile_next(&t)) {
        char *word;
        textfile_word(&t, "lamp or material", &word, err);
        if (!err->status && !strcmp(word, "lamp"))
            read_lamp(c, im, &t, err);
        else if (!err->status && !strcmp(word, "material"))
            read_surface(c, &t, err);
        else if (!err->status)
            textfile_error(&t, err, word, "lamp or material");
        if (!err->status) textfile_end(&t, err);
    }
    textfile_release(&t);
    return err->status;
}

/* Planes by name: R of "after" and the two behind it. */
static enum status find_rgb(const float *plane[3], const struct exr_image *im, const char *name, struct err *err)
{
    char text[EXR_NAME_SIZE];
    for (int k = 0; k < 3; k++) {
        snprintf(text, sizeof text, "%s.%c", name, channels[k]);
        const struct exr_plane *p = exr_find(im, text);
        if (!p || !p->f)
            return err_set(err, ST_DATA,
                           "the integrals have no channel %s; relight the picture again with "
                           "integrals = yes.",
                           text);
        plane[k] = p->f;
    }
    return ST_OK;
}

/* One channel of a pixel: L' from L, E, the change of E by lamps, and k_s I_s. k_d: of a material a factor. */
static double changed(double was, double light, double more, double shine, const struct surface *s, double k_d,
                      bool has_k_d, double gloss_factor)
{
    double diffuse = fmax(was - shine, 0); /* a E / pi */
    if (has_k_d && s->kind == SURFACE_MATERIAL)
        diffuse *= k_d;
    else if (has_k_d)
        diffuse = k_d * light;
    if (light > 0) diffuse *= fmax(0, 1 + more / light);
    return diffuse + gloss_factor * shine;
}

static enum status apply(struct model_picture *picture, const struct exr_image *im, const struct changes *c,
                         struct err *err)
{
    const size_t n = (size_t)picture->width * (size_t)picture->height;
    const float *after[3], *specular[3], *lamp[MAX_LAMPS][3];
    const struct exr_plane *surface = exr_find(im, "surface");
    if (!surface || !surface->u || im->width != picture->width || im->height != picture->height)
        return err_set(err, ST_DATA, "the integrals are not those of the picture; relight it again.");
    if (find_rgb(after, im, "after", err) || find_rgb(specular, im, "specular", err)) return err->status;
    for (int l = 0; l < c->lamp_count; l++) {
        char name[32];
        snprintf(name, sizeof name, "lamp%d", l);
        if (find_rgb(lamp[l], im, name, err)) return err->status;
    }
    for (size_t i = 0; i < n; i++) {
        const int at = (int)surface->u[i] - 1;
        if (at >= c->surfaces.count)
            return err_set(err, ST_DATA, "the integrals name a surface that they do not list.");
        const bool has_k_d = at >= 0 && c->has_k_d[at], has_ks = at >= 0 && c->has_ks[at];
        if (!has_k_d && !has_ks && !c->any_lamp) continue;
        if (!(after[0][i] + after[1][i] + after[2][i] > 0)) continue;
        for (int k = 0; k < 3; k++) {
            const struct surface none = {.kind = SURFACE_FACE}, *s = at >= 0 ? &c->surfaces.list[at] : &none;
            double more = 0, k_d = at >= 0 ? c->k_d[at][k] : 0;
            for (int l = 0; l < c->lamp_count; l++) more += (c->lamps[3 * l + k] - 1) * (double)lamp[l][k][i];
            if (has_k_d && s->kind == SURFACE_MATERIAL) k_d = s->k_d[k] > 0 ? k_d / s->k_d[k] : 1;
            float *pixel = &picture->rgb[3 * i + (size_t)k];
            *pixel = (float)changed((double)*pixel, (double)after[k][i], more, (double)specular[k][i], s, k_d, has_k_d,
                                    has_ks ? c->ks[at] / s->ks : 1);
        }
    }
    return ST_OK;
}

enum status integrals_change(struct model_picture *picture, const struct exr_image *integrals, const char *path,
                             struct err *err)
{
    struct changes c = {.any_lamp = false};
    if (!read_names(&c, integrals, err) && !read_changes(&c, integrals, path, err)) apply(picture, integrals, &c, err);
    release_changes(&c);
    return err->status;
}
