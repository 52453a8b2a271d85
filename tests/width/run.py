"""Lists comments and paragraphs wider than CONVENTIONS.md allows, and names of Rust items that it excludes.

Fails if there is any. Exempt from the width are tables, code, and words that cannot be broken (links,
addresses).

    python3 tests/width/run.py
"""

import re
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
WIDTH = 110

# Vendored texts, and patches whose context is other files' text.
EXCLUDED = ("oracle/report/third_party/", "fuzz/corpus/", "golden/baselines/", "tests/saboteurs/faults/", "tests/width/")

# Names of Rust items: limits that begin with neither MIN_ nor MAX_, and functions in words of people.
NAMES = re.compile(
    r"\b(?:const|static) ((?:LEAST|MOST|FEWEST|LARGEST|SMALLEST|LONGEST|WIDEST)_\w+)"
    r"|\bfn (\w*?(?:\b|_)(?:told|tells?|says?|said|asks?|asked|knows?|wants?|wanted|what|whatever|nobody|somebody)(?:_\w*)?)\b"
)

NAME_EXAMPLES = {
    "const MOST_HITS: f64 = 1e5;": True,
    "fn a_range_is_told_in_few_words() {": True,
    "fn what_is_written_comes_back() {": True,
    "const MAX_HITS: f64 = 1e5;": False,
    "fn somewhat_knowledgeable_task() {": False,
}


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


def excluded_names(lines: list[str]) -> list[tuple[int, str]]:
    """Line number and name of each excluded name, comments left out."""
    found = []
    for number, line in enumerate(lines, 1):
        found += [(number, match[1] or match[2]) for match in NAMES.finditer(line.split("//")[0])]
    return found


def main() -> int:
    for code, expected in NAME_EXAMPLES.items():
        assert bool(NAMES.search(code)) == expected, f"{code!r}, expected {expected}"
    names = subprocess.run(["git", "ls-files"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.splitlines()
    suffixes = (".rs", ".py", ".pyi", ".ts", ".toml", ".md")
    faults = 0
    for name in names:
        path = ROOT / name
        if not name.endswith(suffixes) or name.startswith(EXCLUDED) or not path.is_file():
            continue
        lines = path.read_text(encoding="utf-8").split("\n")
        for number in wide_lines(path, lines):
            print(f"{name}:{number}: wider than {WIDTH} columns")
            faults += 1
        for number, item in excluded_names(lines) if path.suffix == ".rs" else []:
            print(f"{name}:{number}: name {item}")
            faults += 1
    print(f"{faults} lines wider than {WIDTH} columns or names in excluded words; CONVENTIONS.md (Words) has the rules")
    return int(faults > 0)


if __name__ == "__main__":
    sys.exit(main())
