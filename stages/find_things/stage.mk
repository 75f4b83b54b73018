# find_things: furniture before the walls, as things with one id across all views.
FOLLOWS.find_things := trace_ids
READS.find_things := the model and its plan, axes.txt, the views, their ids and depth, scenes/NAME/things.txt
HELP.things := + furniture before the walls, as things: a list, a contact sheet, a plan, a mask of each view
