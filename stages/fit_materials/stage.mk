# fit_materials: the reflectance of marked materials.
FOLLOWS.fit_materials := trace_ids bake_outdoors bake_vita fit_lights
READS.fit_materials := scenes/NAME/materials.txt, the model, axes.txt, cameras, the views that face marked regions, their ids, the VITA, outdoors.exr, lights/lights.txt if there is one
HELP.materials := + reflectance of the materials that scenes/SCENE/materials.txt marks: Lambert, Phong or Ward, as they need
