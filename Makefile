# Everything a user or a developer types. Plain `make` lists it.
SHELL       := /bin/bash
.SHELLFLAGS := -euo pipefail -c
MAKEFLAGS   += --no-print-directory
JOBS        ?= $(shell nproc)
MINUTES     ?= 60
BUILD       ?= build/release
LEVEL       ?=
TALUS_WERROR ?= OFF
SCENE       ?= scenes/slope_failure_3d/scene.yaml
RUN         ?= runs/$(notdir $(patsubst %/,%,$(dir $(SCENE))))

.DEFAULT_GOAL := help
.PHONY: help setup build portable package run test coverage fuzz check format bench scaling verify docs site tutorials clean

help:  ## this list
	@sed -n 's/^\([a-z]*\):[^#]*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 18
	@echo "  variables: JOBS=$(JOBS)  SCENE=$(SCENE)  RUN=$(RUN)  MINUTES=$(MINUTES)"
	@echo "  of build and test: BUILD=$(BUILD)  LEVEL=a processor to compile for, such as x86-64-v3 (now: $(or $(LEVEL),the one at hand))"

# Each target asks for the packages of its own groups (tools/debian-packages.txt). What is typed here never fails by a warning of a compiler:
# they are errors only where TALUS_WERROR=ON says so, as CI does.
packages     = tools/install_packages.sh
configure    = cmake --preset release -B $(BUILD) -D TALUS_LEVEL=$(LEVEL) -D TALUS_WERROR=$(TALUS_WERROR) -Wno-dev >/dev/null

setup:  ## install every Debian package that a developer needs and that is missing (tools/debian-packages.txt)
	@$(packages)

build:  ## compile build/talus and build/talus-render, at full speed
	@$(packages) build
	@$(configure)
	@cmake --build $(BUILD) --target programs -j $(JOBS)
	@for program in talus talus-render; do if [ -e $(BUILD)/$$program ]; then ln -sfnr $(BUILD)/$$program build/$$program; fi; done

portable:  ## compile build/portable/talus, which runs on any x86-64 processor and uses what it has (two builds)
	@$(packages) build
	@tools/build_portable.sh

package: portable  ## the portable programs as a Debian package, and what is in it: build/talus_VERSION_amd64.deb, .cdx.json
	@cpack --config build/portable/CPackConfig.cmake -B build/package >/dev/null
	@mv build/package/talus_*.deb build/ && rm -r build/package
	@for deb in build/talus_*.deb; do dpkg-deb --fsys-tarfile "$$deb" | tar -xO ./usr/share/doc/talus/sbom.cdx.json > "$${deb%.deb}.cdx.json"; done
	@ls build/talus_*.deb build/talus_*.cdx.json

run: build  ## build, run SCENE into RUN, draw its pictures, make its page
	@$(packages) draw
	build/talus run $(SCENE) --out $(RUN)
	build/talus render $(RUN)
	build/talus report $(RUN)
	@echo; echo "Results in $(RUN):"; find $(RUN) \( -name '*.png' -o -name 'summary.json' -o -name 'report.html' \) | sort | sed 's/^/  /'

test:  ## compile what `make build` does and the tests, run every test but the nightly ones
	@$(packages) build draw scripts test
	@$(configure)
	@cmake --build $(BUILD) -j $(JOBS)
	@ctest --test-dir $(BUILD) --output-on-failure --no-tests=error --label-exclude nightly -j $(JOBS)

coverage:  ## which lines the tests run, a table by folder: build/coverage/lines.html (long: compiles everything anew)
	@$(packages) build draw scripts test coverage
	@tools/coverage.sh

fuzz:  ## damaged files into what reads them, MINUTES for each kind
	@$(packages) build fuzz
	@tools/fuzz.sh long $(MINUTES)

check:  ## format, layers, text, spelling, shell scripts, cppcheck, clang-tidy
	@$(packages) build check
	@tools/ci.sh lint

format:  ## rewrite the sources as .clang-format says
	@git ls-files '*.hpp' '*.cpp' | xargs clang-format -i

bench: build  ## speed of the parts (Google Benchmark) and of whole steps (talus bench)
	@$(packages) test
	@$(configure)
	@cmake --build $(BUILD) --target talus_speed -j $(JOBS)
	@$(BUILD)/talus_speed
	@if build/talus bench --help >/dev/null 2>&1; then build/talus bench; fi

scaling: build  ## what sharing a run over ranks costs: measure, fit, write docs/development/scaling.md (some minutes)
	@$(packages) scripts
	@/usr/bin/python3 benchmarks/scaling.py --write-docs

verify: build  ## run the benchmarks against their references, quick level (about 9 minutes)
	@$(packages) scripts
	@tools/verify.sh --level quick --jobs 2 --regression

docs: build  ## write docs/reference/scene.md out of the program
	@$(packages) scripts
	@mkdir -p docs/reference
	@build/talus manual > build/scene.md && mv build/scene.md docs/reference/scene.md
	@tools/ci.sh docs

site:  ## write the documentation as a site that opens from its folder, build/site/index.html
	@$(packages) docs
	@tools/ci.sh site
	@echo "build/site/index.html"

tutorials: build  ## run every command of docs/tutorials
	@$(packages) draw scripts
	@/usr/bin/python3 tools/run_tutorials.py build/talus

clean:  ## remove everything built; runs/ stays
	@rm -rf build
