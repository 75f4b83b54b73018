# walk: a page in which the rooms can be walked through, before and after each edit.
FOLLOWS.walk := bake_outdoors bake_vdta bake_vita choose_exposure find_things plan_tour render_model relight
READS.walk := the models, their plans and tours, texture.txt, objects.txt, atlases, outdoors.exr, exposure.txt, the views with their ids and depth, the things, remodelled and relit pictures where they exist
HELP.walk := a page to walk through the rooms in a browser, before and after each edit
