"""Files in the shapes in which programs write calibrations, with numbers of our own.

A shape is a title, the text, options of `boresight camera import`, and either the numbers that are read (focal
length along columns, principal point, columns, k1, p2) or a part of the reason for which it is refused.
"""

# Numbers of the files: fx, cx, cy, columns, k1, p2.
READ = [612.5, 322.0, 241.5, 640, -0.21, -4e-4]
BOTH = "--columns 640 --rows 480"


def matrix(fx=612.5, fy=612.5):
    """Rows of the camera matrix in OpenCV's notation of numbers."""
    return f"[ {fx}, 0., 322., 0., {fy},\n       2.4150000000000000e+02, 0., 0., 1. ]"


def block(key, rows, columns, data, tag=" !!opencv-matrix", indent="   "):
    """A matrix with rows, cols, dt and data."""
    return f"{key}:{tag}\n{indent}rows: {rows}\n{indent}cols: {columns}\n{indent}dt: d\n{indent}data: {data}\n"


D4 = "[ -0.21, 0.07, 3e-04, -4e-04 ]"
D5 = "[ -2.1000000000000000e-01, 7.0000000000000007e-02,\n       3.0000000000000000e-04, -4.0000000000000000e-04, 0. ]"
D8 = "[ -0.21, 0.07, 0.0003, -0.0004, 0., 0., 0., 0. ]"
D14 = "[ -0.21, 0.07, 0.0003, -0.0004, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0 ]"
SIZE = "image_width: 640\nimage_height: 480\n"
HEAD = "%YAML:1.0\n---\n"
PAIR = block("camera_matrix", 3, 3, matrix()) + block("distortion_coefficients", 5, 1, D5)
INLINE = "[612.5, 0.0, 322.0, 0.0, 612.5, 241.5, 0.0, 0.0, 1.0]"
NESTED = "[[612.5, 0.0, 322.0], [0.0, 612.5, 241.5], [0.0, 0.0, 1.0]]"


def camera_info(model="plumb_bob", coefficients="[-0.21, 0.07, 0.0003, -0.0004, 0]", count=5):
    """A camera_info file of ROS."""
    return (
        f"image_width: 640\nimage_height: 480\ncamera_name: narrow_stereo\ncamera_matrix:\n  rows: 3\n  cols: 3\n  data: {INLINE}\n"
        f"distortion_model: {model}\ndistortion_coefficients:\n  rows: 1\n  cols: {count}\n  data: {coefficients}\n"
        "rectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n"
        "projection_matrix:\n  rows: 3\n  cols: 4\n  data: [600, 0, 322, 0, 0, 600, 241, 0, 0, 0, 1, 0]\n"
    )


def camchain(camera="pinhole", model="radtan", name="cam0", intrinsics="[612.5, 612.5, 322.0, 241.5]"):
    """One camera of a camchain of Kalibr."""
    return (
        f"{name}:\n  cam_overlaps: [1]\n  camera_model: {camera}\n  distortion_coeffs: [-0.21, 0.07, 0.0003, -0.0004]\n"
        f"  distortion_model: {model}\n  intrinsics: {intrinsics}\n  resolution: [640, 480]\n  rostopic: /{name}/image_raw\n"
    )


POSE = "  T_cn_cnm1:\n  - [1.0, 0.0, 0.0, -0.11]\n  - [0.0, 1.0, 0.0, 0.0]\n  - [0.0, 0.0, 1.0, 0.0]\n  - [0.0, 0.0, 0.0, 1.0]\n"
POINTS = "image_points: !!opencv-matrix\n   rows: 40\n   cols: 54\n   dt: \"2f\"\n   data: [ " + ",\n       ".join(["1.5e+02, 2.5e+02"] * 2160) + " ]\n"

SHAPES = [
    ("calibration sample, OpenCV 4", HEAD + 'calibration_time: "Thu Jan  1 00:00:00 2026"\n' + SIZE + "flags: 0\n" + PAIR + "avg_reprojection_error: 3.2e-01\n", "", READ),
    ("calibration sample, OpenCV 2, no mark of the document", "%YAML:1.0\ncalibration_time: \"01/01/26 00:00:00\"\n\n" + SIZE + PAIR, "", READ),
    ("tutorial, OpenCV 3, comment of flags", HEAD + 'nr_of_frames: 25\n' + SIZE + "board_width: 9\n# flags: +fix_aspectRatio\nflags: 2\nfisheye_model: 0\n" + PAIR, "", READ),
    ("tutorial, OpenCV 2.4, capital letters", "%YAML:1.0\nimage_Width: 640\nimage_Height: 480\n" + block("Camera_Matrix", 3, 3, matrix()) + block("Distortion_Coefficients", 5, 1, D5), "", READ),
    ("calibration sample with image points", HEAD + SIZE + PAIR + POINTS, "", READ),
    ("exponents of three digits, of Windows", HEAD + SIZE + PAIR.replace("e+02", "e+002").replace("e-01", "e-001"), "", READ),
    ("line ends of Windows", (HEAD + SIZE + PAIR).replace("\n", "\r\n"), "", READ),
    ("byte order mark", "\ufeff" + HEAD + SIZE + PAIR, "", READ),
    ("blank lines between the lines", (HEAD + SIZE + PAIR).replace("\n", "\n\n"), "", READ),
    ("stereo sample, second camera, no size", HEAD + block("M1", 3, 3, matrix(500, 500)) + block("D1", 1, 14, D14) + block("M2", 3, 3, matrix()) + block("D2", 1, 14, D14), f"--name 2 {BOTH}", READ),
    ("stereo sample without a name", HEAD + block("M1", 3, 3, matrix()) + block("D1", 1, 5, D5) + block("M2", 3, 3, matrix()) + block("D2", 1, 5, D5), BOTH, "several cameras"),
    ("cameraMatrix1, distCoeffs1, imageSize", HEAD + "imageSize: [ 640, 480 ]\n" + "".join(block(f"cameraMatrix{n}", 3, 3, matrix()) + block(f"distCoeffs{n}", 1, 5, D5) for n in (1, 2)), "--name 1", READ),
    ("K_left, D_left", HEAD + "image_size: [ 640, 480 ]\n" + "".join(block(f"K_{side}", 3, 3, matrix()) + block(f"D_{side}", 1, 4, D4) for side in ("left", "right")), "--name left", READ),
    ("LEFT.K, LEFT.D with width and height beside", HEAD + "LEFT.height: 480\nLEFT.width: 640\n" + block("LEFT.D", 1, 5, D5) + block("LEFT.K", 3, 3, matrix()), BOTH, READ),
    ("intrinsics and coefficients of both sides in JSON", '{"width": 640, "height": 480, "left_camera_matrix": %s, "left_distortion": [-0.21, 0.07, 0.0003, -0.0004]}' % NESTED, "", READ),
    ("JSON of FileStorage with tabs", '{\n\t"image_width": 640,\n\t"image_height": 480,\n\t"camera_matrix": {\n\t\t"type_id": "opencv-matrix",\n\t\t"rows": 3,\n\t\t"cols": 3,\n\t\t"dt": "d",\n\t\t"data": %s\n\t},\n\t"distortion_coefficients": {\n\t\t"type_id": "opencv-matrix", "rows": 1, "cols": 5, "dt": "d",\n\t\t"data": [-0.21, 0.07, 0.0003, -0.0004, 0.0]\n\t}\n}\n' % INLINE, "", READ),
    ("JSON on one line", '{"camera_matrix":%s,"distortion_coefficients":[[-0.21,0.07,3e-4,-4e-4,0.0]],"image_size":[640,480]}' % NESTED, "", READ),
    ("JSON with the size in a table", '{"camera_matrix": %s, "distortion_coefficients": [-0.21, 0.07, 0.0003, -0.0004, 0], "calibration_info": {"image_size": [640, 480]}}' % NESTED, "", READ),
    ("JSON of sensors below each other", '{"sensors": {"RGB": {"intrinsics": {"type_id": "opencv-matrix", "rows": 3, "cols": 3, "dt": "d", "data": %s}, "distortionCoefficients": {"rows": 1, "cols": 5, "data": [-0.21, 0.07, 0.0003, -0.0004, 0.0]}}}}' % INLINE, BOTH, READ),
    ("YAML of PyYAML, block lists", "camera_matrix:\n- - 612.5\n  - 0.0\n  - 322.0\n- - 0.0\n  - 612.5\n  - 241.5\n- - 0.0\n  - 0.0\n  - 1.0\ndist_coeff:\n- - -0.21\n  - 0.07\n  - 0.0003\n  - -0.0004\n  - 0.0\n", BOTH, READ),
    ("YAML of PyYAML, mtx and dist in a tuple", f"!!python/tuple\n- dist: [[-0.21, 0.07, 0.0003, -0.0004, 0.0]]\n  mtx: {NESTED}\n  ret: 0.3\n", BOTH, READ),
    ("YAML of PyYAML, an alias", f"left: &id001\n  K: {NESTED}\n  D: [-0.21, 0.07, 0.0003, -0.0004]\nright: *id001\n", f"--name right {BOTH}", READ),
    ("four coefficients and a lens of the name OPENCV", SIZE + f"distortion_model: OPENCV\ncamera_matrix: {{rows: 3, cols: 3, data: {INLINE}}}\ndistortion_coefficients: {{rows: 1, cols: 4, data: {D4}}}\n", "", READ),
    ("camera_info of ROS", camera_info(), "", READ),
    ("camera_info, rows of the matrix on lines", camera_info().replace(INLINE, "[612.5, 0. , 322. ,\n           0. , 612.5, 241.5,\n           0. , 0. , 1. ]"), "", READ),
    ("camera_info without the model", camera_info().replace("distortion_model: plumb_bob\n", ""), "", READ),
    ("camera_info with a misspelt key", camera_info().replace("distortion_coefficients", "distortion_coefficents"), "", READ),
    ("camera_info, rational model with zeros", camera_info("rational_polynomial", "[-0.21, 0.07, 0.0003, -0.0004, 0, 0, 0, 0]", 8), "", READ),
    ("camera_info, rational model", camera_info("rational_polynomial", "[-0.21, 0.07, 0.0003, -0.0004, 0, 0.3, 0.02, 0.01]", 8), "", "rational model"),
    ("camera_info, fisheye", camera_info("equidistant", "[-0.21, 0.07, 0.0003, -0.0004]", 4), "", "equidistant"),
    ("printed message of ROS 1", f"header: \n  seq: 0\n  stamp: \n    secs: 0\n    nsecs:         0\n  frame_id: cam\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nD: [-0.21, 0.07, 0.0003, -0.0004, 0.0]\nK: {INLINE}\nR: [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0]\nP: [612.5, 0.0, 322.0, 0.0, 0.0, 612.5, 241.5, 0.0, 0.0, 0.0, 1.0, 0.0]\nbinning_x: 0\nbinning_y: 0\nroi: \n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: False\n---\n", "", READ),
    ("printed message of ROS 2", "header:\n  stamp:\n    sec: 5\n    nanosec: 6\n  frame_id: cam\nheight: 480\nwidth: 640\ndistortion_model: plumb_bob\nd:\n- -0.21\n- 0.07\n- 0.0003\n- -0.0004\n- 0.0\nk:\n- 612.5\n- 0.0\n- 322.0\n- 0.0\n- 612.5\n- 241.5\n- 0.0\n- 0.0\n- 1.0\nbinning_x: 0\nbinning_y: 0\nroi:\n  x_offset: 0\n  y_offset: 0\n  height: 0\n  width: 0\n  do_rectify: false\n---\n", "", READ),
    ("printed message of a binned camera", f"height: 480\nwidth: 640\ndistortion_model: plumb_bob\nD: [-0.21, 0.07, 0.0003, -0.0004, 0.0]\nK: {INLINE}\nbinning_x: 2\nbinning_y: 2\n", "", "binning_x"),
    ("message of a device below its name", f"front:\n  height: 480\n  width: 640\n  distortion_model: plumb_bob\n  d: [-0.21, 0.07, 0.0003, -0.0004, 0.0]\n  k: {INLINE}\n", "--name front", READ),
    ("camchain of one camera", camchain(), "", READ),
    ("camchain of two cameras", camchain(name="cam0", intrinsics="[500.0, 500.0, 1.0, 2.0]") + camchain(name="cam1") + POSE, "--name cam1", READ),
    ("camchain of two cameras without a name", camchain() + camchain(name="cam1"), "", "cam0, cam1"),
    ("camchain with the turn to an inertial unit", camchain() + "  T_cam_imu:\n  - [1, 0, 0, 0]\n  - [0, 1, 0, 0]\n  - [0, 0, 1, 0]\n  - [0, 0, 0, 1]\n  timeshift_cam_imu: 0.0\n", "", READ),
    ("camchain, fisheye", camchain(model="equidistant"), "", "equidistant"),
    ("camchain, field of view", camchain(model="fov"), "", "fov"),
    ("camchain, omnidirectional", camchain(camera="omni", intrinsics="[1.2, 612.5, 612.5, 322.0, 241.5]"), "", "omni"),
    ("camchain, double sphere", camchain(camera="ds", model="none", intrinsics="[-0.2, 0.6, 612.5, 612.5, 322.0, 241.5]"), "", "ds"),
    ("camchain, extended unified", camchain(camera="eucm", model="none", intrinsics="[0.6, 1.1, 612.5, 612.5, 322.0, 241.5]"), "", "eucm"),
    ("camchain, no distortion", camchain(model="none").replace("[-0.21, 0.07, 0.0003, -0.0004]", "[]"), "", [612.5, 322.0, 241.5, 640, 0.0, 0.0]),
    ("sensor.yaml of a data set", "%YAML:1.0\nsensor_type: camera\ncomment: VI-Sensor cam0\nT_BS:\n  cols: 4\n  rows: 4\n  data: [1.0, 0.0, 0.0, 0.0,\n         0.0, 1.0, 0.0, 0.0,\n         0.0, 0.0, 1.0, 0.0,\n         0.0, 0.0, 0.0, 1.0]\nrate_hz: 20\nresolution: [640, 480]\ncamera_model: pinhole\nintrinsics: [612.5, 612.5, 322.0, 241.5] #fu, fv, cu, cv\ndistortion_model: radial-tangential\ndistortion_coefficients: [-0.21, 0.07, 0.0003, -0.0004]\n", "", READ),
    ("calibration sample, fisheye", HEAD + SIZE + "fisheye_model: 1\n" + block("camera_matrix", 3, 3, matrix()) + block("distortion_coefficients", 4, 1, D4), "", "fisheye"),
    ("rational model of eight terms", HEAD + SIZE + block("M1", 3, 3, matrix()) + block("D1", 1, 8, "[ -0.21, 0.07, 0., 0., -0.02, 0.3, -0.52, -0.12 ]"), "", "rational model"),
    ("thin prism", HEAD + SIZE + block("camera_matrix", 3, 3, matrix()) + block("dist_coeffs", 1, 12, "[ -0.21, 0.07, 0, 0, 0, 0, 0, 0, 1e-3, 0, 0, 0 ]"), "", "thin prism"),
    ("tilted sensor", HEAD + SIZE + block("camera_matrix", 3, 3, matrix()) + block("dist_coeffs", 1, 14, "[ -0.21, 0.07, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1e-2, 0 ]"), "", "tilted"),
    ("omnidirectional module", HEAD + SIZE + "xi: 1.1\n" + PAIR, "", "omnidirectional"),
    ("matrix of MATLAB, transposed", SIZE + "K: [[612.5, 0, 0], [0, 612.5, 0], [322.0, 241.5, 1]]\nD: [0, 0, 0, 0]\n", "", "row 2, column 0"),
    ("matrix with skew", SIZE + "K: [[612.5, 0.4, 322.0], [0, 612.5, 241.5], [0, 0, 1]]\nD: [0, 0, 0, 0]\n", "", "skew"),
    ("settings of a program without a matrix", HEAD + "Camera.fx: 612.5\nCamera.fy: 612.5\nCamera.k1: -0.21\n", "", "no camera"),
    ("calibration that did not converge", HEAD + SIZE + block("camera_matrix", 3, 3, "[ .Nan, 0., .Nan, 0., .Nan, .Nan, 0., 0., 1. ]") + block("distortion_coefficients", 5, 1, D5), "", "finite"),
]
