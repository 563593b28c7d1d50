#!/bin/sh
# Configures and builds one preset (default: release). Further arguments go to the configure step.
set -eu
cd "$(dirname "$0")/.."
preset=${1:-release}
[ $# -eq 0 ] || shift
cmake --preset "$preset" --log-level=WARNING "$@"
cmake --build --preset "$preset"
