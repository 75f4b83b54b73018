# remodel: from a folder of photographs to a 3D pan & scan video, or to a solid model of a room. `make help` lists the rest.
#
# This file has the scene and how to run. common/make/ has the other parts: stages.mk puts the stages in order, top.mk is what
# a person calls, develop.mk what the programs are worked on with, build.mk makes them under out/build/FLAVOR, graph.mk executes the
# graph of products of a scene.
# stages/NAME/stage.mk holds what all of them must know about a stage, stages/NAME/rules.c its rules (docs/adding-a-stage.md).
# The top calls this file again with PHASE=build, then with PHASE=graph for each step of a run, before which print_graph
# prints the graph anew: which photos, views and frames there are is known only when earlier steps have listed them.

SHELL := /bin/bash
.SHELLFLAGS := -o pipefail -ec
.SUFFIXES:
MAKEFLAGS += --no-builtin-rules
.DEFAULT_GOAL := all
.PHONY: FORCE
hide = $(if $(V),,@)

ifeq ($(PHASE),graph)
include common/make/graph.mk
else

# an installed remodel has this file, and compiles nothing (common/install/install.sh)
INSTALLED := $(wildcard common/make/installed)

## SCENE=NAME: the scene to work on, scenes/NAME/
## PHOTOS=DIR: folder of photos (JPEG, PNG, TIFF, HEIC, AVIF, WebP, JPEG XL, EXR, raw) and clips (MP4, QuickTime), or clips themselves ("a.mp4 b.mov"); with a new SCENE it is written to scenes/SCENE/scene.mk
## QUALITY=draft|default|final: configs/QUALITY.cfg; draft and final work beside the default, in out/SCENE+QUALITY
QUALITY ?= default
## PRODUCTS="WORDS": what plain `make` makes: words among parallax (the default), model, which scenes/SCENE/model.txt describes, and of it textures, remodel, tour and relight: its edits, walks through them, and their light
PRODUCTS ?= parallax
## JOBS=local|slurm: where the per-view work runs
JOBS ?= local
## SLURM_ARGS="...": more options for sbatch; they go before what the estimates say
## VIEWS_PER_JOB=N: pieces of work that make a task of a job array (from the estimates, or 4), or a process here; FRAMES_PER_JOB for frames
VIEWS_PER_JOB ?=
FRAMES_PER_JOB ?= 30
## CORES=N: cores to use; jobs times threads never exceed it
CORES ?= $(shell nproc)
## DEPS=auto|manual: install what is missing with apt, or only print the line to run
DEPS ?= auto
## REPEATS=N: how often a bench runs each setting
## SCENES="A B": the scenes that plain `make` and `make regress` run (the latter also A+holdoutN: with HOLDOUT=N)
SCENES ?= $(if $(INSTALLED),,still-life loft)
REGRESS := $(if $(filter file,$(origin SCENES)),still-life still-life+holdout4 loft,$(SCENES))
## FLAVOR=release|debug|asan|clang|portable|arm64: how the programs are compiled
FLAVOR ?= release
## V=1: show commands

B := out/build/$(FLAVOR)
SUB := $(MAKE) --no-print-directory
# without a -j of the caller's, compiling uses all cores
BUILD = $(if $(INSTALLED),:,$(SUB) PHASE=build $(if $(findstring -j,$(MAKEFLAGS)),,-j$(CORES)))

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
endif
include common/make/stages.mk

# what quality and a hold-out change is in O; what all runs of a scene share, such as the photos' records and SfM, is in S
S := out/$(SCENE)
O := $(S)$(if $(filter-out default,$(QUALITY)),+$(QUALITY))$(if $(HOLDOUT),+holdout$(HOLDOUT),$(if $(HOLDOUT_VIEWS),+holdout))

ifeq ($(PHASE),)
  include common/make/top.mk
endif
ifeq ($(INSTALLED),)
  ifeq ($(PHASE),)
    include common/make/develop.mk
  endif
  include common/make/build.mk
  include common/make/wasm.mk
endif
endif
