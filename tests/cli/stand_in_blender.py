# stand_in_blender.py BLENDER.py SCRIPT DIR - runs the exported blender.py, then SCRIPT as
# `blender --python SCRIPT -- DIR` would, with as much of Blender's interface as both use: keys set by
# keyframe_insert() hold at their frame.
import sys
import types


class Vector(list):
    pass


class Quaternion:
    def __init__(self, rows):
        self.rows, self.sign = rows, 1

    def to_matrix(self):
        return self.rows

    def dot(self, other):
        return sum(a * b for p, q in zip(self.rows, other.rows) for a, b in zip(p, q))

    def negate(self):
        pass


class Matrix:
    def __init__(self, rows):
        self.rows = [list(row) for row in rows]

    def decompose(self):
        place, turn = [row[3] for row in self.rows[:3]], [row[:3] for row in self.rows[:3]]
        return Vector(place), Quaternion(turn), Vector((1, 1, 1))


class Keyed:
    def __init__(self, **values):
        self.keys = {}
        self.animation_data = types.SimpleNamespace(action=types.SimpleNamespace(fcurves=[]))
        self.__dict__.update(values)

    def keyframe_insert(self, path, frame):
        self.keys.setdefault(round(frame), {})[path] = getattr(self, path)

    def go_to(self, frame):
        self.__dict__.update(self.keys.get(frame, {}))


class Camera(Keyed):
    @property
    def matrix_world(self):
        rows = self.rotation_quaternion.rows
        return Matrix([rows[k] + [self.location[k]] for k in range(3)] + [[0, 0, 0, 1]])


def frame_set(frame):
    scene.camera.go_to(frame)
    scene.camera.data.go_to(frame)


def new_data(name):
    return Keyed(type='PERSP', sensor_width=36.0, sensor_height=24.0, sensor_fit='AUTO', shift_x=0.0, shift_y=0.0,
                 lens=50.0, dof=Keyed(use_dof=False, aperture_fstop=0, focus_distance=0))


scene = types.SimpleNamespace(camera=None, frame_step=1, frame_set=frame_set, render=types.SimpleNamespace())
scene.collection = types.SimpleNamespace(objects=types.SimpleNamespace(link=lambda camera: None))
bpy = types.ModuleType("bpy")
bpy.context = types.SimpleNamespace(scene=scene)
bpy.data = types.SimpleNamespace(cameras=types.SimpleNamespace(new=new_data),
                                 objects=types.SimpleNamespace(new=lambda name, data: Camera(data=data)))
mathutils = types.ModuleType("mathutils")
mathutils.Matrix = Matrix
sys.modules.update(bpy=bpy, mathutils=mathutils)
exported, script, folder = sys.argv[1:]
sys.argv = ["blender", "--", folder]
for name in (exported, script):
    exec(compile(open(name, encoding="utf-8").read(), name, "exec"), {"__name__": "__main__"})
