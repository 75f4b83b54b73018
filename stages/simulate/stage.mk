# simulate: photographs of a described scene, and what is true of them.
FOLLOWS.simulate :=
READS.simulate := a described scene (scenes/NAME/scene.txt, cameras.txt; docs/scenes.md)
SETTINGS.simulate := EDITS EDIT_VIEWS IRRADIANCE_VIEWS
SHARED.simulate := yes
HELP.truth := more truth of a described scene: its witnesses, its rooms without furniture, IRRADIANCE_VIEWS
HELP.edited := truth of the edited scenes EDITS of a described scene, from the same cameras or EDIT_VIEWS

## EDITS="A B"|all: the edited scenes scenes/SCENE/scene-A.txt and so on, for `make edited`; EDIT=A is the same for one
## EDIT_VIEWS="N M": the photos and witnesses to render them from; default: all
## IRRADIANCE_VIEWS="N M": photos and witnesses that get pictures of irradiance, for `make truth` and `make edited`
