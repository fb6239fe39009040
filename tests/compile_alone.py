#!/usr/bin/python3
"""Check that every source of src/, partition/ and run/study/ compiles alone. The preset that the tests are built with joins
several sources into one, where a source may use what another one includes; a plain `cmake -S . -B build` does not. The
compiler looks at the sources without generating code, with the commands of the preset tidy, and ninja remembers which
ones it has seen with all that they include: a second call checks only what has changed."""
import argparse
import json
import pathlib
import shlex
import subprocess
import sys

TOP = pathlib.Path(__file__).resolve().parents[1]
FOLDERS = ("src", "partition", "run/study")


def escaped(text):
    """A word of a build line of ninja."""
    return "".join("$" + c if c in "$ :" else c for c in text)


def rule(entry):
    """The lines of ninja for one source, whose stamp is made when the compiler has accepted it."""
    words = shlex.split(entry["command"])
    target = words.index("-o")
    stamp = "alone/" + str(pathlib.Path(entry["file"]).relative_to(TOP))
    words[target:target + 2] = ["-fsyntax-only", "-MMD", "-MF", stamp + ".d", "-MT", stamp]
    command = " ".join(map(shlex.quote, words)).replace("$", "$$")
    return f"build {escaped(stamp)}: check {escaped(entry['file'])}\n  command_of = {command}\n  stamp = {stamp}\n"


def main(build, jobs):
    subprocess.run(["cmake", "-S", TOP, "-B", build, "--preset", "tidy"], check=True, stdout=subprocess.DEVNULL)
    entries = [entry for entry in json.loads((build / "compile_commands.json").read_text())
               if any(TOP / folder in pathlib.Path(entry["file"]).parents for folder in FOLDERS)]
    known = {entry["file"] for entry in entries}
    sources = {str(path) for folder in FOLDERS for path in (TOP / folder).rglob("*.cpp")
               if path.parent != TOP / "run/study/peers"}  # built apart, against the libraries of other engines
    if sources - known:
        sys.exit(f"no compile command for {', '.join(sorted(sources - known))}")
    print(f"== sources that compile alone: {len(known)} ==", flush=True)
    rules = {entry["file"]: rule(entry) for entry in entries}  # a source of two targets is checked once
    (build / "alone.ninja").write_text(
        "builddir = alone\nrule check\n  command = $command_of && touch $stamp\n  depfile = $stamp.d\n  deps = gcc\n"
        "  description = $in\n" + "".join(rules.values()))
    return subprocess.run(["ninja", "-C", build, "-f", "alone.ninja", "--quiet", "-k", "0", "-j", str(jobs)]).returncode


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--build", type=pathlib.Path, default=TOP / "build-tidy", help="folder of the preset tidy")
    parser.add_argument("--jobs", type=int, default=2)
    arguments = parser.parse_args()
    sys.exit(main(arguments.build.resolve(), arguments.jobs))
