#!/usr/bin/env python3
"""Whether the tests find defects: seeds those of tests/mutations/defects.toml one at a time.

    tools/mutate.py               all of them
    tools/mutate.py cosine splat  those whose names have one of the words
    tools/mutate.py --list        names alone
    tools/mutate.py --check       whether each still applies to the sources; builds nothing

Works in a copy of the sources, in build/mutate. Each defect is built, then held against
`etendue bench regress`, then against further tests until one fails. Exit 1 if one survives or no
longer applies, 2 if the sources fail without any, or do not build with one. docs/regression.md.
"""
import json
import os
import shlex
import shutil
import subprocess
import sys
import time
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WORK = ROOT / "build" / "mutate"
SOURCE, BUILD = WORK / "source", WORK / "build"


def output(*command):
    return subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True).stdout


def copy_sources():
    """Of all files that git knows or would; those that are the same keep their time."""
    names = set(output("git", "ls-files", "--cached", "--others", "--exclude-standard").split("\n"))
    names = {n for n in names if n and (ROOT / n).is_file()}
    for name in names:
        old, new = SOURCE / name, ROOT / name
        if old.exists() and old.read_bytes() == new.read_bytes():
            continue
        old.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(new, old)
        old.chmod(new.stat().st_mode)
    for old in [p for p in SOURCE.rglob("*") if p.is_file()]:
        if str(old.relative_to(SOURCE)) not in names:
            old.unlink()


def build(target):
    if not (BUILD / "build.ninja").exists():
        command = ["cmake", "-S", SOURCE, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
    done = subprocess.run(["ninja", "-C", BUILD, target], capture_output=True, text=True)
    if done.returncode != 0:
        print(done.stdout[-3000:], file=sys.stderr)
        sys.exit(f"tools/mutate.py: {target} does not build")


def complaints(result):
    """Of a run of bench regress: which cells fail, and by what."""
    found = [f"{c['scene']}, {c['camera']}, {c['estimator']}: {c['outcome']}"
             for c in result["cells"] if c["outcome"] != "pass"]
    found += [f"{p['scene']}, {p['camera']}: {p['estimator']} differs from {p['against']}"
              for p in result["pairs"] if p["bias"]["verdict"] == "BIASED"]
    return found


def regress(arguments):
    build("etendue")
    command = [BUILD / "tools" / "etendue", "bench", "regress", *shlex.split(arguments), "--json"]
    done = subprocess.run(command, cwd=SOURCE, capture_output=True, text=True)
    if done.returncode in (0, 1) and done.stdout:
        found = complaints(json.loads(done.stdout))
        if bool(found) == bool(done.returncode):
            return found
    # A defect that ends the program in its midst is found, too.
    return [f"exit {done.returncode}: {done.stderr.strip()[-200:]}"]


def run_test(line):
    program, *arguments = shlex.split(line)
    build(program)
    command = [BUILD / "tests" / program, *arguments]
    done = subprocess.run(command, cwd=SOURCE, capture_output=True, text=True)
    return [f"{program} {' '.join(arguments)}"] if done.returncode != 0 else []


def find_by(defect):
    found = regress(defect["regress"])
    if found:
        return found
    for line in defect.get("tests", []):
        found = run_test(line)
        if found:
            return found
    return []


def mutated(defect, folder):
    """The file's text with the defect; none if its place is not there, or not just once."""
    file = folder / defect["file"]
    text = file.read_text() if file.exists() else ""
    if text.count(defect["find"]) != 1:
        return None
    return text.replace(defect["find"], defect["replace"])


def main():
    words = [a for a in sys.argv[1:] if not a.startswith("--")]
    options = set(sys.argv[1:]) - set(words)
    with open(ROOT / "tests" / "mutations" / "defects.toml", "rb") as file:
        defects = tomllib.load(file)["defect"]
    defects = [d for d in defects if not words or any(w in d["name"] for w in words)]
    if not defects or options - {"--list", "--check", "--help"}:
        sys.exit(__doc__)
    if "--help" in options:
        print(__doc__)
        return 0
    if "--list" in options:
        print("\n".join(d["name"] for d in defects))
        return 0
    lost = [d for d in defects if mutated(d, ROOT) is None]
    for d in lost:
        print(f"does not apply: {d['name']}: {d['file']} has its text not just once")
    if lost or "--check" in options:
        return 1 if lost else 0

    copy_sources()
    for arguments in sorted({d["regress"] for d in defects}):
        found = regress(arguments)
        if found:
            print(f"without any defect bench regress {arguments} fails: {'; '.join(found)}")
            return 2
    survivors = 0
    for d in defects:
        start = time.monotonic()
        file = SOURCE / d["file"]
        text = file.read_text()
        try:
            file.write_text(mutated(d, SOURCE))
            found = find_by(d)
        finally:
            file.write_text(text)
        survivors += not found
        seconds = time.monotonic() - start
        print(f"| {d['name']} | {'; '.join(found[:3]) or 'SURVIVES'} "
              f"{f'and {len(found) - 3} more ' if len(found) > 3 else ''}| {seconds:.0f} s |",
              flush=True)
    print(f"{len(defects) - survivors} of {len(defects)} defects found")
    return 1 if survivors else 0


if __name__ == "__main__":
    os.environ.setdefault("LC_ALL", "C.UTF-8")
    sys.exit(main())
