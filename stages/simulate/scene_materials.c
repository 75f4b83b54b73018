/* scene_materials.c - the lines of scene.txt about textures and materials (scene_reader.h). */
#include "stages/simulate/scene_reader.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const char *const texture_words[TEXTURE_KINDS] = {"rgb",     "checker", "wood", "brick",
                                                         "plaster", "print",   "books"};

static enum status read_size(struct reader *r, const char *what, double *value, struct err *err)
{
    return textfile_number(&r->file, what, 1e-4, 1e4, value, err);
}

enum status scene_read_texture(struct reader *r, struct err *err)
{
    struct scene *s = r->scene;
    struct scene_texture made = {0};
    struct texture *t = &made.texture;
    int kind = 0;
    if (!description_name(&r->file, &made.name, err) && scene_find_name(s, made.name, scene_next_texture) >= 0)
        scene_name_taken(r, made.name, "texture", err);
    if (!err->status && !scene_read_choice(r, texture_words, TEXTURE_KINDS, "a kind of texture", &kind, err)) {
        t->kind = (enum texture_kind)kind;
        const bool two = t->kind == TEXTURE_CHECKER || t->kind == TEXTURE_WOOD || t->kind == TEXTURE_BRICK;
        const bool generated = t->kind == TEXTURE_PRINT || t->kind == TEXTURE_BOOKS;
        if (t->kind == TEXTURE_CHECKER) read_size(r, "the size of a square", &t->size[0], err);
        if (t->kind == TEXTURE_WOOD || t->kind == TEXTURE_PLASTER) read_size(r, "a scale", &t->size[0], err);
        if (!err->status && t->kind == TEXTURE_PLASTER) textfile_number(&r->file, "an amount", 0, 1, &t->size[1], err);
        if (t->kind == TEXTURE_BRICK && !read_size(r, "the width of a brick", &t->size[0], err) &&
            !read_size(r, "the height of a brick", &t->size[1], err))
            textfile_number(&r->file, "the width of the mortar", 0, fmin(t->size[0], t->size[1]), &t->size[2], err);
        if (!err->status && t->kind != TEXTURE_RGB && t->kind != TEXTURE_CHECKER) scene_read_seed(r, &t->seed, err);
        if (!err->status && generated && !read_size(r, "a width", &t->size[0], err))
            read_size(r, "a height", &t->size[1], err);
        if (!err->status && !generated && !scene_read_colour(r, "a colour from 0 to 1", 1, &t->colour[0], err) && two)
            scene_read_colour(r, "the second colour, from 0 to 1", 1, &t->colour[1], err);
    }
    if (!err->status && !textfile_end(&r->file, err) &&
        !description_append(&r->file, &s->textures, s->texture_count, MAX_LINES, sizeof made, err))
        s->textures[s->texture_count++] = made;
    else
        free(made.name);
    return err->status;
}

enum status scene_read_material(struct reader *r, struct err *err)
{
    static const char *const words[] = {"lambert", "phong", "ward"};
    struct scene *s = r->scene;
    struct scene_material made = {0};
    int kind = 0;
    description_name(&r->file, &made.name, err);
    if (!err->status && scene_find_name(s, made.name, scene_next_material) >= 0)
        scene_name_taken(r, made.name, "material", err);
    if (!err->status && !scene_read_choice(r, words, 3, "a kind of material", &kind, err))
        scene_read_known_name(r, "texture", scene_next_texture, &made.texture, err);
    made.kind = (enum brdf_kind)kind;
    if (!err->status && made.kind != BRDF_LAMBERT) {
        textfile_number(&r->file, "a strength of the gloss", 0, 1e6, &made.ks, err);
        if (!err->status && made.kind == BRDF_PHONG) textfile_number(&r->file, "an exponent", 1, 1e6, &made.shape, err);
        if (!err->status && made.kind == BRDF_WARD) textfile_number(&r->file, "a roughness", 0.01, 1, &made.shape, err);
    }
    if (!err->status) {
        const double albedo = texture_bound(&s->textures[made.texture].texture);
        made.gloss = brdf_gloss_albedo(made.kind, made.ks, made.shape);
        if (albedo + made.gloss > 1 + 1e-9) {
            char found[100];
            snprintf(found, sizeof found, "albedo up to %.3g and gloss of %.3g", albedo, made.gloss);
            textfile_error(&r->file, err, found, "no more than 1 together");
        }
    }
    if (!err->status && !textfile_end(&r->file, err) &&
        !description_append(&r->file, &s->materials, s->material_count, MAX_LINES, sizeof made, err))
        s->materials[s->material_count++] = made;
    else
        free(made.name);
    return err->status;
}

enum status scene_read_glow(struct reader *r, struct err *err)
{
    int material = 0;
    struct rgb glow;
    if (!scene_read_known_name(r, "material", scene_next_material, &material, err) &&
        !scene_read_colour(r, "a radiance", MAX_RADIANCE, &glow, err) && !textfile_end(&r->file, err))
        r->scene->materials[material].glow = glow;
    return err->status;
}
