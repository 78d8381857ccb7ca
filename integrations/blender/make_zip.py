#!/usr/bin/env python3
"""Makes the zip that Blender installs: integrations/blender/make_zip.py [FILE.zip], by default exitance_blender.zip here."""
from __future__ import annotations

import sys
import zipfile
from pathlib import Path

PACKAGE = Path(__file__).resolve().parent / "exitance_blender"
DATE = (2020, 1, 1, 0, 0, 0)  # of every entry, so that equal sources make equal files


def make(file: Path) -> None:
    """Writes the add-on's sources into a zip file, in a folder of the add-on's name."""
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        for source in sorted(PACKAGE.iterdir()):
            if source.suffix in (".py", ".toml"):
                entry = zipfile.ZipInfo(f"{PACKAGE.name}/{source.name}", DATE)
                entry.compress_type, entry.external_attr = zipfile.ZIP_DEFLATED, 0o644 << 16
                archive.writestr(entry, source.read_bytes())


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else Path("exitance_blender.zip")
    make(target)
    print(target)
