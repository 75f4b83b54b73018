# Writes the active camera's frames as a COLMAP text model, for `make video SCENE=NAME CAMERAS=DIR`.
#
#   blender scene.blend --background --python docs/blender_cameras.py -- DIR
#
# or open it in Blender's text editor (2.93 or later), set DIR below, and run it. DIR gets cameras.txt, images.txt and
# an empty points3D.txt; its last part names the film. Import points/points.ply of the scene, without a change of axes,
# and move the camera among them: a Blender unit is a unit of the scene. The frames are those of the scene, from its
# first to its last one by its step; the size is that of the render, the lens may be keyed. Depth of field is not
# exported.
import os
import sys

import bpy

DIR = ""


def write_cameras(folder):
    scene = bpy.context.scene
    camera, render = scene.camera, scene.render
    if camera is None or camera.data.type != 'PERSP':
        raise SystemExit("The scene has no active perspective camera; choose one under Scene Properties.")
    width = render.resolution_x * render.resolution_percentage // 100
    height = render.resolution_y * render.resolution_percentage // 100
    cameras, images = [], []
    frames = range(scene.frame_start, scene.frame_end + 1, scene.frame_step)
    for i, frame in enumerate(frames, 1):
        scene.frame_set(frame)
        data = camera.data
        # pixels may be wider than high; the sensor spans the side that the fit names
        aspect = render.pixel_aspect_y / render.pixel_aspect_x
        fit = data.sensor_fit
        if fit == 'AUTO':
            fit = 'HORIZONTAL' if width >= height * aspect else 'VERTICAL'
        sensor = data.sensor_height if data.sensor_fit == 'VERTICAL' else data.sensor_width
        span = width if fit == 'HORIZONTAL' else height * aspect
        fx = data.lens / sensor * span
        fy = fx / aspect
        cx = width / 2 - data.shift_x * span
        cy = height / 2 + data.shift_y * span / aspect
        place, turn, _ = camera.matrix_world.decompose()
        axes = turn.to_matrix()  # columns: x right, y up, z back
        # camera from world, with x right, y down, z forward
        rows = [[sign * axes[row][column] for row in range(3)] for column, sign in ((0, 1), (1, -1), (2, -1))]
        shift = [-sum(rows[k][j] * place[j] for j in range(3)) for k in range(3)]
        cameras.append("%d PINHOLE %d %d %.17g %.17g %.17g %.17g" % (i, width, height, fx, fy, cx, cy))
        w, x, y, z = quaternion(rows)
        images.append("%d %.17g %.17g %.17g %.17g %.17g %.17g %.17g %d %06d.png\n"
                      % ((i, w, x, y, z) + tuple(shift) + (i, i)))
    os.makedirs(folder, exist_ok=True)
    for name, lines in (("points3D.txt", []), ("cameras.txt", cameras), ("images.txt", images)):
        with open(os.path.join(folder, name), "w") as to:
            to.writelines(line + "\n" for line in lines)
    print("%d cameras in %s" % (len(cameras), folder))


def quaternion(m):
    """The quaternion w, x, y, z of a rotation matrix, by its largest component."""
    t = [1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
         1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]]
    a, b, c = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    d, e, f = m[1][0] + m[0][1], m[0][2] + m[2][0], m[2][1] + m[1][2]
    q = [(t[0], a, b, c), (a, t[1], d, e), (b, d, t[2], f), (c, e, f, t[3])][t.index(max(t))]
    length = sum(v * v for v in q) ** 0.5
    return [v / length for v in q]


words = sys.argv[sys.argv.index("--") + 1:] if "--" in sys.argv else []
if not (words or DIR):
    raise SystemExit("Give the folder to write: set DIR in this script, or add `-- DIR` to Blender's command line.")
write_cameras(words[0] if words else DIR)
