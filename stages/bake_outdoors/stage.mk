# bake_outdoors: what lies outside of the model, by direction.
FOLLOWS.bake_outdoors := rectify trace_ids hdr_merge
READS.bake_outdoors := the model, axes.txt, the views that look out of it and their ids, lighting reference images that `make lri` made
HELP.outdoors := + what lies outside of the model's openings, by direction, from lighting reference images and photos
