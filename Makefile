# The commands people type; each is a few lines over CMake presets (CMakePresets.json) and tools/.
.DEFAULT_GOAL := help
SHELL := /bin/bash

PRESET ?= release
JOBS ?= $(shell nproc)
build = cmake --preset $(1) $(if $(wildcard build/$(1)/CMakeCache.txt),>/dev/null,) && cmake --build --preset $(1) -j $(JOBS)

.PHONY: help
help:  ## this list
	@grep -hE '^[a-z-]+:.*## ' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## (.*)/  make \1 \t\2/' | expand -t 22

.PHONY: demo
demo: program  ## install what is missing, build, play a simulated match and show it in a browser; DURATION=20 ends it, DEMO_OPTIONS="--port 0"
	build/release/bin/tassilo demo --report $(if $(DURATION),--duration $(DURATION)) $(DEMO_OPTIONS)

.PHONY: recording
recording: program  ## the vision on a shipped recording, compared with its truth; says where the video is
	tools/recording.sh

.PHONY: program
program: install-deps
	$(call build,release) --target tassilo $(if $(and $(shell command -v node),$(shell command -v npm)),webui)

.PHONY: test
test: install-deps  ## install what is missing, build everything, run all tests; PRESET=dev|asan|tsan for another build
	$(call build,$(PRESET))
	tools/run_tests.py --preset $(PRESET) -j $(JOBS)

.PHONY: install-deps
install-deps:  ## apt packages (and npm, once there is a web UI); nothing when all is there
	@tools/install_deps.sh

.PHONY: release
release:  ## optimized build in build/release
	$(call build,release)

.PHONY: bench
bench: release  ## build and run all benchmarks
	@for bench in build/release/bin/*_bench; do [ -x "$$bench" ] || continue; echo "$$bench"; "$$bench" || exit 1; done

.PHONY: format
format:  ## rewrite all sources with clang-format 14
	@tools/format.py

.PHONY: check-format
check-format:  ## fail when a source is not as clang-format 14 writes it
	@tools/format.py --check

.PHONY: tidy
tidy:  ## clang-tidy over all sources (apt-get install clang-tidy): names and likely mistakes
	cmake --preset dev >/dev/null
	run-clang-tidy -quiet -p build/dev -j $(JOBS) "$(CURDIR)/(src|bench|examples)/.*\.cpp$$"

.PHONY: clean
clean:  ## remove build/ and out/
	rm -rf build out
