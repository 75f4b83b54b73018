# update_vita: the atlas of all faces after an edit, under the light that the edit makes.
FOLLOWS.update_vita := build_model find_things bake_vita bake_outdoors fit_lights gather_irradiance
READS.update_vita := both models, texture.txt and objects.txt, axes.txt, the VITA, the things, outdoors.exr, lights/lights.txt and the reference images that it names; for lamps that the edit adds, their IES files, lux/scale.txt and its plan.txt
