# Two commands do everything, from a bare Debian 12 on: `make render` and `make test`. Both are safe to repeat.

SCENE ?= scenes/gallery/oren_nayar_spheres.arsl
OUT ?= out
ARGS ?=

export PATH := $(PATH):$(HOME)/.cargo/bin
ARSC = $${CARGO_TARGET_DIR:-target}/release/arsc

.PHONY: help setup build render test check bench

help:
	@echo 'make render [SCENE=path] [OUT=folder] [ARGS="--samples 16"]   render a scene to PNG and spectral EXR'
	@echo 'make test                                                    run every test and count them'
	@echo 'make check                                                   formatting and lints'
	@echo 'make bench                                                   time the compiler and the gallery'

setup:
	@./.ci/setup

build: setup
	@cargo build --release --locked --package arsc

render: build
	@"$(ARSC)" render "$(SCENE)" -o "$(OUT)" $(ARGS)

test: setup
	@./.ci/test

check: setup
	@cargo fmt --all --check
	@cargo clippy --workspace --all-targets --quiet -- -D warnings

bench: build
	@./tests/bench/run "$(ARSC)"
