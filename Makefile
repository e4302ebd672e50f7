# Every target sets up what it needs: only Python 3.11 with venv is assumed.
PYTHON ?= python3.11
VENV := .venv
BIN := $(VENV)/bin
INSTALLED := $(VENV)/.installed
DEMO ?= demo
# For instance an --extra-index-url of PyTorch's CPU builds, which are much smaller where there is no NVIDIA card.
PIP_FLAGS ?=

.DEFAULT_GOAL := help
.PHONY: help setup demo test test-slow check format bench clean

help: ## what there is
	@grep -E '^[a-z-]+:.*##' $(MAKEFILE_LIST) | sed -E 's/:.*## /\t/' | expand -t 12

setup: $(INSTALLED) ## the virtual environment with the locked packages

$(INSTALLED): requirements.lock pyproject.toml
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --disable-pip-version-check $(PIP_FLAGS) --requirement requirements.lock
	$(BIN)/python -m pip install --quiet --disable-pip-version-check --no-deps --no-build-isolation --editable .
	touch $@

demo: $(INSTALLED) ## the whole way of 40 simulated chairs, into $(DEMO)/
	$(BIN)/partwise demo $(DEMO)

test: $(INSTALLED) ## the everyday tests
	$(BIN)/python -m pytest --numprocesses 2 --dist loadfile

test-slow: $(INSTALLED) ## kill loops and soaks
	$(BIN)/python -m pytest -m slow

check: $(INSTALLED) ## ruff, mypy strict, import-linter
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	$(BIN)/mypy
	$(BIN)/lint-imports

format: $(INSTALLED) ## put the code in shape
	$(BIN)/ruff format .
	$(BIN)/ruff check --fix .

bench: $(INSTALLED) ## core-seconds and memory of describing one simulated chair
	$(BIN)/partwise simulate chairs --count 1 --seed 1 --faces 10000 build/bench
	$(BIN)/partwise bench describe build/bench/*.off

clean: ## all that the targets above have made
	rm -rf $(VENV) $(DEMO) build .mypy_cache .ruff_cache .pytest_cache .hypothesis .import_linter_cache
