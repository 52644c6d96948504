# Everything from a fresh clone with Python 3.11 and make: `make soccer`, `make test`.

# The system's Python first: distributions build it with optimisations, and soccer then plays some 5 % faster.
PYTHON ?= $(shell for each in /usr/bin/python3 python3 python3.11 python3.12 python3.13; do \
	$$each -c 'import ensurepip, sys; sys.exit(sys.version_info < (3, 11))' 2>/dev/null && echo $$each && break; done)
BIN := .venv/bin
READY := .venv/.ready
DOCS_READY := .venv/.docs-ready

# Tests wait more than they compute: a worker more than processors.
WORKERS ?= $(shell expr $$(nproc) + 1)
PARALLEL = --numprocesses $(WORKERS) --maxprocesses 9 --dist worksteal

# Hundreds of processes start in the tests; without compiled modules on disk each of them would compile the framework anew.
unexport PYTHONDONTWRITEBYTECODE

.DEFAULT_GOAL := help
.PHONY: help soccer test all-tests test-fast simulate simulate-mutations lint types docs pictures web-pictures rerun-picture clean

help:  ## Lists what can be made
	@sed -nE 's/^([a-z-]+):.*## (.*)/  make \1\t\2/p' $(MAKEFILE_LIST) | expand -t 20

# The stamp is newer than pyproject.toml, so a changed dependency is installed by the next make.
$(READY): pyproject.toml fwk/packaging/build_backend.py
	@test -n "$(PYTHON)" || { echo "fwk needs Python 3.11 or newer with venv (Debian: python3-venv); install it or say: make PYTHON=/path/to/python3"; exit 2; }
	@echo "installing fwk and the libraries that it needs into .venv; the first time this takes some minutes"
	test -x $(BIN)/python || $(PYTHON) -m venv .venv
	$(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check --editable '.[dev]'
	@touch $@

types: $(READY)  ## Generates Python classes from lcmtypes/*.lcm
	@$(BIN)/python -P fwk/lcm/typegen.py lcmtypes tests/components/lcmtypes tests/simulation/messages/lcmtypes

soccer: types  ## Plays five against five; Ctrl-C ends the match
	@$(BIN)/fwk-launch soccer.yaml

lint: types  ## Format, lint, types
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .
	nice $(BIN)/mypy
	$(BIN)/lint-imports --no-logo

# mypy needs a processor for a minute, so the tests begin beside it and go first.
test:  ## Everything that has to hold before a commit
	@$(MAKE) --no-print-directory --jobs 2 lint all-tests

all-tests: types
	$(BIN)/pytest $(PARALLEL)

test-fast: types  ## The tests of parts, and of the whole what breaks first
	$(BIN)/pytest $(PARALLEL) --hypothesis-profile=fast -m '(not system or core) and not slow'

# SEED shows one history step by step; HISTORIES, SECONDS, FIRST and PROCESSES choose how many, which, and how parallel.
SIMULATE = PYTHONPATH=.:tests/simulation/messages $(BIN)/python -m tests.simulation
simulate: types  ## Simulates 1,000 systems with faults; SEED=N shows one, HISTORIES=N, SECONDS=N
	@$(SIMULATE) $(foreach word,seed histories seconds first processes,$(if $($(shell echo $(word) | tr a-z A-Z)),--$(word) $($(shell echo $(word) | tr a-z A-Z))))

simulate-mutations: types  ## Breaks the contract on purpose; shows that the simulation finds it
	@$(SIMULATE).find_mutations $(if $(HISTORIES),--histories $(HISTORIES))

# The generator of the site is installed by the first `make docs`; tests need none of it.
$(DOCS_READY): $(READY)
	$(BIN)/python -m pip install --quiet --quiet --disable-pip-version-check --editable '.[docs]'
	@touch $@

docs: types $(DOCS_READY)  ## Writes docs/commands.md, the index of commands, and the documentation site to build/site
	$(BIN)/python -m fwk.cli.reference docs/commands.md
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --config-file .mkdocs.yml

pictures: types  ## Plays a match and draws docs/match.png, docs/display.svg and docs/camera-sight.jpg
	$(BIN)/fwk-launch soccer.yaml --hosting robot --seed 7 --speed max --time 30 --plain --record build/match.log
	$(BIN)/python -m tools.docs.pictures build/match.log --tick 470
	$(BIN)/python -m procs.view.sight_picture docs/camera-sight.jpg

rerun-picture: types  ## Plays a match and takes docs/rerun.png of 'fwk view --web' in a headless Chromium
	$(BIN)/fwk-launch soccer.yaml --ticks 560 --speed max --run rerun-picture --record build/view.lcm
	$(BIN)/fwk cut build/view.lcm --from 520 --out build/view-part.lcm --force
	$(BIN)/fwk view --from build/view-part.lcm --web --port 8471 --channels 'world/*' --channels 'cyan1/*' & view=$$!; \
	$(BIN)/python -m tools.docs.rerun_picture 'http://127.0.0.1:8472/?url=rerun+http://127.0.0.1:8471/proxy'; code=$$?; \
	kill -INT $$view; exit $$code

web-pictures: types  ## Plays a match and takes docs/web-*.png in a headless Chromium
	$(BIN)/fwk-launch soccer.yaml --hosting robot --seed 7 --run pictures --detach --no-record
	$(BIN)/fwk web --run pictures --port 8461 & console=$$!; \
	$(BIN)/python -m tools.docs.web_pictures http://127.0.0.1:8461 pictures; code=$$?; \
	kill $$console; $(BIN)/fwk stop --all --run pictures; exit $$code

clean:  ## Removes what was made, the environment too
	rm -rf .venv build/lib build/bdist.* build/site dist fwk.egg-info lcmtypes/*/ tests/components/lcmtypes/*/ tests/simulation/messages/lcmtypes/*/ .mypy_cache .ruff_cache .pytest_cache .hypothesis

-include tools/bench/bench.mk
