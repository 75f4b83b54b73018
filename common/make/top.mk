# top.mk - what a person calls.

# Values with $, # and quotes reach a run as variables of its environment; Make must not expand what was typed on its
# command line
literal = $(if $(filter command environment,$(firstword $(origin $(1)))),$(value $(1)),$($(1)))
quoted = '$(subst ','\'',$(1))'
PASSED := $(foreach s,$(STAGES),$(VARIABLES.$(s)))
SETTINGS := PRODUCTS QUALITY TO FRAMES_PER_JOB $(foreach s,$(STAGES),$(SETTINGS.$(s)))
ENVIRONMENT = $(foreach v,$(PASSED) $(SETTINGS),REMODEL_$(v)=$(call quoted,$(call literal,$(v)))) REMODEL_PASSED='$(PASSED)' \
  REMODEL_STAGES='$(STAGES)' REMODEL_SHARED_STAGES='$(foreach s,$(STAGES),$(if $(SHARED.$(s)),$(s)))'

export VIEWS_PER_JOB SLURM_ARGS
## TO=GOAL: the goal that `make plan` counts up to (what plain make makes)
dry = $(findstring n,$(filter-out --%,$(firstword -$(MAKEFLAGS))))
# several goals of a scene follow each other: a run locks it, and takes all cores by itself
.NOTPARALLEL:
.PHONY: all list-stages help why plan check check-long sequences fuzz bench bench-compare regress regress-accept generated deps deps-check deps-bench clean $(GOALS)

ifeq ($(SCENE),)
all: deps ## everything a scene asks for; without SCENE builds the programs and runs SCENES, at draft quality by default
	+@$(BUILD) build
	+@common/run/run_scenes.sh '$(if $(filter file,$(origin QUALITY)),draft,$(QUALITY))' '$(SCENES)' $(SUB)
why:    ## what is stale, and because of what
plan:   ## what a run would do: pieces of work, jobs, core-hours, memory, bytes written; TO=GOAL; makes and submits nothing
$(GOALS) why plan:
	@echo "make $@ works on a scene: make $@ SCENE=NAME ('make help' lists the scenes)." >&2; exit 2
else
all $(GOALS) why plan: deps
	+@$(BUILD) build
	+@$(ENVIRONMENT) common/run/run_scene.sh '$(SCENE)' '$(S)' '$(O)' '$@' '$(dry)' '$(JOBS)' '$(CORES)' '$(B)/bin' $(SUB)
endif

deps:
	+@common/run/deps.sh $(DEPS) run
deps-check:
	+@common/run/deps.sh $(DEPS) run check
deps-bench:
	+@common/run/deps.sh $(DEPS) run bench
check: deps-check ## build and run the tests
	+@$(BUILD) $(if $(filter-out unit fuzz,$(or $(CHECKS),all)),tests-build,$(CHECKS:%=%-build))
	+@tests/run '$(B)' $(CHECKS)
check-long: deps-check ## the tests that take longer: whole runs, the build with clang, its static analyser
	+@$(BUILD) tests-build
	+@tests/run '$(B)' $(or $(CHECKS),long)
bench: deps-bench ## measure everything in tests/bench: tables and plots under out/bench
	+@$(BUILD) bench-build
	+@rc=0; for b in tests/bench/*.sh; do tests/bench/run "$$(basename $$b .sh)" '$(B)' || rc=1; done; exit $$rc
bench-%: deps-bench FORCE ## one of them: bench-depth, bench-exr, bench-hdr, bench-irradiance, bench-irradiance_scenes, bench-lamps, bench-matching, bench-materials, bench-moves, bench-render, bench-relight, bench-remodel, bench-render_model, bench-scaling, bench-simulate, bench-solve, bench-things, bench-unite, bench-vdta
	+@$(BUILD) bench-build
	+@tests/bench/run '$*' '$(B)'
bench-compare: deps-bench ## NAME=exr OLD=REVISION: the same bench on another revision's code, alternating
	+@$(BUILD) bench-build
	+@tests/bench/compare '$(NAME)' '$(OLD)' '$(B)' $(BUILD)
regress: ## run SCENES at draft quality and compare their metrics with tests/expected
	+@tests/regress/run compare $(REGRESS)
regress-accept: ## make what these runs gave the expected metrics
	+@tests/regress/run accept $(REGRESS)
sequences: deps-check ## SEQUENCES=N (10000) random model scripts and edits; each step's model is checked (some minutes)
	+@$(BUILD) $(B)/tests/unit/build_model/sequences
	+@SEQUENCES='$(or $(SEQUENCES),10000)' $(B)/tests/unit/build_model/sequences
fuzz: deps-check ## look for new inputs that break a parser: FUZZ=NAME FUZZ_SECONDS=60
	+@tests/fuzz/fuzz.sh '$(FUZZ)' '$(or $(FUZZ_SECONDS),60)'
help: ## this text
	@common/run/help.sh Makefile common/make/top.mk $(STAGES:%=stages/%/stage.mk)
generated: ## the files that come from the stages: docs/man, configs/default.cfg, the tables of docs/architecture.md and docs/formats.md
	+@$(BUILD) build
	@common/run/generate.sh '$(B)/bin' '$(STAGES)' .
list-stages:
	@echo "$(STAGES)"
clean: ## remove what was built (products of scenes stay)
	rm -rf out/build
