# bake_vdta: a texture atlas for each viewpoint.
FOLLOWS.bake_vdta := rectify trace_ids find_things bake_vita
READS.bake_vdta := the model, axes.txt, the views of one photo and other views that show what these do not, their ids and things, what the edits reveal, the VITA
HELP.vdta := + texture atlases of the model as each photo sees it
