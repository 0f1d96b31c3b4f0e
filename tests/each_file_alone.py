#!/usr/bin/env python3
"""Checks that every source file compiles by itself, which a unity build does not show: includes of its own, no name of
another file shadowed. In: a build folder configured without unity (preset dev). Generated files are left out where
they do not exist yet. Nothing is written."""
import json
import os
import shlex
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor


def check(entry):
    words = shlex.split(entry["command"])
    if words[0].endswith("ccache"):
        words = words[1:]
    output = words.index("-o")
    del words[output:output + 2]
    result = subprocess.run(words + ["-fsyntax-only", "-Wshadow", "-Werror"], cwd=entry["directory"],
                            capture_output=True, text=True)
    return entry["file"], result.returncode, result.stderr


with open(os.path.join(sys.argv[1], "compile_commands.json")) as file:
    entries = [entry for entry in json.load(file) if entry["file"].endswith(".cpp") and os.path.exists(entry["file"])]
with ThreadPoolExecutor(os.cpu_count()) as pool:
    failed = [(file, errors) for file, code, errors in pool.map(check, entries) if code]
for file, errors in failed:
    print(f"{file}\n{errors}", file=sys.stderr)
print(f"{len(entries) - len(failed)} of {len(entries)} files compile alone")
sys.exit(1 if failed or not entries else 0)
