#!/bin/sh
# Sets up, builds and runs all tests. Arguments go to ctest (-L fast: only the fast ones).
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh --test
tools/build.sh release -DBUILD_TESTING=ON
ctest --test-dir build/release --output-on-failure --parallel "$(nproc)" "$@"
