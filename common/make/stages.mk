# stages.mk - what the stages say of themselves, in stages/NAME/stage.mk, and their order.
#
#   FOLLOWS.STAGE  the stages whose products it reads: the order of the stages, here and in everything that lists them
#   READS.STAGE    its row in docs/architecture.md, beside the products that common/product/products.def says it makes
#   VARIABLES.STAGE  variables that a user sets, whose values its recipes find as REMODEL_NAME in the environment
#   SHARED.STAGE   yes: all qualities of a scene share its products
#   LIBS.STAGE     libraries that only it links
#   STEPS.STAGE    its steps of a run; most have one, and the programs that other steps make on the way have none
#   HELP.STEP      a line of `make help`, which makes the step a goal: `make STEP`
#   NEEDS.STEP     the steps that come before it in a run
#   RUN.STEP       farm: one process for each view or chunk of frames, here or on a cluster; otherwise one process
#   PRODUCT.WORD   the step that makes what PRODUCTS=WORD asks for
#
# A function run_STEP in stages/STAGE/run.sh takes the place of RUN.STEP (common/run/run_scene.sh). A stage.mk is read twice:
# here for these lines, and with GRAPH set, in order, for its rules.

STAGE_FOLDERS := $(patsubst stages/%/,%,$(sort $(dir $(wildcard stages/*/stage.mk))))
include $(STAGE_FOLDERS:%=stages/%/stage.mk)

# visits the stages that $(1) follows, then $(1); $(2): the stages that wait for it
visit = $(if $(filter $(1),$(2)),$(error stages/$(1)/stage.mk: FOLLOWS goes in a circle: $(2) $(1)))$(if $(filter $(1),$(STAGE_FOLDERS)),,$(error \
  stages/$(lastword $(2))/stage.mk: FOLLOWS names $(1), which is not a stage))$(if $(filter $(1),$(STAGES)),,$(foreach p,$(FOLLOWS.$(1)),$(call \
  visit,$(p),$(2) $(1)))$(eval STAGES += $(1)))
STAGES :=
$(foreach s,$(STAGE_FOLDERS),$(call visit,$(s)))
STAGES := $(strip $(STAGES))

STEPS := $(foreach s,$(STAGES),$(STEPS.$(s)))
GOALS := $(foreach s,$(STEPS),$(if $(HELP.$(s)),$(s)))
KNOWN_PRODUCTS := $(sort $(patsubst PRODUCT.%,%,$(filter PRODUCT.%,$(.VARIABLES))))
ifneq ($(SCENE),)
  ifneq ($(filter-out $(KNOWN_PRODUCTS),$(PRODUCTS))$(if $(PRODUCTS),,none),)
    $(error PRODUCTS=$(PRODUCTS): wanted one or more of: $(KNOWN_PRODUCTS))
  endif
endif
