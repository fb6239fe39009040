#!/usr/bin/python3
"""Check what the documents print: documents.py BUILD_FOLDER [--only PART_OF_A_PATH] [--times]

Links: every relative link, anchor and picture of every Markdown page of the repository exists.

Commands and scenes: README.md and the pages under run/ are followed from top to bottom, each in a temporary folder that
holds a copy of run/ and the build folder. A comment before a block of code says what the block is:

    <!-- file: NAME -->             the block is saved as NAME; a later command of the page uses it
    <!-- fragment of SCENE -->      the toml block is added to SCENE, tables are merged, entries of [[...]] follow those of
                                    SCENE, and `gcpdda inspect` checks the result
    <!-- too long for a test -->    the commands of the sh block are not run: `inspect` checks the scene of run, fos and
                                    ensemble, and other programs only parse their options
    <!-- too large for a test -->   the same for scenes whose blocks take long to cut: all programs only parse their options

A toml block without such a comment is a failure. Indented blocks are sh blocks. A command of a sh block is run where it
begins with a program of RUN; a script of the repository must exist; other commands (sbatch, srun) are not run. A command
ends with exit code 0, or with N where `# exit code N` follows it. The lines of a text block are printed, in this order, by
the sh block before it; `...` stands for any text.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
import urllib.parse

SOURCE = pathlib.Path(__file__).resolve().parents[2]
RUN = re.compile(r"(build/gcpdda|mpirun|python3|cp|cat|head|tail|grep|cut|run/\w+\.py)$")
SCRIPT = re.compile(r"(run|tests)/[\w./]+$")
LARGEST_PICTURE = 150_000  # bytes, of the users' guide
PICTURES = SOURCE / "run" / "pictures"
PATIENCE = 600  # s for one command: far more than a slow machine needs


def documents():
    """All Markdown pages but those of result folders, and templates in run/study, whose links are those of their copies."""
    pages = sorted(SOURCE.glob("*.md"))
    for folder in ("include", "partition", "run", "src", "tests"):
        pages += sorted((SOURCE / folder).rglob("*.md"))
    results, templates = SOURCE / "run" / "results", SOURCE / "run" / "study"
    return [page for page in pages if templates not in page.parents
            and (results not in page.parents or results / "studies" in page.parents)]


def prose(text):
    """The page without fenced blocks and code spans, line by line as before."""
    text = re.sub(r"^```.*?^```$", lambda block: "\n" * block[0].count("\n"), text, flags=re.M | re.S)
    return re.sub(r"`[^`\n]*`", "``", text)


def anchors(page):
    """Anchors of the headings of a page, as the usual Markdown viewers name them."""
    text = re.sub(r"^```.*?^```$", "", page.read_text(), flags=re.M | re.S)
    names = []
    for heading in re.findall(r"^#{1,6}\s+(.*?)\s*$", text, flags=re.M):
        heading = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").lower()
        name = re.sub(r"[^\w\- ]", "", heading).replace(" ", "-")
        names.append(f"{name}-{names.count(name)}" if name in names else name)
    return names


def wrong_links(page):
    """What is wrong with the links and pictures of a page: lines for the reader."""
    wrong = []
    guide = page.parent == SOURCE / "run" / "guide"
    for number, line in enumerate(prose(page.read_text()).splitlines(), 1):
        for picture, target in re.findall(r"(!?)\[[^\]]*\]\(([^)\s]+)\)", line):
            if re.match(r"[a-z]+:", target):
                continue
            path, _, anchor = urllib.parse.unquote(target).partition("#")
            file = (page.parent / path).resolve() if path else page
            place = f"{page.relative_to(SOURCE)}:{number}"
            if not file.exists():
                wrong.append(f"{place}: {target} does not exist")
            elif anchor and anchor not in anchors(file):
                wrong.append(f"{place}: {target}: the page has no heading for this anchor, but {', '.join(anchors(file))}")
            elif picture and guide and file.stat().st_size > LARGEST_PICTURE:
                wrong.append(f"{place}: {target} has {file.stat().st_size} bytes; pictures of the guide have at most "
                             f"{LARGEST_PICTURE}: draw it with a smaller --dpi")
    return wrong


class Block:
    """A fenced block of a page with the comment before it, or an indented one, which is a sh block."""

    def __init__(self, kind, comment, line):
        self.kind, self.comment, self.line, self.text = kind, comment, line, ""


def code_blocks(page):
    blocks, fenced, indented, comment, before = [], False, False, "", ""
    for number, line in enumerate(page.read_text().splitlines(), 1):
        is_code = line.startswith("    ") and (indented or not before.strip())
        if not fenced and is_code and not indented:
            blocks.append(Block("sh", comment, number))
        indented = not fenced and is_code
        if fenced and line.strip() == "```":
            fenced, comment = False, ""
        elif fenced or indented:
            blocks[-1].text += line + "\n"
        elif line.strip().startswith("```"):
            blocks.append(Block(line.strip()[3:], comment, number + 1))
            fenced = True
        elif line.strip():
            match = re.fullmatch(r"<!--\s*(.*?)\s*-->", line.strip())
            comment = match[1] if match else ""
        before = line
    return blocks


def merged(scene, fragment):
    """A scene with the tables of a fragment."""
    result = dict(scene)
    for key, value in fragment.items():
        if isinstance(value, dict) and isinstance(result.get(key), dict):
            result[key] = merged(result[key], value)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            result[key] = result.get(key, []) + value
        else:
            result[key] = value
    return result


def as_toml(value):
    if isinstance(value, dict):
        return "{" + ", ".join(f"{as_toml(key)} = {as_toml(entry)}" for key, entry in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(as_toml, value)) + "]"
    if isinstance(value, bool):
        return "true" if value else "false"
    return '"' + value + '"' if isinstance(value, str) else repr(value)


class Page:
    """A page that is followed from top to bottom."""

    def __init__(self, path, build, draws):
        self.path, self.build, self.draws = path, build, draws
        self.failures = []
        self.printed = ""  # by the last sh block
        self.unused = {}  # files of the page that no command has named, with their lines

    def fail(self, line, text):
        self.failures.append(f"{self.path.relative_to(SOURCE)}:{line}: {text}")

    def follow(self):
        begin = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="gcpdda_documents_") as folder:
            self.folder = pathlib.Path(folder)
            (self.folder / "build").symlink_to(self.build)
            shutil.copytree(SOURCE / "run", self.folder / "run",
                            ignore=shutil.ignore_patterns("results", "pictures", "study", "*.md"))
            for block in code_blocks(self.path):
                self.check(block)
            shown = re.findall(r"\(\S*pictures/(\S+\.png)\)", self.path.read_text()) if self.draws else []
            for picture in filter(pathlib.Path.exists, [self.folder / name for name in shown]):
                shutil.copy(picture, PICTURES)
            for name, line in self.unused.items():
                self.fail(line, f"no command of the page after it names {name}")
        self.seconds = time.monotonic() - begin
        return self

    def check(self, block):
        name = re.fullmatch(r"file: (\S+)", block.comment)
        base = re.fullmatch(r"fragment of (\S+)", block.comment)
        if name:
            (self.folder / name[1]).write_text(block.text)
            self.unused[name[1]] = block.line
        elif block.kind == "toml" and base:
            self.check_fragment(block, base[1])
        elif block.kind == "toml":
            self.fail(block.line, "the comment before a toml block must be <!-- file: NAME --> or <!-- fragment of SCENE -->")
        elif block.kind == "sh":
            self.printed = ""
            for line, command in self.commands(block):
                self.follow_command(line, command, block.comment)
        elif block.kind == "text":
            self.check_printed(block)

    def check_fragment(self, block, base):
        path = self.folder / base
        try:
            scene = merged(tomllib.loads(path.read_text()), tomllib.loads(block.text))
        except (OSError, tomllib.TOMLDecodeError) as error:
            self.fail(block.line, f"the fragment cannot be added to {base}: {error}")
            return
        whole = path.with_name(f"fragment_{block.line}.toml")
        whole.write_text("".join(f"{key} = {as_toml(value)}\n" for key, value in scene.items()))
        self.execute(block.line, f"build/gcpdda inspect {whole.relative_to(self.folder)}", 0)

    def commands(self, block):
        """Lines of a sh block, those that end with a backslash joined with the next one."""
        number, command = block.line, ""
        for line_number, line in enumerate(block.text.splitlines(), block.line):
            number = number if command else line_number
            command += line.removesuffix("\\")
            if not line.endswith("\\"):
                yield number, command
                command = ""

    def follow_command(self, line, command, comment):
        words = shlex.split(command, comments=True)
        for name in [name for name in self.unused if name in words]:
            del self.unused[name]
        while words and re.match(r"[A-Z_]+=", words[0]):
            words.pop(0)
        if not words:
            return
        if SCRIPT.match(words[0]) and not os.access(SOURCE / words[0], os.X_OK):
            self.fail(line, f"{words[0]} is no program of the repository")
        elif RUN.match(words[0]):
            expected = re.search(r"# exit code (\d+)\s*$", command)
            if comment == "too large for a test" or (comment == "too long for a test" and not self.draws):
                command = self.shortened(words, "inspect" if comment == "too long for a test" else "--help")
            self.execute(line, command, int(expected[1]) if expected else 0)

    @staticmethod
    def shortened(words, check):
        """A command that checks the arguments of a long one."""
        if "build/gcpdda" not in words:
            return shlex.join([*words, "--help"])
        program, task, *rest = words[words.index("build/gcpdda"):]
        scenes = [word for word in rest if word.endswith(".toml")]
        if check == "--help" or task not in ("run", "fos", "ensemble"):
            return f"test -e {shlex.join(scenes[:1] or ['.'])} && {shlex.join([program, task, '--help'])}"
        sets = [word for i, word in enumerate(rest) if "--set" in (word, rest[i - 1])]
        return shlex.join([program, "inspect", *scenes[:1], *sets])

    def execute(self, line, command, expected):
        scratch = self.folder / "mpi"  # starts of Open MPI that share one disturb each other
        scratch.mkdir(exist_ok=True)
        environment = os.environ | {"OMPI_MCA_orte_tmpdir_base": str(scratch),
                                    "OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_hwloc_base_binding_policy": "none",
                                    # python3 is the one that runs this script: it has the packages of run/packages.txt.
                                    "PATH": os.path.dirname(sys.executable) + os.pathsep + os.environ["PATH"]}
        try:
            done = subprocess.run(["bash", "-c", command], cwd=self.folder, env=environment, text=True, timeout=PATIENCE,
                                  stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        except subprocess.TimeoutExpired:
            self.fail(line, f"not done after {PATIENCE} s: {command}")
            return
        self.printed += done.stdout
        if done.returncode != expected:
            end = "\n    ".join(done.stdout.splitlines()[-15:])
            self.fail(line, f"exit code {done.returncode} instead of {expected}: {command.strip()}\n    {end}")

    def check_printed(self, block):
        rest = self.printed
        for number, line in enumerate(block.text.splitlines(), block.line):
            pattern = ".*".join(re.escape(part) for part in line.strip().split("..."))
            found = re.search(rf"^\s*{pattern}\s*$", rest, flags=re.M)
            if found:
                rest = rest[found.end():]
            elif line.strip():
                self.fail(number, f"the commands before do not print, after the lines above it: {line}")
                return


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("build", type=pathlib.Path, help="folder with the program gcpdda")
    parser.add_argument("--only", default="", help="only pages whose path contains this")
    parser.add_argument("--times", action="store_true", help="print the wall time of each page")
    parser.add_argument("--draw", action="store_true",
                        help="run the long commands, too, and put the pictures that pages draw and show in run/pictures")
    arguments = parser.parse_args()

    pages = [page for page in documents() if arguments.only in str(page.relative_to(SOURCE))]
    failures = [wrong for page in pages for wrong in wrong_links(page)]
    followed = [page for page in pages if page.parent == SOURCE or SOURCE / "run" in page.parents]
    with concurrent.futures.ThreadPoolExecutor(max_workers=4) as pool:
        for page in pool.map(lambda path: Page(path, arguments.build.resolve(), arguments.draw).follow(), followed):
            failures += page.failures
            if arguments.times:
                print(f"{page.seconds:6.1f} s  {page.path.relative_to(SOURCE)}")
    print("\n".join(failures) or f"{len(pages)} pages: links, commands and scenes are right")
    sys.exit(1 if failures else 0)


if __name__ == "__main__":
    main()
