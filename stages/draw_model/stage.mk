# draw_model: a page in which people draw a model on the photographs.
FOLLOWS.draw_model := find_lines find_axes suggest_model build_model
READS.draw_model := the photos, cameras, axes.txt, points.ply, the lines of each view, suggested.txt, scenes/NAME/*.txt and edits/E.txt; build_model as WebAssembly
DEPS.draw := draw
BUILDS.draw := wasm-build
HELP.draw := + a page to draw the model on the photographs, in a browser: O/draw/index.html
