# Every target sets up what it needs first; that takes a moment only when something changed.
.DEFAULT_GOAL := help
.PHONY: help setup demo test lint types stubs check-stubs format docs check-pages wheel wheel-test paraview-test sanitize sanitize-threads fuzz same-bytes bench compare clean

PYTHON := .venv/bin/python
PYTEST_ARGS ?= -n auto --dist loadfile
CXX_SOURCES = $(shell find plugin/core -name '*.cpp' -o -name '*.h')
PYTHON_PATHS := metric plugin tests $(wildcard solver_examples) docs

help: ## Show this list
	@grep -hE '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/^([a-z-]+):.*## /\1|/' | \
	  awk -F'|' '{ printf "  make %-16s %s\n", $$1, $$2 }'

setup: ## Install what is missing and build the package into .venv
	@./bootstrap.sh

demo: ## Adapt a channel flow and leave pictures, meshes and a report in anistar-demo/
	@./bootstrap.sh demo
	@.venv/bin/anistar demo --force

test: setup ## Run the tests
	@$(PYTHON) -m pytest $(PYTEST_ARGS)

lint: setup ## Check layout and spelling, Python and C++
	@$(PYTHON) -m ruff check .
	@$(PYTHON) -m ruff format --check .
	@.venv/bin/clang-format --dry-run --Werror $(CXX_SOURCES)
	@.venv/bin/codespell

types: setup check-stubs ## Check the types of the installed package
	@$(PYTHON) -m mypy --package anistar

# Without the shapes of arrays, which no type checker reads.
define write_stub
	@$(PYTHON) -m nanobind.stubgen -q -m anistar._core -o $(1)
	@sed -E -i 's/Annotated\[(NDArray\[[^]]*\]), dict\([^]]*\)\]/\1/g; s/import Annotated, /import /' $(1)
	@$(PYTHON) -m ruff format --quiet $(1)
endef

stubs: setup ## Write the stub of the compiled module anew
	$(call write_stub,plugin/anistar/_core.pyi)

check-stubs: setup
	$(call write_stub,build/_core.pyi)
	@diff -u plugin/anistar/_core.pyi build/_core.pyi || \
	  { echo "the stub of the compiled module is out of date: make stubs"; exit 1; }

format: setup ## Lay out the sources
	@$(PYTHON) -m ruff check --fix .
	@$(PYTHON) -m ruff format .
	@.venv/bin/clang-format -i $(CXX_SOURCES)

docs: ## Build the documentation into docs/_build/html
	@./bootstrap.sh docs
	@$(PYTHON) -m sphinx -W --keep-going -q -b html docs docs/_build/html
	@echo "docs/_build/html/index.html"

check-pages: docs ## Open every built page in a headless Chromium: nothing overflows, is broken or raw
	@$(PYTHON) -m pytest -q -m browser tests/browser

wheel: ## Build wheels that need no compiler, and the source archive, into dist/
	@./bootstrap.sh wheel
	@packaging/build_archives.sh

wheel-test: wheel ## Try each of them as a new user would, in an environment of its own
	@packaging/try_archives.sh

paraview-test: wheel ## Adapt and render in ParaView itself, with the wheel for its Python
	@./bootstrap.sh paraview
	@packaging/try_paraview.sh

# The sanitized builds go beside the ordinary one, which they do without. Python itself is not
# instrumented: the run-time libraries are loaded first, and leaks, of which the interpreter is full,
# not counted. Debug asserts are on; -O1 keeps the time within bounds.
SANITIZED := build/sanitize
install_sanitized = $(PYTHON) -m pip install --quiet --disable-pip-version-check \
  --no-build-isolation --no-deps --upgrade --target $(SANITIZED)/$(1) \
  --config-settings build-dir=$(SANITIZED)/cmake-$(1) \
  --config-settings cmake.build-type=Debug --config-settings cmake.define.$(2)=ON \
  --config-settings cmake.define.ANISTAR_FOR_TESTS=ON .

sanitize: ## Run the tests with the address and undefined-behaviour sanitizers
	@./bootstrap.sh environment
	@$(call install_sanitized,addresses,ANISTAR_SANITIZE)
	@PYTHONPATH=$(CURDIR)/$(SANITIZED)/addresses ASAN_OPTIONS=detect_leaks=0 \
	  UBSAN_OPTIONS=print_stacktrace=1:halt_on_error=1 \
	  LD_PRELOAD="$$(c++ -print-file-name=libasan.so) $$(c++ -print-file-name=libubsan.so)" \
	  $(PYTHON) -m pytest -p no:cacheprovider $(PYTEST_ARGS)

# As above, for races.
sanitize-threads: ## Run the tests of threads with the thread sanitizer
	@./bootstrap.sh environment
	@$(call install_sanitized,threads,ANISTAR_SANITIZE_THREADS)
	@PYTHONPATH=$(CURDIR)/$(SANITIZED)/threads TSAN_OPTIONS=halt_on_error=1 OPENBLAS_NUM_THREADS=1 \
	  LD_PRELOAD="$$(c++ -print-file-name=libtsan.so)" \
	  $(PYTHON) -m pytest -p no:cacheprovider -q tests/remesh/test_threads.py tests/remesh3d/test_threads_3d.py

fuzz: setup ## Run the property tests with many more and random examples
	@$(PYTHON) -m pytest --hypothesis-profile=fuzz $(PYTEST_ARGS)

same-bytes: setup ## Compare the bytes of all results between the code paths for other CPUs
	@$(PYTHON) tests/same_bytes/compare_levels.py

bench: ## Measure against other programs and print a table
	@./bootstrap.sh bench
	@$(PYTHON) tests/benchmarks/run_cases.py

compare: ## Compare with what others do and publish, and write the tables of that page anew
	@./bootstrap.sh bench
	@OMP_NUM_THREADS=1 PYTHONPATH=tests/benchmarks $(PYTHON) \
	  tests/benchmarks/compared/write_tables.py docs/tables

clean: ## Remove everything that these commands made
	@rm -rf .venv build dist docs/_build docs/api/generated docs/auto_examples .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name __pycache__ -type d -prune -exec rm -rf {} +
