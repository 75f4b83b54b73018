/* room_camera.h - cameras that a user gives, of any lens, and pictures from them. */
#ifndef REMODEL_RENDER_ROOM_CAMERA_H
#define REMODEL_RENDER_ROOM_CAMERA_H

#include "stages/render_model/drawn_room.h"

struct room_camera {
    char *name; /* owned by the list */
    struct camera lens;
    struct pose pose; /* cam_from_model */
};

struct room_cameras {
    struct room_camera *list; /* in order of name; owned */
    int count;
};

/* Where given cameras are. */
enum camera_frame {
    FRAME_SCENE, /* the frame of O/views */
    FRAME_MODEL, /* the frame of axes.txt */
    FRAME_PHOTOS /* that of a model which has the scene's photographs */
};

struct camera_source {
    const char *folder; /* cameras.txt, images.txt */
    enum camera_frame frame;
    const char *photos;  /* FRAME_PHOTOS: a folder like it, whose images are photographs of the scene */
    const char *records; /* of the scene's photos */
};

/* The caller releases the list in each case. ST_DATA: no cameras, damaged files, photographs that disagree. */
enum status room_cameras_read(struct room_cameras *cameras, const struct camera_source *source, const struct room *room,
                              struct provenance *prov, struct err *err);
void room_cameras_release(struct room_cameras *cameras);

/* The camera as a view in the model's frame; false: its lens is not a pinhole. */
bool room_camera_view(struct view *view, const struct room_camera *camera);

/* Draws the picture of a camera. A lens that is no pinhole takes it from the faces of a cube around the camera. */
enum status room_camera_draw(struct model_picture *picture, struct room *room, const struct room_camera *camera,
                             const struct texture_pair *pair, struct provenance *prov, struct err *err);

#endif
