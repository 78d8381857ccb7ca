#!/usr/bin/env python3
"""Reads a solution with h5py and with VTK and compares both: read_solution.py SOLUTION.h5"""
import sys

import h5py
import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

path = sys.argv[1]
with h5py.File(path) as f:
    # The three lines in the documentation.
    points = f["VTKHDF/Points"][:]
    radiosity = f["VTKHDF/PointData/radiosity"][:]
    irradiance = f["VTKHDF/PointData/irradiance"][:]

    material = f["VTKHDF/CellData/material"][:]
    offsets = f["VTKHDF/Offsets"][:]
    rho = f["exitance/scene/material_reflectance"][:]
    exitance = f["exitance/scene/material_exitance"][:]
    of_point = np.repeat(material, np.diff(offsets))
    assert np.allclose(radiosity, exitance[of_point] + rho[of_point] * irradiance, rtol=1e-6)

    sets = []
    f.visititems(lambda name, item: sets.append((name, item)) if isinstance(item, h5py.Dataset) else None)
    for name, item in sets:
        assert item.attrs["units"] and item.attrs["long_name"], name
    assert f["exitance/statistics"].attrs["threads"] == 2
    assert abs(f["exitance/statistics/seconds"].attrs["total"] - 1.5) < 1e-15
    assert list(f["exitance/statistics/warnings"][:]) == [b"the room is open", b"it is dark in there"]
    assert f["exitance/options"][()].startswith(b"{")
    assert f["exitance/scene/material_name"].asstr()[:][3] == "sign \u00e9"

reader = vtk.vtkHDFReader()
reader.SetFileName(path)
reader.Update()
grid = reader.GetOutput()
assert grid.GetNumberOfPoints() == len(points) and grid.GetNumberOfCells() == len(material)
assert np.array_equal(vtk_to_numpy(grid.GetPoints().GetData()), points)
assert np.array_equal(vtk_to_numpy(grid.GetPointData().GetArray("radiosity")), radiosity)
assert np.array_equal(vtk_to_numpy(grid.GetCellData().GetArray("material")), material)
print("good")
