# stages.mk - what the stages say of themselves, in stages/NAME/stage.mk, and their order.
#
#   FOLLOWS.STAGE    the stages whose products it reads: the order of the stages, here and in everything that lists them
#   READS.STAGE      its row in docs/architecture.md, beside the products that common/product/products.def says it makes
#   VARIABLES.STAGE  variables that a user sets and a new scene keeps
#   SETTINGS.STAGE   variables of one run, which a new scene does not keep. Rules and recipes find the values of both as
#                    REMODEL_NAME in the environment
#   SHARED.STAGE     yes: all qualities of a scene share its products
#   LIBS.STAGE       libraries that only it links
#   DEPS.GOAL        a group of configs/packages.txt that only `make GOAL` needs; BUILDS.GOAL: a goal of the build likewise
#   HELP.GOAL        a line of `make help`, which makes a step of the stage a goal: `make GOAL`
#
# The rules of its products, and its steps in a run, are in stages/NAME/rules.c. A function run_STEP in stages/STAGE/run.sh
# takes the place of what Make would do in a step (common/run/run_scene.sh).

STAGE_FOLDERS := $(patsubst stages/%/,%,$(sort $(dir $(wildcard stages/*/stage.mk))))
include $(STAGE_FOLDERS:%=stages/%/stage.mk)

# $(call visit,STAGE,LIST,WAITING): LIST with the stages that STAGE follows, and STAGE; WAITING wait for it
visit = $(if $(filter $(1),$(3)),$(error stages/$(1)/stage.mk: FOLLOWS goes in a circle: $(3) $(1)))$(if $(filter $(1),$(STAGE_FOLDERS)),,$(error \
  stages/$(lastword $(3))/stage.mk: FOLLOWS names $(1), which is not a stage))$(if $(filter $(1),$(2)),$(2),$(call \
  visit_all,$(FOLLOWS.$(1)),$(2),$(3) $(1)) $(1))
visit_all = $(if $(1),$(call visit_all,$(wordlist 2,$(words $(1)),$(1)),$(call visit,$(firstword $(1)),$(2),$(3)),$(3)),$(2))
STAGES := $(strip $(call visit_all,$(STAGE_FOLDERS)))

GOALS := $(sort $(patsubst HELP.%,%,$(filter HELP.%,$(.VARIABLES))))
