# fit_lights: lamps and openings of a scene.
FOLLOWS.fit_lights := trace_ids bake_outdoors bake_vita find_things
READS.fit_lights := scenes/NAME/lights.txt, the model and its plan, axes.txt, cameras, the views that face lamps and marked points, their ids, the things, the VITA, outdoors.exr
HELP.lights := + lamps that scenes/SCENE/lights.txt marks, with radiance and cones from the photos, and windows as lights
