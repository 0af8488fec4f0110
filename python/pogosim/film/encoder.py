"""Frames to a film, with ffmpeg: they go through a pipe, one at a time."""

from __future__ import annotations

import shutil
import subprocess
import tempfile
from collections.abc import Iterable, Iterator
from pathlib import Path

from pogosim.errors import PictureError
from pogosim.outputs import partial_output
from pogosim.system_packages import how_to_install

# As films that runs make of themselves, docs/pictures.md: H.264 and VP9 in the colours of players, and for GIF a
# palette for each frame.
VIDEO = "scale=out_color_matrix=bt709:out_range=tv,format=yuv420p"
COLOURS = ["-colorspace", "bt709", "-color_primaries", "bt709", "-color_trc", "bt709", "-color_range", "tv"]
MP4 = ["-c:v", "libx264", "-preset", "veryfast", "-crf", "18", "-movflags", "+faststart", "-f", "mp4"]
WEBM = ["-c:v", "libvpx-vp9", "-crf", "24", "-b:v", "0", "-deadline", "good", "-cpu-used", "5", "-row-mt", "1"]
PALETTES = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=none"
FORMATS = {
    ".mp4": ["-vf", VIDEO, "-pix_fmt", "yuv420p", *COLOURS, *MP4],
    ".webm": ["-vf", VIDEO, "-pix_fmt", "yuv420p", *COLOURS, *WEBM, "-f", "webm"],
    ".gif": ["-filter_complex", PALETTES, "-loop", "0", "-f", "gif"],
}
PAGE = ".html"  # no film, but a page that replays the run
ENCODERS = {".mp4": "libx264", ".webm": "libvpx-vp9", ".gif": "gif"}


def check_ffmpeg(suffix: str) -> None:
    """Look for ffmpeg and the encoder that a format needs.

    Raises:
        PictureError: It is not there; says how to install it.
    """
    install = how_to_install("ffmpeg")
    if shutil.which("ffmpeg") is None:
        raise PictureError(f"{suffix} films need ffmpeg, which is not installed: {install}; or make a page, .html")
    command = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-encoders"]
    done = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    if ENCODERS[suffix] not in done.stdout.split():
        raise PictureError(f"this ffmpeg has no encoder {ENCODERS[suffix]}, which {suffix} films need: {install}")


def encode(frames: Iterable[memoryview], size: tuple[int, int], fps: float, film: Path) -> None:
    """Write a film. What is there stays until the new one is complete.

    Args:
        frames: Bytes of each: red, green and blue, pixel by pixel, row by row from the top.
        size: Width and height in pixels; even, unless for .gif.
        fps: Frames per second.
        film: .mp4, .webm or .gif; absolute, and no symbolic link.

    Raises:
        PictureError: ffmpeg fails; says what it said.
        OSError: The film cannot be written.
    """
    suffix = film.suffix.lower()
    with partial_output(film) as partial, tempfile.TemporaryFile() as said:
        video = ["-f", "rawvideo", "-pixel_format", "rgb24", "-video_size", f"{size[0]}x{size[1]}"]
        command = ["ffmpeg", "-hide_banner", "-loglevel", "error", "-y", *video, "-framerate", f"{fps:.6g}", "-i", "-"]
        command += [*FORMATS[suffix], f"file:{partial}"]
        with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=said) as process:
            assert process.stdin is not None
            try:
                for frame in taken(frames, process):
                    process.stdin.write(frame)
                process.stdin.close()
            except BrokenPipeError:
                pass  # it says why
            except BaseException:
                process.kill()
                raise
            code = process.wait()
        if code:
            said.seek(0)
            lines = said.read().decode("utf-8", "replace").strip().splitlines() or [f"exit code {code}"]
            raise PictureError(f"the film {film} could not be written: ffmpeg: {lines[-1]}")


def taken(frames: Iterable[memoryview], process: subprocess.Popen[bytes]) -> Iterator[memoryview]:
    """Yield frames as long as they are taken."""
    for frame in frames:
        if process.poll() is not None:
            return
        yield frame
