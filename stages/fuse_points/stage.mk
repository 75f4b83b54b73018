# fuse_points: oriented points on which the depth maps of several views agree.
FOLLOWS.fuse_points := segment_depth
READS.fuse_points := cameras, all interior layers
HELP.points := + oriented points on which the depth maps agree (for any viewer, and for axes and model)
