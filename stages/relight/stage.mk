# relight: pictures of edited models under the light that the edits make.
FOLLOWS.relight := update_vita render_model fit_materials encode_video plan_tour
READS.relight := what update_vita reads and writes, remodelled pictures, ids and depth of original views, lights/materials.txt
SETTINGS.relight := RELIT_VIEWS
HELP.relit-tour := films through the rooms of each edit under the light that it makes
HELP.relight := pictures after each edit under the light that it makes, of the views RELIT_VIEWS; with CAMERAS=DIR: from these cameras

## RELIT_VIEWS="P Q": for `make relight`: photos, or views of them, to relight; all: every photo (four, spread over the list)
