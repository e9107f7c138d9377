# make            sets up .venv, then builds everything that config/config.yaml asks for
# make test       the same set-up, then what decides whether a change is good
# make test-all   that, and what takes long and seldom fails: coverage of intervals, other processors, Slurm
# make docs       the same set-up, then the site, in build/site
# make archive    the same as make, then one file to deposit, in build: the sources, the lock and the results
#
# CONFIG=my.yaml builds that configuration instead. CORES=n says on how many cores (2), PYTHON=path with which Python (the first that is new enough).

CORES ?= 2
CONFIG ?=
PYTHON ?=
CANDIDATES = $(PYTHON) python3 python3.14 python3.13 python3.12 python3.11 python
# What an activated .venv brings is gone when it is set up again.
export PATH := $(subst $(CURDIR)/.venv/bin:,,$(PATH))
PIP = .venv/bin/python -m pip install --quiet --disable-pip-version-check
IN_VENV = PATH="$(CURDIR)/.venv/bin:$$PATH"
# Packages are installed with their bytecode. Where Python is told to keep none, as in many containers, each of some
# hundred processes would compile our own sources anew.
export PYTHONDONTWRITEBYTECODE =

.PHONY: all test test-all docs archive

all: .venv/ready $(CONFIG)
	$(IN_VENV) $(if $(CONFIG),twodiscs run --cores $(CORES) $(CONFIG),snakemake --cores $(CORES))

test-all: WHICH = -m "slow or not slow"
test-all: test

test: .venv/ready
	$(IN_VENV) ruff check src tests
	$(IN_VENV) ruff format --check src tests
	$(IN_VENV) snakefmt --check Snakefile workflow
	$(IN_VENV) pytest -n $(CORES) $(WHICH)

docs: .venv/ready
	rm -rf build/site
	@# A warning, as of a dead link, is an error.
	$(IN_VENV) sphinx-build --conf-dir docs/make --doctree-dir build/doctrees --fresh-env \
	  --fail-on-warning --keep-going --quiet . build/site

# Files that git tracks, as they are now, and results/, which holds its manifest and its provenance.
archive: all
	mkdir -p build
	git ls-files -z -- ':!results' | tar --create --gzip --file build/twodiscs.tar.gz \
	  --transform 's,^,twodiscs/,S' --owner 0 --group 0 --null --files-from - results

# The exact packages of requirements.lock, then this one; again whenever either list changes. uv puts them
# there: the one that is installed, or that of the lock, which pip brings. Where uv cannot, pip does it all.
# A copy of another folder has the environment of that one, which runs the code there. An environment without
# the file "ready" is the reader's own.
ifneq ($(shell cat .venv/ready 2> /dev/null),$(CURDIR))
.PHONY: .venv/ready
endif
# An interrupted set-up keeps the file, so that the next one may replace the environment.
.PRECIOUS: .venv/ready
.venv/ready: requirements.lock pyproject.toml
	@if [ -e .venv ] && [ ! -e .venv/ready ]; then \
	  echo "make did not make this .venv, and keeps it: give it another name, such as .venv.old, and run make again." >&2; \
	  echo "make PYTHON=<path> chooses a Python, that of .venv.old/bin/python for instance." >&2; exit 1; \
	fi
	@echo "Setting up .venv"
	@if [ -n "$(PYTHON)" ] && ! "$(PYTHON)" -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2> /dev/null; then \
	  echo "PYTHON must be a Python of 3.11 or newer, not $(PYTHON)" >&2; exit 1; \
	fi
	@if command -v uv > /dev/null; then \
	  rm -rf .venv && uv venv --quiet --seed --python "$(or $(PYTHON),>=3.11)" .venv && \
	  echo unfinished > $@; \
	else \
	  for python in $(CANDIDATES) none; do \
	    if $$python -c 'import sys; sys.exit(sys.version_info < (3, 11))' 2> /dev/null; then break; fi; \
	  done; \
	  if [ $$python = none ]; then \
	    echo "This needs Python 3.11 or newer; make PYTHON=<path> says where it is." >&2; exit 1; \
	  fi; \
	  rm -rf .venv && $$python -m venv .venv && echo unfinished > $@ && \
	  awk '/^[^ ]/ { uv = /^uv==/ } uv' requirements.lock > .venv/uv.lock && \
	  { $(PIP) --require-hashes --requirement .venv/uv.lock || true; }; \
	fi
	@$(IN_VENV) VIRTUAL_ENV="$(CURDIR)/.venv" sh -c '\
	  uv pip install --quiet --compile-bytecode --require-hashes --requirement requirements.lock 2> .venv/uv.log && \
	  uv pip install --quiet --no-deps --no-build-isolation --editable . 2>> .venv/uv.log' || { \
	  $(PIP) --require-hashes --requirement requirements.lock && \
	  $(PIP) --no-deps --no-build-isolation --editable .; }
	@echo "$(CURDIR)" > $@
