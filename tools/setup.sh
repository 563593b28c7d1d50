#!/bin/sh
# Installs what is missing of the Debian packages that Étendue needs, and nothing else.
#   tools/setup.sh          to build and render
#   tools/setup.sh --test   and to run the tests
#   tools/setup.sh --ci     and the checks of .ci/run
set -eu

# The one list of packages.
packages="g++ cmake ninja-build
    libembree-dev libopenimageio-dev libeigen3-dev libtinyobjloader-dev libtbb-dev
    libtomlplusplus-dev nlohmann-json3-dev libcli11-dev libfmt-dev libxxhash-dev libboost-dev
    node-d3-scale node-d3-shape node-d3-selection"
test_packages="doctest-dev assimp-testmodels glmark2-data glslang-tools chromium nodejs npm python3
    slurmctld slurmd slurm-client slurm-wlm-basic-plugins"
ci_packages="clang libclang-rt-dev llvm clang-format clang-tidy"

case "${1:-}" in
    "") ;;
    --test) packages="$packages $test_packages" ;;
    --ci) packages="$packages $test_packages $ci_packages" ;;
    *) echo "usage: tools/setup.sh [--test | --ci]" >&2; exit 64 ;;
esac

missing=""
for package in $packages; do
    # Node that is there already, from wherever, stays: Debian's npm would throw it out.
    case "$package" in
        nodejs) ! command -v node >/dev/null || continue ;;
        npm) ! command -v npm >/dev/null || continue ;;
    esac
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

sudo=""
[ "$(id -u)" = 0 ] || sudo=sudo
echo "setup: installing$missing"
$sudo apt-get update -qq
# shellcheck disable=SC2086
DEBIAN_FRONTEND=noninteractive $sudo apt-get install -y -qq --no-install-recommends $missing >/dev/null
echo "setup: done"
