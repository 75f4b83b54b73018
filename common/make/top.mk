# top.mk - what a person calls.

# Values with $, # and quotes reach a run as variables of its environment; Make must not expand what was typed on its
# command line
literal = $(if $(filter command environment,$(firstword $(origin $(1)))),$(value $(1)),$($(1)))
quoted = '$(subst ','\'',$(1))'
PASSED := $(foreach s,$(STAGES),$(VARIABLES.$(s)))
SETTINGS := PRODUCTS QUALITY TO ON_DONE FRAMES_PER_JOB $(foreach s,$(STAGES),$(SETTINGS.$(s)))
ENVIRONMENT = $(foreach v,$(PASSED) $(SETTINGS),REMODEL_$(v)=$(call quoted,$(call literal,$(v)))) REMODEL_PASSED='$(PASSED)' \
  REMODEL_STAGES='$(STAGES)' REMODEL_SHARED_STAGES='$(foreach s,$(STAGES),$(if $(SHARED.$(s)),$(s)))'

export VIEWS_PER_JOB SLURM_ARGS
## TO=GOAL: the goal that `make plan` and `make status` count up to (what plain make makes)
## ON_DONE=COMMAND: what a shell runs when a run ends, with REMODEL_SCENE, REMODEL_FOLDER, REMODEL_RESULT (done or failed) and REMODEL_SECONDS in its environment
dry = $(findstring n,$(filter-out --%,$(firstword -$(MAKEFLAGS))))
# several goals of a scene follow each other: a run locks it, and takes all cores by itself
.NOTPARALLEL:
.PHONY: all list-stages help why plan status verify deps $(GOALS)

ifeq ($(SCENE),)
all: deps ## everything a scene asks for; without SCENE builds the programs and runs SCENES, at draft quality by default
	+@$(BUILD) build
	+@common/run/run_scenes.sh '$(if $(filter file,$(origin QUALITY)),draft,$(QUALITY))' '$(SCENES)' $(SUB)
doctor: # without a scene it looks at the machine alone
	@common/run/doctor.sh
why:    ## what is stale, and because of what
plan:   ## what a run would do: pieces of work, jobs, core-hours, memory, bytes written; TO=GOAL; makes and submits nothing
status: ## what of a scene is made, stale and failed, what a run does, and how long is left; without SCENE: how each scene's last run went
	@common/run/status_scenes.sh
verify: ## whether photos, what a scene's folder has and all products are as runs left them, back to the photos; names each file that is not
$(filter-out doctor,$(GOALS)) why plan verify:
	@echo "make $@ works on a scene: make $@ SCENE=NAME ('make help' lists the scenes)." >&2; exit 2
else
# DEPS.GOAL, BUILDS.GOAL: packages and programs that only this goal needs
all $(GOALS) why plan verify: deps
	+@$(if $(INSTALLED),:,$(if $(DEPS.$@),common/run/deps.sh $(DEPS) $(DEPS.$@),:))
	+@$(BUILD) build $(BUILDS.$@)
	+@$(ENVIRONMENT) common/run/run_scene.sh '$(SCENE)' '$(S)' '$(O)' '$@' '$(dry)' '$(JOBS)' '$(CORES)' '$(B)/bin' $(SUB)
status: # builds nothing: a run may be at work with these programs
	+@$(ENVIRONMENT) common/run/run_scene.sh '$(SCENE)' '$(S)' '$(O)' '$@' '$(dry)' '$(JOBS)' '$(CORES)' '$(B)/bin' $(SUB)
endif

deps:
	+@$(if $(INSTALLED),:,common/run/deps.sh $(DEPS) run)
help: ## this text
	@common/run/help.sh Makefile common/make/top.mk $(wildcard common/make/develop.mk) $(STAGES:%=stages/%/stage.mk)
list-stages:
	@echo "$(STAGES)"
