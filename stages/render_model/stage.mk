# render_model: the model and its edits under photographic texture, from the photos' views, from given cameras, and as films.
FOLLOWS.render_model := bake_outdoors bake_vdta bake_vita choose_exposure encode_video find_things plan_tour
READS.render_model := the models, texture.txt, atlases, outdoors.exr, exposure.txt, the views with their ids and depth, the things of edits, the tour or the cameras
VARIABLES.render_model := CAMERAS CAMERAS_FRAME
HELP.remodel := what the photos would show after each edit, EDIT=E: after one; with CAMERAS=DIR: what these cameras see before and after
HELP.tour := films through the rooms, of the model and of each edit

## EDIT=E: for `make remodel`, `tour` and `relight`: after this edit alone
## DRAW="E F": edits that these goals and plain `make` draw, usually in scene.mk (all)
## CAMERAS=DIR: a COLMAP text model whose cameras `make remodel` draws the model and its edits from; with `make path`, `frames` and `video`: those of a film, or transforms.json
## CAMERAS_FRAME=scene|model|truth: its frame: O/views (default), the room's model, or TRUTH, which has the photos' cameras
