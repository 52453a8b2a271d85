#!/usr/bin/env python3
"""Checks the commands and the figures of README.md and of the pages in docs/.

    python3 tests/pages/run.py --program target/release/boresight           # what CI runs: two minutes
    python3 tests/pages/run.py --program target/release/boresight --long    # the long commands too
    python3 tests/pages/run.py --program env/bin/boresight --installed      # as a user without this tree
    python3 tests/pages/run.py --list                                       # commands, and figures without a check

1. Every command on a page exists: subcommand and options of `boresight` are those of its help,
   scripts of `python3` are files of this tree, binaries, examples and test suites of `cargo` exist.
2. Every check of checks.toml: its commands run, one after the other, in a directory of their own with the tree
   beside it, and each figure that the page prints is compared with the one in their output. A figure of a page
   must be a text of that page, so a page cannot change without its check. A block of results on a page must be
   in the output, line by line; a line `…` stands for omitted ones.

A figure agrees if the output, rounded to the decimals of the page, is the page's figure, or differs from it by
at most the `within` of its entry, which has a reason. Standard library only; a check that needs numpy or
another package is left out with a message if the interpreter lacks it.
"""

import argparse
import functools
import importlib.util
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

ROOT = pathlib.Path(__file__).resolve().parents[2]
CHECKS = pathlib.Path(__file__).with_name("checks.toml")
# Words on pages that stand for a value of the reader.
PLACEHOLDER = re.compile(r"^[A-Z][A-Z_0-9/.]*$|…|^<")
# Options that every subcommand has.
GLOBAL = {"--help", "--version", "--json", "--color", "--quiet"}


def pages():
    return [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]


def commands(text):
    """Yields (line number, command) for every line of a code block, and every inline code, that is one."""
    is_block = False
    for number, line in enumerate(text.splitlines(), 1):
        if line.lstrip().startswith("```"):
            is_block = not is_block
            continue
        candidates = [line.strip()] if is_block or line.startswith("    ") else re.findall(r"`([^`]+)`", line)
        for candidate in candidates:
            candidate = re.sub(r"^(- run: |\$ )", "", candidate)
            if re.match(r"(boresight|python3|cargo) [^|]*\S", candidate):
                yield number, candidate


def words_of(command):
    """Splits a command into words, without its comment; None for a sentence in between."""
    command = re.split(r"\s#\s|\s#$", command)[0]
    try:
        return shlex.split(command)
    except ValueError:
        return None


def options_by_subcommand(program, name=()):
    """The options of a subcommand and of those below it, from the help of the program."""
    words = [program, *name, "--help"]
    text = subprocess.run(words, cwd=ROOT, check=True, capture_output=True, text=True).stdout
    found = {name: set(re.findall(r"(?<![\w-])(--[a-z][a-z0-9-]*)", text))}
    listed = re.search(r"^Commands:\n((?:  .*\n)+)", text, flags=re.M)
    for inner in re.findall(r"^  ([a-z][a-z-]*) ", listed[1] if listed else "", flags=re.M):
        if inner != "help":
            found |= options_by_subcommand(program, (*name, inner))
    return found


def fault_of_boresight(words, known):
    """The fault of a command of boresight, or None."""
    words = [word for word in words[1:] if not word.startswith("<(")]
    plain = [word for word in words if not word.startswith("-")]
    name = ()
    while len(name) < len(plain) and (*name, plain[len(name)]) in known:
        name = (*name, plain[len(name)])
    if not name and plain and not PLACEHOLDER.search(plain[0]):
        return f"no subcommand {plain[0]}"
    accepted = known.get(name, set()) | GLOBAL
    for word in words:
        option = word.split("=")[0]
        if option == "--":
            break
        if option.startswith("--") and option not in accepted:
            return f"boresight {' '.join(name)} has no option {option}"
    return None


def fault_of_python(words):
    script = next((word for word in words[1:] if not word.startswith("-")), "")
    if words[1:2] and words[1] in ("-m", "-c") or not script.endswith(".py") or PLACEHOLDER.search(script):
        return None
    # Programs of the reader have names of their own.
    if re.match(r"(my_|tools/|missing|mine)", script) or (ROOT / script).is_file():
        return None
    return f"no script {script}"


@functools.cache
def tracked_files():
    listing = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
    return listing.stdout.splitlines()


def fault_of_cargo(words):
    following = lambda option: [words[i + 1] for i in range(len(words) - 1) if words[i] == option]
    files = tracked_files()
    manifests = "\n".join((ROOT / file).read_text() for file in files if file.endswith("Cargo.toml"))
    for package in following("-p"):
        if f'name = "{package}"' not in manifests and not PLACEHOLDER.search(package):
            return f"no package {package}"
    for binary in following("--bin"):
        if f'name = "{binary}"' not in manifests:
            return f"no binary {binary}"
    for example in following("--example"):
        paths = (f"examples/{example}.rs", f"examples/{example}/main.rs")
        if not any(file.endswith(paths) for file in files):
            return f"no example {example}"
    for bench in following("--bench"):
        if not any(re.search(rf"benches/(.*/)?{bench}\b", file) for file in files):
            return f"no benchmark {bench}"
    suite = next((word for word in words if re.fullmatch(r"[a-z_0-9]+::\w*", word)), None)
    if suite and not any(f"tests/it/{suite.split('::')[0]}" in file for file in files):
        return f"no suite {suite}"
    return None


def faults_of_commands(program):
    known, faults = options_by_subcommand(program), []
    for page in pages():
        for number, command in commands(page.read_text()):
            words = words_of(command)
            if not words:
                continue
            check = {"boresight": lambda w: fault_of_boresight(w, known), "python3": fault_of_python, "cargo": fault_of_cargo}
            fault = check[words[0]](words)
            if fault:
                faults.append(f"{page.relative_to(ROOT)}:{number}: {fault}: {command}")
    return faults


class Check:
    """An entry of checks.toml."""

    def __init__(self, entry):
        self.page, self.name = entry["page"], entry["name"]
        self.commands, self.figures = entry["commands"], entry.get("figures", [])
        self.unprinted = entry.get("unprinted", [])
        self.blocks, self.copies = entry.get("blocks", {}), entry.get("copies", {})
        self.results = entry.get("results", [])
        self.needs, self.is_long = entry.get("needs", []), entry.get("long", False)
        self.exit_status = entry.get("exit_status", 0)

    def needs_tree(self):
        """Whether a command needs a file of this tree that `boresight examples` does not write, or a compiler."""
        return any(re.search(r"\b(golden|research|scenarios|sim|tests)/|^cargo (?!run --release -- )", c) for c in self.commands)

    def missing(self):
        return [name for name in self.needs if not importlib.util.find_spec(name)]

    def block(self, language, number):
        """The code block of a language on the page, counted from 0."""
        text = (ROOT / self.page).read_text()
        return re.findall(rf"```{language}\n(.*?)```", text, flags=re.S)[number]

    def faults(self, program, is_installed):
        text = (ROOT / self.page).read_text()
        for figure in self.figures:
            if figure["text"] not in text:
                return [f"{self.page} lacks the text `{figure['text']}` of a check"]
        for command in self.commands:
            if command not in text and command not in self.unprinted:
                return [f"{self.page} lacks the command `{command}` of a check"]
        with tempfile.TemporaryDirectory() as scratch:
            scratch = pathlib.Path(scratch)
            if is_installed:
                run("boresight examples", program, scratch).check_returncode()
            else:
                for name in ("docs", "examples", "scenarios", "golden", "sim", "research", "tests"):
                    (scratch / name).symlink_to(ROOT / name)
            for name, (language, number) in self.blocks.items():
                (scratch / name).write_text(self.block(language, number))
            for name, source in self.copies.items():
                shutil.copy(ROOT / source, scratch / name)
            output = ""
            for command in self.commands:
                done = run(command, program, scratch)
                output += done.stdout
                expected = self.exit_status if command == self.commands[-1] else 0
                if done.returncode != expected:
                    return [f"{self.page}: `{command}` ended with {done.returncode}, not {expected}: {done.stderr[-300:]}"]
            faults = [fault for number in self.results for fault in self.differing_lines(number, output)]
            return faults + [fault for figure in self.figures for fault in self.fault(figure, scratch, output)]

    def differing_lines(self, number, output):
        """The first line of a block of results that is not in the output, after the lines before it."""
        return [f"{self.page}: `{line}` is not in the output of {self.name}" for line in first_missing(self.block("text", number), output)]

    def fault(self, figure, scratch, output):
        """The difference of one figure, as a list of none or one."""
        if "count" in figure:
            found = [str(len(list(scratch.glob(figure["count"]))))]
        elif "lines" in figure:
            found = [str(len(re.findall(figure["lines"], output, flags=re.M)))]
        else:
            source = (scratch / figure["file"]).read_text() if "file" in figure else output
            match = re.search(figure["output"], source, flags=re.M | re.S)
            if not match:
                return [f"{self.page}: the output of {self.name} has no `{figure['output']}`"]
            found = match.groups()
        printed = re.search(figure.get("page", r"(-?[\d,]*\d(?:\.\d+)?)"), figure["text"]).groups()
        faults = []
        for on_page, in_output in zip(printed, found, strict=True):
            if not agree(on_page, in_output, figure.get("within", 0.0), figure.get("scale", 1.0)):
                faults.append(f"{self.page}: `{figure['text']}` prints {on_page}, its commands {in_output}")
        return faults


def first_missing(block, output):
    """The first line of a block that the rest of the output lacks, as a list of none or one."""
    rest = iter(line.rstrip() for line in output.splitlines())
    for line in block.splitlines():
        if line.strip() not in ("", "…") and line.rstrip() not in rest:
            return [line]
    return []


# Numbers that pages write as words.
NUMBERS = {"one": "1", "two": "2", "ten": "10", "twenty": "20", "thirty": "30", "None": "0", "none": "0"}


def agree(on_page, in_output, within, scale):
    on_page, in_output = (NUMBERS.get(text, text).replace(",", "").replace("−", "-") for text in (on_page, in_output))
    try:
        printed, found = float(on_page), scale * float(in_output)
    except ValueError:
        return on_page == in_output
    decimals = len(on_page.partition(".")[2])
    # Half of the last printed digit, and a rounding error.
    return abs(printed - found) <= max(within, 0.5 * 10.0**-decimals) + 1e-9 * abs(printed)


def run(command, program, scratch):
    """Runs a command of a page: `boresight` is the program, and so is `cargo run --release --`."""
    command = re.split(r"\s+#\s", command)[0]
    command = re.sub(r"^cargo run --release -- ", "boresight ", command)
    words = shlex.split(command)
    if words[0] == "boresight":
        words[0] = program
    if words[0] == "python3":
        words[0] = sys.executable
    environment = {**os.environ, "PATH": f"{pathlib.Path(program).parent}{os.pathsep}{os.environ['PATH']}"}
    directory = ROOT if words[0] == "cargo" else scratch
    return subprocess.run(words, cwd=directory, env=environment, capture_output=True, text=True)


def prove(program):
    """Ends the program if a wrong figure or a wrong command would pass."""
    known = options_by_subcommand(program)
    wrong = [
        agree("0.31", "3.18", 0, 1),
        agree("2.0", "2.06", 0, 1),
        agree("16,077", "16078", 0, 1),
        not agree("16,077", "16077", 0, 1),
        not agree("64.0", "0.6396", 0, 100),
        not agree("twenty", "20", 0, 1),
        first_missing("a\n…\nc\n", "a\nb\nc\n") != [],
        first_missing("c\na\n", "a\nb\nc\n") != ["a"],
        fault_of_boresight(["boresight", "run", "argon", "--frame", "1"], known) is None,
        fault_of_boresight(["boresight", "contrast", "a", "b"], known) is None,
        fault_of_boresight(["boresight", "run", "argon", "--frames", "1"], known) is not None,
        fault_of_python(["python3", "examples/absent.py"]) is None,
        fault_of_cargo(["cargo", "run", "--bin", "absent"]) is None,
    ]
    if any(wrong):
        sys.exit(f"this script cannot tell right from wrong: {wrong}")


def unchecked(checks):
    """Commands of pages that run something and that no check runs."""
    run_by_checks = {command for check in checks for command in check.commands}
    for page in pages():
        for number, command in commands(page.read_text()):
            if command not in run_by_checks and not re.search(r"\b[A-Z]{3,}\b|…", command) and len(command.split()) > 2:
                yield f"{page.relative_to(ROOT)}:{number}: {command}"


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--program", default="target/release/boresight")
    parser.add_argument("--long", action="store_true", help="run the long checks too")
    parser.add_argument("--installed", action="store_true", help="without this tree: only the commands that need none")
    parser.add_argument("--only", default="", help="part of the name of the checks to run")
    parser.add_argument("--list", action="store_true", help="list the commands that no check runs")
    options = parser.parse_args()
    checks = [Check(entry) for entry in tomllib.loads(CHECKS.read_text())["check"]]
    if options.list:
        print("\n".join(unchecked(checks)))
        return 0
    program = str((pathlib.Path.cwd() / options.program).resolve())
    prove(program)
    faults = faults_of_commands(program)
    print(f"commands of {len(pages())} pages: {len(faults)} faults", flush=True)
    for check in checks:
        if options.only not in check.name or check.is_long and not options.long:
            continue
        if options.installed and check.needs_tree():
            print(f"{check.name}: left out, needs the source tree", flush=True)
            continue
        if check.missing():
            print(f"{check.name}: left out, needs {', '.join(check.missing())}", flush=True)
            continue
        begin = time.monotonic()
        found = check.faults(program, options.installed)
        faults += found
        verdict = "differs" if found else "agrees"
        print(f"{check.name}: {len(check.figures)} figures, {verdict}, {time.monotonic() - begin:.0f} s", flush=True)
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
