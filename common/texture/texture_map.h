/* texture_map.h - where the faces of an edited model take their texture: out/SCENE/remodel/E/texture.txt, written by
 * build_model [Colburn 2014, 4.5.4, 4.7].
 *
 * Models are united anew after an edit, so corners have no counterpart. Instead each plane of the edited model that
 * carries a face's id has rules, in order: the first rule that covers a point of the face gives its texture there.
 * "The baked domain" is the area of the unedited model and of all declared edits (surfaces.h), which the atlases hold.
 *
 *   remodel-texture 3
 *   base E|none                                        the edit that this one stands on
 *   lamp NAME R G B                                    the radiance of this lamp of lights.txt is multiplied; 0 0 0:
 *                                                      off
 *   planned NAME FILE X Y Z DX DY DZ TURN R G B R G B  a lamp that the edit adds, with an IES file of the scene: its
 *                                                      place, aim, turn, the colour of its light, and factors
 *   face ID NX NY NZ OFFSET NAME                       a plane of the edited model; its gloss and its rules follow
 *   gloss matt|phong KS N|ward KS ALPHA                the gloss of the face (gloss.h); without this line the edit does
 *                                                      not say it
 *   place FROM M [within X Y Z X Y Z X Y Z X Y Z]      the face FROM of the unedited model at M p, where it is baked
 *   edge FROM M [within ...]                           the baked texel of FROM nearest to M p: covers every point
 *   outdoors                                           a pane: what lies outside, by direction; covers every point
 *   colour R G B lit FROM FROM ... [within ...]        an albedo under the light of these unedited faces; every point
 *   new COUNT                                          triangles of the face that the unedited model does not have in
 *   triangle X Y Z X Y Z X Y Z                         this plane under this id, COUNT lines
 *   clear ROOM LOW HIGH COUNT X Y ...                  clutter is left out in this footprint, from LOW to HIGH
 *   keep NAME LOW HIGH COUNT X Y ...                   but not in this one
 *   thing NAME clear | keep SCRIPT LINE                leaves a photographed thing out; keeps it in a cleared place
 *   thing NAME move FROM DX DY UP TURN SCRIPT LINE     shifts the thing FROM, and turns it
 *   thing NAME place FROM X Y FLOOR TURN SCRIPT LINE   puts the middle of its footprint at X Y, at this floor's height
 *
 * SCRIPT and LINE: the file, without its folder, and the line of the statement that said so last, for messages.
 * Where NAME is FROM, the thing leaves its own place; otherwise NAME is a copy of it.
 *
 * Points are of the edited model's frame, which is the unedited one's. M is twelve numbers, a 3 x 4 matrix by rows,
 * that takes a point of the edited model to one of the unedited model: the identity for texture that stays in place
 * (crop), a shift for a wall that carries its texture along, a scale for a pane that is stretched. `within` limits a
 * rule to a quadrilateral of the face. */
#ifndef REMODEL_TEXTURE_MAP_H
#define REMODEL_TEXTURE_MAP_H

#include <stdbool.h>

#include "common/base/provenance.h"
#include "common/light/gloss.h"
#include "common/math/vec.h"

enum texture_rule_kind { TEXTURE_PLACE, TEXTURE_EDGE, TEXTURE_OUTDOORS, TEXTURE_COLOUR };

struct texture_rule {
    enum texture_rule_kind kind;
    int from;              /* id of a face of the unedited model: PLACE, EDGE */
    double matrix[3][4];   /* PLACE, EDGE */
    float albedo[3];       /* COLOUR */
    int *lit;              /* COLOUR: faces of the unedited model that show the light there; owned */
    int lit_count;         /* 0: the whole model does */
    bool limited;          /* to `within` */
    struct vec3 within[4]; /* corners in order */
};

struct texture_face {
    int id;
    char *name;         /* owned */
    struct vec3 normal; /* unit, outward, as in model.txt: normal . p = offset */
    double offset;
    struct texture_rule *rules; /* owned */
    int rule_count;
    struct vec3 (*added)[3]; /* triangles that the unedited model lacks; owned */
    int added_count;
    bool has_gloss;     /* the edit gives the face a gloss, which may be matt */
    struct gloss gloss; /* on top of the rules' texture or colour */
};

/* A lamp that the edit dims, brightens or turns off. */
struct texture_lamp {
    char *name;      /* in lights.txt; owned */
    double scale[3]; /* factors of its radiance: red, green, blue */
};

/* A lamp that the edit adds. */
struct texture_planned {
    char *name, *file;                               /* owned */
    double at[3], aim[3], turn, colour[3], scale[3]; /* degrees */
};

/* A part of the building, by its footprint, in which clutter is left out or kept. */
struct texture_zone {
    char *name; /* owned */
    bool keep;
    double low, high;
    double (*corners)[2]; /* counter-clockwise; owned */
    int corner_count;
};

enum texture_thing_kind { TEXTURE_THING_CLEAR, TEXTURE_THING_KEEP, TEXTURE_THING_MOVE, TEXTURE_THING_PLACE };

/* What an edit does with a thing, or a copy of one. */
struct texture_thing {
    enum texture_thing_kind kind;
    char *name, *from; /* the same but for copies; owned */
    double by[3];      /* MOVE: the shift; PLACE: the middle of the footprint, and the floor's height */
    double turn;       /* degrees, counter-clockwise from above, about the middle of its footprint */
    char *script;      /* file name of the script that says so, for messages; owned */
    int line;          /* of its statement, from 1 */
};

/* {0} is the empty state. */
struct texture_map {
    char *base;                 /* NULL: none; owned */
    struct texture_lamp *lamps; /* names are unique; owned */
    int lamp_count;
    struct texture_planned *planned; /* owned */
    int planned_count;
    struct texture_face *faces; /* in order of id, then of the edited model's faces; owned */
    int face_count;
    struct texture_zone *zones; /* owned */
    int zone_count;
    struct texture_thing *things; /* owned */
    int thing_count;
};

void texture_map_release(struct texture_map *map);
/* Copies the texts. */
enum status texture_map_add_thing(struct texture_map *map, const struct texture_thing *thing, struct err *err);
/* The face of an id whose plane holds p best; NULL: there is none of that id. */
const struct texture_face *texture_map_find(const struct texture_map *map, int id, struct vec3 p);
/* Whether the limits of a rule hold p, a point of the rule's face. */
bool texture_rule_holds(const struct texture_rule *rule, struct vec3 normal, struct vec3 p);
struct vec3 texture_rule_place(const struct texture_rule *rule, struct vec3 p); /* M p */
/* Whether the face of an id still shows at p, within `slack`, what it showed there in the unedited model: its own
 * texture in place, or what lies outdoors behind a pane. So does a face that the map does not list. */
bool texture_map_keeps(const struct texture_map *map, int id, struct vec3 p, double slack);
/* The factors of a lamp's radiance; NULL: the edit does not name it. */
const double *texture_map_lamp(const struct texture_map *map, const char *name);
/* Whether clutter at p is left out: p is in a zone to clear and in none to keep. */
bool texture_map_clears(const struct texture_map *map, struct vec3 p);

/* ST_DATA: the base is named "none", a lamp's factor is below 0 or not finite, the place of a thing is not finite, a
 * face has more than 100 000 added triangles, a zone as many corners or fewer than 3: texture_map_read() would refuse
 * it. */
enum status texture_map_write(const struct texture_map *map, const char *path, const struct provenance *prov,
                              struct err *err);
/* ST_DATA with file and line. A failure leaves map empty. */
enum status texture_map_read(struct texture_map *map, const char *path, struct provenance *prov, struct err *err);

#endif
