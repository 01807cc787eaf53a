# The two commands of the project are `make demo` and `make test`; the others are for people who work on it.
# Everything is built under build/, results go to out/. Nothing outside is touched but missing Debian packages.
SHELL := /bin/bash
.DEFAULT_GOAL := help
.PHONY: help demo serve build test acceptance bench tools fuzz format format-check tidy clean install-build install-test install-check

JOBS  ?= $(shell nproc)
TESTS ?= .*
LISTEN ?= 127.0.0.1:8080
GRPC   ?= 127.0.0.1:50051
DATA   ?= tests/data/berlin

help: ## this list
	@awk -F':.*## ' '/^[a-z-]+:.*## / { printf "  make %-14s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: build ## install, build, run one export of a city through the job API; results in out/demo
	@python3 scripts/demo.py --program build/release/services/apps/citymesh --data $(DATA) --output out/demo

serve: build ## the service on LISTEN and GRPC over the folder DATA; stop with Ctrl-C
	@python3 scripts/demo.py --program build/release/services/apps/citymesh --data $(DATA) --serve \
	  --listen $(LISTEN) --grpc $(GRPC) --state out/state

build: install-build ## the program, in release: build/release/services/apps/citymesh
	@cmake --preset release >build/.configure.log 2>&1 || { cat build/.configure.log >&2; exit 1; }
	@cmake --build --preset release --parallel $(JOBS)

test: install-build install-test ## build with sanitizers and run all tests; TESTS=regex for some
	@cmake --preset dev >build/.configure.log 2>&1 || { cat build/.configure.log >&2; exit 1; }
	@cmake --build --preset dev --parallel $(JOBS)
	@ctest --preset dev --parallel $(JOBS) -R '$(TESTS)'

acceptance: tools ## every file with a known building count, each delivered body re-read by the checker
	@python3 scripts/acceptance.py --program build/tools/services/apps/citymesh \
	  --checker build/tools/tests/support/mesh_checker/citymesh_mesh_checker

bench: tools ## reading and meshing speed, growth and memory on 10 and 100 MB of tiled real data
	@python3 scripts/bench.py --build build/tools

tools: install-build install-test
	@cmake --preset tools >build/.configure.log 2>&1 || { cat build/.configure.log >&2; exit 1; }
	@cmake --build --preset tools --parallel $(JOBS) --target citymesh citymesh_mesh_checker read_throughput

fuzz: install-build install-check ## every parser under libFuzzer, SECONDS_EACH=60
	@cmake --preset fuzz >build/.configure.log 2>&1 || { cat build/.configure.log >&2; exit 1; }
	@cmake --build --preset fuzz --parallel $(JOBS) --target citymesh_fuzzers
	@scripts/fuzz.sh build/fuzz $(or $(SECONDS_EACH),60)

format: install-check ## clang-format over our sources
	@scripts/format.sh

format-check: ## says which sources clang-format would change
	@scripts/format.sh --check

tidy: install-build install-test install-check ## clang-tidy on the files changed since BASE (default: the merge base with main, else the last commit)
	@scripts/tidy.sh $(BASE)

clean: ## removes build/ and out/
	@rm -rf build out

install-build:
	@mkdir -p build && scripts/install_packages.sh build
install-test:
	@scripts/install_packages.sh test
install-check:
	@scripts/install_packages.sh check
