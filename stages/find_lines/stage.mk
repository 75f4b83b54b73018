# find_lines: straight edges of a view.
FOLLOWS.find_lines := rectify
READS.find_lines := cameras, one view
LIBS.find_lines := -lopencv_imgproc -lopencv_core
HELP.lines := + straight edges of each view, from which directions, floor and walls of a room are found
