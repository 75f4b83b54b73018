# A furnished flat of two rooms, photographed in brackets through a fisheye lens. Its photos and its truth are not
# part of the project: make SCENE=apartment PHOTOS=DIR [TRUTH=DIR]
PRODUCTS := model
