#!/bin/sh
# Measures docs/speed-accuracy.md anew: three suites, half an hour on two quiet cores, and its tables. Interrupted, it
# goes on where it stopped; out/speed-accuracy removed, it begins anew.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh
tools/build.sh release -DBUILD_TESTING=OFF
cmake --build --preset release --target speed_accuracy >/dev/null
out=out/speed-accuracy
mkdir -p $out
for suite in lens-terms lenses estimators; do
    build/release/tools/etendue bench scenes/suites/$suite.toml -o $out/$suite
done
build/release/bench/speed_accuracy docs/speed-accuracy.md $out/lens-terms $out/lenses $out/estimators
echo "docs/speed-accuracy.md has the tables, $out/*/report.html the reports"
