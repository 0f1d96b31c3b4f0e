"""A copy of the repository in which a few hundred places are switchable, and its build. In: the repository, the seed,
how many. Out: the sites that compile; the ones that do not (constants of the language, template arguments) are left
as they were, and the next in the order of the seed take their place."""

import functools
import hashlib
import re
import shutil
import subprocess
import sys
from pathlib import Path

import sites

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FOLDERS = ("engine/", "app/", "shaders/shared/")


def tracked_files():
    command = ["git", "ls-files", "-co", "--exclude-standard"]
    listing = subprocess.run(command, cwd=ROOT, check=True, capture_output=True, text=True)
    return [path for path in listing.stdout.splitlines() if (ROOT / path).is_file()]


def mutated_files():
    return [path for path in tracked_files()
            if path.startswith(FOLDERS) and path.endswith((".h", ".cpp", ".glsl"))]


def choose(texts, seed, count, refused):
    """`count` sites, as many of each kind, in the order of their hashes with the seed; at most one a line, so that a
    compiler's message names it. The order does not depend on changes to other lines."""
    ranked = []
    for path, text in texts.items():
        for site in sites.sites_of(path, text):
            ranked.append((hashlib.sha256(f"{seed}|{site.key}".encode()).hexdigest(), site))
    ranked.sort(key=lambda entry: entry[0])
    chosen, lines, ids = [], set(), set()
    for kind in sites.KINDS:
        left = count * (sites.KINDS.index(kind) + 1) // len(sites.KINDS) - len(chosen)
        for _, site in (entry for entry in ranked if entry[1].kind == kind):
            site.id = int(site.key[:4], 16)
            if left == 0:
                break
            if site.key in refused or (site.path, site.line) in lines or site.id in ids:
                continue
            lines.add((site.path, site.line))
            ids.add(site.id)
            chosen.append(site)
            left -= 1
    return sorted(chosen, key=lambda site: (site.path, site.begin))


def write_if_changed(path, content):
    if not path.exists() or path.read_bytes() != content:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content)


def embedded_shaders_with_mutants(text):
    """The preview's shaders take the same mutant: the macro in their text becomes true or false when it is read."""
    text = text.replace('"std::string shader_text(const', '"static std::string unmutated_shader_text(const')
    ending = ('std::string astrosplat_mutated_shader(std::string text);\\n'
              'std::string shader_text(const std::string& name) {\\n'
              '    return astrosplat_mutated_shader(unmutated_shader_text(name));\\n}\\n\\n')
    before = '\\n}\\n\\n}  // namespace astrosplat'
    return text.replace(before, '\\n}\\n\\n' + ending + '}  // namespace astrosplat')


def write_copy(work, texts, chosen):
    """Copies what git knows, with the chosen sites rewritten; unchanged files keep their time, so little is rebuilt."""
    source, written = work / "source", set()
    for path in tracked_files():
        content = (ROOT / path).read_bytes()
        if path in texts:
            here = [site for site in chosen if site.path == path]
            content = sites.apply_sites(texts[path], here).encode() if here else content
        elif path == "app/gl/embed_shaders.cmake":
            content = embedded_shaders_with_mutants(content.decode()).encode()
        elif path == "tests/support/main.cpp":
            content = b"int astrosplat_run_tests();\n" + content.replace(b"RUN_ALL_TESTS", b"astrosplat_run_tests")
        elif path == "tests/CMakeLists.txt":
            content += b"\ninclude(mutation/hooks.cmake)\n"
        write_if_changed(source / path, content)
        written.add(source / path)
    runtime = source / "engine/core/mutant.cpp"
    write_if_changed(runtime, (HERE / "mutant.cpp").read_bytes())
    for file in source.rglob("*"):
        if file.is_file() and file not in written and file != runtime:
            file.unlink()


def configure(work):
    """Optimised a little, to be built soon. Reading past the end of a container is fatal, as under a sanitizer."""
    own = work / "source" / "tests" / "mutation"
    checks = "-Werror=vla -O1 -g0 -DNDEBUG -D_GLIBCXX_ASSERTIONS"
    flags = f"-include {own / 'mutant.h'} -I{own} {checks}"
    subprocess.run(["cmake", "-S", work / "source", "-B", work / "build", "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                    f"-DCMAKE_CXX_FLAGS_RELEASE={flags}", "-DCMAKE_UNITY_BUILD=ON", "-DASTROSPLAT_TESTS=ON",
                    "-DCMAKE_CXX_COMPILER_LAUNCHER="], check=True, stdout=subprocess.DEVNULL)


@functools.cache
def executables_of(build):
    listing = subprocess.run(["ninja", "-C", build, "-t", "targets", "all"], check=True, capture_output=True, text=True)
    return re.findall(r"^(\S+): CXX_EXECUTABLE_LINKER", listing.stdout, re.MULTILINE)


def programs_of(work, wanted):
    """The test programs of the copy whose names after test_ are wanted (all of them: None; but the one that reads the
    source's structure, and that of the window unless it is named), and the program itself where they start it."""
    executables = {Path(path).name: work / "build" / path for path in executables_of(work / "build")}
    tests = {name[5:] for name in executables if name.startswith("test_")} - {"structure"}
    tests = tests - {"window"} if wanted is None else tests & set(wanted)
    names = [f"test_{test}" for test in sorted(tests)] + ["astrosplat"] * bool(tests & {"cli", "window"})
    return {name: executables[name] for name in names}


def compile_all(work, wanted, jobs):
    """Builds on, whatever fails; returns the output of the compiler, empty when all is built."""
    targets = [str(path.relative_to(work / "build")) for path in programs_of(work, wanted).values()]
    result = subprocess.run(["nice", "-n", "10", "ninja", "-C", work / "build", "-k", "0", f"-j{jobs}", *targets],
                            capture_output=True, text=True)
    (work / "build.log").write_text(result.stdout + result.stderr)
    return "" if result.returncode == 0 else result.stdout


def blamed(output, chosen):
    """Keys of the sites on lines that the compiler's errors, or the notes that belong to them, speak of."""
    named, in_error = set(), False
    for line in output.splitlines():
        match = re.search(r"source/((?:engine|app|shaders)/[^:\s]+):(\d+)", line)
        if re.search(r"\b(fatal )?error: ", line):
            in_error = True
        elif re.search(r"\bwarning: ", line):
            in_error = False
        if match and (in_error or "required from" in line or "In instantiation" in line or "In function" in line):
            named.add((match.group(1), int(match.group(2))))
    return {site.key for site in chosen if (site.path, site.line) in named}


def build(work, seed, count, wanted, jobs):
    """Builds the copy; returns the chosen sites, all of which compile."""
    texts = {path: (ROOT / path).read_text() for path in mutated_files()}
    refused_list = work / "refused.txt"
    refused = set(refused_list.read_text().split()) if refused_list.exists() else set()
    while True:
        chosen = choose(texts, seed, count, refused)
        write_copy(work, texts, chosen)
        configure(work)
        print(f"building {len(chosen)} mutants, {len(refused)} refused so far", flush=True)
        output = compile_all(work, wanted, jobs)
        if not output:
            return chosen
        worse = blamed(output, chosen)
        if not worse:
            sys.exit(f"the copy does not build, and not for a mutant: see {work / 'build.log'}")
        refused |= worse
        refused_list.parent.mkdir(parents=True, exist_ok=True)
        refused_list.write_text("\n".join(sorted(refused)) + "\n")
