# choose_exposure: the exposure of all pictures and films of a scene's rooms.
FOLLOWS.choose_exposure := rectify
READS.choose_exposure := the views
