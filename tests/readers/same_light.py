#!/usr/bin/env python3
"""Checks that solutions are identical except for /exitance/statistics:   same_light.py A.h5 B.h5 ...   Needs h5py."""

import sys

import h5py
import numpy as np


def content(path):
    """Returns every data set and attribute by name, as bytes with type and shape."""
    found = {}

    def add(name, value):
        value = np.asarray(value)
        data = repr(value.tolist()) if value.dtype == object else value.tobytes()
        found[name] = (str(value.dtype), value.shape, data)

    def visit(name, thing):
        if name.startswith("exitance/statistics"):
            return
        for key, value in thing.attrs.items():
            add(f"{name}@{key}", value)
        if isinstance(thing, h5py.Dataset):
            add(name, thing[()])

    with h5py.File(path) as file:
        file.visititems(visit)
    return found


def differences(first, second):
    a, b = content(first), content(second)
    return sorted(name for name in a.keys() | b.keys() if a.get(name) != b.get(name))


if __name__ == "__main__":
    failed = False
    for other in sys.argv[2:]:
        wrong = differences(sys.argv[1], other)
        failed |= bool(wrong)
        print(other, "differs in " + ", ".join(wrong[:8]) if wrong else "holds the same light")
    sys.exit(failed)
