# choose_views: the views that films are made from.
FOLLOWS.choose_views := sfm_import
READS.choose_views := cameras, sparse points; scenes/NAME/subjects.txt
