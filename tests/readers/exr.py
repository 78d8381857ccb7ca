"""Reads OpenEXR scanline files of 32-bit floats with ZIP compression, by the format's description."""
import struct
import zlib

import numpy as np


def read_exr(path):
    """Returns header attributes (bytes) and channels (height x width arrays), both by name."""
    data = open(path, "rb").read()
    assert data[:4] == b"\x76\x2f\x31\x01" and data[4] == 2
    at = 8

    def text():
        nonlocal at
        end = data.index(b"\0", at)
        word, at = data[at:end].decode(), end + 1
        return word

    header = {}
    while data[at]:
        name, kind = text(), text()
        size, = struct.unpack_from("<i", data, at)
        header[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    at += 1
    x0, y0, x1, y1 = struct.unpack("<4i", header["dataWindow"])
    width, height = x1 - x0 + 1, y1 - y0 + 1
    assert header["compression"] == b"\x03", "ZIP"
    names, rest = [], header["channels"]
    while rest[0]:
        end = rest.index(b"\0")
        names.append(rest[:end].decode())
        assert struct.unpack_from("<i", rest, end + 1)[0] == 2, "float"
        rest = rest[end + 17:]
    image = np.empty((len(names), height, width), np.float32)
    offsets = struct.unpack_from("<%dQ" % ((height + 15) // 16), data, at)
    for offset in offsets:
        y, size = struct.unpack_from("<2i", data, offset)
        lines = min(16, height - (y - y0))
        raw, whole = data[offset + 8:offset + 8 + size], lines * width * 4 * len(names)
        if size < whole:
            bytes_ = np.frombuffer(zlib.decompress(raw), np.uint8).astype(np.int64)
            bytes_ = (np.cumsum(bytes_) - 128 * np.arange(len(bytes_))) % 256  # each byte is a difference plus 128
            half = (len(bytes_) + 1) // 2
            woven = np.empty(len(bytes_), np.uint8)
            woven[0::2], woven[1::2] = bytes_[:half], bytes_[half:]
            raw = woven.tobytes()
        block = np.frombuffer(raw, "<f4").reshape(lines, len(names), width)
        image[:, y - y0:y - y0 + lines] = block.transpose(1, 0, 2)
    return header, dict(zip(names, image))
