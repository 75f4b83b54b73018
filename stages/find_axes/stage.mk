# find_axes: an interior's axes, floor, ceiling and scale.
FOLLOWS.find_axes := rectify find_frame fuse_points
READS.find_axes := cameras, points.ply, the frame of straight edges, scenes/NAME/scale.txt and axes_fix.txt, a few views
HELP.axes := + an interior's axes, floor, ceiling and scale, drawn on a few photos
