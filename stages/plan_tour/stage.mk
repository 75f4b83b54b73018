# plan_tour: walks through the rooms of the model and of each edit.
FOLLOWS.plan_tour := build_model find_things
READS.plan_tour := a model, its plan and axes, cameras, scenes/NAME/tour.txt, or of an edit texture.txt and the things
