#!/usr/bin/env python3
"""Reads exports of one solution with VTK's readers and compares their areas and fluxes: read_export.py FOLDER

FOLDER holds s.vtkhdf, s.vtu, s.glb, s.obj and s.csv.
"""
import csv
import json
import struct
import sys

import numpy as np
import vtk
from vtk.util.numpy_support import vtk_to_numpy

folder = sys.argv[1] + "/"


def read(reader, name):
    reader.SetFileName(folder + name)
    reader.Update()
    return reader.GetOutput()


def triangulated(data):
    surface = vtk.vtkDataSetSurfaceFilter()
    surface.SetInputData(data)
    triangles = vtk.vtkTriangleFilter()
    triangles.SetInputConnection(surface.GetOutputPort())
    triangles.Update()
    return triangles.GetOutput()


def area_and_flux(points, cells, values):
    corner = points[cells]
    area = np.linalg.norm(np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]), axis=1) / 2
    return area.sum(), (area[:, None] * values[cells].mean(axis=1)).sum(axis=0)


def of_vtk(data):
    mesh = triangulated(data)
    cells = vtk_to_numpy(mesh.GetPolys().GetData()).reshape(-1, 4)[:, 1:]
    return area_and_flux(vtk_to_numpy(mesh.GetPoints().GetData()), cells,
                         vtk_to_numpy(mesh.GetPointData().GetArray("radiosity")))


hdf = read(vtk.vtkHDFReader(), "s.vtkhdf")
vtu = read(vtk.vtkXMLUnstructuredGridReader(), "s.vtu")
assert hdf.GetNumberOfCells() == vtu.GetNumberOfCells() > 0
for name in ("radiosity", "irradiance"):
    assert np.array_equal(*(vtk_to_numpy(g.GetPointData().GetArray(name)) for g in (hdf, vtu)))
for name in ("surface", "region", "material", "group"):
    assert np.array_equal(*(vtk_to_numpy(g.GetCellData().GetArray(name)) for g in (hdf, vtu)))
assert b"W/m^2" in open(folder + "s.vtu", "rb").read(200) and b"W/m^2" in open(folder + "s.obj", "rb").read(200)
area, flux = of_vtk(vtu)

# First decode the glTF file directly, to check every accessor, then with VTK's reader.
data = open(folder + "s.glb", "rb").read()
magic, version, length, json_length, kind = struct.unpack_from("<4sIII4s", data)
assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON") and json_length % 4 == 0
gltf = json.loads(data[20:20 + json_length])
binary_length, kind = struct.unpack_from("<I4s", data, 20 + json_length)
binary = data[28 + json_length:]
assert kind == b"BIN\0" and binary_length == len(binary) == gltf["buffers"][0]["byteLength"]


def accessor(i):
    a = gltf["accessors"][i]
    view = gltf["bufferViews"][a["bufferView"]]
    start = view["byteOffset"] + a["byteOffset"]
    columns = {"VEC3": 3, "SCALAR": 1}[a["type"]]
    kind = {5126: "<f4", 5125: "<u4"}[a["componentType"]]
    assert a["byteOffset"] + 4 * columns * a["count"] <= view["byteLength"]
    values = np.frombuffer(binary, kind, a["count"] * columns, start)
    return values.reshape(-1, columns) if columns > 1 else values


glb_area, glb_flux = 0, 0
for mesh in gltf["meshes"]:
    for primitive in mesh["primitives"]:
        values = {name: accessor(i) for name, i in primitive["attributes"].items()}
        index = accessor(primitive["indices"])
        assert index.max() < len(values["POSITION"])
        box = gltf["accessors"][primitive["attributes"]["POSITION"]]
        assert np.allclose(values["POSITION"].min(axis=0), box["min"]) and np.allclose(values["POSITION"].max(axis=0), box["max"])
        assert values["COLOR_0"].min() >= 0 and values["COLOR_0"].max() <= 1
        assert np.allclose(np.linalg.norm(values["NORMAL"], axis=1), 1, atol=1e-6)
        cells = index.reshape(-1, 3)
        corner = values["POSITION"][cells]
        facing = np.einsum("ij,ij->i", np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0]),
                           values["NORMAL"][cells[:, 0]])
        assert facing.min() > -1e-9, "triangles wind with their normals"
        material = gltf["materials"][primitive["material"]]
        rho = np.array(material["pbrMetallicRoughness"]["baseColorFactor"][:3])
        radiance = np.array(material.get("emissiveFactor", [0, 0, 0])) * material["extensions"].get(
            "KHR_materials_emissive_strength", {}).get("emissiveStrength", 0)
        assert np.allclose(values["_RADIOSITY"], np.pi * radiance + rho * values["_IRRADIANCE"], rtol=1e-5)
        a, f = area_and_flux(values["POSITION"].astype(float), cells, values["_RADIOSITY"])
        glb_area, glb_flux = glb_area + a, glb_flux + f
assert np.isclose(glb_area, area, rtol=1e-5)
# Quadrilaterals may be split along either diagonal. Values are random here, so the flux depends on the choice.
assert np.allclose(glb_flux, flux, rtol=0.05), (glb_flux, flux)

reader = vtk.vtkGLTFReader()
reader.SetFileName(folder + "s.glb")
reader.Update()
append = vtk.vtkAppendPolyData()
blocks = reader.GetOutput().NewIterator()
while not blocks.IsDoneWithTraversal():
    append.AddInputData(blocks.GetCurrentDataObject())
    blocks.GoToNextItem()
append.Update()
low = np.array(append.GetOutput().GetBounds())[[0, 2, 4]]
assert np.allclose(low, [vtu.GetBounds()[0], vtu.GetBounds()[4], -vtu.GetBounds()[3]], atol=1e-6), "Y is up"

obj = read(vtk.vtkOBJReader(), "s.obj")
assert obj.GetNumberOfPoints() == vtu.GetNumberOfPoints() and obj.GetNumberOfPolys() == vtu.GetNumberOfCells()
assert np.allclose(obj.GetBounds(), vtu.GetBounds(), atol=1e-6)

with open(folder + "s.csv", newline="") as f:
    rows = list(csv.DictReader(f))
assert np.isclose(sum(float(r["area [m^2]"]) for r in rows), area, rtol=1e-6)
table = [sum(float(r["area [m^2]"]) * float(r["B_" + b + " [W/m^2]"]) for r in rows) for b in "rgb"]
# The table integrates bilinear elements exactly; triangles only approximate them.
assert np.allclose(table, flux, rtol=0.05), (table, flux)
assert [int(r["line"]) for r in rows] == list(range(10, 21)) and rows[9]["material"] == "sign \u00e9"
print("good")
