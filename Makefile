# Everything a newcomer needs: `make demo` shows the stadium, `make test` checks the code.
# .ci/setup makes .venv and says, or as root on Debian and Ubuntu installs, what the system lacks.

.DEFAULT_GOAL := help
.NOTPARALLEL:
.PHONY: help demo test test-all bench pictures lint clean

# Passed on by demo and bench: make demo ARGS="--help"
ARGS ?=

help: ## list these targets
	@sed -n 's/^\([a-z-]*\):.*## /\1 /p' Makefile | awk '{ name = $$1; $$1 = ""; printf "  make %-9s%s\n", name, $$0 }'

demo: ## show the stadium in a window, or draw pictures of it where there is no display
	@.ci/setup demo
	@.venv/bin/tifo demo $(ARGS)

bench: ## measure the simulation and the drawing
	@.ci/setup demo
	@.venv/bin/tifo bench $(ARGS)

pictures: ## draw the pictures of docs/ that are made by code
	@.ci/setup demo
	@.venv/bin/python -m tifo.benchmarks.pictures

test: lint ## format, lint, types, and all tests but the slow ones
	@.ci/setup test
	@$(with_display) .venv/bin/python -m pytest -q -rs $(in_parallel) -m "not slow"

test-all: lint ## the same with the slow tests
	@.ci/setup test
	@$(with_display) .venv/bin/python -m pytest -q -rs $(in_parallel) -m "slow or not slow"

lint: ## format, lint and types only
	@.ci/setup lint
	@RUFF_OUTPUT_FORMAT=concise .venv/bin/python -m ruff format --check --quiet . || \
		{ echo 'to format them: .venv/bin/ruff format .' >&2; exit 1; }
	@RUFF_OUTPUT_FORMAT=concise .venv/bin/python -m ruff check --quiet .
	@.venv/bin/python -m mypy --no-error-summary

clean: ## remove .venv and everything else that was made here
	@rm -rf .venv .cache build dist out *.egg-info tests/golden/diffs
	@rm -rf .pytest_cache .mypy_cache .ruff_cache .hypothesis
	@find . -name .git -prune -o -type d -name __pycache__ -prune -exec rm -rf {} +

# A process for each processor; the tests of a file share one, and what they are slow to set up.
in_parallel = --numprocesses auto --maxprocesses 8 --dist loadfile

# Tests that open a window get a display of their own where there is none.
with_display = $$(test -n "$$DISPLAY" || \
	{ { command -v xauth && command -v xvfb-run; } >/dev/null && echo xvfb-run -a; })
