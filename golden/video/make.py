"""Makes small video files with FFmpeg's writers (PyAV): 4 frames of 48 x 35 or 48 x 36, grey values known.

Grey of the pixel (x, y) of frame k: 20 + 2 x + 2 y + 15 k.
"""

import pathlib
import sys

import av
import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(FOLDER.parent))
import manifest  # noqa: E402


def grey(rows, k):
    y, x = np.mgrid[0:rows, 0:48]
    return (20 + 2 * x + 2 * y + 15 * k).astype(np.uint8)


def with_ffmpeg(name, container, codec, pixels, rows, **options):
    """Writes the frames unchanged: the grey values are the plane Y, or all three colours."""
    with av.open(str(FOLDER / name), "w", format=container, options={"fflags": "+bitexact", **options}) as file:
        stream = file.add_stream(codec, rate=25)
        stream.width, stream.height, stream.pix_fmt = 48, rows, pixels
        if codec == "mjpeg":
            stream.codec_context.options = {"qmin": "1", "qmax": "1"}
        stream.codec_context.flags |= av.codec.context.Flags.bitexact
        for k in range(4):
            image = grey(rows, k)
            if pixels == "gray":
                frame = av.VideoFrame.from_ndarray(image, format="gray")
            elif pixels == "bgr24":
                frame = av.VideoFrame.from_ndarray(np.dstack([image] * 3), format="bgr24")
            else:
                frame = av.VideoFrame(48, rows, pixels)
                for i, (plane, height) in enumerate(zip(frame.planes, plane_rows(pixels, rows))):
                    data = np.full((height, plane.line_size), 128, np.uint8)
                    if pixels in ("yuyv422", "uyvy422"):
                        first = 0 if pixels == "yuyv422" else 1
                        data[:, first : 2 * 48 : 2] = image
                    elif i == 0:
                        data[:, :48] = image
                    plane.update(data.tobytes())
            frame.pts = k
            for packet in stream.encode(frame):
                file.mux(packet)
        for packet in stream.encode():
            file.mux(packet)


def plane_rows(pixels, rows):
    chroma = {"yuv420p": (rows + 1) // 2, "yuvj420p": (rows + 1) // 2, "yuv422p": rows}.get(pixels)
    return [rows, chroma, chroma] if chroma else [rows]


def main():
    arguments = manifest.begin()
    with_ffmpeg("mjpeg.avi", "avi", "mjpeg", "yuvj420p", 36)
    with_ffmpeg("grey.avi", "avi", "rawvideo", "gray", 35)
    with_ffmpeg("bgr24.avi", "avi", "rawvideo", "bgr24", 35)
    with_ffmpeg("yuy2.avi", "avi", "rawvideo", "yuyv422", 35)
    with_ffmpeg("uyvy.avi", "avi", "rawvideo", "uyvy422", 35)
    with_ffmpeg("i420.avi", "avi", "rawvideo", "yuv420p", 36)
    with_ffmpeg("mono.y4m", "yuv4mpegpipe", "wrapped_avframe", "gray", 35)
    with_ffmpeg("420.y4m", "yuv4mpegpipe", "wrapped_avframe", "yuv420p", 35)
    with_ffmpeg("422.y4m", "yuv4mpegpipe", "wrapped_avframe", "yuv422p", 35)
    for path in sorted(FOLDER.glob("*.avi")) + sorted(FOLDER.glob("*.y4m")):
        manifest.record(path, arguments.reason)
    manifest.record(__file__, arguments.reason)
    manifest.record(FOLDER / "requirements.txt", arguments.reason)


if __name__ == "__main__":
    main()
