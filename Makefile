# Needs only make and Python 3.11 or newer; everything else goes into .venv.
PYTHON ?= python3
VENV := .venv
BIN := $(VENV)/bin
MINUTES ?= 30
JOBS ?= 2
READY := $(VENV)/ready

.PHONY: demo test check lint types unit quick soak docs routes bench bench-agreement bench-peers bench-speed clean help

help:
	@echo "make demo   derive and simulate differentials; tables and pictures in out/"
	@echo "make test   format, lint, types, tests, documentation and doctests"
	@echo "make check  what of that needs no compiler and no more than a few seconds"
	@echo "make soak MINUTES=30  random families beyond what every test run takes; totals in tests/soak/README.md"
	@echo "make docs   README's guides and the API as pages in site/"
	@echo "make routes the table of every kind of port by every route, docs/routes.md"
	@echo "make bench  how time and memory to derive grow with the size of a graph"
	@echo "make bench-speed  how fast and how exact runs are: generated C, numpy, scipy and SUNDIALS beside C by hand"
	@echo "make bench-agreement  how far simulators, exported Python and C, FMUs, and tools of others agree"
	@echo "make bench-peers  the same with other packages and modelling tools, each in an environment of its own"
	@echo "make clean  remove the environment and what was generated"

$(READY): pyproject.toml constraints.txt
	$(PYTHON) -c "import sys; sys.exit('Python 3.11 or newer is needed: make PYTHON=...' if sys.version_info < (3, 11) else 0)"
	$(PYTHON) -m venv $(VENV)
	$(BIN)/python -m pip install --quiet --constraint constraints.txt --editable ".[cli,pictures,tables,control,c,sweep,cluster,sundae,fmu,export,notebooks,docs,test]"
	@touch $(READY)

demo: $(READY)
	$(BIN)/python -m differentials demo

# Types take one processor while the tests begin on the others.
test: lint
	+@$(MAKE) --no-print-directory --jobs=2 types unit

check: lint types quick

lint: $(READY)
	$(BIN)/ruff format --check .
	$(BIN)/ruff check .

types: $(READY)
	$(BIN)/mypy

unit: $(READY)
	$(BIN)/python -m pytest -n $(JOBS) --dist loadfile

# Slices of random families are a quarter of those of every run.
quick: $(READY)
	BONDGRAPH_SLICE=0.25 $(BIN)/python -m pytest -n $(JOBS) --dist loadfile --quick

soak: $(READY)
	PYTHONPATH=tests $(BIN)/python -m soak $(MINUTES) $(if $(FAMILY),--family $(FAMILY)) $(if $(AGAIN),--again)

docs: $(READY)
	NO_MKDOCS_2_WARNING=1 $(BIN)/python -m mkdocs build --strict --quiet

routes: $(READY)
	PYTHONPATH=tests:tests/codegen $(BIN)/python -m oracles.routes

bench: $(READY)
	$(BIN)/python benchmarks/derivation.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/sparse.py
	$(BIN)/python benchmarks/writing.py
	$(BIN)/python benchmarks/peers.py

bench-speed: $(READY)
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/speed.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/sweeps.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/magic.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/beside.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/switchings.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/nonlinear.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/cycle.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/stepping.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/controlled.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/many.py
	$(BIN)/python benchmarks/starting.py
	$(BIN)/python benchmarks/rhs.py

bench-agreement: $(READY)
	$(BIN)/python benchmarks/agreement.py
	OPENBLAS_NUM_THREADS=1 $(BIN)/python benchmarks/confirm.py

bench-peers: $(READY)
	$(BIN)/python benchmarks/peers.py 10
	$(BIN)/python benchmarks/modelling.py

clean:
	rm -rf $(VENV) .peers out site build *.egg-info .mypy_cache .pytest_cache .ruff_cache
