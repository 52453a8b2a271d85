#!/usr/bin/env python3
"""Compares frames and their detection with other tools; writes docs/evidence/speed/rivals.json, tables of speed.md.

    python3 -m venv venv && venv/bin/pip install -r docs/evidence/speed/requirements.txt
    python3 docs/evidence/speed/compare.py --python venv/bin/python

Times are processor time of one thread. Every round runs each work once (A B C, A B C, …), so that other load
on the machine affects all alike; results are the least and the median over the rounds. First, the frames of
every simulator that claims our expected image are compared with ours in mean and variance, and the detectors
with the stars. Exit 0: done; 1: a simulator disagrees; 2: something is missing.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

ROOT = pathlib.Path(__file__).resolve().parents[3]
# Name for the example frame_speed, name in the table, number of frames in a turn: all where frames differ.
FRAMES = [
    ("plain", "**Boresight**: the plain frame, whole", 10),
    ("plain-uneven", "Boresight: the same, a response and a dark current of its own for every pixel", 10),
    ("field", "Boresight: star field with truth and telemetry, whole", 10),
    ("field-regions", "Boresight: the same, 40 regions", 10),
]
for day in range(1, 6):
    FRAMES += [
        (f"argon-day-{day}-whole", f"Boresight: complete frame of ARGON, day {day}, whole", 10),
        (f"argon-day-{day}", f"Boresight: the same, 40 regions, day {day}", 10),
    ]
DETECTION = [
    ("process-plain", "**Boresight**: the far-range pipeline", 50),
    ("process-argon-whole", "Boresight: on whole frames of ARGON, with identification and tracks", 50),
    ("process-argon-regions", "Boresight: the same on 40 regions", 50),
    ("process-argon-best-whole", "Boresight: the best mode on whole frames of ARGON", 50),
    ("process-argon-best-regions", "Boresight: the same on 40 regions", 50),
]
FRAMES_COMPARED = 8
ANCHOR = "getframes 2.6: `Camera.observe`"


def stop(message, code=2):
    print(message, file=sys.stderr)
    sys.exit(code)


class Ours:
    """The example frame_speed, which waits for requests."""

    def __init__(self):
        command = ["cargo", "build", "--release", "-p", "boresight-research", "--bin", "frame_speed", "--message-format=json"]
        built = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, text=True)
        if built.returncode != 0:
            stop("frame_speed was not built")
        messages = [json.loads(line) for line in built.stdout.splitlines()]
        programs = [m["executable"] for m in messages if m.get("target", {}).get("name") == "frame_speed"]
        self.process = subprocess.Popen([programs[-1]], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.told = self.read()

    def read(self):
        line = self.process.stdout.readline()
        if not line:
            stop("frame_speed has ended; its message is above")
        return json.loads(line)

    def ask(self, request):
        self.process.stdin.write(request + "\n")
        self.process.stdin.flush()
        return self.read()

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--python", help="the interpreter that has docs/evidence/speed/requirements.txt; this one otherwise")
    parser.add_argument("--rounds", type=int, default=30, help="turns of each work (30)")
    parser.add_argument("--cpu", type=int, help="the core to stay on; the last one otherwise")
    parser.add_argument("--dry", action="store_true", help="print the tables, write nothing")
    given = parser.parse_args()
    if given.rounds < 1:
        parser.error(f"--rounds is {given.rounds}, expected 1 or more")
    cores = sorted(os.sched_getaffinity(0))
    given.cpu = cores[-1] if given.cpu is None else given.cpu
    if given.cpu not in cores:
        parser.error(f"--cpu is {given.cpu}, expected one of {cores}")
    if given.python and not os.environ.get("BORESIGHT_COMPARE"):
        os.environ["BORESIGHT_COMPARE"] = "1"
        try:
            os.execv(given.python, [given.python, *sys.argv])
        except OSError as error:
            parser.error(f"--python is {given.python}: {error.strerror}")
    return given


def written_frames(ours, scene, count):
    """Plain frames of ours."""
    import numpy as np

    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "frames"
        ours.ask(f"write {count} {file}")
        return np.fromfile(file, dtype="<u2").reshape(count, *scene.shape)


def check_agreement(scene, ours, makers):
    """Differences of each simulator from ours; stops when one that should agree does not."""
    import agreement
    import numpy as np

    kept, others = ours[:FRAMES_COMPARED], ours[FRAMES_COMPARED:]
    off = agreement.from_expectation(scene, ours)
    print(f"Boresight, the expected image by scipy: star pixels {off:+.1f}", file=sys.stderr)
    report, disagree = {"Boresight, from scipy": {"star pixels": off}}, abs(off) >= agreement.LIMIT
    for name, frame, same_image in [("Boresight, other frames", others.__getitem__, True), *makers]:
        frames = np.stack([np.array(frame(number)) for number in range(FRAMES_COMPARED)])
        report[name] = agreement.differences(scene, kept, frames)
        words = ", ".join(f"{what} {z:+.1f}" for what, z in report[name].items())
        print(f"{name}: {words}{'' if same_image else ' (another image: not compared)'}", file=sys.stderr)
        disagree |= same_image and max(map(abs, report[name].values())) >= agreement.LIMIT
    if disagree:
        stop(f"a difference is beyond {agreement.LIMIT} standard errors", code=1)
    return report


def stars_found(scene, places):
    """Number of stars with a position found within 1.5 px, and number of positions without a star within 3
    px."""
    import numpy as np

    places = np.asarray(places, dtype=float).reshape(-1, 2)
    distance = np.hypot(scene.x[:, None] - places[:, 0], scene.y[:, None] - places[:, 1])
    return int((distance.min(axis=1) < 1.5).sum()), int((distance.min(axis=0) > 3.0).sum())


def timed(turns, rounds):
    """Least and median processor time of each work, ms."""
    times = {name: [] for name, _ in turns}
    for number in range(rounds):
        for name, turn in turns:
            times[name].append(turn(number))
    return {name: {"least_ms": min(each), "median_ms": statistics.median(each)} for name, each in times.items()}


def turn_here(work, count):
    def turn(_):
        start = time.process_time()
        for number in range(count):
            work(number)
        return (time.process_time() - start) * 1e3 / count

    return turn


def main():
    given = arguments()
    # Set before numpy is imported: its libraries read these variables when they are loaded.
    for library in ("OMP", "OPENBLAS", "MKL", "NUMBA", "RAYON"):
        os.environ[f"{library}_NUM_THREADS"] = "1"
    try:
        import detectors
        import page
        import simulators
    except ImportError as error:
        stop(f"{error}; {sys.executable} needs docs/evidence/speed/requirements.txt")
    ours = Ours()
    for process in (0, ours.process.pid):
        os.sched_setaffinity(process, {given.cpu})
    scene = simulators.Scene(ours.told["scene"])
    frames = written_frames(ours, scene, 2 * FRAMES_COMPARED)
    makers = [(name, maker(scene), same_image) for name, maker, same_image in simulators.SIMULATORS]
    differences = check_agreement(scene, frames, makers)
    found = {DETECTION[0][1]: stars_found(scene, ours.ask("clusters process-plain")["clusters"])}
    found |= {name: stars_found(scene, detect(frames[0])) for name, detect in detectors.DETECTORS}

    turns = [(name, turn_here(frame, 1)) for name, frame, _ in makers]
    for work, name, count in FRAMES + DETECTION:
        turns.append((name, lambda _, work=work, count=count: ours.ask(f"time {work} {count}")["cpu_ms"]))
    for name, detect in detectors.DETECTORS:
        turns.append((name, turn_here(lambda number, detect=detect: detect(frames[number]), 4)))
    results = timed(turns, given.rounds)
    ours.close()

    note = f"{page.machine()}; {given.rounds} turns; other load at the end {max(0.0, os.getloadavg()[0] - 1.0):.1f}."
    text = f"{note}\n\n{frame_table(page, results, makers)}\n\n{detection_table(page, results, found)}"
    if given.dry:
        print(text)
        return
    report = {
        "machine": note,
        "times": results,
        "differences_standard_errors": differences,
        "stars_found_and_false": found,
    }
    (page.FOLDER / "rivals.json").write_text(json.dumps(report, indent=1) + "\n")
    page.replace("rivals", text)


def frame_table(page, results, makers):
    anchor = results[ANCHOR]["least_ms"]
    names = [name for name, *_ in makers] + [name for _, name, _ in FRAMES]
    head = ["frame", "least, ms", "median, ms", "times as fast as getframes"]
    return page.table(head, [[*times(results[name]), f"{anchor / results[name]['least_ms']:.1f}"] for name in names], names)


def detection_table(page, results, found):
    own = results[DETECTION[0][1]]["least_ms"]
    names = [name for _, name, _ in DETECTION] + [name for name in found if name != DETECTION[0][1]]
    head = ["detection", "least, ms", "median, ms", "times our time", "stars found of 160", "false"]
    rows = [
        [*times(results[name]), f"{results[name]['least_ms'] / own:.1f}", *found.get(name, ("", ""))] for name in names
    ]
    return page.table(head, rows, names)


def times(result):
    return f"{result['least_ms']:.2f}", f"{result['median_ms']:.2f}"


if __name__ == "__main__":
    main()
