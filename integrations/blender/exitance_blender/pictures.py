"""Pictures of textures as PNG files that exitance reads. Needs no Blender."""
from __future__ import annotations

import struct
import zlib
from pathlib import Path

import numpy as np

LARGEST_SIDE = 1024  # pixels; exitance takes the mean over a face, so more detail has no effect


def srgb(linear: np.ndarray) -> np.ndarray:
    """Encodes linear values in [0, 1] as IEC 61966-2-1 (sRGB) does."""
    clipped = np.clip(linear, 0, 1)
    return np.where(clipped <= 0.0031308, 12.92 * clipped, 1.055 * clipped ** (1 / 2.4) - 0.055)


def reduced(pixels: np.ndarray) -> np.ndarray:
    """Returns a picture (height, width, channels) of at most LARGEST_SIDE pixels by means over blocks."""
    step = -(-max(pixels.shape[:2]) // LARGEST_SIDE)
    if step <= 1:
        return pixels
    height, width = (side // step * step for side in pixels.shape[:2])
    if height == 0 or width == 0:
        return pixels
    blocks = pixels[:height, :width].reshape(height // step, step, width // step, step, -1)
    return blocks.mean(axis=(1, 3))


def write_png(file: Path, pixels: np.ndarray) -> None:
    """Writes encoded values in [0, 1] (height, width, 3), the first row on top, as an RGB picture of eight bits."""
    height, width, _ = pixels.shape
    levels = np.round(np.clip(pixels, 0, 1) * 255).astype(np.uint8)
    rows = np.concatenate([np.zeros((height, 1), np.uint8), levels.reshape(height, -1)], axis=1)  # 0: no filter

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes())) +
                     chunk(b"IEND", b""))
