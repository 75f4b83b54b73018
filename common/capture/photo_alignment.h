/* photo_alignment.h - cameras of another model in the scene's frame, by the scene's photographs in that model. */
#ifndef REMODEL_PHOTO_ALIGNMENT_H
#define REMODEL_PHOTO_ALIGNMENT_H

#include "common/capture/camera_alignment.h"
#include "common/capture/sfm_model.h"

/* The scene's photographs: the folder of its views, and that of the records of its photos. */
struct scene_photos {
    const char *views, *records;
    struct provenance *prov; /* gets the files of views; NULL: none is recorded */
};

struct alignment_rules {
    double max_misfit;             /* %: largest median distance after alignment, of the photographs' extent */
    const char *if_few, *if_apart; /* what to do if there are too few common photographs, or they disagree */
};

/* How well the photographs that both models have agree, after alignment. */
struct frame_agreement {
    int photos;                  /* 0: the frame was not found from photographs */
    struct camera_errors errors; /* centres in units of `extent` */
    double extent;               /* of the scene's common photographs: largest distance from their mean, scene units */
};

/* folder: of the model, for messages. ST_DATA: too few common photographs, all in one place, or they disagree. */
enum status photo_alignment_find(struct similarity *model_from_scene, struct frame_agreement *agreement,
                                 const struct sfm_model *model, const char *folder, const struct scene_photos *scene,
                                 const struct alignment_rules *rules, struct err *err);

/* A camera of the model in the scene: it has the same picture. */
struct pose photo_alignment_pose(const struct pose *in_model, const struct similarity *model_from_scene);

#endif
