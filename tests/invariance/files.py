"""Writes a scene as the files that the program reads: OBJ and MTL, glTF for its camera and its lights without extent, a
photometric file with a table of luminaires, and weather."""
import json
import math
import os
import struct
import zlib

import numpy as np


def number(value):
    return "%.17g" % value


def words(values):
    return " ".join(number(v) for v in values)


def png(path, row):
    """Writes a picture with one row of pixels."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    pixels = b"\0" + bytes(v for pixel in row for v in pixel)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", len(row), 1, 8, 2, 0, 0, 0)) +
                  chunk(b"IDAT", zlib.compress(pixels)) + chunk(b"IEND", b""))


def write_materials(scene, folder):
    with open(os.path.join(folder, "scene.mtl"), "w") as out:
        for name, m in scene.materials.items():
            out.write(f"newmtl {name}\nKd {words(m.reflectance)}\nKe {words(m.radiance)}\n")
            if m.transmission:
                out.write(f"illum 4\nTf {words([m.transmission] * 3)}\n")
            if m.texture:
                png(os.path.join(folder, f"{name}.png"), m.texture)
                out.write(f"map_Kd {name}.png\n")


def write_faces(scene, folder):
    path = os.path.join(folder, "scene.obj")
    with open(path, "w") as out:
        out.write("mtllib scene.mtl\n")
        for face in scene.faces:
            out.write(f"g {face.group}\nusemtl {face.material}\n")
            textured = bool(scene.materials[face.material].texture)
            for p in face.points:
                out.write(f"v {words(p)}\n")
                if textured:  # texture coordinates do not depend on the transformation; one repetition per face
                    out.write(f"vt {face.parent % 4 / 4 + 0.125} 0.5\n")
            n = len(face.points)
            out.write("f " + " ".join(f"{i}/{i}" if textured else str(i) for i in range(-n, 0)) + "\n")
    return path


def to_gltf(v):
    """Converts Z up to glTF's Y up."""
    return [v[0], v[2], -v[1]]


def node_matrix(position, ahead, up):
    """Rotation of a camera or a spot, whose direction is its own -z."""
    ahead = ahead / np.linalg.norm(ahead)
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    columns = [right, np.cross(right, ahead), -ahead, position]
    return [v for i, c in enumerate(columns) for v in to_gltf(c) + [1.0 if i == 3 else 0.0]]


def write_camera_and_lights(scene, folder):
    nodes = [{"name": "view", "camera": 0, "matrix": node_matrix(scene.eye, scene.target - scene.eye, scene.up)}]
    lights = []
    for light in scene.lights:
        ahead = light.direction if light.direction is not None else np.array([0.0, 0.0, -1.0])
        aside = np.eye(3)[np.argmin(np.abs(ahead))]
        kind = {"type": "point"} if light.direction is None else {
            "type": "spot", "spot": {"innerConeAngle": 0, "outerConeAngle": math.radians(light.angle)}}
        nodes.append({"name": f"light {len(lights)}", "matrix": node_matrix(light.position, ahead, aside),
                      "extensions": {"KHR_lights_punctual": {"light": len(lights)}}})
        lights.append(kind | {"intensity": light.intensity})
    content = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(nodes)))}], "nodes": nodes,
               "cameras": [{"type": "perspective", "name": "view", "perspective": {"yfov": 1.0, "aspectRatio": 1.25, "znear": 0.01}}]}
    if lights:
        content |= {"extensionsUsed": ["KHR_lights_punctual"], "extensions": {"KHR_lights_punctual": {"lights": lights}}}
    path = os.path.join(folder, "view.gltf")
    with open(path, "w") as out:
        json.dump(content, out)
    return path


def aimed(axis):
    """Shortest rotation from the vertical to the opposite of a luminaire's axis."""
    up = -axis
    k = np.cross([0, 0, 1], up)
    sine = np.linalg.norm(k)
    if sine < 1e-12:
        return np.eye(3) if up[2] > 0 else np.diag([1.0, -1.0, -1.0])
    k /= sine
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    return np.eye(3) + sine * cross + (1 - up[2]) * cross @ cross


def write_luminaires(scene, folder):
    """Writes a photometric file. Intensity decreases faster in C90 than in C0; it and the opening's size follow the scale."""
    angles, planes = list(range(0, 91, 5)), [0, 22.5, 45, 67.5, 90]
    with open(os.path.join(folder, "lamp.ies"), "w") as out:
        out.write("IESNA:LM-63-2002\n[TEST] invariance\n[MANUFAC] none\nTILT=NONE\n")
        out.write(f"1 -1 {number(scene.scale**2)} {len(angles)} {len(planes)} 1 2 {words([0.3 * scene.scale, 0.6 * scene.scale, 0])}\n1 1 1\n")
        out.write(" ".join(map(str, angles)) + "\n" + " ".join(map(str, planes)) + "\n")
        for c in planes:
            power = 1 + 3 * math.sin(math.radians(c))**2
            out.write(" ".join("%.6g" % (900 * math.cos(math.radians(a))**power) for a in angles) + "\n")
    path = os.path.join(folder, "lights.csv")
    with open(path, "w") as out:
        out.write("file,x,y,z,aim_x,aim_y,aim_z,rotation\n")
        for luminaire in scene.luminaires:
            axis = -luminaire.axes[:, 2]
            about = aimed(axis).T @ luminaire.axes
            rotation = math.degrees(math.atan2(about[1, 0], about[0, 0]))
            out.write("lamp.ies," + ",".join(number(v) for v in (*luminaire.position, *axis, rotation)) + "\n")
    return path


def write_weather(folder):
    """Writes the weather of a clear day in summer and an overcast day in winter."""
    path = os.path.join(folder, "weather.epw")
    with open(path, "w") as out:
        out.write("LOCATION,Town,-,CHE,test,0,47.4,8.5,1.0,400\n" + "HEADER\n" * 7)
        for month, normal, diffuse in ((6, 600, 120), (12, 0, 60)):
            for hour in range(1, 25):
                is_day = 8 < hour < 17
                out.write(f"2021,{month},21,{hour},0,f,10,5,70,95000,0,1300,300,500,{normal if is_day else 0},{diffuse if is_day else 0},0,0,0\n")
    return path


def write_scene(scene, folder):
    """Returns the scene's files and the options of `solve` for them."""
    os.makedirs(folder, exist_ok=True)
    write_materials(scene, folder)
    files, options = [write_faces(scene, folder), write_camera_and_lights(scene, folder)], []
    if scene.luminaires:
        options += ["--luminaires", write_luminaires(scene, folder)]
    if scene.sky:
        options += ["--sky", scene.sky + f",north={number(scene.north)}"]
    if scene.lights:
        options += ["--quantity", "radiometric"]
    return files, options
