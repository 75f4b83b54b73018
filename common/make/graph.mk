# graph.mk - executes the graph of a scene's products, which print_graph has printed to O/graph (common/graph/graph.h).
#
# run_scene.sh sets O, the folder of the run's products, and T, the threads of a process.

T ?= 1
include $(O)/graph/all.mk
