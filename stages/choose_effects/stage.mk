# choose_effects: which effects suit a scene, for EFFECT=auto and EFFECT=all.
FOLLOWS.choose_effects := find_subjects
READS.choose_effects := subjects.txt; only for EFFECT=auto and all
VARIABLES.choose_effects := EFFECT

## EFFECT="NAMES": films to make, by name, like dolly_in or dolly_in+narrow_dof (docs/formats.md); establishing_dolly by default
## EFFECT=auto|all: one drawn at random from those that suit the scene, or all of them; two photos get their morph
## EFFECT=FILM: the film of keys scenes/SCENE/keyframes/FILM.txt
