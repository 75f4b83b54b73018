# graph.mk - the graph of a scene's products, under out/SCENE. Its rules are in stages/NAME/stage.mk.

GRAPH := yes
BIN := $(B)/bin
T := $(CORES)
made = $(1)
# $(call list_in,FILE,NAME): the list that a product sets, "NAME := words"; not by `include`, for which make would first remake
# the product, even under -n
list_in = $(shell sed -n 's/^$(2) := *//p' $(1) 2>/dev/null)
# what every product of a stage depends on: its effective parameters and its code
needs = $(O)/slice/$(1).cfg $(B)/code/$(1)
shared_needs = $(S)/slice/$(1).cfg $(B)/code/$(1)

# $(call stage,NAME,ITEM,FOLDER,ARGS): runs it here; what it says goes to the screen and to FOLDER/log
stage = $(hide)common/run/run_stage.sh live $(1) $(2) $(3) $(BIN)/$(1) --threads $(T) --config $(3)/slice/$(1).cfg $(4)
# $(call farm,NAME,ITEM,PRODUCTS,ARGS[,SHELLWORD[,FOLDER[,OWN]]]): the same for per-view work, which may be planned (LAUNCH=plan).
# FOLDER is O by default. OWN, behind ARGS: options that a process may be given several times, for items whose ARGS are the same.
# A plan's line, for common/run/run_lines.sh: PRODUCTS, a tab, the command with SHELLWORD already expanded behind it, and with OWN
# a tab and OWN
farm_line = common/run/run_stage.sh quiet $(1) $(2) $(or $(6),$(O)) $(BIN)/$(1) --threads $(T) --config $(or $(6),$(O))/slice/$(1).cfg $(4)
farm = $(if $(filter plan,$(LAUNCH)),printf '%s\t%s %s$(if $(7),\t%s)\n' '$(3)' '$(farm_line)' "$(5)" $(if $(7),'$(7)') >>$(PLAN),$(farm_line) \
  $(5) $(7))
# $(call chunks,RULE,FRAMES,WORD): a rule for each FRAMES_PER_JOB of FRAMES
chunks = $(if $(2),$(eval $(call $(1),$(wordlist 1,$(FRAMES_PER_JOB),$(2)),$(3)))$(call chunks,$(1),$(wordlist \
  $(words x $(wordlist 1,$(FRAMES_PER_JOB),$(2))),$(words $(2)),$(2)),$(3)))

# Checked anew in every run, also under -n: configs here, photos and more by the stages. Files are rewritten only if their text
# changed.
CONFIGS := configs/default.cfg $(if $(filter-out default,$(QUALITY)),configs/$(QUALITY).cfg) $(wildcard scenes/$(SCENE)/scene.cfg)
SHARED_CONFIGS := $(filter-out configs/draft.cfg configs/final.cfg,$(CONFIGS))
.PHONY: look-slices
look:: look-slices
look-slices:
	+@common/run/look.sh slices $(BIN) $(O)/slice '$(STAGES)' $(CONFIGS)
	+@common/run/look.sh slices $(BIN) $(S)/slice '$(foreach s,$(STAGES),$(if $(SHARED.$(s)),$(s)))' $(SHARED_CONFIGS)

# what evaluate and report read; stages add to it
MEASURED :=
SHOWN :=
SHOWN_ALWAYS :=
$(foreach s,$(STAGES),$(eval include stages/$(s)/stage.mk))

# the steps of a run that ends with GOAL, in order, as "STAGE RUN STEP" lines
steps = $(foreach s,$(1),$(if $(filter $(s),$(ORDER)),,$(call steps,$(NEEDS.$(s)))$(eval ORDER += $(s))))
stage_of = $(foreach s,$(STAGES),$(if $(filter $(1),$(STEPS.$(s))),$(s)))
.PHONY: steps
steps:
	$(strip $(call steps,$(GOAL)))@printf '%s\n' $(foreach s,$(ORDER),'$(call stage_of,$(s)) $(or $(RUN.$(s)),one) $(s)')
