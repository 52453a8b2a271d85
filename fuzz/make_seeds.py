"""Makes the seeds of the corpus: small files of every kind, written by Boresight's writers.

    python3 fuzz/make_seeds.py target/release/boresight

Writes the files `small*`, `argon*` and `docking*` into fuzz/corpus/, and leaves all others (found by the
fuzzer) unchanged. Needs only the standard library.
"""

import hashlib
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
COLUMNS, ROWS = 48, 36
# Files that `run_directory` combines, see fuzz/src/runs.rs.
FAR_RUN = ["run.toml", "score.json", "measurements.csv", "telemetry.csv", "clusters.parquet", "truth/frames.parquet", "truth/objects.parquet"]
DOCKING_RUN = ["run.toml", "setup.toml", "score.json", "measurements.csv", "motion.csv", "telemetry.csv", "features.parquet", "truth/fields.parquet"]


# Tetrahedron with a corner at a distance of 1 m, and its material.
MESH = """newmtl grey
Kd 0.5 0.5 0.5
Ks 0.1 0.1 0.1
Ns 30
v 0 0 0
v 1 0 0
v 0 1 0
v 0 0 1
usemtl grey
f 1 3 2
f 1 2 4
f 1 4 3
f -3 -2 -1
"""


# A calibration in the notations of OpenCV, its stereo sample, ROS (a file and a message) and Kalibr.
CALIBRATIONS = {
    "small-opencv.yaml": """%YAML:1.0
---
image_width: 640
image_height: 480
camera_matrix: !!opencv-matrix
   rows: 3
   cols: 3
   dt: d
   data: [ 6.575e+02, 0., 3.195e+02, 0., 658.25, 239.25, 0., 0., 1. ]
distortion_coefficients: !!opencv-matrix
   rows: 5
   cols: 1
   dt: d
   data: [ -0.25, 0.125, 1e-03, -2e-03, 0.5 ]
""",
    "small-opencv.json": """{ "imageSize": [640, 480],
  "cameraMatrix": { "type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d",
    "data": [ 657.5, 0.0, 319.5, 0.0, 657.5, 239.25, 0.0, 0.0, 1.0 ] },
  "distCoeffs": [[-0.25, 0.125, 0.001, -0.002]] }
""",
    "small-stereo.yaml": """%YAML:1.0
M1: &m !!opencv-matrix
   rows: 3
   cols: 3
   data: [ 657.5, 0., 319.5, 0., 658.25, 239.25, 0., 0., 1. ]
D1: [ -0.25, 0.125, 0, 0, 0, 0, 0, 0 ]
M2: *m
D2: [ 0, 0, 0, 0 ]
""",
    "small-camera-info.yaml": """image_width: 640
image_height: 480
camera_matrix: {rows: 3, cols: 3, data: [657.5, 0, 319.5, 0, 658.25, 239.25, 0, 0, 1]}
distortion_model: plumb_bob
distortion_coefficients: {rows: 1, cols: 5, data: [-0.25, 0.125, 0.001, -0.002, 0]}
""",
    "small-message.yaml": """height: 480
width: 640
distortion_model: plumb_bob
d: [-0.25, 0.125, 0.001, -0.002, 0]
k: [657.5, 0, 319.5, 0, 658.25, 239.25, 0, 0, 1]
binning_x: 1
roi: {x_offset: 0, do_rectify: false}
---
""",
    "small-camchain.yaml": """cam0:
  camera_model: pinhole
  distortion_coeffs: [-0.25, 0.125, 0.001, -0.002]
  distortion_model: radtan
  intrinsics: [657.5, 658.25, 319.5, 239.25]
  resolution: [640, 480]
cam1:
  camera_model: omni
  intrinsics: [1.2, 657.5, 658.25, 319.5, 239.25]
""",
}


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        make(pathlib.Path(program).resolve(), pathlib.Path(folder))


def keep(target, name, content):
    folder = HERE / "corpus" / target
    folder.mkdir(parents=True, exist_ok=True)
    if isinstance(content, pathlib.Path):
        shutil.copyfile(content, folder / name)
    else:
        (folder / name).write_bytes(content if isinstance(content, bytes) else content.encode())


def portable(text):
    """A run.toml or study.json without its original folder, and with the matching hash."""
    text = re.sub(r'"[^"]*/stars\.csv"', '"stars.csv"', text)
    # Without the hashes of its files a scenario is known by their paths.
    text = re.sub(r"^\[files\]\n(?:.+\n)*\n", "", text, flags=re.M)
    scenario = re.sub(r"^(\[+)scenario\.", r"\1", text.partition("[scenario]\n")[2], flags=re.M)
    return re.sub(r"^hash = .*$", f'hash = "{hashlib.sha256(scenario.encode()).hexdigest()}"', text, count=1, flags=re.M)


def bare(path):
    """A TOML file without its comments, which teach a fuzzer nothing."""
    lines = (re.sub(r"\s+#[^\"']*$", "", line) for line in path.read_text().splitlines())
    return "\n".join(line for line in lines if line and not line.startswith("#")) + "\n"


def small(text):
    """A scenario with a small detector."""
    sizes = {"columns": COLUMNS, "rows": ROWS, "principal_x_px": COLUMNS / 2, "principal_y_px": ROWS / 2}
    for name, value in sizes.items():
        text = re.sub(rf"^{name} = .*$", f"{name} = {value}", text, flags=re.M)
    return re.sub(r"^count = .*$", "count = 3", text, flags=re.M)


def make(program, folder):
    def boresight(*words):
        subprocess.run([program, *map(str, words)], cwd=folder, check=True, stdout=subprocess.DEVNULL)

    for name in ["argon", "docking", "starting-point"]:
        keep("scenario", f"{name}.toml", bare(ROOT / f"scenarios/{name}.toml"))
    far, docking = (small(bare(ROOT / f"scenarios/{name}.toml")) for name in ["starting-point", "docking"])
    far = re.sub(r"^source = .*$", 'source = "stars.csv"', far, flags=re.M)
    stars = "id,ra_deg,dec_deg,v_mag,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr,b_v\n" + "".join(
        f"{i},{i * 360 / 400:.3f},{(i * 37) % 180 - 89.5:.3f},{3 + i % 4},{i % 9},{i % 5},-{i % 7},{0.1 * (i % 11):.1f}\n"
        for i in range(400)
    )
    (folder / "stars.csv").write_text(stars)
    (folder / "far.toml").write_text(far)
    (folder / "docking.toml").write_text(docking)
    keep("simulator", "small.toml", re.sub(r"^source = .*$", 'source = "hipparcos2"', far, flags=re.M))
    keep("simulator", "small-docking.toml", docking)
    keep("catalogue_csv", "small.csv", "\n".join(stars.splitlines()[:20]) + "\n")

    boresight("run", "far.toml", "--out", "far")
    boresight("run", "docking.toml", "--frames", "24000..24003", "--out", "docking")
    for kind in ["fits", "png", "exr"]:
        boresight("render", "far.toml", "--frames", "0..2", "--format", kind, "--out", kind)
        keep(kind, f"small.{kind}", sorted((folder / kind / "frames").iterdir())[0])
    for kind, suffix in [("avi", "avi"), ("mjpeg", "avi"), ("y4m", "y4m")]:
        boresight("render", "docking.toml", "--frames", "24000..24004", "--format", kind, "--out", f"video-{kind}")
        keep(suffix, f"small-{kind}.{suffix}", next((folder / f"video-{kind}").glob(f"*.{suffix}")))
    keep("raw", "small.raw", bytes(i % 251 for i in range(2 * COLUMNS * ROWS)))
    keep("tiff", "small.tiff", tiff())

    run_file = folder / "far/run.toml"
    run_file.write_text(portable(run_file.read_text()))
    keep("run_file", "small.toml", run_file)
    keep("run_file", "small-docking.toml", folder / "docking/run.toml")
    keep("camera", "small.toml", folder / "png/camera.toml")
    keep("setup", "small.toml", folder / "docking/setup.toml")
    keep("dataset", "small.csv", (folder / "png/telemetry.csv").read_text().replace("frames/", ""))
    for run, names in {
        "far": ["measurements", "telemetry", "stars"],
        "docking": ["measurements", "telemetry", "motion"],
    }.items():
        for name in names:
            table = folder / run / f"{name}.csv"
            if table.exists():
                keep("csv", f"small-{run}-{name}.csv", "\n".join(table.read_text().splitlines()[:6]) + "\n")
    keep("csv", "small-value.csv", "value\n1\n-2.5e-3\n")
    keep("csv", "small-covariances.csv", COVARIANCES)
    for path in sorted(folder.glob("far/**/*.parquet")) + sorted(folder.glob("docking/**/*.parquet")):
        keep("parquet", f"small-{path.relative_to(folder).parts[0]}-{path.name}", path)
    keep("json", "small-score.json", folder / "far/score.json")
    keep("json", "small-docking-score.json", folder / "docking/score.json")

    for run, kinds in {"far": FAR_RUN, "docking": DOCKING_RUN}.items():
        for name in kinds:
            content = (folder / run / name).read_bytes()
            keep("run_directory", f"small-{run}-{name.replace('/', '-')}", f"{run}/{name}\n".encode() + content)

    keep("study", "small.toml", bare(ROOT / "scenarios/studies/argon-optics.toml"))
    keep("study", "small-laws.toml", LAWS)
    study = STUDY
    (folder / "study.toml").write_text(study)
    boresight("study", "run", "study.toml", "--out", "study")
    keep("json", "small-summary.json", folder / "study/summary.json")
    keep("json", "small-study.json", portable((folder / "study/study.json").read_text()))
    keep("parquet", "small-cases.parquet", folder / "study/cases.parquet")
    keep("requirements", "small.toml", bare(ROOT / "scenarios/requirements/uasc-far-range.toml"))
    keep("preset", "small.toml", small(bare(ROOT / "scenarios/cameras/uasc-far-range.toml")))
    for name, text in CALIBRATIONS.items():
        keep("calibration", name, text)
    for name in ["progress", "apollo", "idss"]:
        keep("target", f"small-{name}.toml", bare(ROOT / f"scenarios/targets/{name}.toml"))
    keep("baseline", "argon.toml", ROOT / "golden/baselines/argon/baseline.toml")
    keep("baseline_rows", "argon.parquet", ROOT / "golden/baselines/argon/rows.parquet")
    keep("psf", "small.csv", "0,1,0\n1,4,1.5\n0,1e0,0\n")
    keep("mesh_glb", "small.glb", ROOT / "scenarios/targets/smallsat.glb")
    keep("mesh_obj", "small.obj", MESH)

    for path in sorted((ROOT / "golden/flight_dynamics").iterdir()):
        target = {"oem": "oem", "aem": "aem", "opm": "opm", "tdm": "tdm", "tle": "tle", "bsp": "spk"}.get(path.name.removesuffix(".xml").rpartition(".")[2])
        if target is not None:
            keep(target, f"small-{path.name}", path)
    keep("opm", "small.opm", OPM)
    keep("opm", "small.opm.xml", OPM_XML)

    keep("answer", "small-greeting", '{"boresight_pipeline": 1, "name": "mine"}\n')
    keep("answer", "small-detected", ANSWER_FAR)
    keep("answer", "small-none", '{"frame": 7, "status": "failed: no stars"}\n')
    keep("answer", "small-measured", ANSWER_DOCKING)
    keep("answer", "small-range", '{"field": 7, "status": "range_only", "range_m": 310, "sigma_range_m": 4}\n')
    for name, path, more in [
        ("page", "/", ""),
        ("report", "/api/frames/24000.json", "Origin: http://@@\r\n"),
        ("picture", "/api/frames/24001.gray", "Sec-Fetch-Site: same-origin\r\n"),
        ("other", "/%2e%2e/Cargo.toml?a=b", "Origin: null\r\n"),
    ]:
        keep("http", f"small-{name}", f"GET {path} HTTP/1.1\r\nHost: @@\r\n{more}Connection: close\r\n\r\n")

    hip_main = ["" for _ in range(78)]
    for number, text in {0: "H", 1: "7", 8: "101.28", 9: "-16.71", 11: "379.2", 12: "-546", 13: "-1223", 37: "0.01", 40: "0", 44: "-1.09"}.items():
        hip_main[number] = text
    blank = list(hip_main)
    blank[1], blank[8] = "8", ""
    keep("catalogue_dat", "small-hip_main.dat", "|".join(hip_main) + "\n" + "|".join(blank) + "\n")
    line = bytearray(b" " * 276)
    for start, text in {0: "     7", 15: " 1.7677943505", 29: "-0.2917512618", 43: " 379.21", 51: " -546.01", 60: "-1223.07", 129: "-1.0876", 152: " 0.009", 159: "0.007", 165: "-0.020"}.items():
        line[start : start + len(text)] = text.encode()
    keep("catalogue_dat", "small-hip2.dat", bytes(line) + b"\n")


def tiff():
    """Grey image of 16 bits in two strips, one of them deflated, made by hand: Boresight writes no TIFF."""
    columns, rows = 8, 4
    pixels = struct.pack(f"<{columns * rows}H", *(37 * i % 4096 for i in range(columns * rows)))
    packed = zlib.compress(pixels)
    entries = [(256, 3, 1, columns), (257, 3, 1, rows), (258, 3, 1, 16), (259, 3, 1, 8), (262, 3, 1, 1), (273, 4, 1, 8),
               (277, 3, 1, 1), (278, 3, 1, rows), (279, 4, 1, len(packed))]
    body = packed + b"\0" * (len(packed) % 2)
    directory = struct.pack("<H", len(entries)) + b"".join(struct.pack("<HHII", *entry) for entry in entries) + b"\0\0\0\0"
    return b"II*\0" + struct.pack("<I", 8 + len(body)) + body + directory


COVARIANCES = (
    "frame,status,x_px,y_px,los_j2000_x,los_j2000_y,los_j2000_z,sigma_x_px,sigma_y_px,correlation_xy,"
    "sigma_ra_deg,sigma_dec_deg,correlation_ra_dec\n"
    "1,detected,12.5,8.25,0,0.6,0.8,0.05,0.04,0.1,0.002,0.003,-0.2\n"
    "2,detected,12.5,8.25,,,,0.05,0.04,-0.999,,,\n"
    "3,no_target,,,,,,,,,,,\n"
)
OPM = """CCSDS_OPM_VERS = 2.0
CREATION_DATE = 2012-04-20T00:00:00
ORIGINATOR = A
OBJECT_NAME = A
OBJECT_ID = 2010-028B
CENTER_NAME = EARTH
REF_FRAME = TEME
TIME_SYSTEM = TDB
EPOCH = 2012-114T00:00:00.5
X = 7130.0 [km]
Y = 0.0
Z = -1e1 [km]
X_DOT = 0.0
Y_DOT = 1.0 [km/s]
Z_DOT = 7.4
MASS = 150 [kg]
MAN_EPOCH_IGNITION = 2012-04-23T01:00:00
MAN_DURATION = 2.5 [s]
MAN_DELTA_MASS = -0.1 [kg]
MAN_REF_FRAME = RTN
MAN_DV_1 = 0.0 [km/s]
MAN_DV_2 = 1e-5
MAN_DV_3 = 0.0
"""
OPM_XML = """<?xml version="1.0" encoding="UTF-8"?>
<opm id="CCSDS_OPM_VERS" version="2.0"><header><CREATION_DATE>2012-04-20T00:00:00</CREATION_DATE><ORIGINATOR>A</ORIGINATOR></header>
<body><segment><metadata><OBJECT_NAME>A</OBJECT_NAME><OBJECT_ID>A</OBJECT_ID><CENTER_NAME>EARTH</CENTER_NAME>
<REF_FRAME>GCRF</REF_FRAME><TIME_SYSTEM>GPS</TIME_SYSTEM></metadata><data><stateVector><EPOCH>2012-04-23T00:00:00</EPOCH>
<X units="km">7130</X><Y>0</Y><Z>0</Z><X_DOT units="km/s">0</X_DOT><Y_DOT>1</Y_DOT><Z_DOT>7.4</Z_DOT></stateVector></data></segment></body></opm>
"""
ANSWER_FAR = (
    '{"frame": 7, "status": "detected", "x_px": 12.5, "y_px": 400.25, "los_j2000": [0, 0.6, 0.8], '
    '"q_cam_j2000": [1, 0, 0, 0], "n_stars": 12, "sigma_x_px": 0.05, "sigma_y_px": 0.04, "correlation_xy": 0.1, '
    '"sigma_ra_deg": 0.002, "sigma_dec_deg": 0.003, "correlation_ra_dec": -0.2}\n'
)
ANSWER_DOCKING = (
    '{"field": 7, "status": "measured", "d_m": [0.1, -0.2, 9.7], "phi_deg": [0.1, 0.0, 1.2], '
    '"sigma_d_m": [0.02, 0.02, 0.01], "sigma_phi_deg": [0.1, 0.1, 0.05], "contrast": 1.4, "brightness": -0.1}\n'
)
STUDY = """title = "small"
scenario = "far.toml"
seed = 1
frames = "0..2"
[stop]
cases = 6
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "normal", mean = 0.8, sigma = 0.15, min = 0.4, max = 1.6 }
[[sweep]]
path = "sensor.bit_depth"
values = [8, 10, 12]
"""
LAWS = """title = "laws"
scenario = "argon"
seed = 1
frames = "2000..2001"
design = "saltelli"
[stop]
cases = 10
[[vary]]
path = "psf.sigma_px"
distribution = { kind = "uniform", min = 0.4, max = 1.6 }
[[vary]]
path = "attitude.control.jitter_arcsec[2]"
distribution = { kind = "log_normal", median = 15.0, sigma_ln = 0.4 }
[record]
figures = ["hit_rate"]
worst_by = "hit_rate"
"""

if __name__ == "__main__":
    main(sys.argv[1])
