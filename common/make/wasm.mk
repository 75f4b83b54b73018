# wasm.mk - the C code that pages run, as WebAssembly: out/build/FLAVOR/wasm/build_model.wasm.
#
# The same sources as those of the program, compiled by Debian's clang for wasm32-wasi, with common/base/wasm before the
# system's headers and in place of what needs processes, signals and a disk. Only goals with BUILDS.GOAL make it.

WASM_CC := clang --target=wasm32-wasi
# hidden: the module exports what live.h shows, and the linker drops what nothing calls
WASM_FLAGS := -std=c11 -D_GNU_SOURCE -O2 -ffp-contract=off -fvisibility=hidden -DXXH_INLINE_ALL -Icommon/base/wasm -I. \
  -Wall -Wextra -Wno-unknown-pragmas
WASM_SOURCES := $(filter-out common/base/cli.c common/base/ledger.c common/base/outfile.c common/base/process.c common/math/delaunay.c \
  stages/build_model/picture/overlay_picture.c stages/build_model/picture/view_picture.c, \
  $(wildcard $(addsuffix /*.c,$(addprefix common/,base base/wasm product math capture model light))) \
  common/texture/texture_map.c $(wildcard stages/build_model/*/*.c))
WASM_OBJS := $(WASM_SOURCES:%.c=$(B)/wasm/obj/%.o)
WASM := $(B)/wasm/build_model.wasm

.PHONY: wasm-build
wasm-build: $(WASM)
$(B)/wasm/flags: FORCE
	+@mkdir -p $(@D); t=$@.$$$$.tmp; echo '$(WASM_CC) $(WASM_FLAGS)' >$$t; cmp -s $$t $@ && rm $$t || mv $$t $@
$(B)/wasm/obj/%.o: %.c $(B)/wasm/flags
	$(call say,CC $<)mkdir -p $(@D); $(WASM_CC) $(WASM_FLAGS) $(STRICT) -MMD -MP -c -o $@ $<
$(WASM): $(WASM_OBJS)
	$(call say,LD $@)$(WASM_CC) -mexec-model=reactor -o $@ $^ -Wl,--export-dynamic,--strip-all,-z,stack-size=1048576
ifneq ($(filter wasm-build $(WASM),$(MAKECMDGOALS)),)
-include $(WASM_OBJS:.o=.d)
endif
