# gather_irradiance: the light that arrives at points and at the surfaces of a view.
FOLLOWS.gather_irradiance := bake_outdoors bake_vita find_things fit_lights fit_materials
READS.gather_irradiance := the model, axes.txt, the things, the VITA, outdoors.exr, lights/lights.txt and the reference images that it names, if there are any, lights/materials.txt and the cameras, if materials were marked; points, or a view's camera
SETTINGS.gather_irradiance := GATHER_VIEWS
VARIABLES.gather_irradiance := GATHER_POINTS
HELP.irradiance := the light that arrives at the points of GATHER_POINTS, or of TRUTH/irradiance.txt, and at views named by GATHER_VIEWS

## GATHER_POINTS=FILE: for `make irradiance`: lines X Y Z NX NY NZ, points and normals in the frame of O/views
## GATHER_VIEWS="V W": for `make irradiance`: views of which each pixel's surface gets its irradiance
