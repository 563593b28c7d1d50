#!/bin/sh
# Feeds each format that the renderer reads with what chance makes of its corpus (docs/fuzzing.md).
#   tools/fuzz.sh SECONDS [TARGET…]    for so long each; default: every target of tests/fuzz
# Prints a line for each target. Ends with 1 after a finding, whose input it leaves in out/fuzz/.
set -eu
cd "$(dirname "$0")/.."
usage() { echo "usage: tools/fuzz.sh SECONDS [TARGET...]" >&2; exit 64; }
[ $# -gt 0 ] || usage
seconds=$1
shift
case "$seconds" in "" | *[!0-9]*) usage ;; esac
known=$(cd tests/fuzz && ls fuzz_*.cpp | sed 's/fuzz_\(.*\)\.cpp/\1/')
[ $# -gt 0 ] || set -- $known
for target; do
    [ -f "tests/fuzz/fuzz_$target.cpp" ] || { echo "fuzz: no target $target among" $known >&2; exit 64; }
done

tools/setup.sh --ci
cmake --preset fuzz --log-level=WARNING >/dev/null
cmake --build --preset fuzz

# The targets' own files, in memory where there is some.
parent=/tmp
[ ! -w /dev/shm ] || parent=/dev/shm
TMPDIR=$(mktemp -d "$parent/etendue-fuzz-XXXXXX")
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT
trap 'exit 75' INT TERM

# Of the program: seconds an input, and megabytes at once and in all. A C++ exception that leaves a
# target, too, is a finding.
limits="-timeout=10 -rss_limit_mb=2048"
result=0
printf '%-8s %12s %10s %9s  %s\n' target executions coverage findings seconds
for target; do
    out=out/fuzz/$target
    mkdir -p "$out/corpus" "$out/findings"
    dictionary=tests/fuzz/$target.dict
    [ ! -f "$dictionary" ] || dictionary="-dict=$dictionary"
    begin=$(date +%s)
    status=0
    # shellcheck disable=SC2086
    build/fuzz/tests/fuzz/fuzz_"$target" $limits -max_total_time="$seconds" -print_final_stats=1 \
        "$dictionary" -artifact_prefix="$out/findings/" \
        "$out/corpus" "tests/fuzz/corpus/$target" >"$out/log" 2>&1 || status=$?
    executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$out/log")
    coverage=$(sed -n 's/.* cov: \([0-9]*\) .*/\1/p' "$out/log" | tail -1)
    findings=$(find "$out/findings" -type f | wc -l)
    printf '%-8s %12s %10s %9s  %s\n' "$target" "${executions:--}" "${coverage:--}" "$findings" \
        $(($(date +%s) - begin))
    [ "$status" -ne 0 ] || [ "$findings" -ne 0 ] || continue
    result=1
    grep -E 'FINDING|SUMMARY|runtime error|terminate called|Test unit written' "$out/log" >&2 || tail -20 "$out/log" >&2
done
exit $result
