# build.mk - the programs, under out/build/FLAVOR.

say = $(if $(V),,@echo '  $(1)';)
.DELETE_ON_ERROR:

CC := gcc
CXX := g++
PKGS := OpenEXR libjpeg libturbojpeg libpng libtiff-4 libraw_r libexif lcms2 expat libheif libwebp libwebpdemux libjxl inih libxxhash qhull_r libdeflate
WARN := -Wall -Wextra -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Wpointer-arith -Wwrite-strings
FLAGS.release := -O3 -g
# with the sanitizers' code between, gcc warns of bounds and texts that are as large as they need be; -g1 has the lines that
# the sanitizers print, and takes three quarters of the time
FLAGS.asan := -O2 -g1 -fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer \
    -Wno-stringop-overflow -Wno-stringop-overread -Wno-format-truncation
# the unit tests' own code: half the time to compile, and nearly all of their time goes into what they test
UNIT_FLAGS.asan := -O1
FLAGS.debug := -O0 -g
FLAGS.clang := -O2 -g
# the parsers, with what libFuzzer wants to see of them (tests/fuzz/fuzz.sh)
FLAGS.fuzz := -O1 -g -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined
# no instruction that only newer processors have, on any processor: slower, the same products (common/math/lanes.h)
FLAGS.portable := -O3 -g
# for another processor: its unit tests run under an emulator (tests/long/arm64.sh)
FLAGS.arm64 := -O3 -g
ifeq ($(FLAGS.$(FLAVOR)),)
  $(error FLAVOR=$(FLAVOR) is not one of: release asan debug clang fuzz portable arm64)
endif
ifneq ($(filter clang fuzz,$(FLAVOR)),)
  CC := clang
  CXX := clang++
endif
PKG_CONFIG := pkg-config
ifeq ($(FLAVOR),arm64)
  CROSS := aarch64-linux-gnu-
  ifeq ($(shell command -v $(CROSS)gcc),)
    $(error FLAVOR=arm64 needs Debian's crossbuild-essential-arm64; docs/architecture.md says how to set it up)
  endif
  CC := $(CROSS)gcc
  CXX := $(CROSS)g++
  PKG_CONFIG := PKG_CONFIG_LIBDIR=/usr/lib/aarch64-linux-gnu/pkgconfig:/usr/share/pkgconfig pkg-config
endif
AR := $(CROSS)ar
STRIP := $(CROSS)strip
# -ffp-contract=off: the same bits from every compiler version; on x86-64, AVX2 and F16C (every processor with the one
# has the other) are what the hot loops are fast with. C++ is the same in all flavours: Eigen sums in the order of its vectors
X86 := $(filter x86_64-%,$(shell $(CC) -dumpmachine 2>/dev/null))
LANES := $(if $(filter portable,$(FLAVOR)),-Wno-psabi,$(if $(X86),-mavx2 -mf16c -mno-fma))
CFLAGS := -std=c11 -D_GNU_SOURCE $(LANES) -ffp-contract=off -fopenmp $(WARN) $(FLAGS.$(FLAVOR)) \
  -I. $(shell $(PKG_CONFIG) --cflags $(PKGS) 2>/dev/null)
# apart from the flags that decide what is compiled anew: tests unset CI
STRICT := $(if $(CI),-Werror)
# C++ only where a library has no C interface: OpenCV, Ceres, OpenEXR's C++ library
CXXFLAGS := -std=c++17 $(if $(X86),-mavx2 -mno-fma) -ffp-contract=off -Wall -Wextra -Wshadow $(FLAGS.$(FLAVOR)) \
  -I. -isystem /usr/include/eigen3 -isystem /usr/include/opencv4 \
  $(patsubst -I%,-isystem %,$(shell $(PKG_CONFIG) --cflags OpenEXR 2>/dev/null))
LDLIBS := -lOpenEXRCore $(shell $(PKG_CONFIG) --libs $(PKGS) 2>/dev/null) -lm
# Debian 12 has version 3, Debian 13 version 4; ray_scene.c chooses alike
EMBREE := -lembree$(if $(wildcard /usr/include/embree4/rtcore.h),4,3)
# what a stage alone needs, and common/math and common/light; a program gets those libraries that its objects use
MORE_LIBS := $(sort $(foreach s,$(STAGES),$(LIBS.$(s)))) $(EMBREE) -lceres -lglog -lcholmod -lstdc++

objs = $(patsubst %.c,$(B)/obj/%.o,$(patsubst %.cc,$(B)/obj/%.o,$(wildcard $(1))))
# print_graph is a program of its own: it calls the rules of all stages
GRAPH_MAIN := $(B)/obj/common/graph/print_graph.o
COMMON_OBJS := $(filter-out $(GRAPH_MAIN),$(call objs,common/*/*.c common/*/*.cc))
BINS := $(STAGES:%=$(B)/bin/%)
STAGE_LIBS := $(STAGES:%=$(B)/lib/%.a)
UNIT_TESTS := $(patsubst %.c,$(B)/%,$(wildcard tests/unit/*/*.c tests/unit/*/*/*.c))
BENCHES := $(patsubst %.c,$(B)/%,$(wildcard tests/bench/*.c))
FUZZ_TESTS := $(patsubst %.c,$(B)/%,$(wildcard tests/fuzz/fuzz_*.c))
# the campaign of faults knows the calls of x86-64
FAULT_TOOLS := $(if $(X86),$(B)/tests/faults/campaign)
TOOLS := $(B)/tests/pipeline/make_photos $(B)/tests/pipeline/picture_tool $(FAULT_TOOLS)

.PHONY: build tests-build bench-build unit-build fuzz-build
build: $(BINS) $(B)/bin/print_graph $(STAGES:%=$(B)/stripped/%)
tests-build: build $(BENCHES) $(UNIT_TESTS) $(FUZZ_TESTS) $(TOOLS)
bench-build: build $(BENCHES)
# for the groups of tests that need no other program
unit-build: $(UNIT_TESTS)
fuzz-build: $(FUZZ_TESTS)

# temporary names of their own: runs of two scenes look at the same programs
$(B)/flags: FORCE
	+@mkdir -p $(@D); t=$@.$$$$.tmp; echo '$(CC) $(CFLAGS) $(UNIT_FLAGS.$(FLAVOR)) $(CXX) $(CXXFLAGS) $(LDLIBS)' >$$t; cmp -s $$t $@ && rm $$t || mv $$t $@

$(B)/obj/%.o: %.c $(B)/flags
	$(call say,CC $<)mkdir -p $(@D); $(CC) $(CFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

$(B)/obj/%.o: %.cc $(B)/flags
	$(call say,CXX $<)mkdir -p $(@D); $(CXX) $(CXXFLAGS) $(STRICT) -MMD -MP -c -o $@ $<

$(UNIT_TESTS:$(B)/%=$(B)/obj/%.o): private CFLAGS += $(UNIT_FLAGS.$(FLAVOR))

# libraries: common/, each stage with its folders but without its main, and what benches share
archive = $(call say,AR $@)mkdir -p $(@D); rm -f $@; $(AR) rcsD $@ $^
$(B)/libremodel.a: $(COMMON_OBJS)
	$(archive)
# the objects of a stage without its main
stage_objs = $(filter-out $(B)/obj/stages/$(1)/$(1).o,$(call objs,$(foreach f,stages/$(1) stages/$(1)/*,$(f)/*.c $(f)/*.cc)))
.SECONDEXPANSION:
$(STAGE_LIBS): $(B)/lib/%.a: $$(call stage_objs,$$*)
	$(archive)
$(BINS): $(B)/bin/%: $(B)/obj/stages/$$*/$$*.o $(B)/lib/%.a
# the stages that have rules, in order, for print_graph
$(B)/rules.def: FORCE
	+@mkdir -p $(@D); t=$@.$$$$.tmp; printf 'STAGE(%s)\n' $(foreach s,$(STAGES),$(if $(wildcard stages/$(s)/rules.c),$(s))) >$$t; cmp -s $$t $@ && rm $$t || mv $$t $@
$(GRAPH_MAIN): CFLAGS += -I$(B)
$(GRAPH_MAIN): $(B)/rules.def
$(B)/lib/bench.a: $(call objs,tests/bench/*.cc tests/bench/*/*.c)
	$(archive)

# what a product depends on is the code, not the file: code/STAGE is a checksum of the stripped program and of the parts of
# its page, rewritten only if that changed. stripped/STAGE has the time of the newest file that was looked at. Temporary
# files stay there: make install and others read code/ while runs of scenes look at the same programs
$(B)/stripped/%: $(B)/bin/% $$(wildcard stages/$$*/page/*)
	+@[ -e $< ] || exit 0; mkdir -p $(@D) $(B)/code; t=$@.$$$$; touch -r $< $$t; $(STRIP) -s -o $$t.bin $<; \
	  for f in $(wordlist 2,99,$^); do [ ! $$f -nt $$t ] || touch -r $$f $$t; done; \
	  cat $$t.bin $(wordlist 2,99,$^) | cksum >$$t.tmp; rm $$t.bin; cmp -s $$t.tmp $(B)/code/$* && rm $$t.tmp || mv $$t.tmp $(B)/code/$*; mv $$t $@

# archives may need each other; libraries that nothing needs are left out
link = $(call say,LD $@)mkdir -p $(@D); $(CC) $(CFLAGS) -o $@ $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group \
  -Wl,--as-needed $(LDLIBS) $(MORE_LIBS) $(1)
$(B)/bin/print_graph: $(GRAPH_MAIN) $(STAGE_LIBS)
$(BINS) $(B)/bin/print_graph: $(B)/libremodel.a
	$(call link)
TESTS := $(UNIT_TESTS) $(FUZZ_TESTS) $(BENCHES) $(TOOLS)
# a test's program is linked by what is fastest here: there are hundreds, and no product depends on them
FAST_LINK := $(if $(CROSS),,$(if $(shell command -v ld.lld),-fuse-ld=lld))
$(TESTS): $(B)/tests/%: $(B)/obj/tests/%.o $(B)/libremodel.a
	$(call link,$(FAST_LINK) $(if $(filter $(B)/tests/unit/%,$@),-lcmocka) $(if $(filter $(B)/tests/fuzz/%,$@),$(if $(filter fuzz,$(FLAVOR)),-fsanitize=fuzzer)))
$(FAULT_TOOLS): $(B)/obj/tests/faults/trace.o $(B)/obj/tests/faults/tree.o | $(FAULT_TOOLS:%/campaign=%/shim.so)
$(B)/tests/faults/shim.so: tests/faults/shim.c tests/faults/page.h $(B)/flags
	$(call say,CC $<)mkdir -p $(@D); $(CC) -std=c11 -D_GNU_SOURCE -O2 -g $(WARN) $(STRICT) -fPIC -shared -I. -o $@ $<
$(FUZZ_TESTS): $(if $(filter fuzz,$(FLAVOR)),,$(B)/obj/tests/fuzz/run_corpus.o)
$(BENCHES): $(B)/lib/bench.a
$(BENCHES): private MORE_LIBS += -lopencv_calib3d -lopencv_imgproc -lopencv_core $(shell $(PKG_CONFIG) --libs OpenEXR 2>/dev/null)
# a test of stage NAME, below tests/unit/NAME/, has the stage's library; so has every program that includes a header of the stage
ifneq ($(filter %-build $(B)/tests/%,$(MAKECMDGOALS)),)
USES := $(sort $(shell grep -roE --include='*.[ch]' '^\#include "stages/[a-z_0-9]+/' tests | sed -E 's|(.*):.*/(.*)/|\1:\2|'))
uses = $(patsubst $(1).c:%,$(B)/lib/%.a,$(filter $(1).c:%,$(USES)))
stage_of_test = $(filter $(STAGES),$(word 3,$(subst /, ,$(1))))
libs_of_test = $(if $(1),$(patsubst %,$(B)/lib/%.a,$(sort $(1) $(foreach u,$(filter tests/unit/$(1)/%,$(USES)),$(lastword $(subst :, ,$(u)))))))
$(TESTS): $(B)/%: $$(call uses,$$*) $$(call libs_of_test,$$(call stage_of_test,$$*))
endif
.SECONDARY: $(call objs,tests/*/*.c tests/*/*/*.c tests/*/*/*/*.c stages/*/*.c) $(STAGE_LIBS)
# what a person calls has the rest made by a make of its own, and need not read hundreds of files before
ifneq ($(PHASE)$(filter $(B)/%,$(MAKECMDGOALS)),)
-include $(shell find $(if $(filter %-build $(B)/tests/%,$(MAKECMDGOALS)),$(B)/obj,$(B)/obj/common $(B)/obj/stages) -name '*.d' 2>/dev/null)
endif
