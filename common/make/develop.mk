# develop.mk - what a person calls who works on the programs. An installed remodel has none of it.

.PHONY: check check-long sequences fuzz bench bench-compare regress regress-accept generated deps-check deps-bench deps-deb deps-draw wasm clean install uninstall deb

# the packages for arm64 may take the place of this machine's own, so nothing installs them unasked
deps-check:
	+@$(if $(filter arm64,$(FLAVOR)),:,common/run/deps.sh $(DEPS) run check)
deps-bench:
	+@common/run/deps.sh $(DEPS) run bench
check: deps-check ## build and run the tests
	+@$(BUILD) $(if $(filter-out unit fuzz,$(or $(CHECKS),all)),tests-build,$(CHECKS:%=%-build))
	+@tests/run '$(B)' $(CHECKS)
check-long: deps-check ## the tests that take longer: whole runs, the build with clang, its static analyser
	+@$(BUILD) tests-build
	+@tests/run '$(B)' $(or $(CHECKS),long)
deps-draw:
	+@common/run/deps.sh $(DEPS) run draw
wasm: deps-draw ## build_model as WebAssembly, which make draw of an installed remodel needs: before make install
	+@$(BUILD) wasm-build
bench: deps-bench ## measure everything in tests/bench: tables and plots under out/bench
	+@$(BUILD) bench-build
	+@rc=0; for b in tests/bench/*.sh; do tests/bench/run "$$(basename $$b .sh)" '$(B)' || rc=1; done; exit $$rc
bench-%: deps-bench FORCE ## one of them: bench-daylight, bench-depth, bench-exr, bench-hdr, bench-irradiance, bench-irradiance_scenes, bench-lamps, bench-matching, bench-materials, bench-moves, bench-render, bench-relight, bench-remodel, bench-render_model, bench-rooms, bench-scaling, bench-simulate, bench-solve, bench-things, bench-unite, bench-vdta
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
generated: ## the files that come from the stages: docs/man, configs/default.cfg, the tables of docs/architecture.md, docs/formats.md and docs/evaluation.md
	+@$(BUILD) build
	@common/run/generate.sh '$(B)/bin' '$(STAGES)' .
## PREFIX=DIR DESTDIR=DIR: of make install: the folder it is used from (/usr/local), and one that all paths are put under, for packages
PREFIX ?= /usr/local
install: deps ## programs, manual pages, completion and the command remodel, which works in any folder
	+@$(BUILD) build
	@common/install/install.sh '$(B)' '$(PREFIX)' '$(DESTDIR)' '$(STAGES)'
uninstall: ## remove what make install with the same PREFIX and DESTDIR installed
	@common/install/uninstall.sh '$(PREFIX)' '$(DESTDIR)'
deps-deb:
	+@common/run/deps.sh $(DEPS) run deb
deb: deps-deb ## out/remodel_VERSION_ARCHITECTURE.deb, a package for this release of Debian
	+@$(BUILD) build
	@common/install/deb.sh '$(B)' '$(STAGES)'
clean: ## remove what was built (products of scenes stay)
	rm -rf out/build
