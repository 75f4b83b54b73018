# Rendered by the project itself from scene.txt and cameras.txt (docs/scenes.md).
PHOTOS := out/loft/simulated/photos
# Taken outdoors; SfM cannot place these images from photographs of the rooms, so LRI_SFM gives their cameras.
LRI := out/loft/simulated/lri
LRI_SFM := out/loft/simulated/truth/lri
TRUTH := out/loft/simulated/truth
PRODUCTS := model textures remodel tour relight
# what is drawn unless EDIT, DRAW or RELIT_VIEWS say more: a larger window, from one photo
DRAW ?= big-window
RELIT_VIEWS ?= v06
