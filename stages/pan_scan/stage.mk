# pan_scan: the same move in 2D, crops of one photograph.
FOLLOWS.pan_scan := segment_depth plan_path
READS.pan_scan := one view, its layers, the path; on request
HELP.pan_scan := the same move in 2D, crops of one photograph, to compare; from then on the page shows it too
