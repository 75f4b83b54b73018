/* materials.h - materials.txt: the reflectance of the materials that a person marked in photographs.
 *
 * O/lights/materials.txt, written by fit_materials. The models are those of common/light/brdf.h, with k_d = albedo /
 * pi. */
#ifndef REMODEL_GATHER_MATERIALS_H
#define REMODEL_GATHER_MATERIALS_H

#include "common/base/provenance.h"
#include "common/base/textfile.h"
#include "common/light/gloss.h"

#define MATERIAL_PHONG_MAX GLOSS_PHONG_MAX /* the exponent is 1 to this, Ward's roughness 0.02 to 1 */
enum { MATERIAL_MODELS = 3 };              /* values of enum brdf_kind */

/* A polygon of pixels of a photograph, as it is stored; VIEW is a photo's id or a view's name. */
struct material_region {
    char *view;    /* owned */
    double *pixel; /* x y of each corner; owned */
    int corners;   /* 3 or more */
    int line;      /* of the file it was read from */
};

struct material_range {
    double low, high; /* INFINITY: no bound */
};

struct material {
    char *name; /* owned */
    struct material_region *regions;
    int region_count;
    enum brdf_kind kind;
    double k_d[3], ks, shape;                                  /* ks and shape are 0 for Lambert */
    struct material_range k_d_range[3], ks_range, shape_range; /* 95 % */
    int samples, points, views;
    double scale;                  /* residuals are about this many standard deviations */
    double error[MATERIAL_MODELS]; /* cross-validated; -1: was not computed */
    char *why;                     /* the model was chosen; owned */
};

/* {0} is the empty state; everything is owned. */
struct material_list {
    struct material *items;
    int count;
};

/* ST_DATA with file and line: a damaged line, a name twice, a line of a material that no line above has, numbers out of
 * range. */
enum status material_list_read(struct material_list *l, const char *path, struct provenance *prov, struct err *err);
enum status material_list_write(const struct material_list *l, const char *path, const struct provenance *prov,
                                struct err *err);
void material_list_release(struct material_list *l);

/* The next empty material, which the list owns. ST_DATA at the line of t: the name is taken. */
enum status material_list_add(struct material **added, struct material_list *l, const char *name, struct textfile *t,
                              struct err *err);
struct material *material_list_find(const struct material_list *l, const char *name); /* NULL: not there */

/* Reads VIEW X Y X Y X Y ... up to a word that is not a number, and adds it to the material. */
enum status material_read_region(struct material *m, struct textfile *t, struct err *err);
bool material_region_holds(const struct material_region *r, double x, double y);
double material_region_area(const struct material_region *r); /* square pixels */

const char *material_kind_name(enum brdf_kind kind); /* lambert, phong, ward */
/* Reads that word. */
enum status material_read_kind(enum brdf_kind *kind, struct textfile *t, struct err *err);
/* The reflectance for common/light/brdf.h. */
struct brdf material_brdf(const struct material *m);

#endif
