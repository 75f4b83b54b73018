/* textures.h - the atlases of a scene: where they are, and the model whose faces they show. */
#ifndef REMODEL_TEXTURES_H
#define REMODEL_TEXTURES_H

#include "common/model/solid_mesh.h"
#include "common/texture/atlas.h"
#include "stages/evaluate/scene/evaluation_parts.h"

struct textures {
    char (*viewpoints)[256]; /* O/vdta/NAME, in order of name; owned */
    int viewpoint_count;
    bool vita;              /* O/vita */
    struct solid_mesh mesh; /* O/model/model.txt */
    int *face_of_id;        /* a face with the id, -1: none; owned */
    int ids;                /* the largest id of the model + 1 */
};

/* Finds atlases; reads the model only if there are some. */
enum status textures_find(struct textures *t, struct evaluation *e, struct err *err);
void textures_release(struct textures *t);

/* O/vdta/NAME, or O/vita if name is NULL. */
enum status textures_folder(char folder[FILE_PATH], const struct evaluation *e, const char *name, struct err *err);
/* Reads an atlas, which becomes an input. The caller releases it. */
enum status textures_read(struct atlas *a, struct evaluation *e, const char *name, struct err *err);
/* A face with the id, -1: the model has none. */
int textures_face(const struct textures *t, int id);

#endif
