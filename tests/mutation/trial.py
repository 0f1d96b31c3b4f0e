"""Runs the tests against mutants. In: the built work copy and its sites. Out: for each mutant which tests reach it and
which test, if any, fails because of it. The quick tests that reach few mutants come first; the first failure ends the
trial; a test that hangs has failed too. A failure counts only if the same test then passes without the mutant."""

import collections
import functools
import json
import os
import resource
import subprocess
from dataclasses import dataclass
from pathlib import Path

import work_copy

REACHED_BYTES = 1 << 16
catches = collections.Counter()  # mutants caught by each test, in this run
STEPS_S = (0.5, 3.0, 10.0)  # after this much time of tests the next, slower ones begin, in another child


@dataclass
class Test:
    program: str
    name: str
    seconds: float
    reached: set
    at_start: set  # reached by the program before any test


def environment(work, **more):
    """No display, no network settings, and folders of its own, so that a mutant can spoil nothing."""
    kept = {name: value for name, value in os.environ.items()
            if not name.startswith(("ASTROSPLAT_", "GTEST_", "XDG_")) and name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    home = work / "home"
    (home / "tmp").mkdir(parents=True, exist_ok=True)
    kept.update(HOME=str(home), TMPDIR=str(home / "tmp"), ASTROSPLAT_CACHE=str(home / "cache"))
    kept.update({name: str(value) for name, value in more.items()})
    return kept


def limit_process():
    os.nice(10)
    os.setpgrp()  # not a session of its own: a group of processes has one priority
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
    resource.setrlimit(resource.RLIMIT_FSIZE, (4 << 30, 4 << 30))
    resource.setrlimit(resource.RLIMIT_AS, (24 << 30, 24 << 30))


class TestProgram:
    """A test program that is loaded once and runs each trial in a child of its own. Mutants that take effect while a
    program is loaded (constants at namespace level) need one that is loaded with them."""

    def __init__(self, work, program, mutant=-1):
        self.log = work / "test.log"
        executable = work_copy.programs_of(work, [program[5:]])[program]
        self.process = subprocess.Popen(
            [executable, "--gtest_color=no"], cwd=work / "build" / "tests", stdin=subprocess.PIPE,
            stdout=subprocess.PIPE, preexec_fn=limit_process, text=True,
            env=environment(work, GTEST_FAIL_FAST=1, ASTROSPLAT_MUTANT=mutant))

    def run(self, mutant, names, seconds):
        """The exit code of these tests up to the first failure, negative for a signal (-9: took far too long)."""
        self.log.write_text("")
        try:
            self.process.stdin.write(f"{mutant} {30 + 15 * seconds} {self.log} {':'.join(names)}\n")
            self.process.stdin.flush()
        except BrokenPipeError:
            return -6
        return int(self.process.stdout.readline() or -6)  # -6: it did not even start

    def close(self):
        self.process.kill()
        self.process.wait()


@functools.cache
def loaded(work, program):
    return TestProgram(work, program)


def run_tests(work, program, mutant, tests, at_start):
    """Exit code of the tests with the mutant on."""
    names, seconds = [test.name for test in tests], sum(test.seconds for test in tests)
    if not at_start:
        return loaded(work, program).run(mutant, names, seconds)
    own = TestProgram(work, program, mutant)
    code = own.run(mutant, names, seconds)
    own.close()
    return code


def culprit(output, tests):
    """The test that failed or was running at the end. After a failure the rest are named too, as skipped."""
    last = tests[0].name
    for line in output.splitlines():
        if line.startswith("[  FAILED  ] "):
            break
        if line.startswith("[ RUN      ] "):
            last = line[13:].strip()
    return next((test for test in tests if test.name == last), tests[0])


def measured(work, program, without):
    """Runs a test program without a mutant; returns the tests that pass, with what they reach. Measured once for
    each state of the program. `without`: tests to leave out."""
    executables = work_copy.programs_of(work, [program[5:]])
    kept = work / "reach" / f"{program}.json"
    newest = max(path.stat().st_mtime for path in executables.values())
    if not kept.exists() or kept.stat().st_mtime < newest:
        reached, notes = work / "reached.bin", work / "tests.jsonl"
        reached.write_bytes(bytes(REACHED_BYTES))
        notes.write_text("")
        variables = environment(work, ASTROSPLAT_MUTANT_REACHED=reached, ASTROSPLAT_MUTANT_TESTS=notes,
                                GTEST_FILTER=f"-{without}")
        subprocess.run([executables[program]], cwd=work / "build" / "tests", env=variables,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                       preexec_fn=limit_process)
        kept.parent.mkdir(exist_ok=True)
        notes.replace(kept)
    tests, at_start = [], set()
    for note in map(json.loads, kept.read_text().splitlines()):
        if note["state"] == "started":
            at_start = set(note["reached"])
        elif note["state"] == "passed":
            tests.append(Test(program, note["test"], note["seconds"], set(note["reached"]), at_start))
        elif note["state"] == "failed":
            print(f"{program} {note['test']} fails without a mutant: left out", flush=True)
    print(f"{program}: {len(tests)} tests", flush=True)
    return tests


def steps(tests, limit_s, known):
    """(program, tests) in the order to run: the one that is known to catch it, then quick ones that reach few
    mutants and caught others."""
    def cost(test):
        if f"{test.program} {test.name}" == known:
            return -1.0
        return (test.seconds + 0.02) * (len(test.reached) + 5) / (1 + catches[test.name]) ** 2

    ordered = sorted(tests, key=cost)
    groups, spent = collections.OrderedDict(), 0.0
    for test in ordered:
        if spent + test.seconds > limit_s:
            continue
        spent += test.seconds
        groups.setdefault((sum(spent > step for step in STEPS_S), test.program), []).append(test)
    return [(program, group) for (_, program), group in sorted(groups.items(), key=lambda item: item[0][0])]


def trial(work, site, tests, limit_s, known="", wide=False):
    """{"caught": name of the test or "", "reached": how many tests execute the place, "run": how many were run}.
    `known`: what caught it in an earlier run. `wide`: then the other tests of these programs are run too, because what
    a process makes only once is executed by the first test alone that needs it."""
    reaching = [test for test in tests if site.id in test.reached]
    result = {"caught": "", "reached": len(reaching), "run": 0}
    order = steps(reaching, limit_s, known.removesuffix(" (hangs)"))
    if wide:
        programs = {test.program for test in reaching}
        order += steps([t for t in tests if t.program in programs and site.id not in t.reached], limit_s, known)
    for program, group in order:
        at_start = site.id in group[0].at_start
        code = run_tests(work, program, site.id, group, at_start)
        result["run"] += len(group)
        if code == 0:
            continue
        failed = culprit((work / "test.log").read_text(errors="replace"), group)
        if run_tests(work, program, -1, [failed], False) == 0:
            catches[failed.name] += 1
            return {**result, "caught": f"{program} {failed.name}" + (" (hangs)" if code == -9 else "")}
    return result
