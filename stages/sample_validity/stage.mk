# sample_validity: the viewpoints from which a move can be shown.
FOLLOWS.sample_validity := segment_depth choose_views find_subjects choose_effects
READS.sample_validity := parallax/views.txt, cameras, all layers, subjects.txt
