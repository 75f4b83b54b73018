# remodel: from a folder of photographs to a 3D pan & scan video. `make help` tells what there is.
#
# One file, four parts: the scene and how to run, the top (what a person calls), the build (programs under
# out/build/FLAVOR), the pipeline's graph (products under out/SCENE). The top calls this file again with PHASE=build, then
# with PHASE=graph once for each step that needs a list only a product can give: which photos, which views, which frames.

SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -ec
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
.DEFAULT_GOAL := all
.PHONY: FORCE

## SCENE=NAME: the scene to work on, scenes/NAME/
## PHOTOS=DIR: folder of photos (JPEG, PNG, TIFF, EXR, raw); with a new SCENE it is written to scenes/SCENE/scene.mk
## SPLIT=CxR: each photo is of a multi-lens camera: C columns and R rows of small pictures, which become the photos
## SFM=DIR: a COLMAP (text, binary) or Bundler model of the photos, used in place of running COLMAP
## DEPTH=DIR: depth that is known already: DIR/VIEW.exr or .png of any view (docs/formats.md); the others are matched
## LRI=DIR: folder of lighting reference images, for `make lri`: fisheye photos of the light outside, bracketed
## LRI_SFM=DIR: a COLMAP text model that has their cameras
## EXCLUDE="NAMES": photos to leave out, by id or file name
## QUALITY=draft|default|final: configs/QUALITY.cfg; draft and final work beside the default, in out/SCENE+QUALITY
QUALITY ?= default
## HOLDOUT=N: every Nth photo, the first included, is kept out of depth and rendering, to compare; in out/SCENE+holdoutN
## HOLDOUT_VIEWS="NAMES": the same for these photos or views, in out/SCENE+holdout
## TRUTH=DIR: known cameras and depths, which products are compared with (docs/evaluation.md)
## EFFECT="NAMES": films to make, by name, like dolly_in or dolly_in+narrow_dof (docs/formats.md); establishing_dolly if none is named
## EFFECT=auto|all: one by chance of those that suit the scene, or all of them; two photos get their morph
## EFFECT=FILM: the film of keys scenes/SCENE/keyframes/FILM.txt
## MORPH="A B": the two photos, by id, that `make morph` goes between; of a scene of two photos these
## EDIT=E: the edited scene scenes/SCENE/scene-E.txt, for `make edited`
## PRODUCTS="WORDS": what plain `make` makes: parallax, and model, which scenes/SCENE/model.txt describes; parallax if none is said
PRODUCTS ?= parallax
## JOBS=local|slurm: where the per-view work runs
JOBS ?= local
## SLURM_ARGS="...": more options for sbatch; VIEWS_PER_JOB and FRAMES_PER_JOB cut the job array
VIEWS_PER_JOB ?= 4
FRAMES_PER_JOB ?= 30
## CORES=N: cores to use; jobs times threads never exceed it
CORES ?= $(shell nproc)
## DEPS=auto|manual: install what is missing with apt, or only print the line to run
DEPS ?= auto
## REPEATS=N: how often a bench runs each setting
## SCENES="A B": the scenes that plain `make` and `make regress` run (the latter also A+holdoutN: with HOLDOUT=N)
SCENES ?= still-life loft
REGRESS := $(if $(filter file,$(origin SCENES)),still-life still-life+holdout4 loft,$(SCENES))
## FLAVOR=release|debug|asan: how the programs are compiled
FLAVOR ?= release
## V=1: show commands

B := out/build/$(FLAVOR)
STAGES := $(patsubst stages/%/,%,$(sort $(dir $(wildcard stages/*/*.c))))
SUB := $(MAKE) --no-print-directory
# without a -j of the caller's, compiling uses all cores
BUILD = $(SUB) PHASE=build $(if $(findstring -j,$(MAKEFLAGS)),,-j$(CORES))
hide = $(if $(V),,@)

ifneq ($(SCENE),)
  ifeq ($(shell [[ '$(subst ','\'',$(SCENE))' =~ ^[A-Za-z0-9_][A-Za-z0-9_-]*$$ ]] && echo good),)
    $(error SCENE=$(SCENE): a scene is named with letters, digits, _ and -)
  endif
  ifeq ($(filter $(QUALITY),draft default final),)
    $(error QUALITY=$(QUALITY) is not one of: draft default final)
  endif
  ifeq ($(filter $(JOBS),local slurm),)
    $(error JOBS=$(JOBS) is not one of: local slurm)
  endif
  -include scenes/$(SCENE)/scene.mk
  EFFECT_NAMED := $(if $(filter undefined,$(origin EFFECT)),,$(filter-out auto all,$(EFFECT)))
  EFFECT ?= establishing_dolly
  ifneq ($(EDIT),)
    ifeq ($(wildcard scenes/$(SCENE)/scene-$(EDIT).txt),)
      $(error EDIT=$(EDIT): there is no scenes/$(SCENE)/scene-$(EDIT).txt)
    endif
  endif
  ifneq ($(filter-out parallax model,$(PRODUCTS))$(if $(PRODUCTS),,none),)
    $(error PRODUCTS=$(PRODUCTS): wanted one or more of: parallax model)
  endif
  ifneq ($(SPLIT),)
    ifeq ($(shell [[ '$(subst ','\'',$(SPLIT))' =~ ^[1-9][0-9]?x[1-9][0-9]?$$ ]] && echo good),)
      $(error SPLIT=$(SPLIT): wanted COLUMNSxROWS, such as 3x2: how many pictures a photo holds)
    endif
    ifeq ($(SPLIT),1x1)
      $(error SPLIT=1x1: one picture a photo is no split; leave SPLIT out)
    endif
  endif
  ifeq ($(shell [[ '$(subst ','\'',$(EFFECT))' =~ ^[A-Za-z0-9_+\ -]+$$ ]] && echo good),)
    $(error EFFECT=$(EFFECT): effects are named with letters, digits, _, - and +)
  endif
  ifneq ($(HOLDOUT),)
    ifeq ($(shell [[ '$(subst ','\'',$(HOLDOUT))' =~ ^[1-9][0-9]{0,8}$$ ]] && echo good),)
      $(error HOLDOUT=$(HOLDOUT): wanted a number: every how many photos one is held out)
    endif
    ifneq ($(HOLDOUT_VIEWS),)
      $(error HOLDOUT and HOLDOUT_VIEWS are both given; give one of them)
    endif
  endif
  ifneq ($(HOLDOUT_VIEWS),)
    ifeq ($(shell [[ '$(subst ','\'',$(HOLDOUT_VIEWS))' =~ ^[A-Za-z0-9_@\ -]+$$ ]] && echo good),)
      $(error HOLDOUT_VIEWS=$(HOLDOUT_VIEWS): names of photos and views are letters, digits, _, - and @)
    endif
  endif
endif
ifneq ($(MORPH),)
  ifeq ($(shell [[ '$(subst ','\'',$(MORPH))' =~ ^[A-Za-z0-9_][A-Za-z0-9_-]*\ +[A-Za-z0-9_][A-Za-z0-9_-]*$$ ]] && echo good),)
    $(error MORPH=$(MORPH): wanted the ids of two photos, as in MORPH="a b")
  endif
  ifeq ($(firstword $(MORPH)),$(lastword $(MORPH)))
    $(error MORPH=$(MORPH): wanted two photos, found one twice)
  endif
endif
# what quality changes is in O; what all qualities share, the photos' records and SfM, is in S
S := out/$(SCENE)
HELDOUT := $(if $(HOLDOUT),+holdout$(HOLDOUT),$(if $(HOLDOUT_VIEWS),+holdout))
O := $(S)$(if $(filter-out default,$(QUALITY)),+$(QUALITY))$(HELDOUT)

ifneq ($(PHASE),graph)
# ------------------------------------------------------------------------------------------------------------ the top
ifeq ($(PHASE),)

# Values with $, # and quotes reach recipes as shell variables; Make must not expand what was typed on its command line
literal = $(if $(filter command environment,$(firstword $(origin $(1)))),$(value $(1)),$($(1)))
export REMODEL_PHOTOS := $(call literal,PHOTOS)
export REMODEL_SPLIT := $(SPLIT)
export REMODEL_PRODUCTS := $(PRODUCTS)
export REMODEL_EFFECT := $(EFFECT)
export REMODEL_EFFECT_NAMED := $(EFFECT_NAMED)
export REMODEL_SFM := $(call literal,SFM)
export REMODEL_DEPTH := $(call literal,DEPTH)
export REMODEL_LRI := $(call literal,LRI)
export REMODEL_LRI_SFM := $(call literal,LRI_SFM)
export REMODEL_EXCLUDE := $(call literal,EXCLUDE)
export REMODEL_TRUTH := $(call literal,TRUTH)

export VIEWS_PER_JOB SLURM_ARGS
dry = $(findstring n,$(filter-out --%,$(firstword -$(MAKEFLAGS))))
# several goals of a scene follow each other: a run locks it, and takes all cores by itself
.NOTPARALLEL:
GOALS := edited hdr lri sfm views depth points axes suggest model subjects path frames video pan_scan morph evaluate report
.PHONY: all help why resfm check sequences fuzz bench bench-compare regress regress-accept man deps deps-check deps-bench clean $(GOALS)

ifeq ($(SCENE),)
all: deps ## everything a scene asks for; without SCENE builds the programs and runs SCENES, at draft quality if none is said
	+@$(BUILD) build
	+@common/run/run_scenes.sh '$(if $(filter file,$(origin QUALITY)),draft,$(QUALITY))' '$(SCENES)' $(SUB)
edited: ## what is true of the edited scene EDIT of a described one: its radiance from the same cameras
hdr:    ## bracketed photos merged; nothing where photos are no brackets
lri:    ## the lighting reference images of LRI merged: linear, on the scene's scale, still fisheye (no part of what follows)
sfm:    ## + camera poses: COLMAP, or the model in SFM
views:  ## + rectified, linear views
depth:  ## + layered depth maps
points: ## + oriented points on which they agree (no part of what follows)
axes:   ## + the room's axes, floor, ceiling and scale, drawn on a few photos (no part of what follows)
suggest: ## + a first model script from the points, to look at and correct: O/model/suggested.txt (nothing reads it)
model:  ## the solid model of scenes/SCENE/model.txt, and of each edit in edits/, with pictures to check them
subjects: ## + faces, or the rectangles of scenes/SCENE/subjects.txt
path:   ## + the camera move
frames: ## + its frames
video:  ## + the video
pan_scan: ## the same move in 2D, crops of one photograph, to compare; from then on the page shows it too
morph:  ## the film from one photo of MORPH to the other, along matches (all that a scene of two photos gets)
evaluate: ## the depth maps, compared with TRUTH or with photos held out, into metrics.tsv
report: ## + the page: the same as all
why:    ## what is stale, and because of what
resfm:  ## run COLMAP again, after photos were changed
$(GOALS) why resfm:
	@echo "make $@ works on a scene: make $@ SCENE=NAME ('make help' lists the scenes)." >&2; exit 2
else
all $(GOALS) why resfm: deps
	+@$(BUILD) build
	+@common/run/run_scene.sh '$(SCENE)' '$(S)' '$(O)' '$@' '$(dry)' '$(JOBS)' '$(CORES)' '$(B)/bin' $(SUB)
endif

deps:
	+@common/run/deps.sh $(DEPS) run
deps-check:
	+@common/run/deps.sh $(DEPS) run check
deps-bench:
	+@common/run/deps.sh $(DEPS) run bench
check: deps-check ## build and run all tests
	+@$(BUILD) tests-build
	+@tests/run '$(B)' $(CHECKS)
bench: deps-bench ## measure everything in tests/bench: tables and plots under out/bench
	+@$(BUILD) bench-build
	+@rc=0; for b in tests/bench/*.sh; do tests/bench/run "$$(basename $$b .sh)" '$(B)' || rc=1; done; exit $$rc
bench-%: deps-bench FORCE ## one of them: bench-depth, bench-exr, bench-hdr, bench-moves, bench-render, bench-simulate, bench-unite
	+@$(BUILD) bench-build
	+@tests/bench/run '$*' '$(B)'
bench-compare: deps-bench ## NAME=exr OLD=REVISION: the same bench on another revision's code, alternating
	+@$(BUILD) bench-build
	+@tests/bench/compare '$(NAME)' '$(OLD)' '$(B)' $(BUILD)
regress: ## run SCENES at draft quality and compare their metrics with tests/expected
	+@tests/regress/run compare $(REGRESS)
regress-accept: ## make what these runs gave the expected metrics
	+@tests/regress/run accept $(REGRESS)
sequences: deps-check ## SEQUENCES=N random scripts and sequences of edits, each step's model checked; 10000 if none is said (some minutes)
	+@$(BUILD) $(B)/tests/unit/build_model/sequences
	+@SEQUENCES='$(or $(SEQUENCES),10000)' $(B)/tests/unit/build_model/sequences
fuzz: deps-check ## look for new inputs that break a parser: FUZZ=NAME FUZZ_SECONDS=60
	+@tests/fuzz/fuzz.sh '$(FUZZ)' '$(or $(FUZZ_SECONDS),60)'
help: ## this text
	@common/run/explain.sh help $(firstword $(MAKEFILE_LIST))
man: ## docs/man from the programs' --help
	+@$(BUILD) build
	@for s in $(STAGES); do common/run/man.sh $(B)/bin $$s >docs/man/$$s.1.tmp && mv docs/man/$$s.1.tmp docs/man/$$s.1; done
clean: ## remove what was built (products of scenes stay)
	rm -rf out/build

endif
# ---------------------------------------------------------------------------------------------------------- the build

say = $(if $(V),,@echo '  $(1)';)
.DELETE_ON_ERROR:

CC := gcc
CXX := g++
PKGS := OpenEXR libturbojpeg libpng libtiff-4 libraw_r libexif inih libxxhash qhull_r libdeflate
WARN := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith -Wwrite-strings
FLAGS.release := -O3 -g
FLAGS.asan := -O1 -g -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
FLAGS.debug := -O0 -g
ifeq ($(FLAGS.$(FLAVOR)),)
  $(error FLAVOR=$(FLAVOR) is not one of: release asan debug)
endif
# -ffp-contract=off: the same bits from every compiler version; AVX2 and F16C (every processor with
# the one has the other) are what the hot loops are written for
CFLAGS := -std=c11 -D_GNU_SOURCE -mavx2 -mf16c -mno-fma -ffp-contract=off -fopenmp $(WARN) $(FLAGS.$(FLAVOR)) \
  -I. $(shell pkg-config --cflags $(PKGS) 2>/dev/null)
# apart from the flags that decide what is compiled anew: tests unset CI
STRICT := $(if $(CI),-Werror)
# C++ only where a library has no C interface
CXXFLAGS := -std=c++17 -mavx2 -mno-fma -ffp-contract=off -Wall -Wextra -Wshadow $(FLAGS.$(FLAVOR)) \
  -I. $(shell pkg-config --cflags OpenEXR 2>/dev/null)
LDLIBS := -lOpenEXRCore $(shell pkg-config --libs $(PKGS) 2>/dev/null) -lm

objs = $(patsubst %.c,$(B)/obj/%.o,$(wildcard $(1)))
COMMON_OBJS := $(call objs,common/*/*.c)
BINS := $(STAGES:%=$(B)/bin/%)
UNIT_TESTS := $(patsubst tests/unit/%.c,$(B)/tests/unit/%,$(wildcard tests/unit/*/*.c tests/unit/common/*/*.c))
BENCHES := $(patsubst tests/bench/%.c,$(B)/tests/bench/%,$(wildcard tests/bench/*.c))
# of them what needs more of OpenCV than find_subjects does: tests must do without
OPENCV_BENCHES := $(B)/tests/bench/stereo_sgbm
FUZZ_TESTS := $(patsubst tests/fuzz/%.c,$(B)/tests/fuzz/%,$(wildcard tests/fuzz/fuzz_*.c))

.PHONY: build tests-build bench-build
build: $(BINS) $(STAGES:%=$(B)/code/%)
tests-build: build $(filter-out $(OPENCV_BENCHES),$(BENCHES)) $(UNIT_TESTS) $(FUZZ_TESTS) $(B)/tests/pipeline/make_photos
bench-build: build $(BENCHES)

# temporary names of their own: runs of two scenes look at the same programs
$(B)/flags: FORCE
	+@mkdir -p $(@D); t=$@.$$$$.tmp; echo '$(CC) $(CFLAGS) $(CXX) $(CXXFLAGS) $(LDLIBS)' >$$t; cmp -s $$t $@ && rm $$t || mv $$t $@

$(B)/obj/%.o: %.c $(B)/flags
	$(call say,CC $<)mkdir -p $(@D); $(CC) $(CFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

$(B)/obj/%.o: %.cc $(B)/flags
	$(call say,CXX $<)mkdir -p $(@D); $(CXX) $(CXXFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

$(B)/libremodel.a: $(COMMON_OBJS)
	$(call say,AR $@)rm -f $@; ar rcsD $@ $^

# what a product depends on is the code, not the file: a stamp of the stripped program, rewritten only if that changed
$(B)/code/%: $(B)/bin/%
	+@[ -e $< ] || exit 0; mkdir -p $(@D); t=$@.$$$$; strip -s -o $$t.bin $<; cksum <$$t.bin >$$t.tmp; rm $$t.bin; \
	  cmp -s $$t.tmp $@ && rm $$t.tmp || mv $$t.tmp $@

link = $(call say,LD $@)mkdir -p $(@D); $(CC) $(CFLAGS) -o $@ $(filter %.o,$^) $(filter %.a,$^) $(LDLIBS) $(1)

define stage_rules
$(B)/bin/$(1): $(call objs,stages/$(1)/*.c) $(B)/libremodel.a
	$$(call link)
$(patsubst tests/unit/%.c,$(B)/tests/unit/%,$(wildcard tests/unit/$(1)/*.c)): \
  $(filter-out $(B)/obj/stages/$(1)/$(1).o,$(call objs,stages/$(1)/*.c))
endef
$(foreach s,$(STAGES),$(eval $(call stage_rules,$(s))))

# tests/unit/common/FOLDER/*.c test common/FOLDER/; tests/unit/STAGE/*.c test a stage's algorithm (its objects but for its main)
$(UNIT_TESTS): $(B)/tests/unit/%: $(B)/obj/tests/unit/%.o $(B)/libremodel.a
	$(call link,-lcmocka)
$(BENCHES): $(B)/tests/bench/%: $(B)/obj/tests/bench/%.o $(B)/libremodel.a
	$(call link,-lstdc++)
$(B)/tests/bench/exr: $(B)/obj/tests/bench/exr_openexr.o # the baseline
$(B)/tests/bench/hdr $(B)/tests/bench/hdr_views: $(filter-out %/hdr_merge.o,$(call objs,stages/hdr_merge/*.c))
$(B)/tests/bench/hdr_views: $(call objs,stages/rectify/resample.c stages/sfm_import/view_cameras.c)
$(B)/tests/bench/render_rate: $(filter-out %/render_views.o,$(call objs,stages/render_views/*.c))
$(B)/tests/bench/move_pairs: $(filter-out %/plan_path.o,$(call objs,stages/plan_path/*.c))
$(B)/tests/bench/unite: $(filter-out %/build_model.o,$(call objs,stages/build_model/*.c))
$(B)/tests/bench/stereo_sgbm: $(B)/obj/tests/bench/depth_sgbm.o
$(B)/tests/bench/stereo_sgbm: private LDLIBS += -lopencv_calib3d -lopencv_imgproc -lopencv_core
$(B)/obj/tests/bench/depth_sgbm.o: private CXXFLAGS += -isystem /usr/include/opencv4
$(B)/tests/pipeline/make_photos: $(B)/obj/tests/pipeline/make_photos.o $(B)/libremodel.a
	$(call link)
$(FUZZ_TESTS): $(B)/tests/fuzz/%: $(B)/obj/tests/fuzz/%.o $(B)/obj/tests/fuzz/run_corpus.o $(B)/libremodel.a
	$(call link)
$(B)/tests/fuzz/fuzz_given_units: $(call objs,stages/segment_depth/given_read.c)
$(B)/tests/fuzz/fuzz_keyframes: $(filter-out %/plan_path.o,$(call objs,stages/plan_path/*.c))
# the curve that fits a scene is tested by merging with it
$(B)/tests/unit/hdr_merge/cross_validation: $(call objs,stages/fit_response/recover.c)
# the planner's test samples the viewpoints that it plans with
$(B)/tests/unit/plan_path/plan_move: $(filter-out %/sample_validity.o,$(call objs,stages/sample_validity/*.c))
# what plan_path alone needs: JSON, nonlinear least squares
PLANNERS := $(B)/bin/plan_path $(B)/tests/fuzz/fuzz_keyframes $(B)/tests/bench/move_pairs $(filter $(B)/tests/unit/plan_path/%,$(UNIT_TESTS))
$(PLANNERS): $(B)/obj/common/math/ceres_least_squares.o
$(PLANNERS): private LDLIBS += -ljansson -lceres -lglog -lstdc++
$(B)/obj/common/math/ceres_least_squares.o: private CXXFLAGS += -isystem /usr/include/eigen3
$(B)/tests/fuzz/fuzz_split_list: $(call objs,stages/import_photos/split_list.c)
# what find_subjects alone needs; its tests do without OpenCV
$(B)/bin/find_subjects: $(B)/obj/stages/find_subjects/opencv_faces.o
$(B)/bin/find_subjects: private LDLIBS += -lopencv_objdetect -lopencv_imgproc -lopencv_core -lstdc++
$(B)/tests/fuzz/fuzz_model_script: $(filter-out %/build_model.o,$(call objs,stages/build_model/*.c))
$(B)/tests/fuzz/fuzz_marks: $(call objs,stages/find_axes/marks.c)
$(B)/tests/fuzz/fuzz_true_room: $(call objs,stages/evaluate/true_room.c)
$(B)/tests/fuzz/fuzz_wall_plan: $(call objs,stages/evaluate/wall_plan.c)
$(B)/tests/fuzz/fuzz_regions: $(call objs,stages/find_subjects/region*.c)
# what morph_views alone needs
$(B)/bin/morph_views $(filter $(B)/tests/unit/morph_views/%,$(UNIT_TESTS)): $(B)/obj/stages/morph_views/opencv_features.o
$(B)/bin/morph_views $(filter $(B)/tests/unit/morph_views/%,$(UNIT_TESTS)): private LDLIBS += -lopencv_calib3d -lopencv_features2d -lopencv_core -lstdc++
$(patsubst %.cc,$(B)/obj/%.o,$(wildcard stages/*/opencv_*.cc)): private CXXFLAGS += -isystem /usr/include/opencv4
# what simulate alone needs
$(B)/bin/simulate $(B)/tests/unit/simulate/%: private LDLIBS += -lembree3
$(B)/tests/fuzz/fuzz_scene $(B)/tests/fuzz/fuzz_shoot: private LDLIBS += -lembree3
$(B)/tests/fuzz/fuzz_scene $(B)/tests/fuzz/fuzz_shoot: $(filter-out %/simulate.o,$(call objs,stages/simulate/*.c))
.SECONDARY: $(call objs,tests/*/*.c tests/*/*/*.c tests/*/*/*/*.c)
-include $(shell find $(B)/obj -name '*.d' 2>/dev/null)

else
# ---------------------------------------------------------------------------------------------------------- the graph

# lists that products give: PHOTO_IDS and BRACKETED, LRI_IDS, VIEWS, FRAMES, HELD (held-out views); not by `include`, for which make would first
# remake them, even under -n
$(if $(HELDOUT),$(eval $(file <$(O)/holdout/views/views.mk))$(eval HELD := $(VIEWS))$(eval VIEWS :=))
$(eval $(file <$(S)/lri/photos/photos.mk))$(eval LRI_IDS := $(PHOTO_IDS))$(eval PHOTO_IDS :=)$(eval BRACKETED :=)
$(foreach f,$(S)/photos/photos.mk $(O)/views/views.mk $(O)/parallax/morph/frames.mk,$(eval $(file <$(f))))
# the films of this run, and FRAMES_film of each
EFFECTS ?= $(sort $(EFFECT))
$(foreach e,$(EFFECTS),$(eval FRAMES :=)$(eval $(file <$(O)/parallax/$(e)/frames.mk))$(eval FRAMES_$(e) := $(FRAMES)))

BIN := $(B)/bin
P := $(O)/parallax
# a described scene is photographed first: photos.mk lists its SHOTS, and SHOT_NAME the files of each
SIM := $(S)/simulated
DESCRIBED := $(wildcard scenes/$(SCENE)/scene.txt)
$(if $(DESCRIBED),$(eval $(file <$(SIM)/photos.mk)))
CAMERAS := $(addprefix $(O)/views/,cameras.txt images.txt points3D.txt)
VIEW_EXR := $(VIEWS:%=$(O)/views/%.exr)
H := $(O)/holdout
HELD_CAMERAS := $(if $(HELDOUT),$(addprefix $(H)/views/,cameras.txt images.txt points3D.txt lenses.txt views.mk))
HELD_EXR := $(HELD:%=$(H)/views/%.exr)
HELD_FRAMES := $(HELD:%=$(H)/frames/%.exr)
DEPTH_EXR := $(VIEWS:%=$(O)/depth/%.exr)
DEPTH_TXT := $(DEPTH_EXR:.exr=.txt)
# depth comes in rounds: each reads what the one before left in its folder; the last is O/depth itself
LAST_ROUND := $(shell sed -n 's/^rounds = //p' $(O)/slice/segment_depth.cfg 2>/dev/null)
round = $(O)/depth$(if $(filter-out $(LAST_ROUND),$(1)),/round$(1))
POINTS := $(O)/points/points.ply
AXES := $(O)/model/axes.txt
# models: the one of model.txt, and one of each edit
model_files = $(addprefix $(1)/,model.txt model.obj plan.txt merged.txt plan.svg view.png)
MODEL_SCRIPT := $(wildcard scenes/$(SCENE)/model.txt)
EDITS := $(if $(MODEL_SCRIPT),$(patsubst scenes/$(SCENE)/edits/%.txt,%,$(wildcard scenes/$(SCENE)/edits/*.txt)))
MODELS := $(if $(MODEL_SCRIPT),$(O)/model $(EDITS:%=$(O)/remodel/%))
# of a view
photo_of = $(firstword $(subst @, ,$(1)))
VIEWED := $(sort $(foreach v,$(VIEWS),$(call photo_of,$(v)))) # photos that have a view
OVERLAYS := $(foreach m,$(MODELS),$(VIEWED:%=$(m)/overlay/%.jpg))
SUBJECTS := $(P)/subjects.txt
CHOICE := $(if $(CHOOSE),$(P)/$(CHOOSE)-effects.mk)
# films of keys among them
keyframes = $(wildcard scenes/$(SCENE)/keyframes/$(1).txt)
FILMS := $(foreach e,$(EFFECTS),$(if $(call keyframes,$(e)),$(e)))
# of a film
frame_exr = $(FRAMES_$(1):%=$(P)/$(1)/frames/%.exr)
pan_exr = $(FRAMES_$(1):%=$(P)/$(1)/pan_scan/frames/%.exr)
path_txt = $(P)/$(1)/path.txt $(addprefix $(P)/$(1)/path/,cameras.txt images.txt points3D.txt)
path_all = $(call path_txt,$(1)) $(addprefix $(P)/$(1)/,effects.txt transforms.json blender.py frames.mk)
# of a planned effect
needs_subjects = $(if $(filter establishing_%,$(1)),,$(SUBJECTS))
move_of = $(firstword $(subst +, ,$(1)))
validity = $(addprefix $(P)/$(call move_of,$(1))/,validity.txt validity.png)
# two photos have a morph and nothing else, unless a move was named; poses are used where there are any
MORPH ?= $(if $(filter 2,$(words $(PHOTO_IDS))),$(PHOTO_IDS))
PAIR := $(if $(REMODEL_EFFECT_NAMED),,$(filter 2,$(words $(PHOTO_IDS))))
M := $(P)/morph
MORPH_EXR := $(MORPH_FRAMES:%=$(M)/frames/%.exr)
MORPH_TXT := $(M)/path.txt $(addprefix $(M)/path/,cameras.txt images.txt points3D.txt) $(M)/first.exr $(M)/second.exr
needs = $(O)/slice/$(1).cfg $(B)/code/$(1)
T := $(CORES)

# $(call stage,NAME,ITEM,FOLDER,ARGS): runs it here, its words on screen and in FOLDER/log
stage = $(hide)common/run/run_stage.sh live $(1) $(2) $(3) $(BIN)/$(1) --threads $(T) --config $(3)/slice/$(1).cfg $(4)
# $(call farm,NAME,ITEM,PRODUCTS,ARGS[,SHELLWORD[,FOLDER]]): the same for per-view work, which may be planned (LAUNCH=plan) for a
# cluster; a plan's line is PRODUCTS, a tab, and the command with SHELLWORD already expanded behind it; FOLDER is O if not given
farm_line = common/run/run_stage.sh quiet $(1) $(2) $(or $(6),$(O)) $(BIN)/$(1) --threads $(T) --config $(or $(6),$(O))/slice/$(1).cfg $(4)
farm = $(if $(filter plan,$(LAUNCH)),printf '%s\t%s %s\n' '$(3)' '$(farm_line)' "$(5)" >>$(PLAN),$(farm_line) $(5))

SHOOT := $(if $(DESCRIBED),scenes/$(SCENE)/cameras.txt $(wildcard scenes/$(SCENE)/*.obj)) $(S)/slice/simulate.cfg $(B)/code/simulate
DESCRIPTION := $(DESCRIBED) $(SHOOT)
$(SIM)/photos.mk: $(DESCRIPTION)
	$(call stage,simulate,common,$(S),--scene scenes/$(SCENE) --out $(SIM) --common)
define shot_rules
$(SHOT_$(1):%=$(SIM)/%) &: $(DESCRIPTION)
	$$(hide)$$(call farm,simulate,$(1),$(SHOT_$(1):%=$(SIM)/%),--scene scenes/$(SCENE) --out $(SIM) --photo $(1),,$(S))
endef
$(foreach s,$(SHOTS),$(eval $(call shot_rules,$(s))))
.PHONY: simulated
simulated: $(foreach s,$(SHOTS),$(SHOT_$(s):%=$(SIM)/%))

EDITED := $(SIM)/truth/edited-$(EDIT)
EDITED_TXT := $(EDITED)/scene.txt $(EDITED)/faces.txt
$(EDITED_TXT) &: scenes/$(SCENE)/scene-$(EDIT).txt $(SHOOT)
	$(call stage,simulate,edited-$(EDIT),$(S),--scene scenes/$(SCENE) --out $(SIM) --common --edit $(EDIT))
$(EDITED)/hdr/%.exr: scenes/$(SCENE)/scene-$(EDIT).txt $(SHOOT)
	$(hide)$(call farm,simulate,$*,$@,--scene scenes/$(SCENE) --out $(SIM) --photo $* --edit $(EDIT),,$(S))
.PHONY: edited
edited: $(EDITED_TXT) $(patsubst truth/%,$(EDITED)/%,$(foreach s,$(SHOTS),$(filter truth/hdr/%,$(SHOT_$(s)))))

# what stages after hdr_merge take for the photos, and what a photo's view is made from; $(1) is a photo's id
HDR := $(if $(BRACKETED),$(foreach p,$(PHOTO_IDS),$(S)/hdr/$(p).exr $(S)/hdr/$(p).jpg))
ORIGINALS := $(if $(SPLIT),$(S)/split,"$$REMODEL_PHOTOS")
PICTURES := $(if $(BRACKETED),$(S)/hdr,$(ORIGINALS))
picture = $(if $(BRACKETED),$(S)/hdr/$(1).exr,$(S)/photos/$(1).txt)

.PHONY: hdr lri sfm views depth points axes suggest model overlays subjects choice path frames video pan_frames pan_scan heldout evaluate report morph-path morph-frames morph
hdr: $(HDR)
lri: $(LRI_IDS:%=$(S)/lri/%.exr) $(LRI_IDS:%=$(S)/lri/%.jpg)
sfm: $(O)/views/views.mk
views: $(VIEW_EXR) $(HELD_EXR)
depth: $(DEPTH_EXR) $(DEPTH_TXT)
points: $(POINTS)
model: $(foreach m,$(MODELS),$(call model_files,$(m)))
overlays: $(OVERLAYS)
axes: $(AXES)
suggest: $(O)/model/suggested.txt
subjects: $(SUBJECTS)
choice: $(CHOICE)
path: $(foreach e,$(EFFECTS),$(call path_all,$(e)) $(if $(filter $(e),$(FILMS)),,$(call validity,$(e))))
frames: $(foreach e,$(EFFECTS),$(call frame_exr,$(e)))
video: $(EFFECTS:%=$(P)/%/video.mp4)
pan_frames: $(foreach e,$(EFFECTS),$(call pan_exr,$(e)))
pan_scan: $(EFFECTS:%=$(P)/%/pan_scan/video.mp4)
morph-path: $(M)/frames.mk
morph-frames: $(MORPH_EXR)
morph: $(M)/video.mp4
heldout: $(HELD_FRAMES)
evaluate: $(O)/metrics.tsv
report: $(O)/index.html

# how samples follow light: what the scene says, else what its exposures show. Found out before the merges are planned (run_scene.sh), and
# written only if it is new, so that merges go by its text and not by the photos; hence the stamp, and the rule without a recipe
RESPONSE := $(or $(wildcard scenes/$(SCENE)/response.txt),$(S)/hdr/response.txt)
RESPONSE_STAMP := $(if $(wildcard scenes/$(SCENE)/response.txt),,$(S)/stamp/response.txt)
$(S)/stamp/response.txt: $(if $(BRACKETED),$(PHOTO_IDS:%=$(S)/photos/%.txt) $(S)/photos/list.txt) $(S)/slice/fit_response.cfg $(B)/code/fit_response
	$(call stage,fit_response,all,$(S),--photos $(ORIGINALS) --records $(S)/photos --out $(S)/hdr/response.txt)
	+@mkdir -p $(@D); echo done >$@
$(S)/hdr/response.txt: ;
.PHONY: response
response: $(if $(BRACKETED),$(RESPONSE_STAMP))

# a view's exposures, all qualities share them
define hdr_rules
$(S)/hdr/$(1).exr $(S)/hdr/$(1).jpg &: $(S)/photos/$(1).txt $(RESPONSE) $(S)/slice/hdr_merge.cfg $(B)/code/hdr_merge | $(RESPONSE_STAMP)
	$$(hide)$$(call farm,hdr_merge,$(1),$(S)/hdr/$(1).jpg $(S)/hdr/$(1).exr,\
	  --id $(1) --photos $$(ORIGINALS) --records $(S)/photos --response $(RESPONSE) --out $(S)/hdr,,$(S))
endef
$(if $(BRACKETED),$(foreach p,$(PHOTO_IDS),$(eval $(call hdr_rules,$(p)))))

# lighting reference images: merged as a view's exposures are, with the scene's curve; what lens and pose they have is told by the EXR
LRI_RESPONSE := $(if $(BRACKETED),$(RESPONSE),$(wildcard scenes/$(SCENE)/response.txt))
LRI_FOLDER := "$$REMODEL_LRI"
LRI_MODEL := $(if $(value REMODEL_LRI_SFM),--model "$$$$REMODEL_LRI_SFM")
define lri_rule
$(S)/lri/$(1).exr $(S)/lri/$(1).jpg &: $(S)/lri/photos/$(1).txt $(LRI_RESPONSE) $(S)/stamp/lri.txt $(S)/slice/hdr_merge.cfg $(B)/code/hdr_merge | $(if $(BRACKETED),$(RESPONSE_STAMP))
	$$(hide)$$(call farm,hdr_merge,lri.$(1),$(S)/lri/$(1).jpg $(S)/lri/$(1).exr,\
	  --id $(1) --photos $$(LRI_FOLDER) --records $(S)/lri/photos $(LRI_RESPONSE:%=--response %) $(LRI_MODEL) --out $(S)/lri,,$(S))
endef
$(foreach p,$(LRI_IDS),$(eval $(call lri_rule,$(p))))

MASKS := $(if $(wildcard scenes/$(SCENE)/masks),--masks scenes/$(SCENE)/masks)
# SfM runs once for a set of photos: COLMAP is not reproducible, so a changed photo or mask does not redo it (make resfm does)
$(S)/sfm/models.txt: $(S)/photos/list.txt $(S)/slice/sfm.cfg $(S)/stamp/sfm_source.txt | $(HDR)
	$(call stage,sfm,all,$(S),--photos $(PICTURES) --records $(S)/photos --out $(S)/sfm \
	  $(MASKS) $${REMODEL_SFM:+--model "$$REMODEL_SFM"})

$(CAMERAS) $(O)/views/lenses.txt $(O)/views/views.mk $(HELD_CAMERAS) &: $(S)/sfm/models.txt $(S)/photos/list.txt \
  $(S)/stamp/photo_sizes.txt $(if $(HELDOUT),$(O)/stamp/holdout.txt) $(call needs,sfm_import)
	$(call stage,sfm_import,all,$(O),--sfm $(S)/sfm --records $(S)/photos --out $(O)/views \
	  $(if $(HOLDOUT),--holdout $(HOLDOUT)) $(if $(HOLDOUT_VIEWS),--holdout-views '$(HOLDOUT_VIEWS)'))

# a photo's views are made together, for it is read once; only those that are missing or stale. $(1): a photo; $(2): the folder of the
# cameras; $(3): the views that it has there
define rectify_rule
$(3:%=$(2)/%.exr) &: $(call picture,$(1)) $(addprefix $(2)/,cameras.txt images.txt points3D.txt lenses.txt) \
  $(wildcard $(S)/stamp/mask/$(1).txt) $(call needs,rectify)
	$$(hide)stale=$$$$(common/run/stale.sh views $(3:%=$(2)/%.exr) -- $$^); \
	  $$(call farm,rectify,$(if $(filter $(H)/%,$(2)),heldout-)$(1),$(3:%=$(2)/%.exr),--photo $(1) --photos $$(PICTURES) $(MASKS) --records $(S)/photos --views $(2) --out $(2),$$$$stale)
endef
rectify_rules = $(foreach p,$(sort $(foreach v,$(1),$(call photo_of,$(v)))),$(eval $(call rectify_rule,$(p),$(2),$(filter $(p) $(p)@%,$(1)))))
$(call rectify_rules,$(VIEWS),$(O)/views)
$(call rectify_rules,$(HELD),$(H)/views)

GIVEN := $(if $(value REMODEL_DEPTH),--given "$$$$REMODEL_DEPTH")
# $(1): a view; $(2): the folder of a round; $(3): that of the round before, empty for the first
define depth_rule
$(2)/$(1).exr $(2)/$(1).txt &: $(O)/views/$(1).exr $(if $(3),$(3)/$(1).exr) $(wildcard $(S)/stamp/given/$(1).txt) $(CAMERAS) $(call needs,segment_depth) \
  | $(VIEW_EXR) $(if $(3),$(VIEWS:%=$(3)/%.exr))
	$$(hide)$$(call farm,segment_depth,$(1),$(2)/$(1).txt $(2)/$(1).exr,\
	  --view $(1) --views $(O)/views $(if $(3),--before $(3)) $(GIVEN) --out $(2)/$(1).exr --deps $(2)/$(1).d)
endef
# $(1): a round
define round_rules
.PHONY: depth-round$(1)
depth-round$(1): $(VIEWS:%=$(call round,$(1))/%.exr)
-include $(wildcard $(VIEWS:%=$(call round,$(1))/%.d)) # the neighbours each view really read
endef
$(foreach k,$(if $(LAST_ROUND),$(shell seq 0 $(LAST_ROUND))),$(eval $(call round_rules,$(k)))\
  $(foreach v,$(VIEWS),$(eval $(call depth_rule,$(v),$(call round,$(k)),$(if $(filter-out 0,$(k)),$(call round,$(shell expr $(k) - 1)))))))
$(O)/views/%.exr: ; # a neighbour that is a view no more

$(POINTS): $(CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,fuse_points)
	$(call stage,fuse_points,all,$(O),--views $(O)/views --depth $(O)/depth --out $@)

# what a user marked; that a file came or went is a change whatever the files' times
MARKED := $(wildcard $(addprefix scenes/$(SCENE)/,scale.txt axes_fix.txt))
WAS_MARKED := $(shell sed -nE '/^[^#]/q; s/^. input (scale.txt|axes_fix.txt) .*/\1/p' $(AXES) 2>/dev/null)
$(AXES): $(CAMERAS) $(O)/views/lenses.txt $(VIEW_EXR) $(POINTS) $(MARKED) $(S)/photos/list.txt $(call needs,find_axes) \
  $(if $(filter-out $(notdir $(MARKED)),$(WAS_MARKED))$(filter-out $(WAS_MARKED),$(notdir $(MARKED))),FORCE)
	$(call stage,find_axes,all,$(O),--views $(O)/views --records $(S)/photos --points $(POINTS) \
	  $(if $(filter %/scale.txt,$(MARKED)),--scale scenes/$(SCENE)/scale.txt) $(if $(filter %/axes_fix.txt,$(MARKED)),--fix scenes/$(SCENE)/axes_fix.txt) --out $@)
$(O)/model/suggested.txt: $(AXES) $(CAMERAS) $(POINTS) $(call needs,suggest_model)
	$(call stage,suggest_model,all,$(O),--views $(O)/views --points $(POINTS) --axes $(AXES) --out $@)
# a script that places nothing in photographs needs no points
MODEL_POINTS := $(if $(MODEL_SCRIPT),$(if $(shell grep -lE '^[ \t]*(wall|adjust)[ \t]+[^ \t]+[ \t]+in[ \t]' $(MODEL_SCRIPT) $(EDITS:%=scenes/$(SCENE)/edits/%.txt)),$(POINTS)))
MODEL_NEEDS := $(AXES) $(CAMERAS) $(O)/views/lenses.txt $(MODEL_POINTS) $(call needs,build_model)
MODEL_ARGS := --axes $(AXES) --views $(O)/views $(MODEL_POINTS:%=--points %)
$(call model_files,$(O)/model) &: $(MODEL_SCRIPT) $(MODEL_NEEDS)
	$(call stage,build_model,model,$(O),--script $(MODEL_SCRIPT) $(MODEL_ARGS) --out $(O)/model)
define edit_rule
$(call model_files,$(O)/remodel/$(1)) &: $(MODEL_SCRIPT) scenes/$(SCENE)/edits/$(1).txt $(O)/model/model.txt $(MODEL_NEEDS)
	$$(call stage,build_model,$(1),$(O),--script $(MODEL_SCRIPT) --edit scenes/$(SCENE)/edits/$(1).txt --base $(O)/model/model.txt $(MODEL_ARGS) --out $(O)/remodel/$(1))
endef
$(foreach e,$(EDITS),$(eval $(call edit_rule,$(e))))
# $(1): a model's folder; $(2): a photo
define overlay_rule
$(1)/overlay/$(2).jpg: $(1)/model.txt $(AXES) $(CAMERAS) $(O)/views/lenses.txt $(call picture,$(2)) $(call needs,build_model)
	$$(hide)$$(call farm,build_model,$(notdir $(1))-$(2),$$@,--overlay $(2) --model $(1)/model.txt --axes $(AXES) --views $(O)/views --photos $$(PICTURES) --records $(S)/photos --out $$@)
endef
$(foreach m,$(MODELS),$(foreach p,$(VIEWED),$(eval $(call overlay_rule,$(m),$(p)))))

# rectangles that a user drew, in place of faces; that they came or went is a change whatever the file's time
DRAWN := $(wildcard scenes/$(SCENE)/subjects.txt)
WERE_DRAWN := $(shell grep -om1 '^. input subjects.txt' $(SUBJECTS) 2>/dev/null)
$(SUBJECTS): $(CAMERAS) $(O)/views/lenses.txt $(if $(DRAWN),$(DRAWN),$(VIEW_EXR)) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,find_subjects) \
  $(if $(DRAWN),$(if $(WERE_DRAWN),,FORCE),$(if $(WERE_DRAWN),FORCE))
	$(call stage,find_subjects,all,$(O),--views $(O)/views --depth $(O)/depth --records $(S)/photos $(DRAWN:%=--subjects %) --out $@)

# which effects suit the scene, for EFFECT=auto and EFFECT=all
$(P)/%-effects.mk: $(SUBJECTS) $(call needs,choose_effects)
	$(call stage,choose_effects,$(CHOOSE),$(O),--subjects $(SUBJECTS) --effect $(CHOOSE) --out $@)

# from where a move can be shown: the same for all of its image effects. $(1): the move
define validity_rule
$(call validity,$(1)) &: $(CAMERAS) $(O)/views/lenses.txt $(DEPTH_EXR) $(DEPTH_TXT) $(call needs_subjects,$(1)) $(call needs,sample_validity)
	$$(call stage,sample_validity,$(1),$(O),--views $(O)/views --depth $(O)/depth --records $(S)/photos --effect $(1) \
	  $(addprefix --subjects ,$(call needs_subjects,$(1))) --out $(P)/$(1))
endef
# $(1): a planned effect
define path_rule
$(call path_all,$(1)) &: $(CAMERAS) $(call validity,$(1)) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs_subjects,$(1)) $(call needs,plan_path)
	$$(call stage,plan_path,$(1),$(O),--views $(O)/views --depth $(O)/depth --validity $(firstword $(call validity,$(1))) --effect $(1) \
	  $(addprefix --subjects ,$(call needs_subjects,$(1))) --out $(P)/$(1))
endef
# a film of keys: its effect is its name; the moves that it chains are planned first
chained = $(sort $(shell awk '$$1 == "move" && $$2 ~ /^[A-Za-z0-9_+-]+$$/ { print $$2 }' $(call keyframes,$(1))))
define film_rule
$(call path_all,$(1)) &: $(call keyframes,$(1)) $(foreach m,$(CHAINED_$(1)),$(P)/$(m)/path.txt $(P)/$(m)/effects.txt) $(CAMERAS) $(O)/views/lenses.txt $(call needs,plan_path)
	$$(call stage,plan_path,$(1),$(O),--views $(O)/views --records $(S)/photos --keyframes $(call keyframes,$(1)) --moves $(P) --effect $(1) --out $(P)/$(1))
endef
$(foreach f,$(FILMS),$(eval CHAINED_$(f) := $(call chained,$(f))))
$(foreach f,$(FILMS),$(foreach e,$(CHAINED_$(f)),$(if $(call keyframes,$(e)),$(error $(call keyframes,$(f)) chains $(e), a film of keys: only planned moves can be chained))))
PLANNED := $(sort $(filter-out $(FILMS),$(EFFECTS)) $(foreach f,$(FILMS),$(CHAINED_$(f))))
$(foreach m,$(sort $(foreach e,$(PLANNED),$(call move_of,$(e)))),$(eval $(call validity_rule,$(m))))
$(foreach e,$(PLANNED),$(eval $(call path_rule,$(e))))
$(foreach f,$(FILMS),$(eval $(call film_rule,$(f))))

# frames come in chunks, a process each; of a chunk only the frames that are missing or stale are rendered. $(1): frames, $(2): their film
effect_layers = $(P)/$(1)/effects.txt $(if $(filter $(1),$(FILMS)),,$(wildcard scenes/$(SCENE)/effects.txt))
define chunk_rule
$(1:%=$(P)/$(2)/frames/%.exr) &: $(call path_txt,$(2)) $(call effect_layers,$(2)) $(CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,render_views)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(P)/$(2)/frames/%.exr) -- $$^); \
	  $$(call farm,render_views,$(2)-$(firstword $(1)),$(1:%=$(P)/$(2)/frames/%.exr),--views $(O)/views --depth $(O)/depth --path $(P)/$(2) $(addprefix --effects ,$(call effect_layers,$(2))) --out $(P)/$(2)/frames --frames,$$$$stale)
endef
chunks = $(if $(2),$(eval $(call $(1),$(wordlist 1,$(FRAMES_PER_JOB),$(2)),$(3)))$(call chunks,$(1),$(wordlist $(words x $(wordlist 1,$(FRAMES_PER_JOB),$(2))),$(words $(2)),$(2)),$(3)))
$(foreach e,$(EFFECTS),$(call chunks,chunk_rule,$(FRAMES_$(e)),$(e)))

# the move in 2D, on request; which view it shows is told by the path
define pan_rule
$(1:%=$(P)/$(2)/pan_scan/frames/%.exr) &: $(call path_txt,$(2)) $(CAMERAS) $(VIEW_EXR) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,pan_scan)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(P)/$(2)/pan_scan/frames/%.exr) -- $$^); \
	  $$(call farm,pan_scan,$(2)-$(firstword $(1)),$(1:%=$(P)/$(2)/pan_scan/frames/%.exr),--views $(O)/views --depth $(O)/depth --path $(P)/$(2) --out $(P)/$(2)/pan_scan/frames --frames,$$$$stale)
endef
$(foreach e,$(EFFECTS),$(call chunks,pan_rule,$(FRAMES_$(e)),$(e)))

define video_rules
$(P)/$(1)/video.mp4: $(call frame_exr,$(1)) $(call path_txt,$(1)) $(call needs,encode_video)
	$$(call stage,encode_video,$(1),$(O),--path $(P)/$(1) --frames $(P)/$(1)/frames --out $$@)
$(P)/$(1)/pan_scan/video.mp4: $(call pan_exr,$(1)) $(call path_txt,$(1)) $(call needs,encode_video)
	$$(call stage,encode_video,$(1)-pan_scan,$(O),--path $(P)/$(1) --frames $(P)/$(1)/pan_scan/frames --out $$@)
endef
$(foreach e,$(EFFECTS),$(eval $(call video_rules,$(e))))

MORPH_POSES := $(if $(wildcard $(O)/views/views.mk),$(CAMERAS) $(O)/views/lenses.txt)
$(MORPH_TXT) $(M)/frames.mk &: $(foreach p,$(MORPH),$(call picture,$(p))) $(MORPH_POSES) $(O)/stamp/morph.txt $(call needs,morph_views)
	$(call stage,morph_views,path,$(O),--photos $(PICTURES) --records $(S)/photos --first $(firstword $(MORPH)) --second $(lastword $(MORPH)) \
	  $(if $(MORPH_POSES),--views $(O)/views) --out $(M))
define morph_rule
$(1:%=$(M)/frames/%.exr) &: $(MORPH_TXT) $(call needs,morph_views)
	$$(hide)stale=$$$$(common/run/stale.sh frames $(1:%=$(M)/frames/%.exr) -- $$^); \
	  $$(call farm,morph_views,$(firstword $(1)),$(1:%=$(M)/frames/%.exr),--morph $(M) --out $(M)/frames --frames,$$$$stale)
endef
$(call chunks,morph_rule,$(MORPH_FRAMES))
$(M)/video.mp4: $(MORPH_EXR) $(MORPH_TXT) $(call needs,encode_video)
	$(call stage,encode_video,morph,$(O),--path $(M) --frames $(M)/frames --out $@)

# the held-out photos' cameras, rendered from the other views
define heldout_rule
$(1:%=$(H)/frames/%.exr) &: $(HELD_CAMERAS) $(CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(call needs,render_views)
	$$(hide)$$(call farm,render_views,heldout-$(firstword $(1)),$(1:%=$(H)/frames/%.exr),--views $(O)/views --depth $(O)/depth --cameras $(H)/views --out $(H)/frames $(1:%=--camera %))
endef
$(call chunks,heldout_rule,$(HELD))

made = $(1)
MODELLED := $(and $(filter model,$(PRODUCTS)),$(MODELS))
$(O)/metrics.tsv: $(CAMERAS) $(O)/views/lenses.txt $(DEPTH_EXR) $(DEPTH_TXT) $(HELD_CAMERAS) $(HELD_EXR) $(HELD_FRAMES) \
  $(call $(if $(MODELLED),made,wildcard),$(AXES) $(if $(MODELS),$(O)/model/plan.txt)) $(S)/photos/list.txt $(O)/stamp/truth.txt \
  $(call needs,evaluate)
	$(call stage,evaluate,all,$(O),--folder $(O) --shared $(S) $${REMODEL_TRUTH:+--truth "$$REMODEL_TRUTH"} --out $@)

SHOWN := $(if $(PAIR),$(M)/video.mp4,$(if $(HELDOUT)$(TRUTH),$(O)/metrics.tsv) $(EFFECTS:%=$(P)/%/video.mp4) $(wildcard $(EFFECTS:%=$(P)/%/pan_scan/video.mp4)) \
  $(EFFECTS:%=$(P)/%/path.txt) $(CAMERAS) $(DEPTH_EXR) $(DEPTH_TXT) $(wildcard $(AXES) $(M)/video.mp4)) \
  $(call $(if $(filter model,$(PRODUCTS)),made,wildcard),$(foreach m,$(MODELS),$(call model_files,$(m))) $(OVERLAYS))
$(O)/index.html: $(SHOWN) $(S)/photos/list.txt $(STAGES:%=$(O)/slice/%.cfg) $(call needs,report)
	$(call stage,report,page,$(O),--scene $(SCENE) --folder $(O) --shared $(S) --photos $(PICTURES) --defaults configs/default.cfg --out $@)

# What is looked at afresh in every run, also under -n: configs, photos. Files are rewritten only if their text changed.
CONFIGS := configs/default.cfg $(if $(filter-out default,$(QUALITY)),configs/$(QUALITY).cfg) $(wildcard scenes/$(SCENE)/scene.cfg)
.PHONY: look look-simulate look-lri look-morph
look-lri:
	+@common/run/look.sh lri $(BIN) $(S)
look-morph:
	+@common/run/look.sh morph $(BIN) $(O) '$(MORPH)'
look-simulate:
	+@common/run/look.sh slices $(BIN) $(S)/slice simulate $(filter-out configs/draft.cfg configs/final.cfg,$(CONFIGS))
look:
	+@common/run/look.sh slices $(BIN) $(O)/slice '$(STAGES)' $(CONFIGS)
	+@common/run/look.sh slices $(BIN) $(S)/slice 'import_photos fit_response hdr_merge sfm' $(filter-out configs/draft.cfg configs/final.cfg,$(CONFIGS))
	+@common/run/look.sh photos $(BIN) $(S) scenes/$(SCENE)
	+@common/run/look.sh morph $(BIN) $(O) '$(MORPH)'
	+@common/run/look.sh evaluation $(BIN) $(O) '$(HOLDOUT)' '$(HOLDOUT_VIEWS)'
endif
