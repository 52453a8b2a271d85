"""Counts wording patterns that CONVENTIONS.md excludes, and lines wider than it allows.

A block is a comment (consecutive lines of one kind) in Rust, Python, TypeScript or TOML, a docstring, or a
paragraph, list entry or table row in Markdown. Fails if 1 % or more of the blocks of any of these kinds match
a pattern, if a comment or paragraph is wider than 110 columns, or if a Rust function or limit has a name in
excluded words. Exempt from the width are tables, code, and words that cannot be broken (links, addresses).

    python3 tests/words/run.py                 # counts by kind and pattern
    python3 tests/words/run.py --list [PATH]   # every match, and every wide line, below PATH
"""

import argparse
import ast
import re
import subprocess
import sys
from collections import Counter
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WIDTH = 110
LIMIT = 0.01

# Vendored or generated texts, and patches whose context is other files' text.
EXCLUDED = ("oracle/report/third_party/", "fuzz/corpus/", "golden/baselines/", "tests/saboteurs/faults/", "tests/words/")

# Pages that a test writes from the program; their paragraphs are not wrapped.
GENERATED = ("docs/command-line.md", "docs/scenario-keys.md")

PATTERNS = {
    "opening word": re.compile(r"^(?:What|How|Whether|That|The same|As|Of|Where|Which|Who|Why|None)\b(?![-…?]|[^.]*\?)"),
    "personified": re.compile(
        r"\b(?:told|tells?|telling|asks?|asked|knows?|knew|wants?|wanted|heeds?|believes?|looks? at|looked at"
        r"|(?<!paper )(?<!standard )says?|said)\b"
    ),
    "nobody": re.compile(r"\b(?:nobody|somebody|anybody|whoever)\b", re.IGNORECASE),
    "law": re.compile(
        r"(?<!cos⁴ )(?<!cosine )(?<!power )(?<!physical )(?<!power-)(?<!'s )(?<!’s )\blaws?\b(?! of (?:sines|cosines|refraction))"
    ),
    "place": re.compile(r"(?<!in )(?<!in-)(?<!take )(?<!takes )(?<!taking )(?<!decimal )\bplaces?\b"),
    "what is": re.compile(r"\bwhat (?:is|was|are|were|it|they|has|have|had|a|the)\b|\bwhatever\b", re.IGNORECASE),
    "as it is": re.compile(r"\bas (?:it|they) (?:is|are|was|were|stands?|comes?)\b"),
}

# Names of Rust items: limits that begin with neither MIN_ nor MAX_, and functions in words of people.
NAMES = re.compile(
    r"\b(?:const|static) ((?:LEAST|MOST|FEWEST|LARGEST|SMALLEST|LONGEST|WIDEST)_\w+)"
    r"|\bfn (\w*?(?:\b|_)(?:told|tells?|says?|said|asks?|asked|knows?|wants?|wanted|what|whatever|nobody|somebody)(?:_\w*)?)\b"
)

EXAMPLES = {
    "What this table holds.": "opening word",
    "The reader is told where the rows are.": "personified",
    "Nobody opens this file.": "nobody",
    "Cut of a normal law.": "law",
    "Index of the place of a star.": "place",
    "Returns what is left.": "what is",
    "The file stays as it is.": "as it is",
    "Relative illumination by the cos⁴ law.": None,
    "Number of electrons in a pixel.": None,
    "Sorts the rows in place.": None,
}

NAME_EXAMPLES = {
    "const MOST_HITS: f64 = 1e5;": True,
    "fn a_range_is_told_in_few_words() {": True,
    "fn what_is_written_comes_back() {": True,
    "const MAX_HITS: f64 = 1e5;": False,
    "fn somewhat_knowledgeable_task() {": False,
}


def matches(text: str) -> list[str]:
    """Names of the patterns that a text matches; code in backticks and link targets do not count."""
    plain = re.sub(r"`[^`]*`", "`x`", " ".join(text.split()))
    plain = re.sub(r"\]\([^)]*\)", "]", plain)
    plain = re.sub(r'"[^"]*"|“[^”]*”', '"x"', plain)
    return [name for name, pattern in PATTERNS.items() if pattern.search(plain)]


def comments(lines: list[str], marker: str) -> list[tuple[int, str]]:
    """First line (from 1) and text of each run of comment lines with the same indentation and marker."""
    shape = re.compile(rf"^(\s*)({marker})(?: |$)(.*)$")
    blocks: list[tuple[int, str]] = []
    start, key, text = 0, None, []
    for number, line in enumerate([*lines, "\0"], 1):
        match = shape.match(line)
        found = match and (match[1], match[2])
        if text and found != key:
            blocks.append((start, "\n".join(text)))
            text = []
        if match:
            if not text:
                start = number
            text.append(match[3])
        key = found
    return blocks


def docstrings(source: str) -> list[tuple[int, str]]:
    """First line and text of each docstring of a Python file."""
    kinds = (ast.Module, ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)
    nodes = [node for node in ast.walk(ast.parse(source)) if isinstance(node, kinds)]
    return [(node.body[0].lineno, text) for node in nodes if (text := ast.get_docstring(node))]


def paragraphs(lines: list[str]) -> list[tuple[int, str]]:
    """First line and text of each paragraph, list entry and table row of a Markdown file, code left out."""
    blocks: list[tuple[int, str]] = []
    fenced, fresh = False, True
    for number, line in enumerate(lines, 1):
        if re.match(r"\s*(```|~~~)", line):
            fenced, fresh = not fenced, True
        elif fenced or not line.strip() or line.startswith(("    ", "#", "<!--")):
            fresh = True
        elif line.lstrip().startswith("|"):
            blocks += [(number, cell.strip()) for cell in line.strip().strip("|").split("|") if cell.strip()]
            fresh = True
        else:
            if fresh or re.match(r"\s*([-*+]|\d+\.)\s", line):
                blocks.append((number, re.sub(r"^\s*(?:[-*+>]|\d+\.)\s+", "", line)))
            else:
                blocks[-1] = (blocks[-1][0], blocks[-1][1] + "\n" + line)
            fresh = False
    return blocks


def wide_lines(path: Path, lines: list[str]) -> list[int]:
    """Numbers of the comment and paragraph lines wider than the limit that could be broken."""
    wide, fenced = [], False
    for number, line in enumerate(lines, 1):
        if re.match(r"\s*(//[/!] ?)?\s*(```|~~~)", line):
            fenced = not fenced
        if len(line) <= WIDTH or fenced:
            continue
        if path.suffix == ".md":
            exempt = line.lstrip().startswith(("|", "<", "!", "[", "#")) or line.startswith("    ")
        else:
            code = path.suffix == ".toml" and re.match(r"\s*# ?[\w.]+ = ", line)
            exempt = code or not re.match(r"\s*(//|# )", line) or re.match(r"\s*//[/!] *\|", line)
        longest = max(len(word) for word in re.sub(r"\[[^\]]*\]\([^)]*\)", lambda m: m[0].replace(" ", "_"), line).split())
        if not exempt and longest < WIDTH // 2:
            wide.append(number)
    return wide


def blocks_of(path: Path, text: str) -> tuple[str, list[tuple[int, str]]]:
    """Kind of a file, and its blocks."""
    lines = text.split("\n")
    match path.suffix:
        case ".rs":
            return "Rust", comments(lines, "//[/!]?")
        case ".py" | ".pyi":
            return "Python", comments(lines, "#") + docstrings(text)
        case ".ts" | ".css":
            return "page", comments(lines, "//") + comments(lines, r" ?\*")
        case ".toml":
            return "TOML", comments(lines, "#")
        case _:
            return "Markdown", paragraphs(lines)


def main() -> int:
    arguments = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    arguments.add_argument("--list", nargs="?", const="", metavar="PATH", help="print every match below PATH")
    listed = arguments.parse_args().list
    for text, expected in EXAMPLES.items():
        found = matches(text)
        assert found == ([expected] if expected else []), f"{text!r}: {found}, expected {expected}"
    for code, expected in NAME_EXAMPLES.items():
        assert bool(NAMES.search(code)) == expected, f"{code!r}, expected {expected}"

    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    suffixes = (".rs", ".py", ".pyi", ".ts", ".toml", ".md")
    totals, faulty, patterns, wide, wrong_names = Counter(), Counter(), Counter(), 0, 0
    for name in names:
        path = ROOT / name
        if not name.endswith(suffixes) or name.startswith(EXCLUDED) or not path.is_file():
            continue
        text = path.read_text(encoding="utf-8")
        kind, blocks = blocks_of(path, text)
        show = listed is not None and name.startswith(listed)
        for line, block in blocks:
            totals[kind] += 1
            found = matches(block)
            faulty[kind] += bool(found)
            patterns.update(found)
            if found and show:
                print(f"{name}:{line}: {', '.join(found)}: {' '.join(block.split())[:160]}")
        if kind == "Rust":
            for line, code in enumerate(text.split("\n"), 1):
                for found in NAMES.finditer(code.split("//")[0]):
                    wrong_names += 1
                    if show:
                        print(f"{name}:{line}: name {found[1] or found[2]}")
        for line in [] if name in GENERATED else wide_lines(path, text.split("\n")):
            wide += 1
            if show:
                print(f"{name}:{line}: wider than {WIDTH} columns")

    for kind, total in sorted(totals.items()):
        print(f"{kind}: {faulty[kind]} of {total} blocks match a pattern ({100 * faulty[kind] / total:.2f} %)")
    print(", ".join(f"{name} {count}" for name, count in patterns.most_common()) or "no pattern matches")
    print(f"{wide} lines wider than {WIDTH} columns, {wrong_names} names in excluded words")
    failed = wide > 0 or wrong_names > 0 or any(faulty[kind] >= LIMIT * total for kind, total in totals.items())
    if failed:
        print("`--list` prints every match; CONVENTIONS.md (Words) has the rules", file=sys.stderr)
    return int(failed)


if __name__ == "__main__":
    sys.exit(main())
