"""Reads what --export wrote, with nothing but Python's own library, and holds the files against each other.

Usage: read_frames.py FOLDER SPACING RATE    FOLDER: a run's frames/ with all five kinds. Prints what it saw; exits 1
with a sentence where something is not as it should be.
"""
import base64
import csv
import json
import math
import struct
import sys
import xml.etree.ElementTree as ElementTree
from pathlib import Path

SIZES = {"float": "f", "uchar": "B", "uint": "I"}


def must(truth, sentence):
    if not truth:
        sys.exit("read_frames.py: " + sentence)


def read_ply(file):
    """Elements by name, each a dict of columns; comments as a list. Lists only as the triangles of a face."""
    data = file.read_bytes()
    head, body = data.split(b"end_header\n", 1)
    comments, elements = [], []
    for line in head.decode().splitlines():
        word = line.split()
        if word[0] == "comment":
            comments.append(line[8:])
        elif word[0] == "element":
            elements.append((word[1], int(word[2]), []))
        elif word[0] == "property":
            elements[-1][2].append(word[1:])
    out, at = {}, 0
    for name, count, properties in elements:
        if properties[0][0] == "list":
            rows = list(struct.iter_unpack("<BIII", body[at:at + 13 * count]))
            must(all(row[0] == 3 for row in rows), f"{file}: not triangles alone")
            out[name] = [row[1:] for row in rows]
            at += 13 * count
            continue
        row = struct.Struct("<" + "".join(SIZES[kind] for kind, _ in properties))
        rows = list(row.iter_unpack(body[at:at + row.size * count]))
        at += row.size * count
        out[name] = {p[1]: [r[i] for r in rows] for i, p in enumerate(properties)}
    must(at == len(body), f"{file}: {len(body) - at} bytes too many")
    return out, comments


def read_vtu(file):
    root = ElementTree.parse(file).getroot()
    grid = root.find("UnstructuredGrid")
    time = float(grid.find("FieldData/DataArray").text)
    piece = grid.find("Piece")
    appended = root.find("AppendedData").text.strip()[1:]
    kinds = {"Float32": "f", "Int64": "q", "UInt8": "B", "UInt32": "I"}
    arrays = {}
    for array in piece.iter("DataArray"):
        start = int(array.get("offset"))
        size = struct.unpack("<Q", base64.b64decode(appended[start:start + 12])[:8])[0]
        block = base64.b64decode(appended[start:start + (size + 8 + 2) // 3 * 4])[8:]
        must(len(block) == size, f"{file}: {array.get('Name')} is cut short")
        values = [v[0] for v in struct.iter_unpack("<" + kinds[array.get("type")], block)]
        lanes = int(array.get("NumberOfComponents"))
        arrays[array.get("Name")] = list(zip(*[iter(values)] * lanes)) if lanes > 1 else values
    must(len(arrays["Points"]) == int(piece.get("NumberOfPoints")), f"{file}: points are missing")
    must(arrays["offsets"][-1] == len(arrays["connectivity"]), f"{file}: cells are not vertices")
    return arrays, time


def read_glb(file):
    data = file.read_bytes()
    magic, version, length, json_length, json_kind = struct.unpack("<4sIIII", data[:20])
    must((magic, version, length, json_kind) == (b"glTF", 2, len(data), 0x4E4F534A), f"{file}: not a .glb")
    document = json.loads(data[20:20 + json_length])
    buffer = data[20 + json_length + 8:]
    def accessor(number):
        a = document["accessors"][number]
        view = document["bufferViews"][a["bufferView"]]
        lanes = {"SCALAR": 1, "VEC3": 3}[a["type"]]
        kind = {5126: "f", 5125: "I"}[a["componentType"]]
        start = view.get("byteOffset", 0)
        values = [v[0] for v in struct.iter_unpack("<" + kind, buffer[start:start + 4 * lanes * a["count"]])]
        return list(zip(*[iter(values)] * lanes)) if lanes > 1 else values
    meshes = []
    for mesh in document["meshes"]:
        part = mesh["primitives"][0]
        meshes.append({name: accessor(number) for name, number in part["attributes"].items()})
        meshes[-1]["triangles"] = list(zip(*[iter(accessor(part["indices"]))] * 3))
        meshes[-1]["name"] = mesh["name"]
    return meshes, document["scenes"][0]["extras"]["time_s"]


def volume(places, triangles):
    return sum(ax * (by * cz - bz * cy) + ay * (bz * cx - bx * cz) + az * (bx * cy - by * cx)
               for (ax, ay, az), (bx, by, bz), (cx, cy, cz) in
               ((places[a], places[b], places[c]) for a, b, c in triangles)) / 6


def open_edges(triangles):
    edges = {}
    for a, b, c in triangles:
        for edge in ((a, b), (b, c), (c, a)):
            edges[edge] = edges.get(edge, 0) + 1
    return sum(1 for (a, b), count in edges.items() if count != 1 or edges.get((b, a)) != 1)


def main():
    folder, spacing, rate = Path(sys.argv[1]), float(sys.argv[2]), float(sys.argv[3])
    frames = list(csv.DictReader(open(folder / "frames.csv")))
    must(len(frames) >= 3, "fewer than three frames")
    index = ElementTree.parse(folder / "particles.pvd").getroot().findall("Collection/DataSet")
    must(len(index) == len(frames), "particles.pvd lists other frames")
    worst = 0.0
    for frame, listed in zip(frames, index):
        number, time = int(frame["frame"]), float(frame["time_s"])
        must(0 <= time - number / rate < 0.01, f"frame {number} is of {time} s")
        must(listed.get("file") == f"particles_{number:05d}.vtu" and abs(float(listed.get("timestep")) - time) < 1e-9,
             "particles.pvd has another time")
        ply, comments = read_ply(folder / f"particles_{number:05d}.ply")
        must(f"time_s {frame['time_s']}" in comments, f"no time in {comments}")
        must(abs(float(next(c for c in comments if c.startswith("spacing_m")).split()[1]) - spacing) < 1e-9, "spacing")
        p = ply["vertex"]
        vtu, vtu_time = read_vtu(folder / f"particles_{number:05d}.vtu")
        must(abs(vtu_time - time) < 1e-9, f"the .vtu is of {vtu_time}")
        must(len(p["x"]) == len(vtu["Points"]) == int(frame["particles"]), "counts of particles differ")
        must(p["id"] == sorted(set(p["id"])) == vtu["id"], "ids")
        must(p["fluid"] == vtu["fluid"] and p["pressure"] == vtu["pressure"], "attributes differ")
        # Blender's axes are glTF's turned about x.
        must(all((x, -z, y) == (px, py, pz) for (x, y, z), px, py, pz in zip(vtu["Points"], p["x"], p["y"], p["z"])),
             "places differ")
        must(all((x, -z, y) == (px, py, pz)
                 for (x, y, z), px, py, pz in zip(vtu["velocity"], p["vx"], p["vy"], p["vz"])), "velocities differ")
        must(all(map(math.isfinite, p["pressure"])), "a pressure is no number")

        surface, _ = read_ply(folder / f"surface_{number:05d}.ply")
        s = surface["vertex"]
        places = list(zip(s["x"], s["y"], s["z"]))
        must(open_edges(surface["face"]) == 0, f"surface {number} is not closed: {open_edges(surface['face'])}")
        enclosed = volume(places, surface["face"])
        particles = spacing ** 3 * len(p["x"])
        worst = max(worst, abs(enclosed / particles - 1))
        must(abs(enclosed / particles - 1) < 0.01, f"the surface holds {enclosed / particles:.4f} of the particles' volume")
        must(abs(float(frame["surface_volume_m3"]) / enclosed - 1) < 1e-3, "frames.csv has another volume")
        must(abs(float(frame["particle_volume_m3"]) / particles - 1) < 1e-6, "frames.csv has another particle volume")
        for axis, own in (("x", p["x"]), ("y", p["y"]), ("z", p["z"])):
            must(min(own) - spacing < min(s[axis]) < min(own) and max(own) < max(s[axis]) < max(own) + spacing,
                 f"the surface is not around the particles along {axis}")
        meshes, glb_time = read_glb(folder / f"surface_{number:05d}.glb")
        must(abs(glb_time - time) < 1e-9, f"the .glb is of {glb_time}")
        must([(x, -z, y) for m in meshes for x, y, z in m["POSITION"]] == places, "the .glb has other places")
        must([q for m in meshes for q in m["_PRESSURE"]] == s["pressure"], "the .glb has other pressures")
        must(volume(meshes[0]["POSITION"], meshes[0]["triangles"]) > 0, "the .glb is inside out")
        must((folder / f"surface_{number:05d}.vdb").read_bytes()[:4] == b"\x20BDV", "not a .vdb")
    print(f"{len(frames)} frames of {len(p['x'])} particles, surfaces closed, volume within {100 * worst:.2f} %")


main()
