# find_subjects: what a move can show: faces, or rectangles that a user draws.
FOLLOWS.find_subjects := segment_depth choose_views
READS.find_subjects := parallax/views.txt, cameras, the most central views and those that confirm what they show, their layers; or scenes/NAME/subjects.txt
LIBS.find_subjects := -lopencv_objdetect -lopencv_imgproc -lopencv_core
HELP.subjects := + faces, or the rectangles of scenes/SCENE/subjects.txt
