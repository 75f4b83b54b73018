# bake_vita: one texture atlas of all faces.
FOLLOWS.bake_vita := rectify trace_ids find_things
READS.bake_vita := the model and the edited models, axes.txt, the views that show faces best, their ids and things
HELP.vita := + one texture atlas of the model, each face seen orthogonally
HELP.textures := both kinds of atlases
