/* scene_rules.h - what the rules of several stages say alike. */
#ifndef REMODEL_SCENE_RULES_H
#define REMODEL_SCENE_RULES_H

#include "common/graph/graph.h"
#include "common/graph/scene_facts.h"

/* OPTION FOLDER: the photos as people gave them, or the parts of multi-lens pictures. */
void rule_originals(struct graph *g, const char *option);
/* The same of what later stages take for the photos: where photos are brackets, the merged ones. */
void rule_photos(struct graph *g, const struct scene_facts *f, const char *option);
/* What the views of a photo are made from: its merged exposures, or its record, which changes with it. */
const char *scene_photo_source(struct graph *g, const struct scene_facts *f, const char *photo);
/* Whether photos are compared with each other: the cameras are found from them, or a given model has no points. */
bool scene_matches_photos(struct graph *g, const struct scene_facts *f);
/* --masks FOLDER where the scene has masks. */
void rule_masks(struct graph *g, const struct scene_facts *f);

/* What many stages read: they need the files, and an option names the folder. Cameras: --views; depth maps of all
 * views: --depth; faces that the views see: --ids; the atlas of all faces: --vita. */
void rule_takes_cameras(struct graph *g);
void rule_takes_depth(struct graph *g);
void rule_takes_ids(struct graph *g);
void rule_takes_vita(struct graph *g);
/* Furniture: --things, if the scene has views. */
void rule_takes_things(struct graph *g, const struct scene_facts *f);
/* What programs read that look at the model in the photos: --model, --axes, cameras with their lenses and views, and
 * the faces that the views see. */
void rule_takes_seen_model(struct graph *g);
/* The cameras of the views that are held out, and their list. */
void rule_needs_held_cameras(struct graph *g);

/* The response curve of bracketed photos: the scene's own, else the fitted one, which is written only if it is new, so
 * that rules need its text and wait for the stamp. */
void rule_needs_response(struct graph *g);
const char *scene_response(struct graph *g);

/* The folder of a model below the scene's: "model", "remodel/EDIT"; i: -1 for the unedited one, else one of `edits`. */
const char *scene_model_folder(struct graph *g, const struct name_list *edits, int i);
bool scene_model_is_edited(const char *model);
/* Its own name: "model", "EDIT". */
const char *scene_model_name(const char *model);

/* The lighting reference images that `make lri` has made, one rule_needs() each. False: there are none. */
bool rule_needs_references(struct graph *g, const struct scene_facts *f);
bool scene_has_references(struct graph *g, const struct scene_facts *f);

/* Lamps and materials that somebody marked in a scene with a model; NULL: nobody did. */
const char *scene_lights(struct graph *g, const struct scene_facts *f);
const char *scene_materials(struct graph *g, const struct scene_facts *f);

/* The scale to lx: made where somebody measured, else where `make luminance` has made it, since photos need not say
 * their exposure; NULL: there is none. */
const char *scene_lux_scale(struct graph *g, const struct scene_facts *f);
/* IES files of luminaires in the scene's folder. */
bool scene_has_webs(struct graph *g, const struct scene_facts *f);
void rule_needs_webs(struct graph *g, const struct scene_facts *f);

/* What a change of light is computed from, by the edit's name: needs, and options of the programs. */
void rule_needs_light_change(struct graph *g, const struct scene_facts *f, const char *edit);
void rule_light_change(struct graph *g, const struct scene_facts *f, const char *edit);

/* The path of a film, as frames and videos need it; of a tour, whose pairs say what each frame blends. */
void rule_needs_path(struct graph *g, const char *film);
void rule_needs_tour(struct graph *g, const char *tour);
/* encode_video makes the video of a film from these frames; `planned` is the film whose path they follow. The caller
 * adds the files of that path. */
void rule_encodes(struct graph *g, const char *film, const struct name_list *frames, const char *planned);
/* The numbers of the frames of a planned tour. */
void scene_tour_frames_read(struct graph *g, struct name_list *frames, const char *tour);

/* Whether a film goes its own way, whatever views a move would be made from: a film of keys (scenes/NAME/keyframes), or
 * that of given cameras (CAMERAS). */
bool scene_film_is_given(const char *film);
bool scene_film_is_free(struct graph *g, const char *film);

/* Of an eye's folder below that of a film: the part of a log's name, "-vr180-left"; whether it sees a half-sphere. */
const char *scene_item(struct graph *g, const char *eye);
bool scene_is_half_sphere(const char *eye);

/* Frames come in chunks of FRAMES_PER_JOB: how many the one that begins with `first` has. */
int scene_chunk_size(const struct scene_facts *f, const struct name_list *frames, int first);

/* What render_model draws a model from, by its folder below O: needs, and options. */
void rule_draws_model(struct graph *g, const char *model);
/* The same for the views of a photo, of an edited model: PICTURES/VIEW.txt of each, which are goals too. */
void rule_draws_photo(struct graph *g, const char *edit, const char *pictures, const struct photo_views *p,
                      const char *goal);

/* Adds a product to a list if a run makes it (wanted), or if it exists. */
void graph_list_if(struct graph *g, enum graph_list_kind list, const char *path, bool wanted);

/* Whether the scene asks for one of these words (blanks between them). */
bool scene_asks_for_any(const struct scene_facts *f, const char *words);

#endif
