# find_frame: directions, floor, ceiling and walls from straight edges.
FOLLOWS.find_frame := find_lines
READS.find_frame := cameras, the straight edges of all views
HELP.frame := + directions, floor, ceiling and walls of a room, from straight edges
