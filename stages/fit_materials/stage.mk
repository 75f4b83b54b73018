# fit_materials: the reflectance of materials from regions that a person marks.
FOLLOWS.fit_materials := bake_vita bake_outdoors
LIBS.fit_materials := -lembree3
