# calibrate_light: the scale from the radiance of a scene's views to cd/m2.
FOLLOWS.calibrate_light := import_photos rectify bake_outdoors bake_vita find_things fit_lights
READS.calibrate_light := the photos' records and the cameras; with scenes/NAME/lux.txt also the views it names, and for illuminances the model, axes.txt, the things, the VITA, outdoors.exr, lights/lights.txt and reference images
HELP.luminance := + cd/m2 of the scene's radiance, from the photos' exposures or from scenes/SCENE/lux.txt
