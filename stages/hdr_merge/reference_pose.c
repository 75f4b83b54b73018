/* reference_pose.c - moves the pose of a lighting reference image to the scene's frame: by the photographs that its
 * model and the scene have in common (common/capture/photo_alignment.c), or by axes.txt for a pose in the frame of the
 * room's model. */
#include "stages/hdr_merge/reference_pose.h"

#include "common/model/model_axes.h"

enum status reference_pose_find(struct pose *cam_from_world, struct frame_agreement *agreement,
                                const struct sfm_model *model, const char *folder, const struct reference_frame *frame,
                                const struct merge_params *params, struct provenance *prov, struct err *err)
{
    struct similarity model_from_scene = {0};
    struct model_axes axes = {0};
    *agreement = (struct frame_agreement){0};
    if (!frame->views && !frame->axes) return ST_OK;
    if (frame->axes) {
        model_axes_read(&axes, frame->axes, prov, err);
        model_from_scene = (struct similarity){axes.scale, mat3_from_quat(axes.rotation), axes.translation};
    } else {
        const struct scene_photos scene = {frame->views, frame->records, prov};
        const struct alignment_rules rules = {
            params->max_misfit,
            "Otherwise the pose of the lighting reference images in the scene is unknown. Give a model made from "
            "photographs of the scene and reference images together, or set LRI_FRAME = scene or model if the poses "
            "are in one of these frames.",
            "Give a model of the same photographs, or raise [hdr_merge] max_misfit."};
        photo_alignment_find(&model_from_scene, agreement, model, folder, &scene, &rules, err);
    }
    if (!err->status) *cam_from_world = photo_alignment_pose(cam_from_world, &model_from_scene);
    return err->status;
}
