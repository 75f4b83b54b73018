/* scene_file.h - a described scene, as scenes/NAME/scene.txt tells it (docs/scenes.md).
 *
 * Metres, z up, degrees as the file has them; radiance is scene-linear Rec.709. Nothing is built yet: geometry.h makes
 * faces of it, lights.h lights. */
#ifndef REMODEL_SIMULATE_SCENE_FILE_H
#define REMODEL_SIMULATE_SCENE_FILE_H

#include <stdbool.h>

#include "common/base/err.h"
#include "common/base/provenance.h"
#include "common/light/brdf.h"
#include "common/light/sky.h"
#include "common/math/vec.h"
#include "stages/simulate/texture.h"

struct scene_texture {
    char *name;
    struct texture texture;
};

struct scene_material {
    char *name;
    enum brdf_kind kind;
    int texture;
    double ks, shape;
    double gloss;    /* largest reflectance of the lobe */
    struct rgb glow; /* radiance that every surface of it emits */
};

enum item_kind {
    ITEM_WALL,
    ITEM_OPENING,
    ITEM_WINDOW,
    ITEM_BOX,
    ITEM_QUAD,
    ITEM_MESH,
    ITEM_ROOM,
    ITEM_LAMP_QUAD,
    ITEM_LAMP_DISK,
    ITEM_KINDS,
};

/* What stands in the scene, in file order. */
struct scene_item {
    enum item_kind kind;
    char *name;
    int material, ceiling;                    /* a lamp has none: -1; ceiling: a room's second one */
    int wall;                                 /* of an opening: which item */
    double x0, y0, x1, y1, z0, z1, thickness; /* wall, box, room */
    double s0, s1;                            /* opening, window: along the wall's centre line; heights in z0, z1 */
    double turn, scale;                       /* box, mesh */
    struct vec3 at, u, v;                     /* quad: corner and edges; mesh: at; disk: centre, and its normal in u */
    double radius, half_angle, exponent;      /* disk */
    struct rgb radiance;                      /* lamps */
    struct vec3 (*triangles)[3];              /* mesh, as its file has them; owned */
    int triangle_count;
};

struct scene {
    struct scene_texture *textures;
    struct scene_material *materials;
    struct scene_item *items;
    int texture_count, material_count, item_count;
    struct sky_params sky;
};

/* Reads FOLDER/FILE and the meshes it names beside it. ST_DATA with file, line, what was found and what was wanted:
 * unknown words, names used twice or not known, sizes that are none, materials that would reflect more than all light,
 * openings outside their wall or through one another. A scene in which nothing emits light is refused. prov (may be
 * NULL) gets what was read. */
enum status scene_read(struct scene *s, const char *folder, const char *file, struct provenance *prov, struct err *err);
void scene_release(struct scene *s);

#endif
