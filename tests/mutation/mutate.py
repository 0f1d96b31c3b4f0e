#!/usr/bin/env python3
"""Asks of the tests: which change to the program would make one fail? Plants a few hundred small faults, one at a time,
in engine/, app/ and shaders/shared, runs the tests that execute the place, and lists the faults that none noticed.

  tests/mutation/mutate.py [--count 500] [--limit 60] [--only PATH] [--tests A,B] [--without TESTS] [--again]

All faults are compiled into one copy of the program (build/mutation), switched on by an environment variable. The
choice depends on the seed and the text of the lines alone. Results go to build/mutation/report.txt and results.json;
a run that was stopped goes on where it was. Exit code 1 when the share caught is under the --floor."""

import argparse
import fnmatch
import json
import sys
from pathlib import Path

import trial
import work_copy

EQUIVALENT = work_copy.HERE / "equivalent.txt"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--work", type=Path, default=work_copy.ROOT / "build" / "mutation")
    parser.add_argument("--seed", type=int, default=16)
    parser.add_argument("--count", type=int, default=500, help="mutants, a fifth of each kind")
    parser.add_argument("--limit", type=float, default=60, help="seconds of tests for a mutant")
    parser.add_argument("--jobs", type=int, default=2, help="compilers at a time")
    parser.add_argument("--only", default="*", help="mutants of these files, such as 'engine/camera/*'")
    parser.add_argument("--again", action="store_true", help="try the survivors of the last run again")
    parser.add_argument("--fresh", action="store_true", help="try all again, first with the tests that caught them")
    parser.add_argument("--tests", type=lambda names: names.split(","),
                        help="test programs, such as core,camera (default: all but window, which is slow)")
    parser.add_argument("--without", default="", help="slow tests to leave out, as in GoogleTest's filters: 'A.*:B.*'")
    parser.add_argument("--list", action="store_true", help="build, print the mutants and stop")
    parser.add_argument("--floor", type=float, default=0.9, help="share that must be caught")
    return parser.parse_args()


def equivalent_mutants():
    """The mutants of equivalent.txt, as describe() names them but for the line's number."""
    lines = EQUIVALENT.read_text().splitlines()
    return {line for line in lines if line and not line.startswith(("#", " "))}


def describe(site, line=None):
    mutated = site.mutated or "(dropped)"
    place = site.path if line == "" else f"{site.path}:{site.line}"
    return f"{place}: {site.original[:150]} => {mutated[:150]}"


def report(work, chosen, results, proofs):
    tried = [site for site in chosen if site.key in results]
    caught = [site for site in tried if results[site.key]["caught"]]
    alive = [site for site in tried if not results[site.key]["caught"]]
    equal = [site for site in alive if describe(site, '') in proofs]
    rest = [site for site in alive if site not in equal]
    share = len(caught) / max(1, len(tried) - len(equal))
    lines = [f"{describe(site)}   [{site.kind} {site.id}; {results[site.key]['run']} of "
             f"{results[site.key]['reached']} tests that reach it]" for site in rest]
    lines.append(f"{len(tried)} mutants: {len(caught)} caught, {len(equal)} equivalent, {len(rest)} survive; "
                 f"{100 * share:.1f} % of those not equivalent are caught")
    (work / "report.txt").write_text("\n".join(lines) + "\n")
    (work / "results.json").write_text(json.dumps(
        [{"mutant": describe(site), "kind": site.kind, "id": site.id, "key": site.key, "equivalent": site in equal,
          **results[site.key]} for site in tried], indent=1))
    return lines, share


def earlier_results(work):
    file = work / "results.json"
    return {entry["key"]: entry for entry in json.loads(file.read_text())} if file.exists() else {}


def tests_of(work, wanted, without):
    programs = [name for name in work_copy.programs_of(work, wanted) if name != "astrosplat"]
    return [test for name in programs for test in trial.measured(work, name, without)]


def main():
    options = arguments()
    work = options.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    chosen = work_copy.build(work, options.seed, options.count, options.tests, options.jobs)
    if options.list:
        print("\n".join(describe(site) for site in chosen))
        return 0
    earlier = earlier_results(work)
    results = {} if options.fresh else earlier
    tests = tests_of(work, options.tests, options.without)
    # In an order that has nothing to do with the files: a run that is stopped has tried a fair sample.
    for number, site in enumerate(sorted(chosen, key=lambda site: site.key), 1):
        known = results.get(site.key)
        if not fnmatch.fnmatch(site.path, options.only) or known and (known["caught"] or not options.again):
            continue
        before = earlier.get(site.key, {"caught": ""})
        results[site.key] = trial.trial(work, site, tests, options.limit, before["caught"], wide=options.again)
        print(f"{number}/{len(chosen)} {describe(site)}: {results[site.key]['caught'] or 'SURVIVES'}", flush=True)
        report(work, chosen, results, equivalent_mutants())
    lines, share = report(work, chosen, results, equivalent_mutants())
    print("\n".join(lines))
    return 0 if share >= options.floor else 1


if __name__ == "__main__":
    sys.exit(main())
