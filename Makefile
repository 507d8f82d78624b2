# The whole house from a bare Debian 12 with git and make. `make help` lists what there is.

JOBS ?= $(shell nproc)
CMAKE_FLAGS ?=
SOURCES = files=$$(git ls-files '*.cpp' '*.hpp') && [ -n "$$files" ]
BUILD_TARGET = cmake --build build -j $(JOBS) --target
DEMO = build/demo

.PHONY: help deps configure build demo test bench format check-format clean

help:
	@echo 'make deps          install the Debian packages that are missing'
	@echo 'make build         build the program: build/gridmerge'
	@echo 'make demo          draw two maps and merge them: pictures in build/demo'
	@echo 'make test          build and run all tests'
	@echo 'make bench         build and run the micro benchmarks'
	@echo 'make format        put all sources into the house style'
	@echo 'make check-format  fail where a source is not in the house style'
	@echo 'make clean         remove build/'
	@echo 'JOBS=n: how many things at once. CMAKE_FLAGS=...: handed to cmake.'

# Touches neither the network nor root's rights when nothing is missing.
deps:
	@command -v dpkg-query >/dev/null || { echo 'not a Debian: see cmake/debian-packages.txt for what is needed'; exit 0; }; \
	missing=; \
	for package in $$(sed 's/#.*//' cmake/debian-packages.txt); do \
	  dpkg-query -W -f='$${db:Status-Status}\n' "$$package" 2>/dev/null | grep -qx installed || missing="$$missing $$package"; \
	done; \
	[ -n "$$missing" ] || exit 0; \
	echo "installing:$$missing"; \
	sudo=; [ "$$(id -u)" -eq 0 ] || sudo=sudo; \
	$$sudo apt-get update && \
	$$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $$missing

configure: deps
	@cmake -S . -B build -DCMAKE_BUILD_TYPE=Release $(CMAKE_FLAGS)

build: configure
	@$(BUILD_TARGET) gridmerge_cli

demo: build
	@rm -rf $(DEMO)
	@build/gridmerge simulate --kind office --seed 3 -o $(DEMO)
	build/gridmerge merge $(DEMO)/a.yaml $(DEMO)/b.yaml -o $(DEMO)/merged
	@echo 'The two maps:           $(DEMO)/a.pgm, $(DEMO)/b.pgm (truth: $(DEMO)/truth.json)'
	@echo 'Merged map, overlay:    $(DEMO)/merged'

test: configure
	@$(BUILD_TARGET) all
	@ctest --test-dir build --output-on-failure -j $(JOBS)

bench: configure
	@$(BUILD_TARGET) gridmerge_micro
	@build/benchmarks/micro/gridmerge_micro

format:
	@$(SOURCES) && clang-format -i $$files

check-format:
	@$(SOURCES) && clang-format --dry-run --Werror $$files

clean:
	@rm -rf build
