# choose_views: the views that films are made from.
FOLLOWS.choose_views := sfm_import
READS.choose_views := cameras, sparse points; scenes/NAME/subjects.txt
WRITES.choose_views := parallax/views.txt: all views, or where they look all round, a cluster that sees one thing
