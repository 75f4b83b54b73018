# bake_outdoors: what lies outside of the model, by direction.
FOLLOWS.bake_outdoors := rectify trace_ids hdr_merge bake_vita
READS.bake_outdoors := the model, axes.txt, the views that look out of it and their ids, the VITA of the unedited model, lighting reference images that `make lri` made
HELP.outdoors := + what lies outside of the model's openings, by direction, from lighting reference images, photos and patches of sun
