#!/bin/bash
# etendue farm by a real Slurm: slurm_test.sh ETENDUE. What its nodes render, through every accident here, must
# be the picture of one render, bit for bit. KEEP=1 leaves its folder in /tmp.
set -u
export LC_ALL=C.UTF-8 PATH=$PATH:/usr/sbin:/sbin
here=$(dirname "$(realpath "$0")")
scene=$(realpath "$here/../../scenes/cornell-box/scene.toml")
etendue=$(realpath "$1")
folder=$(mktemp -d /tmp/etendue-farm-XXXXXX)
cd "$folder" || exit 1
# shellcheck source=tests/farm/slurm_cluster.sh
. "$here/slurm_cluster.sh"

checks=0
failures=0
pass() { checks=$((checks + 1)); }
miss() {
    checks=$((checks + 1)) failures=$((failures + 1))
    echo "FAILED: $1" >&2
}
check() {  # SENTENCE COMMAND …
    local sentence=$1
    shift
    if "$@"; then pass; else miss "$sentence"; fi
}
says() {  # SENTENCE FILE TEXT
    if grep -qF -- "$3" "$2"; then pass; else miss "$1: no \"$3\" in $2:"$'\n'"$(cat "$2")"; fi
}
fail() {  # nothing more can be tested
    miss "$1"
    exit 1
}
finish() {
    [ $failures = 0 ] || tail -n 40 "$folder"/slurm*.log "$folder"/*/logs/* >&2
    stopCluster
    echo "farm by Slurm: $checks checks, $failures failed, $SECONDS s"
    [ $failures = 0 ] || exit 1
}
trap finish EXIT
trap 'exit 1' INT TERM

# farm OUT OPTION …: submits, and waits for nothing; what it said is in OUT.said.
farm() {
    local out=$1
    shift
    "$etendue" farm slurm "$scene" -o "$out" --submit "$@" > "$out.said" 2>&1 ||
        fail "farm slurm $out: $(cat "$out.said")"
}
mergeId() { sed -n 's/^merge //p' "$1.said"; }
isOver() { [ -z "$(squeue --noheader --jobs="$1" 2>/dev/null)" ]; }
# merged OUT CODE: the merge ends with that exit code.
merged() {
    local id code
    id=$(mergeId "$1")
    waitFor 120 isOver "$id" || fail "$1: the merge does not end: $(squeue; sinfo)"
    code=$(scontrol show job "$id" | sed -n 's/.*ExitCode=\([0-9]*\):.*/\1/p')
    check "$1: the merge ends with $code, should with $2: $(cat "$1"/logs/merge-"$id".log)" [ "$code" = "$2" ]
}
samePicture() { "$etendue" compare "$1" "$2" --max-relmse 0 --max-mean-error 0 > same.said 2>&1; }

# A task's render, told by its part's name.
renderOf() {
    local entry
    for entry in /proc/[0-9]*; do
        [ "$(readlink "$entry/exe" 2>/dev/null)" = "$etendue" ] || continue
        tr '\0' '\n' < "$entry/cmdline" 2>/dev/null | grep -qxF -- "$1" && echo "${entry#/proc/}"
    done
}
# Holds a task's render once it has begun its part, and tells its process.
holdRender() {
    render=
    waitFor 60 begun "$1" || fail "$1 was not begun: $(squeue)"
    kill -STOP "$render"
}
begun() { [ -e "$1" ] && render=$(renderOf "$1") && [ -n "$render" ]; }
valueOf() { tr '\0' '\n' < "/proc/$1/environ" | sed -n "s/^$2=//p"; }
# Requeued jobs wait a while; not in a test.
startSoon() { scontrol update jobid="$1" starttime=now 2>/dev/null; }

startCluster

# 20 samples in tasks of 3, of which the last has 2; arrays of at most 5 (MaxArraySize). A hole, a damaged part
# and a complete set, merged again.
small=(--samples 20 --size 24,20 -s estimator.kind=bdpt --seed 7)
"$etendue" render "$scene" -o small.exr "${small[@]}" --quiet || fail "render"
short="ein kleines Büro %j"
plan=("${small[@]}" --task-samples 3)
farm "$short" "${plan[@]}"
says "all tasks are told" "$short.said" "7 tasks, of 3 samples each"
check "two arrays of at most five" [ "$(grep -c '^array ' "$short.said")" = 2 ]
merged "$short" 0
check "the array's picture is the render's" samePicture "$short/picture.exr" small.exr
check "every task has a log" [ "$(ls "$short/logs" | grep -vc merge)" = 7 ]

farm "$short" "${plan[@]}"
says "nothing is missing" "$short.said" "all 7 tasks are rendered: only the merge is left"
check "no array is submitted" [ "$(grep -c '^array ' "$short.said")" = 0 ]
merged "$short" 0

rm "$short"/parts/9-12.part*.exr "$short"/parts/18-20.part*.exr
farm "$short" "${plan[@]}"
says "what is missing is told" "$short.said" "2 of 7 tasks are missing or incomplete: 3,6"
merged "$short" 0
check "the filled picture is the render's" samePicture "$short/picture.exr" small.exr

# Bytes of a part are lost: the merge names the file, and the next run renders that task again.
printf 'lost' | dd of="$short/parts/6-9.part.exr" bs=1 seek=3000 conv=notrunc 2>/dev/null
damaged=$(sbatch --parsable "$short/merge.sbatch")
echo "merge $damaged" > "$short.said"
merged "$short" 65
says "the damaged part is named" "$short/logs/merge-$damaged.log" "$short/parts/6-9.part.exr"
farm "$short" "${plan[@]}"
says "the damaged part is missing" "$short.said" "1 of 7 tasks are missing or incomplete: 2"
merged "$short" 0
check "the mended picture is the render's" samePicture "$short/picture.exr" small.exr

# Four tasks of seconds, each with its own accident when it has begun its part.
large=(--samples 8000 --size 24,20 -s estimator.kind=bdpt --seed 8)
plan=("${large[@]}" --task-samples 2000 --checkpoint 0.2)
farm accidents "${plan[@]}"
"$etendue" render "$scene" -o large.exr "${large[@]}" --threads 1 --quiet &
reference=$!
array=$(sed -n 's/^array //p' accidents.said)
partOf() { echo "$folder/accidents/parts/$(($1 * 2000))-$(($1 * 2000 + 2000)).part.exr"; }

holdRender "$(partOf 0)"
killed=$render
holdRender "$(partOf 1)"
lost=$render
lostSince=$SECONDS
eightSecondsOn() { [ $((SECONDS - lostSince)) -ge 8 ]; }
check "two nodes render at once" [ "$(valueOf "$killed" SLURMD_NODENAME)" != "$(valueOf "$lost" SLURMD_NODENAME)" ]
"$etendue" farm slurm "$scene" -o accidents --submit "${plan[@]}" > again.said 2>&1
check "what is queued is not submitted again" [ $? = 1 ]
says "what is queued is named" again.said "${array}_0"

kill -9 "$killed"

holdRender "$(partOf 2)"
scontrol requeue "${array}_2"
kill -CONT "$render"

holdRender "$(partOf 3)"
# As Slurm does before the time limit.
scancel --signal=USR1 --batch "${array}_3"
kill -CONT "$render"

waitFor 10 eightSecondsOn
node=$(valueOf "$lost" SLURMD_NODENAME)
killNode "$node"
startNode "$node"

merge=$(mergeId accidents)
hurryUntilOver() {
    for task in 1 2 3; do startSoon "${array}_$task"; done
    sleep 0.9
    isOver "$merge"
}
waitFor 120 hurryUntilOver
merged accidents 75
check "the hole is named" grep -qE "^hole [0-9]+:2000$" "accidents/logs/merge-$merge.log"
check "a picture is there, hole or not" [ -s accidents/picture.exr ]
check "the killed task is not requeued by itself" [ "$(grep -c restarts: "accidents/logs/${array}_0.log")" = 1 ]
for task in 1 2 3; do
    log=accidents/logs/${array}_$task.log
    says "task $task was requeued" "$log" "restarts: 1"
    check "task $task went on where it was: $(cat "$log")" [ "$(grep -c "the render begins" "$log")" = 1 ]
done
says "the time limit requeues" "accidents/logs/${array}_3.log" "the time is up"
wait $reference || miss "the reference"

farm accidents "${plan[@]}"
says "the killed task alone is missing" accidents.said "1 of 4 tasks are missing or incomplete: 0"
merged accidents 0
check "the picture of accidents is the render's" samePicture accidents/picture.exr large.exr
