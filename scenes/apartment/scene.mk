# A furnished flat of two rooms, photographed in brackets through a fisheye lens. Its photos and what is true of it are no
# part of the project: make SCENE=apartment PHOTOS=DIR [TRUTH=DIR]
PRODUCTS := model
