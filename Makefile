# For a newcomer: `make demo` plans, draws and simulates a mission, `make test` runs the fast tests. `make help` lists the rest.

PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
CPP := $(wildcard src/muster/core/*.[ch]pp src/muster/core/*/*.[ch]pp)
BUILT_FROM := pyproject.toml CMakeLists.txt $(CPP)
DEMO_MISSION ?= 31T-6R50

unexport PYTHONDONTWRITEBYTECODE  # else each of the many processes that tests start compiles all that it imports

.PHONY: house standing demo test test-all test-alone quick turn flakes ci docs docs-check docs-check-long figures campaign campaign-times campaign-carry campaign-mixed campaign-state campaign-auction campaign-byzantine campaign-mutated campaign-model campaign-goods campaign-server campaign-faults fault-flights campaign-api campaign-coverage campaign-kills campaign-narrow network-figures disturbances disturbances-timed disturbances-traffic help check format stub man sanitize study bench clean prerequisites test-packages

demo: $(VENV)/installed
	@mkdir -p demo
	$(BIN)/muster solve $(DEMO_MISSION) --time-limit 2 --seed 1 -o demo/plan.json --plot demo/plan.png --gantt demo/gantt.png
	$(BIN)/muster verify $(DEMO_MISSION) demo/plan.json
	$(BIN)/muster simulate $(DEMO_MISSION) --plan demo/plan.json --html demo/run.html
	@echo
	@echo "The picture of the plan: $(CURDIR)/demo/plan.png"
	@echo "Its time chart:          $(CURDIR)/demo/gantt.png"
	@echo "The mission carried out: $(CURDIR)/demo/run.html (animated; open it in a browser)"
	@echo "Next: $(BIN)/muster --help"
	@echo "Maps, physics, ROS 2, MAVLink, mission control in the browser, ...: $(BIN)/pip install -e '.[all]' (1.3 GB; docs/index.md)"

test: $(VENV)/developed test-packages
	$(BIN)/python -m pytest -n 2 --dist loadgroup --suite=fast $(PYTEST_FLAGS)

test-all: $(VENV)/developed test-packages
	$(BIN)/python -m pytest -n 2 --dist loadgroup $(PYTEST_FLAGS)

test-alone: $(VENV)/developed test-packages
	@$(BIN)/python -m tools.suites.alone $(PACKAGE)

quick: $(VENV)/developed
	@$(BIN)/python -m tools.suites.quick $(if $(BASE),--base $(BASE)) $(if $(BUDGET),--budget $(BUDGET)) $(PYTEST_FLAGS)

turn: $(VENV)/developed test-packages
	$(BIN)/python -m tools.suites.turn $(TURN_FLAGS)

flakes: $(VENV)/developed test-packages
	$(BIN)/python -m tools.suites.flakes $(FLAKES_FLAGS)

ci: $(VENV)/documented test-packages
	$(BIN)/python -m tools.suites.ci

docs: $(VENV)/documented
	$(BIN)/python -m tools.docs_site

docs-check: $(VENV)/developed
	$(BIN)/python -m tools.docs_check $(DOCS_FLAGS) $(DOCS)

docs-check-long: $(VENV)/developed
	$(BIN)/python -m tools.docs_check --long $(DOCS)

figures: $(VENV)/developed
	$(BIN)/python -m tools.figures --page $(STUDIES)

campaign: $(VENV)/developed
	$(BIN)/python -m tests.campaign $(CAMPAIGN_FLAGS)

campaign-times: $(VENV)/developed
	$(BIN)/python -m tests.timed_missions $(or $(CAMPAIGN_FLAGS),5000)

campaign-carry: $(VENV)/developed
	$(BIN)/python -m tests.carried_missions $(or $(CAMPAIGN_FLAGS),3000)

campaign-mixed: $(VENV)/developed
	$(BIN)/python -m tests.mixed_missions $(CAMPAIGN_FLAGS)

campaign-state: $(VENV)/developed
	$(BIN)/python -m tests.state.campaign $(CAMPAIGN_FLAGS)

campaign-auction: $(VENV)/developed
	$(BIN)/python -m tests.muster_team.campaign $(CAMPAIGN_FLAGS)

campaign-byzantine: $(VENV)/developed
	$(BIN)/python -m tests.muster_team.byzantine $(CAMPAIGN_FLAGS)

campaign-mutated: $(VENV)/developed
	$(BIN)/python -m tests.muster_team.mutated $(CAMPAIGN_FLAGS)

campaign-model: $(VENV)/developed
	$(BIN)/python -m tests.muster_team.model $(CAMPAIGN_FLAGS)

campaign-server: $(VENV)/developed
	$(BIN)/python -m tests.muster_control.runs.campaign $(CAMPAIGN_FLAGS)

campaign-faults: $(VENV)/developed
	$(BIN)/python -m tests.muster_control.runs.double_faults $(CAMPAIGN_FLAGS)

fault-flights: $(VENV)/developed
	$(BIN)/python -m tests.muster_robots.mavlink.fault_flights $(CAMPAIGN_FLAGS)

campaign-kills: $(VENV)/developed
	$(BIN)/python -m tests.muster_robots.kills $(CAMPAIGN_FLAGS)

campaign-narrow: $(VENV)/developed
	$(BIN)/python -m tests.running.narrow $(or $(CAMPAIGN_FLAGS),50)

campaign-coverage: $(VENV)/developed
	MUSTER_AREAS=$(or $(CAMPAIGN_FLAGS),200) $(BIN)/python -m pytest tests/motion/areas/test_coverage_path.py

campaign-api: $(VENV)/developed
	MUSTER_SCHEMA_EXAMPLES=$(or $(CAMPAIGN_FLAGS),60) $(BIN)/python -m pytest tests/muster_control/api/test_schema.py

network-figures: $(VENV)/developed
	$(BIN)/python -m tests.muster_team.real_figures $(NETWORK_FLAGS)

disturbances: $(VENV)/developed
	$(BIN)/python -m tests.disturbances $(DISTURBANCES_FLAGS)

disturbances-timed: $(VENV)/developed
	$(BIN)/python -m tests.disturbances.timed $(or $(DISTURBANCES_FLAGS),2000)

campaign-goods: $(VENV)/developed
	$(BIN)/python -m tests.disturbances.goods $(or $(CAMPAIGN_FLAGS),2000)

disturbances-traffic: $(VENV)/developed
	$(BIN)/python -m tests.disturbances.traffic $(or $(DISTURBANCES_FLAGS),2000)

standing: $(VENV)/developed
	$(BIN)/muster bench --only standing,standing-live

help:
	@echo "make demo       plan, draw and simulate a mission (DEMO_MISSION=$(DEMO_MISSION))"
	@echo "make test       run the fast tests, and the short forms of long ones"
	@echo "make test-all   run all tests, the long ones too"
	@echo "make test-alone  run the fast tests of one package with its extras alone (PACKAGE=muster_files)"
	@echo "make quick      run the fast tests that executed what has changed (BASE=COMMIT BUDGET=SECONDS)"
	@echo "make turn       the last step of a change: raise .ci/turn and remake a tenth of the map of tests"
	@echo "make flakes     run the fast tests five times in random order, beside two busy loops"
	@echo "make ci         what .ci/run executes (CI_ALL=1: everything)"
	@echo "make docs       build the documentation site in build/docs/site, and run its notebooks; reads no network"
	@echo "make docs-check  run what the documents show: blocks, pictures, numbers (DOCS='README.md ...')"
	@echo "make docs-check-long  make what takes minutes, and store it in docs/measured (DOCS='NAME...')"
	@echo "make figures    draw every figure of every study, and docs/figures.md (STUDIES='rvo ...'); minutes"
	@echo "make campaign   plan and judge 10,000 random missions (CAMPAIGN_FLAGS='1000 --first 5000')"
	@echo "make campaign-times  5,000 small missions with windows, lags, teams and relations, against every plan of each"
	@echo "make campaign-carry  3,000 small missions with goods and energy, against every plan of each"
	@echo "make campaign-state  10,000 runs that are killed at random moments, and know afterwards what they knew before"
	@echo "make campaign-mixed  10,000 tiny missions in which rules of every kind meet, against every plan of each"
	@echo "make campaign-auction  10,000 auctions without a centre, with random faults, in a simulated network"
	@echo "                       (CAMPAIGN_FLAGS='--timed 2000': of missions with rules of time)"
	@echo "make campaign-byzantine  10,000 teams of which one robot states what is not so; with CAMPAIGN_FLAGS='--orders'"
	@echo "                       operators give orders that contradict each other"
	@echo "make campaign-mutated  a million mutated messages, validly sealed, to robots in every phase"
	@echo "make campaign-model  every run of three robots that negotiate, within bounds (CAMPAIGN_FLAGS='1 --first 8')"
	@echo "make campaign-goods  carry out 2,000 missions with goods and batteries in which robots and stations fail"
	@echo "make campaign-server  kill servers, runners and workers of mission control at 50 random moments"
	@echo "make campaign-faults  kill a server of mission control 100 times while its database is away; no order is lost"
	@echo "make fault-flights  fly 66 simulated flights of drones with faults that come and go"
	@echo "make campaign-narrow  carry out 50 scenes of 2 to 200 robots in narrow places; nobody touches another"
	@echo "make campaign-coverage  cover 200 random areas with holes; Shapely says whether every place is seen"
	@echo "make campaign-api  many more requests, made from the description of mission control's API, than the tests make"
	@echo "make network-figures  time robots in network namespaces, through loss and a cut (root; NETWORK_FLAGS='--robots 20')"
	@echo "make disturbances  carry out 10,000 random missions in which robots fail and tasks change"
	@echo "make disturbances-timed  carry out 2,000 with windows, lags, shifts, teams and relations"
	@echo "make disturbances-traffic  carry out 2,000 in narrow places, where robots stop and come back"
	@echo "                           (DISTURBANCES_FLAGS='500 --first 1000')"
	@echo "make check      formatters, linters, types, import contract"
	@echo "make format     let the formatters change the files"
	@echo "make stub       make the type stub of the core anew"
	@echo "make man        make the manual page anew"
	@echo "make house      draw the map of packages and rooms in docs/house.md anew"
	@echo "make sanitize   run the core's tests under the address and undefined-behaviour sanitizers"
	@echo "make study      repeat section 3.3 of the TCF thesis, 10 seeds a case"
	@echo "make standing   an hour of a standing fleet, simulated, and ten minutes in real time"
	@echo "make bench      measure speed on this machine"
	@echo "make clean      remove what make has made"

check: $(VENV)/developed
	$(BIN)/ruff check .
	$(BIN)/ruff format --check .
	$(BIN)/mypy
	$(BIN)/lint-imports
	$(BIN)/clang-format --dry-run --Werror $(CPP)
	$(BIN)/check-jsonschema --builtin-schema vendor.github-workflows .github/workflows/*.yml

format: $(VENV)/developed
	$(BIN)/ruff check --fix .
	$(BIN)/ruff format .
	$(BIN)/clang-format -i $(CPP)

stub: $(VENV)/developed
	$(BIN)/python -m nanobind.stubgen -m muster.core._core -o src/muster/core/_core.pyi

man: $(VENV)/developed
	$(BIN)/muster man > man/muster.1

house: $(VENV)/developed
	$(BIN)/python -m tools.house

sanitize: $(VENV)/developed
	PYTHON=$(BIN)/python tools/sanitize.sh

study: $(VENV)/developed
	$(BIN)/muster study thesis-3.3

bench: $(VENV)/developed
	$(BIN)/muster bench

# Three states of one environment: what the demo needs (the core, pictures, pages); everything, with the developers' tools; and
# with what builds the documentation site besides.

$(VENV)/installed: $(BUILT_FROM) | $(VENV)/made
	@echo "Building Muster; this takes one to two minutes on two cores ..."
	$(BIN)/pip install --quiet --disable-pip-version-check --no-compile --editable '.[plot,record]'
	@touch $@

$(VENV)/developed: $(BUILT_FROM) | $(VENV)/made
	@echo "Building Muster, and installing all extras and the tools for tests; this takes minutes ..."
	$(BIN)/pip install --quiet --upgrade 'pip >=25.1'  # knows dependency groups
	$(BIN)/pip install --quiet --group dev --editable '.[all]' \
		-C cmake.define.MUSTER_WERROR=ON -C cmake.define.MUSTER_UNITY=OFF  # a change of one file compiles one file
	-$(BIN)/python -m pytest --collect-only -q >/dev/null  # compiles the tests once, which each worker would do by itself
	@touch $(VENV)/installed $@

$(VENV)/documented: $(VENV)/developed
	$(BIN)/pip install --quiet --group docs
	@touch $@

$(VENV)/made: | prerequisites
	$(PYTHON) -m venv $(VENV)
	@touch $@

test-packages:
	@PYTHON=$(PYTHON) tools/test_packages.sh || echo "Going on without; those tests are skipped." >&2

prerequisites:
	@PYTHON=$(PYTHON) tools/prerequisites.sh

clean:
	rm -rf $(VENV) build demo
