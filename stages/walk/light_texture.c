/* light_texture.c - see light_texture.h.
 *
 * update_vita wrote the edited model's atlas in the new light. What a face had in the old light says its texture: the
 * rules of the texture map, and the unedited atlas. The quotient of both, each summed over a square of texels, is the
 * change of light there. Light has few details, so squares of some texels hold it; squares without a texel in both take
 * the nearest one's. */
#include "stages/walk/light_texture.h"

#include <stdlib.h>
#include <string.h>

#include "stages/walk/atlas_texture.h"
#include "stages/walk/data_file.h"
#include "stages/walk/scene_text.h"

struct light_job {
    const struct walk_scene *s;
    const struct walk_model *m;
    const struct atlas_page *vita_pages;
    float (*colours)[3]; /* of each rule of colour, by the order of faces and rules; owned */
};

/* The plane of a tile's face: its offset along `normal`, which is set. False: the model has no such face. */
static bool find_plane(const struct solid_mesh *mesh, const struct atlas_tile *t, struct vec3 *normal, double *offset)
{
    const struct vec3 across = vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]);
    const struct vec3 down = vec3_make(t->matrix[1][0], t->matrix[1][1], t->matrix[1][2]);
    const struct vec3 along = vec3_normalize(vec3_cross(across, down));
    for (int i = 0; i < mesh->face_count; i++) {
        if (solid_face_id(mesh, i) != t->face || fabs(vec3_dot(along, mesh->faces[i].normal)) < 0.999) continue;
        *normal = mesh->faces[i].normal;
        *offset = mesh->faces[i].offset;
        return true;
    }
    return false;
}

/* The point of the plane that an orthogonal tile shows at a pixel of its page. */
static struct vec3 tile_point(const struct atlas_tile *t, struct vec3 normal, double offset, double x, double y)
{
    const struct vec3 a = vec3_make(t->matrix[0][0], t->matrix[0][1], t->matrix[0][2]);
    const struct vec3 b = vec3_make(t->matrix[1][0], t->matrix[1][1], t->matrix[1][2]);
    const struct vec3 u = vec3_cross(b, normal), v = vec3_cross(normal, a), n = vec3_cross(a, b);
    const double det = vec3_dot(a, u);
    const struct vec3 sum = vec3_add(vec3_add(vec3_scale(u, x - t->matrix[0][3]), vec3_scale(v, y - t->matrix[1][3])),
                                     vec3_scale(n, offset));
    return vec3_scale(sum, 1 / det);
}

/* The radiance of a place in the old light; false: nothing is known of it. */
static bool old_radiance(float rgb[3], const struct light_job *j, int id, struct vec3 p)
{
    const struct texture_face *face = texture_map_find(&j->m->map, id, p);
    const struct texture_rule itself = {
        .kind = TEXTURE_PLACE, .from = id, .matrix = {{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}};
    for (int k = 0; k < (face ? face->rule_count : 1); k++) {
        const struct texture_rule *rule = face ? &face->rules[k] : &itself;
        double x, y;
        if (face && !texture_rule_holds(rule, face->normal, p)) continue;
        if (rule->kind == TEXTURE_COLOUR) {
            const ptrdiff_t at = face - j->m->map.faces;
            memcpy(rgb, j->colours[at], 3 * sizeof *rgb);
            return true;
        }
        if (rule->kind != TEXTURE_PLACE) continue;
        const struct atlas_tile *t = atlas_find(&j->s->vita, rule->from, texture_rule_place(rule, p), &x, &y);
        if (t && atlas_sample(rgb, NULL, &j->vita_pages[t->page], t, x, y)) return true;
    }
    return false;
}

/* The colours of rules, one for each face that has such a rule. */
static enum status find_colours(struct light_job *j, struct err *err)
{
    j->colours = calloc((size_t)j->m->map.face_count + 1, sizeof *j->colours);
    if (!j->colours) return err_nomem(err, "colours", (size_t)j->m->map.face_count * sizeof *j->colours);
    for (int i = 0; i < j->m->map.face_count; i++)
        for (int k = 0; k < j->m->map.faces[i].rule_count; k++) {
            const struct texture_rule *rule = &j->m->map.faces[i].rules[k];
            if (rule->kind == TEXTURE_COLOUR && scene_text_colour(j->colours[i], rule, &j->s->vita, j->vita_pages, err))
                return err->status;
        }
    return ST_OK;
}

/* The small atlas: a texel for each square of `step` texels. */
static enum status make_atlas(struct atlas *a, const struct atlas *of, int step, struct err *err)
{
    a->tile_count = of->tile_count;
    a->tiles = calloc((size_t)of->tile_count + 1, sizeof *a->tiles);
    if (!a->tiles) return err_nomem(err, "tiles", (size_t)of->tile_count * sizeof *a->tiles);
    for (int i = 0; i < of->tile_count; i++) {
        a->tiles[i] = of->tiles[i];
        a->tiles[i].width = (of->tiles[i].width + step - 1) / step;
        a->tiles[i].height = (of->tiles[i].height + step - 1) / step;
    }
    if (atlas_pack(a, err)) return err->status;
    for (int i = 0; i < of->tile_count; i++) {
        struct atlas_tile *t = &a->tiles[i];
        const struct atlas_tile *from = &of->tiles[i];
        for (int k = 0; k < 4; k++) {
            t->matrix[0][k] = (from->matrix[0][k] - from->x * from->matrix[2][k]) / step + t->x * from->matrix[2][k];
            t->matrix[1][k] = (from->matrix[1][k] - from->y * from->matrix[2][k]) / step + t->y * from->matrix[2][k];
        }
    }
    return ST_OK;
}

/* Sets a square's factors; false: no texel of it is known in both lights. */
static bool find_factor(float factor[3], const struct light_job *j, const struct atlas_tile *from,
                        const struct atlas_page *page, struct vec3 normal, double offset, int x0, int y0)
{
    const int step = j->s->params->light_step;
    double now[3] = {0}, was[3] = {0};
    for (int y = y0; y < y0 + step && y < from->y + from->height; y++)
        for (int x = x0; x < x0 + step && x < from->x + from->width; x++) {
            const size_t at = (size_t)y * (size_t)page->width + (size_t)x;
            float old[3];
            if (page->source[at] == ATLAS_NONE) continue;
            if (!old_radiance(old, j, from->face, tile_point(from, normal, offset, x + 0.5, y + 0.5))) continue;
            for (size_t c = 0; c < 3; c++) {
                now[c] += (double)page->rgb[3 * at + c];
                was[c] += (double)old[c];
            }
        }
    for (int c = 0; c < 3; c++) {
        if (!(was[c] > 0)) return false;
        factor[c] = (float)fmin(1, now[c] / was[c] / LIGHT_MOST);
    }
    return true;
}

static void fill_tile(struct atlas_page *to, const struct atlas_tile *t, const struct light_job *j,
                      const struct atlas_tile *from, const struct atlas_page *page)
{
    const int step = j->s->params->light_step;
    struct vec3 normal;
    double offset;
    if (!find_plane(&j->m->rays.mesh, from, &normal, &offset)) return;
    for (int y = 0; y < t->height; y++)
        for (int x = 0; x < t->width; x++) {
            const size_t at = (size_t)(t->y + y) * (size_t)to->width + (size_t)(t->x + x);
            if (find_factor(to->rgb + 3 * at, j, from, page, normal, offset, from->x + x * step, from->y + y * step))
                to->source[at] = ATLAS_VIEWS;
        }
}

static enum status read_page(struct atlas_page *page, const struct light_job *j, int index, struct provenance *prov,
                             struct err *err)
{
    char folder[FILE_PATH], vita[FILE_PATH];
    return file_path(folder, j->s->files->relight, j->m->edit, "", err) || file_path(vita, folder, "vita", "", err)
               ? err->status
               : atlas_page_read(page, &j->m->relit_atlas, index, vita, prov, err);
}

/* Fills the pages of the small atlas, one page of the relit one after the other. */
static enum status fill_pages(struct atlas_page *pages, const struct atlas *a, const struct light_job *j,
                              struct provenance *prov, struct err *err)
{
    const struct atlas *relit = &j->m->relit_atlas;
    for (int k = 0; !err->status && k < a->page_count; k++)
        atlas_page_init(&pages[k], a->page_sizes[k][0], a->page_sizes[k][1], err);
    for (int k = 0; !err->status && k < relit->page_count; k++) {
        struct atlas_page page = {0};
        read_page(&page, j, k, prov, err);
        for (int i = 0; !err->status && i < relit->tile_count; i++)
            if (relit->tiles[i].page == k)
                fill_tile(&pages[a->tiles[i].page], &a->tiles[i], j, &relit->tiles[i], &page);
        atlas_page_release(&page);
    }
    return err->status;
}

enum status light_texture_write(FILE *to, const struct walk_scene *s, const struct walk_model *m,
                                const struct atlas_page *vita_pages, struct provenance *prov, struct err *err)
{
    struct light_job j = {.s = s, .m = m, .vita_pages = vita_pages};
    struct atlas a = {0};
    struct atlas_page *pages = NULL;
    char *source = NULL;
    if (!find_colours(&j, err) && !make_atlas(&a, &m->relit_atlas, s->params->light_step, err)) {
        pages = calloc((size_t)a.page_count + 1, sizeof *pages);
        if (!pages) err_nomem(err, "pages", (size_t)a.page_count * sizeof *pages);
    }
    if (!err->status) fill_pages(pages, &a, &j, prov, err);
    if (!err->status && !(source = strdup(""))) err_nomem(err, "a name", 1);
    a.sources = &source;
    a.source_count = 1;
    fputs("{\"atlas\":", to);
    scene_text_atlas(to, &a);
    fprintf(to, ",\"most\":%g,\"textures\":[", LIGHT_MOST);
    for (int k = 0; !err->status && k < a.page_count; k++) {
        if (k) putc(',', to);
        atlas_texture_write(to, &a, &pages[k], k, 1, s->params, err);
    }
    fputs("]}", to);
    for (int k = 0; pages && k < a.page_count; k++) atlas_page_release(&pages[k]);
    free(pages);
    a.sources = NULL;
    a.source_count = 0;
    atlas_release(&a);
    free(source);
    free(j.colours);
    return err->status;
}
