/* path_export.c - export of a camera move as transforms.json and blender.py.
 *
 * A frame's JSON object of numbers and plain strings is also a valid Python dictionary, so blender.py contains the same
 * frame lines as transforms.json.
 *
 * Blender's camera has its sensor fitted to the picture's width: the width spans the angle that sensor_width spans at
 * the distance `lens`; shifts are fractions of the width. Non-square pixels (fx and fy differ) become the render's
 * pixel aspect, which Blender has once for all frames: that of the first frame. */
#include "stages/plan_path/path_export.h"

#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "common/product/product.h"

enum { NUMBER = JSON_ENCODE_ANY | JSON_REAL_PRECISION(17) };

static json_t *frame_json(const struct path_frame *f)
{
    const struct view *v = &f->camera;
    const struct mat3 r = mat3_transpose(v->cam_from_world);
    const struct vec3 c = vec3_scale(mat3_apply(r, v->translation), -1);
    json_t *file = json_sprintf("frames/%s.exr", v->name);
    return json_pack("{s:o, s:f, s:[[f,f,f,f],[f,f,f,f],[f,f,f,f],[f,f,f,f]], s:f, s:f, s:f, s:f, s:i, s:i, s:f, s:f}",
                     "file_path", file, "time", f->time, "transform_matrix", r.m[0][0], -r.m[0][1], -r.m[0][2], c.x,
                     r.m[1][0], -r.m[1][1], -r.m[1][2], c.y, r.m[2][0], -r.m[2][1], -r.m[2][2], c.z, 0.0, 0.0, 0.0, 1.0,
                     "fl_x", v->fx, "fl_y", v->fy, "cx", v->cx, "cy", v->cy, "w", v->width, "h", v->height, "aperture",
                     f->aperture, "focus", f->focus);
}

/* The fields before the frames. The lens is among them only if it is constant, since readers apply these fields to all
 * frames. */
static json_t *head_json(const struct camera_path *p, const struct provenance *prov)
{
    const struct view *first = &p->frames[0].camera;
    bool same = true;
    for (int i = 1; i < p->frame_count; i++) {
        const struct view *v = &p->frames[i].camera;
        same = same && v->fx == first->fx && v->fy == first->fy && v->cx == first->cx && v->cy == first->cy;
    }
    json_t *head = json_pack("{s:i, s:s, s:f, s:s, s:i, s:i}", "remodel_transforms", 1, "effect", p->effect, "fps",
                             p->fps, "camera_model", "PINHOLE", "w", first->width, "h", first->height);
    json_t *lens = same ? json_pack("{s:f, s:f, s:f, s:f, s:f}", "fl_x", first->fx, "fl_y", first->fy, "cx", first->cx,
                                    "cy", first->cy, "camera_angle_x", 2 * atan(first->width / (2 * first->fx)))
                        : json_object();
    bool ok = head && lens && !json_object_update(head, lens);
    if (ok && prov) {
        char *inputs = provenance_inputs_text(prov);
        json_t *from = json_pack("{s:s?, s:s?, s:s?, s:s?}", "stage", prov->stage, "version", prov->version,
                                 "parameters", prov->params, "inputs", inputs);
        ok = inputs && from && !json_object_set(head, "made_by", from);
        json_decref(from);
        free(inputs);
    }
    json_decref(lens);
    if (ok) return head;
    json_decref(head);
    return NULL;
}

/* Writes the frames, one per line, between "[" and "]". */
static bool put_frames(FILE *to, const struct camera_path *p)
{
    bool ok = fputs("[\n", to) >= 0;
    for (int i = 0; ok && i < p->frame_count; i++) {
        json_t *frame = frame_json(&p->frames[i]);
        ok = frame && !json_dumpf(frame, to, NUMBER) && fputs(i + 1 < p->frame_count ? ",\n" : "\n", to) >= 0;
        json_decref(frame);
    }
    return ok && fputs("]", to) >= 0;
}

static bool put_transforms(FILE *to, const struct camera_path *p, const struct provenance *prov)
{
    json_t *head = head_json(p, prov), *value;
    const char *key;
    bool ok = head && fputs("{\n", to) >= 0;
    json_object_foreach(head, key, value) ok =
        ok && fprintf(to, "\"%s\": ", key) > 0 && !json_dumpf(value, to, NUMBER) && fputs(",\n", to) >= 0;
    json_decref(head);
    return ok && fputs("\"frames\": ", to) >= 0 && put_frames(to, p) && fputs("\n}\n", to) >= 0;
}

/* The code after the constants NAME, FPS and FRAMES. Blender 5 moved the curves of an action. */
static const char script[] =
    "\n"
    "\n"
    "\n"
    "def make_linear(action):\n"
    "    if hasattr(action, \"fcurves\"):\n"
    "        curves = list(action.fcurves)\n"
    "    else:  # Blender 5\n"
    "        bags = [bag for layer in action.layers for strip in layer.strips for bag in strip.channelbags]\n"
    "        curves = [curve for bag in bags for curve in bag.fcurves]\n"
    "    for curve in curves:\n"
    "        for key in curve.keyframe_points:\n"
    "            key.interpolation = 'LINEAR'\n"
    "\n"
    "\n"
    "def remodel_camera():\n"
    "    scene, first = bpy.context.scene, FRAMES[0]\n"
    "    width, height = first[\"w\"], first[\"h\"]\n"
    "    stretch = first[\"fl_x\"] / first[\"fl_y\"]\n"
    "    render = scene.render\n"
    "    render.fps = max(1, round(FPS))\n"
    "    render.fps_base = render.fps / FPS\n"
    "    render.resolution_x, render.resolution_y, render.resolution_percentage = width, height, 100\n"
    "    render.pixel_aspect_x, render.pixel_aspect_y = max(1.0, 1 / stretch), max(1.0, stretch)\n"
    "\n"
    "    data = bpy.data.cameras.new(NAME)\n"
    "    camera = bpy.data.objects.new(NAME, data)\n"
    "    scene.collection.objects.link(camera)\n"
    "    scene.camera = camera\n"
    "    camera.rotation_mode = 'QUATERNION'\n"
    "    data.sensor_fit, data.sensor_width = 'HORIZONTAL', 36.0\n"
    "    data.dof.use_dof = any(f[\"aperture\"] > 0 for f in FRAMES)\n"
    "\n"
    "    turn = None\n"
    "    for f in FRAMES:\n"
    "        at = 1 + round(f[\"time\"] * FPS, 6)\n"
    "        place, rotation, _ = Matrix(f[\"transform_matrix\"]).decompose()\n"
    "        if turn is not None and turn.dot(rotation) < 0:\n"
    "            rotation.negate()  # the same rotation, the short way\n"
    "        turn = rotation\n"
    "        camera.location, camera.rotation_quaternion = place, rotation\n"
    "        data.lens = f[\"fl_x\"] / width * data.sensor_width\n"
    "        data.shift_x = 0.5 - f[\"cx\"] / width\n"
    "        data.shift_y = (f[\"cy\"] - height / 2) / width * stretch\n"
    "        for path in (\"location\", \"rotation_quaternion\"):\n"
    "            camera.keyframe_insert(path, frame=at)\n"
    "        for path in (\"lens\", \"shift_x\", \"shift_y\"):\n"
    "            data.keyframe_insert(path, frame=at)\n"
    "        if data.dof.use_dof:\n"
    "            # lens is in mm, and Blender takes a scene unit for a metre\n"
    "            data.dof.aperture_fstop = data.lens / 1000 / f[\"aperture\"] if f[\"aperture\"] > 0 else 1e9\n"
    "            data.dof.focus_distance = f[\"focus\"]\n"
    "            for path in (\"aperture_fstop\", \"focus_distance\"):\n"
    "                data.dof.keyframe_insert(path, frame=at)\n"
    "    make_linear(camera.animation_data.action)\n"
    "    make_linear(data.animation_data.action)\n"
    "\n"
    "    scene.frame_start, scene.frame_end = 1, 1 + round(FRAMES[-1][\"time\"] * FPS)\n"
    "    scene.frame_set(1)\n"
    "\n"
    "\n"
    "remodel_camera()\n";

static bool put_script(FILE *to, const struct camera_path *p, const struct provenance *prov)
{
    json_t *name = json_string(p->effect), *fps = json_real(p->fps);
    fputs("# remodel-blender 1: a camera move as an animated camera, keyed at every frame; Blender 2.93 or later.\n"
          "# Open it in Blender's text editor and run it, or: blender --python blender.py\n",
          to);
    if (prov) provenance_print(prov, to);
    bool ok = name && fps && fputs("import bpy\nfrom mathutils import Matrix\n\nNAME = ", to) >= 0 &&
              !json_dumpf(name, to, NUMBER) && fputs("\nFPS = ", to) >= 0 && !json_dumpf(fps, to, NUMBER) &&
              fputs("\n# camera to world, axes x right, y up, z back; fl_x fl_y cx cy w h in px; time in seconds; "
                    "diameter of the aperture\n# and depth in focus in scene units\nFRAMES = ",
                    to) >= 0 &&
              put_frames(to, p) && fputs(script, to) >= 0;
    json_decref(name);
    json_decref(fps);
    return ok;
}

typedef bool put_fn(FILE *to, const struct camera_path *p, const struct provenance *prov);

static enum status write_file(const struct camera_path *p, const char *folder, enum product_id id, put_fn *put,
                              const struct provenance *prov, struct err *err)
{
    char path[FILE_PATH];
    struct outfile f = {0};
    if (!product_path_in(path, folder, id, NULL, err)) outfile_open(&f, path, err);
    if (!err->status && !put(f.fp, p, prov)) {
        if (ferror(f.fp))
            err_errno(err, "write", path);
        else
            err_nomem(err, "a path in JSON", 0);
    }
    if (!err->status) outfile_commit(&f, err);
    outfile_discard(&f);
    return err->status;
}

/* Rejects what JSON cannot express. */
static enum status check_path(const struct camera_path *p, struct err *err)
{
    if (p->frame_count < 1) return err_set(err, ST_DATA, "cannot export a path without frames.");
    for (int i = 0; i < p->frame_count; i++) {
        const struct path_frame *f = &p->frames[i];
        const struct view *v = &f->camera;
        const struct vec3 t = v->translation;
        double sum = f->time + f->aperture + f->focus + v->fx + v->fy + v->cx + v->cy + t.x + t.y + t.z;
        for (int k = 0; k < 9; k++) sum += v->cam_from_world.m[k / 3][k % 3];
        if (!isfinite(sum))
            return err_set(err, ST_DATA, "frame %.32s of the path %s has a value that is not a finite number.", v->name,
                           p->effect);
    }
    json_t *name = json_string(p->effect);
    if (!name) err_set(err, ST_DATA, "the effect's name \"%s\" is not UTF-8.", p->effect);
    json_decref(name);
    return err->status;
}

enum status path_export_write(const struct camera_path *p, const char *folder, const struct provenance *prov,
                              struct err *err)
{
    if (check_path(p, err) || write_file(p, folder, PRODUCT_BLENDER, put_script, prov, err) ||
        write_file(p, folder, PRODUCT_TRANSFORMS, put_transforms, prov, err))
        return err->status;
    return ST_OK;
}
