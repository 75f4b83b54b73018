/* gloss.c - see gloss.h. */
#include "common/light/gloss.h"

#include <stdio.h>
#include <string.h>

static const char *const kinds[] = {[BRDF_LAMBERT] = "matt", [BRDF_PHONG] = "phong", [BRDF_WARD] = "ward"};

void gloss_shape_bounds(enum brdf_kind kind, double *least, double *most)
{
    *least = kind == BRDF_PHONG ? 1 : kind == BRDF_WARD ? 0.02 : 0;
    *most = kind == BRDF_PHONG ? GLOSS_PHONG_MAX : kind == BRDF_WARD ? 1 : 0;
}

struct brdf gloss_brdf(const struct gloss *g, struct rgb albedo)
{
    return (struct brdf){g->kind, albedo, g->ks, g->shape, brdf_gloss_albedo(g->kind, g->ks, g->shape)};
}

/* ---------------------------------------------------------------------------------------------------------- reading */

static enum status read_kind(enum brdf_kind *kind, struct textfile *t, struct err *err)
{
    char *word;
    if (textfile_word(t, "matt, phong or ward", &word, err)) return err->status;
    for (int k = 0; k < (int)(sizeof kinds / sizeof *kinds); k++)
        if (!strcmp(word, kinds[k])) {
            *kind = (enum brdf_kind)k;
            return ST_OK;
        }
    return textfile_error(t, err, word, "matt, phong or ward");
}

/* KS and N or ALPHA, unless it is matt. */
static enum status read_lobe(struct gloss *g, struct textfile *t, struct err *err)
{
    double least, most;
    if (g->kind == BRDF_LAMBERT) return ST_OK;
    gloss_shape_bounds(g->kind, &least, &most);
    if (textfile_number(t, "KS, the strength of the gloss", 0, 1e6, &g->ks, err) ||
        textfile_number(t, g->kind == BRDF_WARD ? "ALPHA, a roughness" : "N, an exponent", least, most, &g->shape, err))
        return err->status;
    return ST_OK;
}

static enum status check_sum(double albedo, double gloss, const struct textfile *t, struct err *err)
{
    char found[96];
    if (albedo + gloss <= 1 + 1e-9) return ST_OK;
    snprintf(found, sizeof found, "albedo up to %.3g, gloss of %.3g", albedo, gloss);
    return textfile_error(t, err, found, "no more than 1 together, all of the light; make KS smaller");
}

enum status gloss_check(const struct gloss *g, double albedo, const struct textfile *t, struct err *err)
{
    return check_sum(albedo, brdf_gloss_albedo(g->kind, g->ks, g->shape), t, err);
}

enum status gloss_read(struct gloss *g, struct textfile *t, struct err *err)
{
    *g = (struct gloss){0};
    return read_kind(&g->kind, t, err) || read_lobe(g, t, err) ? err->status : ST_OK;
}

enum status gloss_read_brdf(struct brdf *b, struct textfile *t, struct err *err)
{
    struct gloss g = {0};
    struct rgb albedo = {0, 0, 0};
    *b = (struct brdf){0};
    if (read_kind(&g.kind, t, err) || textfile_number(t, "a share of red light", 0, 1, &albedo.r, err) ||
        textfile_number(t, "a share of green light", 0, 1, &albedo.g, err) ||
        textfile_number(t, "a share of blue light", 0, 1, &albedo.b, err) || read_lobe(&g, t, err))
        return err->status;
    *b = gloss_brdf(&g, albedo);
    return check_sum(rgb_max(albedo), b->gloss, t, err);
}

/* --------------------------------------------------------------------------------------------------------- printing */

void gloss_print(const struct gloss *g, FILE *to)
{
    fputs(kinds[g->kind], to);
    if (g->kind != BRDF_LAMBERT) fprintf(to, " %.17g %.17g", g->ks, g->shape);
}

void gloss_print_brdf(const struct brdf *b, FILE *to)
{
    fprintf(to, "%s %.17g %.17g %.17g", kinds[b->kind], b->albedo.r, b->albedo.g, b->albedo.b);
    if (b->kind != BRDF_LAMBERT) fprintf(to, " %.17g %.17g", b->ks, b->shape);
}
