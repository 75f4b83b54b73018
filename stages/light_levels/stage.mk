# light_levels: how bright rooms and places are, by groups of light.
FOLLOWS.light_levels := build_model find_things bake_vita bake_outdoors fit_lights update_vita calibrate_light
READS.light_levels := both models, plan.txt, texture.txt and objects.txt, axes.txt, the VITA, the things, cameras, lenses and views, those of photos in other light, pictures of edits, outdoors.exr and sky.txt, lights/lights.txt, fit.txt and the reference images that they name; lux/scale.txt; scenes/NAME/places.txt and states.txt with its IES files, and WEATHER, if there are any
VARIABLES.light_levels := WEATHER
SETTINGS.light_levels := LUX_PHOTOS DAY
HELP.lux := + light levels of rooms and named places, of the room as it is and with EDIT=E after an edit: O/lux/sheet.tsv

## WEATHER=FILE: for `make lux`: weather of a year, an EPW file: adds sDA, ASE, useful daylight and hours of sun to the sheet
## LUX_PHOTOS="P Q": for `make lux`: photos to draw illuminance over; all: every photo; none (four, spread over the list)
## DAY=2026-12-21: for `make lux`: date of a film of light levels over the day, and of hours on the page; needs the place in states.txt
