/* scene_file.h - a described scene: scenes/NAME/scene.txt (docs/scenes.md).
 *
 * Metres, z up, degrees as in the file; radiance is scene-linear Rec.709. This is the description only: geometry.h
 * builds the faces, light_sampling.h the lights. */
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
    int texture; /* index */
    double ks, shape;
    double gloss;    /* maximum reflectance of the lobe */
    struct rgb glow; /* radiance that each surface of the material emits */
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
};

/* An object of the scene; items keep the order of the file, those of a base come first. */
struct scene_item {
    enum item_kind kind;
    char *name;
    int material, ceiling;                    /* indices; material -1: a lamp; ceiling: a room's second material */
    int wall;                                 /* opening, window: index of the wall; else -1 */
    int line;                                 /* in its file */
    bool furniture;                           /* a box, quad or mesh that pictures of the shell leave out */
    double x0, y0, x1, y1, z0, z1, thickness; /* wall, box, room */
    double s0, s1;                       /* opening, window: range along the wall's centre line; heights in z0, z1 */
    double turn, scale;                  /* box, mesh */
    struct vec3 at, u, v;                /* quad: corner and edges; mesh: position; disk: centre, and normal in u */
    double radius, half_angle, exponent; /* disk */
    struct rgb radiance;                 /* lamps */
    struct vec3 (*triangles)[3];         /* mesh, in the coordinates of its file; owned */
    int triangle_count;
};

struct scene {
    struct scene_texture *textures;
    struct scene_material *materials;
    struct scene_item *items;
    int texture_count, material_count, item_count;
    struct sky_params sky;
    char *base;   /* an edit: the file that it changes; else NULL */
    int *dropped; /* lines of the base that the edit drops */
    int dropped_count;
};

/* Reads FOLDER/FILE and the meshes beside it that it names. ST_DATA names file, line, the word found and the word
 * expected: unknown words, names that are unknown or used twice, sizes out of range, materials that reflect more light
 * than they receive, openings outside their wall or overlapping. A scene without a light source is rejected. prov (may
 * be NULL) gets the hashes of the files. The caller releases *s; on failure there is nothing to release. */
enum status scene_read(struct scene *s, const char *folder, const char *file, struct provenance *prov, struct err *err);

/* Writes the scene that was read from FOLDER/FILE as a file of its own: a copy of FILE, or for an edit the lines of its
 * base without the dropped ones, then those that it adds. */
enum status scene_write(const struct scene *s, const char *folder, const char *file, const char *path, struct err *err);
void scene_release(struct scene *s);

#endif
