/* field_openings.c - see field_openings.h.
 *
 * A ray that leaves the model passes the opening whose quad it cuts, from the inside; of several the nearest. The
 * frames of the model and lights.txt agree to some centimetres, so a quad counts with a margin of MARGIN of its size.
 * What lies outside is far away: the reference image is looked up by direction alone [Colburn 2014, 5.3.2]. An image
 * does not count where it is clipped, or where its own ray meets the model: there it shows the reveal in which its
 * camera stood, or dark corners beyond a fisheye's circle (outdoors_picture.c). The next image of the opening comes
 * after it. */
#include "common/gather/field_openings.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "common/product/product.h"

static const double MARGIN = 0.05;
static const struct outdoors_limits limits = {.edge = 2, .max_clutter = 1};

void field_dual(struct vec3 dual[2], struct vec3 x, struct vec3 y)
{
    const struct vec3 n = vec3_cross(x, y);
    const double nn = vec3_dot(n, n);
    dual[0] = vec3_scale(vec3_cross(y, n), 1 / nn);
    dual[1] = vec3_scale(vec3_cross(n, x), 1 / nn);
}

/* ---------------------------------------------------------------------------------------------------------- look-up */

static const struct field_opening *passed(const struct field_openings *all, struct vec3 from, struct vec3 direction)
{
    const struct field_opening *found = NULL;
    double nearest = INFINITY;
    for (int i = 0; i < all->count; i++) {
        const struct field_opening *o = &all->items[i];
        const double cosine = -vec3_dot(direction, o->opening->normal);
        const struct vec3 to = vec3_sub(o->opening->centre, from);
        const double t = -vec3_dot(to, o->opening->normal) / cosine;
        if (!(cosine > 0) || !(t > 0 && t < nearest)) continue;
        const struct vec3 q = vec3_sub(vec3_scale(direction, t), to);
        if (!(fabs(vec3_dot(o->dual[0], q)) <= 1 + MARGIN && fabs(vec3_dot(o->dual[1], q)) <= 1 + MARGIN)) continue;
        found = o;
        nearest = t;
    }
    return found;
}

bool field_openings_look(float rgb[3], const struct field_openings *o, struct vec3 from, struct vec3 direction)
{
    const struct field_opening *way = passed(o, from, direction);
    for (int i = 0; way && i < way->reference_count; i++)
        if (outdoors_picture_sample(rgb, NULL, &o->pictures[way->references[i]], direction) == SHOWS_OUTDOORS)
            return true;
    return false;
}

/* ---------------------------------------------------------------------------------------------------------- reading */

void field_openings_release(struct field_openings *o)
{
    for (int i = 0; i < o->count; i++) free(o->items[i].references);
    for (int i = 0; i < o->picture_count; i++) outdoors_picture_release(&o->pictures[i]);
    free(o->items);
    free(o->pictures);
    *o = (struct field_openings){0};
}

struct reading {
    struct field_openings *openings;
    const struct model_rays *model;
    const char *folder;
    const struct model_axes *axes;
    struct provenance *prov;
};

static enum status read_picture(const struct reading *r, const char *id, struct err *err)
{
    char path[FILE_PATH];
    bool placed, shows;
    struct outdoors_picture *p = &r->openings->pictures[r->openings->picture_count++];
    if (product_path_in(path, r->folder, PRODUCT_LRI, &(struct product_key){.photo = id}, err) ||
        outdoors_picture_of_reference(p, path, r->axes, &placed, err))
        return err->status;
    if (!placed)
        return err_set(err, ST_DATA,
                       "%s has no pose in the scene, but an opening of lights.txt names it; give it one by LRI_SFM or "
                       "scenes/NAME/lri.txt, and run `make lri` again.",
                       path);
    if (outdoors_picture_load(p, &shows, r->model, NULL, &limits, r->prov, err)) return err->status;
    if (!shows)
        return err_set(err, ST_DATA,
                       "%s shows nothing outside of the model, but an opening of lights.txt names it; check its pose, "
                       "or take it out of scenes/NAME/lights.txt.",
                       path);
    return ST_OK;
}

/* The index of a reference image, read if it is new. */
static enum status find_picture(int *index, const struct reading *r, const char *id, struct err *err)
{
    for (*index = 0; *index < r->openings->picture_count; (*index)++)
        if (!strcmp(r->openings->pictures[*index].name, id)) return ST_OK;
    return read_picture(r, id, err);
}

static enum status add_opening(const struct reading *r, const struct daylight *opening, struct err *err)
{
    if (!opening->reference_count) return ST_OK;
    struct field_opening *o = &r->openings->items[r->openings->count++];
    *o = (struct field_opening){.opening = opening};
    field_dual(o->dual, opening->x, opening->y);
    o->references = calloc((size_t)opening->reference_count, sizeof *o->references);
    if (!o->references) return err_nomem(err, "references", (size_t)opening->reference_count * sizeof *o->references);
    for (int k = 0; k < opening->reference_count; k++) {
        if (find_picture(&o->references[k], r, opening->references[k], err)) return err->status;
        o->reference_count++;
    }
    return ST_OK;
}

enum status field_openings_read(struct field_openings *o, const struct light_list *lights,
                                const struct model_rays *model, const char *folder, const struct model_axes *axes,
                                struct provenance *prov, struct err *err)
{
    struct provenance unused = {0};
    const struct reading r = {o, model, folder, axes, prov ? prov : &unused};
    size_t most = 1;
    field_openings_release(o);
    for (int i = 0; i < lights->opening_count; i++) most += (size_t)lights->openings[i].reference_count;
    o->items = calloc((size_t)lights->opening_count + 1, sizeof *o->items);
    o->pictures = calloc(most, sizeof *o->pictures);
    if (!o->items || !o->pictures) err_nomem(err, "reference images", most * sizeof *o->pictures);
    for (int i = 0; !err->status && i < lights->opening_count; i++) add_opening(&r, &lights->openings[i], err);
    provenance_release(&unused);
    return err->status;
}
