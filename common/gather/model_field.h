/* model_field.h - the field of light of a textured model: its VITA, its lamps, and the outdoors through its openings.
 *
 * Everything is in the model's frame and units. */
#ifndef REMODEL_GATHER_MODEL_FIELD_H
#define REMODEL_GATHER_MODEL_FIELD_H

#include "common/gather/field_materials.h"
#include "common/gather/field_openings.h"
#include "common/gather/field_sky.h"
#include "common/gather/irradiance.h"

/* Where a model's light is read from. */
struct model_field_files {
    const char *model;                     /* model.txt */
    const char *vita;                      /* folder of the VITA */
    const char *outdoors;                  /* outdoors.exr; NULL: it is dark outside */
    const char *lights;                    /* lights.txt; NULL: no lamps, and the panes of the model are its openings */
    const struct field_surfaces *surfaces; /* NULL: none */
};

/* Further surfaces in the model, synthetic objects: triangles and what each sends out, on its front and on its back.
 * Both arrays are the caller's, must outlive the field, and may change between gathers. */
struct field_surfaces {
    struct model_extra triangles;
    const struct rgb (*radiance)[2];
};

/* A lamp, ready for rays: q, from its centre, is a x + b y with a = dual[0].q and b = dual[1].q. */
struct field_lamp {
    const struct lamp *lamp; /* of `lights` */
    struct vec3 dual[2];
    bool off;
};

/* {0} is the empty state; everything is owned. */
struct model_field {
    struct light_field field; /* for the estimators; its ctx is this struct, which must not move */
    struct light_field plain; /* the same as photographed: texels of glossy materials look alike from everywhere */
    struct model_rays model;  /* without panes: rays pass them; with `surfaces` behind its faces */
    const struct field_surfaces *surfaces;
    struct field_atlas atlas;
    struct outdoors outdoors;
    struct field_sky sky;
    struct light_list lights;
    struct field_lamp *lamps;
    struct field_openings openings;
    struct field_materials materials;
    struct emitter *emitters;  /* lamps, then openings, then suns */
    struct face_plane *planes; /* of each face id */
    double reach;              /* how far a lamp may be behind the surface that it lies on, model units */
    int covered_texels;        /* under and around lamps */
};

/* Reads everything and adds the files to prov, which may be NULL. The caller releases the field, also after a failure.
 * ST_DATA: a damaged file, or an atlas that is no VITA. */
enum status model_field_read(struct model_field *f, const struct model_field_files *files, struct provenance *prov,
                             struct err *err);
void model_field_release(struct model_field *f);

/* Reads the lighting reference images that the openings of lights.txt name, FOLDER/ID.exr, with their places in the
 * scene: a ray through such an opening sees the first of them that shows its direction, and outdoors.exr where none
 * does. ST_DATA also: an image without a pose, or that shows nothing of the outdoors, because it lies in a solid or
 * looks at one. */
enum status model_field_read_references(struct model_field *f, const char *folder, const struct model_axes *axes,
                                        struct provenance *prov, struct err *err);

/* Reads materials.txt (field_materials.h), once for a field, after model_field_read(). From then on a ray that meets a
 * texel of a glossy material sees it as its own origin would, with the source LIGHT_MATERIAL. */
enum status model_field_read_materials(struct model_field *f, const char *path, const char *views,
                                       const struct model_axes *axes, struct provenance *prov, struct err *err);

/* The material at a point of a face, an index into materials.list; -1: none, or no texel. Model frame. */
int model_field_material(const struct model_field *f, int face_id, struct vec3 p);
/* From where the texel at a point of a face was photographed, as far as its mark knows; *viewpoint is unchanged where
 * it has none. */
void model_field_viewpoint(const struct model_field *f, int face_id, struct vec3 p, struct vec3 *viewpoint);

/* Switches a lamp (an index into `lights`; -1: all) off or on. In the place of a lamp that is off there is the ceiling,
 * in the colour of its surroundings: what is left is the light from elsewhere. Not while others gather. */
void model_field_switch_lamp(struct model_field *f, int lamp, bool on);

/* Multiplies the radiance of the lamp of this name; 0 0 0 switches it off. Unknown names are left alone. */
void model_field_scale_lamp(struct model_field *f, const char *name, const double scale[3]);

/* Adds an emitter for each pane that lights.txt names and that `was`, the field before an edit, has at another place or
 * in another size, because lights.txt describes the window as it was. Call it last, after lamps were switched or
 * scaled. */
void model_field_add_changed_panes(struct model_field *f, const struct model_field *was);

/* The nearest lamp that is on and seen from its bright side, on a ray from `from` in a unit direction up to the
 * distance t of a surface (INFINITY allowed), or a little behind that; sets *at to its distance. NULL: none. */
const struct lamp *model_field_lamp(const struct model_field *f, struct vec3 from, struct vec3 direction, double t,
                                    double *at);

/* Whether a surface hides a lamp at the distance `at` beyond it, however near: one across the lamp's plane does, such
 * as a wall that an edit puts under it. The ceiling that the lamp lies on may be in front of it by an error. */
bool model_field_hides_lamp(const struct lamp *lamp, double at, const struct ray_hit *hit);

/* What a ray that leaves the model sees of the outdoors: through an opening with reference images theirs, otherwise
 * outdoors.exr. */
enum light_source model_field_outdoors(struct rgb *radiance, const struct model_field *f, struct vec3 from,
                                       struct vec3 direction);

/* The rectangle around a pane of glass, a body of the mesh, as an emitter; its normal points indoors. False: the body
 * is something else, or daylight does not pass it, because both of its sides or neither are indoors. */
bool model_field_pane(struct emitter *pane, const struct model_field *f, int body);

/* Whether a point is behind a surface of the model, that is in a solid, with the surface no further than `most` ahead
 * along its normal. Then it is moved there: photographs and the model agree on a surface to some centimetres only. */
bool model_field_lift(const struct model_field *f, struct gather_point *p, double most);

#endif
