# Everything runs in $(VENV), which is made with the versions in constraints.txt when first
# needed and again when pyproject.toml or constraints.txt change. `make help` lists what there is.

VENV ?= .venv
BIN := $(VENV)/bin
PYTHONS := $(or $(PYTHON),python3 python3.13 python3.12 python3.11 python)
PIP := $(BIN)/python -m pip install -qq --disable-pip-version-check -c constraints.txt
INSTALL := $(PIP) --no-build-isolation -e
PINS := pyproject.toml constraints.txt
BENCHMARK := benchmarks/run.py
PYTEST := $(BIN)/python -m pytest -n auto --dist loadgroup
MADE := build dist site docs/laws nullmotion-demo src/*.egg-info
CACHES := .pytest_cache .mypy_cache .ruff_cache .import_linter_cache .hypothesis .benchmarks

.PHONY: help demo test quick lint types docs examples wheel bench bench-quick ci setup clean distclean
.DEFAULT_GOAL := help

help: ## Show this list
	@awk -F ':.*## ' '/^[a-z-]+:.*## / { printf "  make %-12s %s\n", $$1, $$2 }' $(MAKEFILE_LIST)

demo: $(VENV)/.made ## Steer through an elliptic singularity with every law; table and HTML report
	@$(BIN)/nullmotion demo $(ARGS)

test: $(VENV)/.dev ## Run the whole test suite (ARGS="-k sigma" for some of it)
	@$(PYTEST) $(ARGS)

quick: $(VENV)/.dev ## Run the tests without the slow ones
	@$(PYTEST) -q -m "not slow and not browser" $(ARGS)

lint: $(VENV)/.dev ## Check style, format and the order of imports
	@$(BIN)/ruff check --quiet .
	@$(BIN)/ruff format --check --quiet . || { $(BIN)/ruff format --check .; exit 1; }
	@$(BIN)/lint-imports --no-logo

types: $(VENV)/.dev ## Check types
	@$(BIN)/mypy

docs: $(VENV)/.dev ## Build the documentation into site/
	@NO_MKDOCS_2_WARNING=1 $(BIN)/mkdocs build --strict --quiet
	@echo "site/index.html"

examples: $(VENV)/.made ## Run every script in examples/
	@for file in examples/*.py; do \
	  echo "== $$file"; $(BIN)/python $$file || exit 1; \
	done

wheel: $(VENV)/.dev ## Build source distribution and wheel into dist/
	@rm -rf build dist
	@$(BIN)/python -m build --no-isolation > $(VENV)/build.log 2>&1 || { cat $(VENV)/build.log; exit 1; }
	@ls dist/*

bench: $(VENV)/.bench ## Run the benchmarks (takes a while; wants an idle machine)
	@$(BIN)/python $(BENCHMARK) $(ARGS)

bench-quick: $(VENV)/.bench ## Run the benchmarks on small sizes, to see that they run
	@$(BIN)/python $(BENCHMARK) --quick $(ARGS)

ci: ## Run all checks, as continuous integration does
	@bash .ci/run

setup: $(VENV)/.dev ## Make the development environment

clean: ## Remove what was made, but not the environment
	@rm -rf $(MADE) $(CACHES)
	@find . -name __pycache__ -not -path './$(VENV)/*' -prune -exec rm -rf {} +

distclean: clean ## Remove the environment as well
	@rm -rf $(VENV)

$(VENV)/.made: $(PINS)
	@python=; \
	for name in $(PYTHONS); do \
	  if $$name -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null; then python=$$name; break; fi; \
	done; \
	if [ -z "$$python" ]; then \
	  echo "nullmotion needs Python 3.11 or newer; looked for: $(PYTHONS)." >&2; \
	  echo "Install one, or name it: make PYTHON=/path/to/python ..." >&2; exit 1; \
	fi; \
	if ! $$python -c 'import ensurepip, venv' 2>/dev/null; then \
	  echo "$$python cannot make virtual environments (Debian, Ubuntu: apt-get install python3-venv)." >&2; exit 1; \
	fi; \
	echo "Installing nullmotion into $(VENV) with $$($$python --version) (once; a minute or two) ..."; \
	[ -x $(BIN)/python ] || $$python -m venv $(VENV)
	@$(PIP) setuptools
	@$(INSTALL) .
	@touch $@

$(VENV)/.dev: $(VENV)/.made
	@echo "Installing what tests, checks and documentation need ..."
	@$(INSTALL) '.[dev]'
	@touch $@

$(VENV)/.bench: $(VENV)/.dev
	@echo "Installing what the benchmarks compare with ..."
	@$(INSTALL) '.[bench]'
	@touch $@
