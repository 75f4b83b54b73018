# suggest_model: a first model script of walls, rooms, doorways and windows.
FOLLOWS.suggest_model := find_frame find_axes
READS.suggest_model := cameras, points.ply, the frame of straight edges, axes.txt, all views, interior layers; on request
HELP.suggest := + a first model script from the points, for you to correct: O/model/suggested.txt, suggested.svg
