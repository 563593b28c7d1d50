#!/bin/sh
# Sets up, builds and renders the demo scene to out/demo.exr and out/demo.png.
set -eu
cd "$(dirname "$0")/.."
tools/setup.sh
tools/build.sh release -DBUILD_TESTING=OFF
mkdir -p out
build/release/tools/etendue render scenes/still-life/scene.toml --camera scenes/still-life/double-gauss.toml \
    -o out/demo.exr --preview out/demo.png "$@"
echo "The picture is in out/demo.exr and out/demo.png"
