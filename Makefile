# Everything a user or a developer types. Plain `make` lists it.
SHELL       := /bin/bash
.SHELLFLAGS := -euo pipefail -c
MAKEFLAGS   += --no-print-directory
JOBS        ?= $(shell nproc)
MINUTES     ?= 60
SCENE       ?= scenes/slope_failure_3d/scene.yaml
RUN         ?= runs/$(notdir $(patsubst %/,%,$(dir $(SCENE))))

.DEFAULT_GOAL := help
.PHONY: help setup build portable package run test fuzz check format bench scaling verify docs site tutorials clean

help:  ## this list
	@sed -n 's/^\([a-z]*\):[^#]*## \(.*\)/  make \1\t\2/p' Makefile | expand -t 16
	@echo "  variables: JOBS=$(JOBS)  SCENE=$(SCENE)  RUN=$(RUN)  MINUTES=$(MINUTES)"

setup:  ## install the Debian packages that are missing (tools/debian-packages.txt)
	@tools/install_packages.sh

build: setup  ## compile build/talus and build/talus-render, at full speed
	@cmake --preset release -Wno-dev >/dev/null
	@cmake --build build/release --target programs -j $(JOBS)
	@for program in talus talus-render; do if [ -e build/release/$$program ]; then ln -sfn release/$$program build/$$program; fi; done

portable: setup  ## compile build/portable/talus, which runs on any x86-64 processor and uses what it has (two builds)
	@tools/build_portable.sh

package: portable  ## the portable programs as a Debian package: build/talus_VERSION_amd64.deb
	@cpack --config build/portable/CPackConfig.cmake -B build/package >/dev/null
	@mv build/package/talus_*.deb build/ && rm -r build/package
	@ls build/talus_*.deb

run: build  ## build, run SCENE into RUN, draw its pictures, make its page
	build/talus run $(SCENE) --out $(RUN)
	build/talus render $(RUN)
	build/talus report $(RUN)
	@echo; echo "Results in $(RUN):"; find $(RUN) \( -name '*.png' -o -name 'summary.json' -o -name 'report.html' \) | sort | sed 's/^/  /'

test: setup  ## compile with all warnings and asserts, run every test but the nightly ones
	@cmake --preset dev -Wno-dev >/dev/null
	@cmake --build build/dev -j $(JOBS)
	@ctest --test-dir build/dev --output-on-failure --label-exclude nightly -j $(JOBS)

fuzz: setup  ## damaged scenes, meshes and checkpoints into what reads them, MINUTES for each
	@tools/fuzz.sh long $(MINUTES)

check:  ## format, layers, text, spelling, shell scripts, cppcheck, clang-tidy
	@tools/ci.sh lint

format:  ## rewrite the sources as .clang-format says
	@git ls-files '*.hpp' '*.cpp' | xargs clang-format -i

bench: build  ## speed of the parts (Google Benchmark) and of whole steps (talus bench)
	@cmake --build build/release --target talus_speed -j $(JOBS)
	@build/release/talus_speed
	@if build/talus bench --help >/dev/null 2>&1; then build/talus bench; fi

scaling: build  ## what sharing a run over ranks costs: measure, fit, write docs/scaling.md (some minutes)
	@/usr/bin/python3 benchmarks/scaling.py --write-docs

verify: build  ## run the benchmarks against their references, quick level (about 9 minutes)
	@tools/verify.sh --level quick --jobs 2 --regression

docs: build  ## write docs/reference/scene.md out of the program
	@mkdir -p docs/reference
	@build/talus manual > build/scene.md && mv build/scene.md docs/reference/scene.md
	@tools/ci.sh docs

site: setup  ## write the documentation as a site that opens from its folder, build/site/index.html
	@tools/ci.sh site
	@echo "build/site/index.html"

tutorials: build  ## run every command of docs/tutorials
	@/usr/bin/python3 tools/run_tutorials.py build/talus

clean:  ## remove everything built; runs/ stays
	@rm -rf build
