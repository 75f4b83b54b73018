/* materials.c - reads and writes materials.txt: reflectances that were fitted or given, and the regions that show
 * them.
 *
 * A material is a diffuse k_d for each channel, a specular strength k_s and a shape, the exponent of Phong's model
 * or the roughness of Ward's model [Ward 1992]. Beside the values stand the ranges in which the photographs leave
 * them, the numbers of samples and views, the error of each model, and the reason for the choice: a reader can see
 * how well a value is known.
 *
 * A region is a polygon of pixels in a photo. A pixel is inside if a ray to the right crosses the outline an odd
 * number of times; its area is half the absolute sum of the cross products of consecutive corners, and must not be
 * 0.
 *
 * The file says k_d as radiance per irradiance, the reflectance over pi; struct brdf has the reflectance.
 *
 * Lines refer to a material above them by its name; all bounds are checked as they are read, with file and line. */
#include "common/gather/materials.h"

#include <limits.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "common/base/array.h"
#include "common/base/scan.h"
#include "common/math/numbers.h"
#include "common/math/polygon.h"
#include "common/product/product.h"

enum { MAX_WORD = 255, QUOTED_SIZE = 2 * MAX_WORD + 3 };

static const char *const kinds[MATERIAL_MODELS] = {"lambert", "phong", "ward"};

const char *material_kind_name(enum brdf_kind kind) { return kinds[kind]; }

void material_list_release(struct material_list *l)
{
    if (!l) return;
    for (int i = 0; i < l->count; i++) {
        struct material *m = &l->items[i];
        for (int k = 0; k < m->region_count; k++) {
            free(m->regions[k].view);
            free(m->regions[k].pixel);
        }
        free(m->regions);
        free(m->name);
        free(m->why);
    }
    free(l->items);
    *l = (struct material_list){0};
}

struct material *material_list_find(const struct material_list *l, const char *name)
{
    for (int i = 0; i < l->count; i++)
        if (!strcmp(l->items[i].name, name)) return &l->items[i];
    return NULL;
}

enum status material_list_add(struct material **added, struct material_list *l, const char *name, struct textfile *t,
                              struct err *err)
{
    if (material_list_find(l, name)) return textfile_error(t, err, name, "a name that no line above has");
    if (array_append(&l->items, (size_t)l->count, sizeof *l->items, "materials", err)) return err->status;
    struct material *m = &l->items[l->count];
    *m = (struct material){.name = strdup(name), .scale = 1, .error = {-1, -1, -1}};
    if (!m->name) return err_nomem(err, "a name", strlen(name) + 1);
    l->count++;
    *added = m;
    return ST_OK;
}

/* ---------------------------------------------------------------------------------------------------------- regions */

/* Whether the next word is a number: the polygon goes on. */
static bool number_follows(const struct textfile *t)
{
    const char *at = t->cursor + strspn(t->cursor, " \t\r");
    return *at && strchr("+-.0123456789", *at);
}

static enum status read_pixels(struct material_region *r, struct textfile *t, struct err *err)
{
    while (number_follows(t)) {
        double pixel[2];
        if (textfile_number(t, "x of a pixel", -1e6, 1e6, &pixel[0], err) ||
            textfile_number(t, "y of a pixel", -1e6, 1e6, &pixel[1], err))
            return err->status;
        for (int k = 0; k < 2; k++) {
            if (array_append(&r->pixel, 2 * (size_t)r->corners + (size_t)k, sizeof *r->pixel, "pixels", err))
                return err->status;
            r->pixel[2 * r->corners + k] = pixel[k];
        }
        r->corners++;
    }
    if (r->corners < 3)
        return textfile_error(t, err, r->corners ? "too few corners" : NULL, "a region: X Y of three corners or more");
    if (!(material_region_area(r) > 0))
        return textfile_error(t, err, "a region without area", "corners around an area");
    return ST_OK;
}

enum status material_read_region(struct material *m, struct textfile *t, struct err *err)
{
    char view[MAX_WORD + 1];
    if (textfile_word_into(t, "a photo's id or a view's name", view, sizeof view, err) ||
        array_append(&m->regions, (size_t)m->region_count, sizeof *m->regions, "regions", err))
        return err->status;
    struct material_region *r = &m->regions[m->region_count];
    *r = (struct material_region){.view = strdup(view), .line = t->line};
    if (!r->view) return err_nomem(err, "a view's name", strlen(view) + 1);
    m->region_count++;
    return read_pixels(r, t, err);
}

bool material_region_holds(const struct material_region *r, double x, double y)
{
    return polygon_holds((const double(*)[2])r->pixel, r->corners, x, y);
}

double material_region_area(const struct material_region *r)
{
    double sum = 0;
    for (int i = 0, j = r->corners - 1; i < r->corners; j = i++)
        sum += r->pixel[2 * j] * r->pixel[2 * i + 1] - r->pixel[2 * i] * r->pixel[2 * j + 1];
    return fabs(sum) / 2;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

enum status material_read_kind(enum brdf_kind *kind, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "a model", &word, err)) return err->status;
    for (int k = 0; k < MATERIAL_MODELS; k++)
        if (!strcmp(word, kinds[k])) {
            *kind = (enum brdf_kind)k;
            return ST_OK;
        }
    return textfile_error(t, err, word, "lambert, phong or ward");
}

static enum status read_material(struct material_list *l, struct textfile *t, struct err *err)
{
    char name[MAX_WORD + 1];
    struct material *m = NULL;
    double least, most;
    if (textfile_word_into(t, "a name", name, sizeof name, err) || material_list_add(&m, l, name, t, err) ||
        material_read_kind(&m->kind, t, err))
        return err->status;
    for (int c = 0; c < 3; c++)
        if (textfile_number(t, "k_d", 0, 1e9, &m->k_d[c], err)) return err->status;
    gloss_shape_bounds(m->kind, &least, &most);
    if (textfile_number(t, "k_s", 0, m->kind == BRDF_LAMBERT ? 0 : 1e9, &m->ks, err) ||
        textfile_number(t, m->kind == BRDF_WARD ? "alpha" : "n", least, most, &m->shape, err))
        return err->status;
    return textfile_end(t, err);
}

static enum status read_range(struct material_range *r, struct textfile *t, struct err *err)
{
    if (textfile_number(t, "the lower end", 0, 1e9, &r->low, err)) return err->status;
    const char *at = t->cursor + strspn(t->cursor, " \t\r");
    if (*at == '-' && (!at[1] || strchr(" \t\r", at[1]))) {
        char *word;
        r->high = INFINITY;
        return textfile_word(t, "the upper end", &word, err);
    }
    return textfile_number(t, "the upper end", r->low, 1e12, &r->high, err);
}

static enum status read_ranges(struct material *m, struct textfile *t, struct err *err)
{
    for (int c = 0; c < 3; c++)
        if (read_range(&m->k_d_range[c], t, err)) return err->status;
    if (read_range(&m->ks_range, t, err) || read_range(&m->shape_range, t, err)) return err->status;
    return textfile_end(t, err);
}

static enum status read_evidence(struct material *m, struct textfile *t, struct err *err)
{
    int *const counts[] = {&m->samples, &m->points, &m->views};
    char *why;
    for (int k = 0; k < 3; k++) {
        int64_t count;
        if (textfile_int(t, "a count", 0, INT_MAX, &count, err)) return err->status;
        *counts[k] = (int)count;
    }
    if (textfile_number(t, "a scale", 0, 1e12, &m->scale, err)) return err->status;
    for (int k = 0; k < MATERIAL_MODELS; k++)
        if (textfile_number(t, "an error", -1, 1e12, &m->error[k], err)) return err->status;
    if (textfile_rest(t, "a reason", &why, err)) return err->status;
    free(m->why);
    m->why = strdup(why);
    return m->why ? ST_OK : err_nomem(err, "a reason", strlen(why) + 1);
}

static enum status read_statement(struct material_list *l, struct textfile *t, struct err *err)
{
    char verb[16], name[MAX_WORD + 1];
    if (textfile_word_into(t, "a statement", verb, sizeof verb, err)) return err->status;
    if (!strcmp(verb, "material")) return read_material(l, t, err);
    const bool range = !strcmp(verb, "range"), evidence = !strcmp(verb, "evidence");
    if (!range && !evidence && strcmp(verb, "region"))
        return textfile_error(t, err, verb, "material, range, evidence or region");
    if (textfile_word_into(t, "a name", name, sizeof name, err)) return err->status;
    struct material *m = material_list_find(l, name);
    if (!m) return textfile_error(t, err, name, "the name of a material of a line above");
    if (range) return read_ranges(m, t, err);
    if (evidence) return read_evidence(m, t, err);
    return material_read_region(m, t, err) || textfile_end(t, err) ? err->status : ST_OK;
}

enum status material_list_read(struct material_list *l, const char *path, struct provenance *prov, struct err *err)
{
    struct textfile t = {0};
    *l = (struct material_list){0};
    product_open(&t, NULL, PRODUCT_MATERIALS, path, prov, err);
    while (!err->status && textfile_next(&t)) read_statement(l, &t, err);
    textfile_release(&t);
    if (err->status) material_list_release(l);
    return err->status;
}

struct brdf material_brdf(const struct material *m)
{
    return (struct brdf){m->kind,
                         {m->k_d[0] * PI, m->k_d[1] * PI, m->k_d[2] * PI},
                         m->ks,
                         m->shape,
                         brdf_gloss_albedo(m->kind, m->ks, m->shape)};
}

/* ---------------------------------------------------------------------------------------------------------- writing */

static void write_range(FILE *to, struct material_range r)
{
    fprintf(to, " %.17g ", r.low);
    if (isfinite(r.high))
        fprintf(to, "%.17g", r.high);
    else
        fputc('-', to);
}

static enum status write_material(const struct material *m, FILE *to, struct err *err)
{
    char name[QUOTED_SIZE], view[QUOTED_SIZE];
    if (textfile_quote(m->name, name, sizeof name, err)) return err->status;
    fprintf(to, "material %s %s %.17g %.17g %.17g %.17g %.17g\n", name, kinds[m->kind], m->k_d[0], m->k_d[1], m->k_d[2],
            m->ks, m->shape);
    fprintf(to, "range %s", name);
    for (int c = 0; c < 3; c++) write_range(to, m->k_d_range[c]);
    write_range(to, m->ks_range);
    write_range(to, m->shape_range);
    fprintf(to, "\nevidence %s %d %d %d %.17g %.17g %.17g %.17g %s\n", name, m->samples, m->points, m->views, m->scale,
            m->error[0], m->error[1], m->error[2], m->why ? m->why : "unknown");
    for (int k = 0; k < m->region_count; k++) {
        const struct material_region *r = &m->regions[k];
        if (textfile_quote(r->view, view, sizeof view, err)) return err->status;
        fprintf(to, "region %s %s", name, view);
        for (int i = 0; i < 2 * r->corners; i++) fprintf(to, " %.17g", r->pixel[i]);
        fputc('\n', to);
    }
    return ST_OK;
}

enum status material_list_write(const struct material_list *l, const char *path, const struct provenance *prov,
                                struct err *err)
{
    struct outfile f = {0};
    if (product_begin(&f, PRODUCT_MATERIALS, path, prov, err)) return err->status;
    const locale_t kept = uselocale(scan_c_locale());
    fprintf(f.fp, "# material NAME MODEL k_d (R G B), k_s, n or alpha; range NAME: 95 %% intervals of these, low high\n"
                  "# evidence NAME samples points views, residuals in standard deviations, cross-validated errors\n");
    for (int i = 0; !err->status && i < l->count; i++) write_material(&l->items[i], f.fp, err);
    uselocale(kept);
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}
