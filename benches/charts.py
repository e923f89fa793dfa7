#!/usr/bin/env python3
"""Charts of the same meshes by texrender and xatlas, in turn: seconds, utilisation, stretch, charts turned over.

    cargo build --release -p texrender-rs
    pip install numpy xatlas
    benches/charts.py [--threads N] [MODEL.glb|MODEL.gltf ...]

A torus knot and a bumpy sphere of 50,000 triangles, an icosphere, a knot of 200,000, the showcase's teapot; of models the
triangles of all meshes. --models leaves the first ones out. Figures of both are taken from their coordinates by the same code (L² stretch as Sander et al. 2001; overlaps are
texrender's own count, in its report). xatlas with its default options; --skip leaves it out.
"""
import argparse
import json
import os
import struct
import subprocess
import tempfile
import time

import numpy as np


def knot(nu, nv):
    t = np.linspace(0, 2 * np.pi, nu, endpoint=False)
    centre = np.stack([(2 + np.cos(3 * t)) * np.cos(2 * t), (2 + np.cos(3 * t)) * np.sin(2 * t), np.sin(3 * t)], 1)
    along = np.roll(centre, -1, 0) - np.roll(centre, 1, 0)
    along /= np.linalg.norm(along, axis=1)[:, None]
    normal = np.cross(along, centre)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    other = np.cross(along, normal)
    a = np.linspace(0, 2 * np.pi, nv, endpoint=False)
    ring = np.cos(a)[None, :, None] * normal[:, None] + np.sin(a)[None, :, None] * other[:, None]
    i, j = np.meshgrid(np.arange(nu), np.arange(nv), indexing="ij")
    at = lambda i, j: (i % nu * nv + j % nv).ravel()
    a, b, c, d = at(i, j), at(i + 1, j), at(i, j + 1), at(i + 1, j + 1)
    triangles = np.concatenate([np.stack([a, b, c], 1), np.stack([b, d, c], 1)])
    return (centre[:, None] + 0.45 * ring).reshape(-1, 3), triangles


def bumpy_sphere(nu, nv):
    j, i = np.meshgrid(np.arange(1, nv), np.arange(nu), indexing="ij")
    theta, phi = np.pi * j / nv, 2 * np.pi * i / nu
    inner = np.stack([np.sin(theta) * np.cos(phi), np.cos(theta), np.sin(theta) * np.sin(phi)], -1).reshape(-1, 3)
    points = np.concatenate([[[0, 1, 0]], inner, [[0, -1, 0]]])
    radius = 1 + 0.12 * np.sin(7 * points[:, 0] + 1) * np.sin(9 * points[:, 1]) * np.sin(8 * points[:, 2] + 2)
    last = len(points) - 1
    faces = [[0, 1 + (k + 1) % nu, 1 + k] for k in range(nu)]
    for row in range(nv - 2):
        for k in range(nu):
            a, b = 1 + row * nu + k, 1 + row * nu + (k + 1) % nu
            faces += [[a, b, a + nu], [b, b + nu, a + nu]]
    faces += [[last, 1 + (nv - 2) * nu + k, 1 + (nv - 2) * nu + (k + 1) % nu] for k in range(nu)]
    return points * radius[:, None], np.array(faces)


def icosphere(subdivisions):
    g = (1 + 5**0.5) / 2
    points = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g)]
    points += [(0, -1, -g), (0, 1, -g), (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6)]
    faces += [(7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10)]
    faces += [(8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(a, b):
            key = (min(a, b), max(a, b))
            if key not in middles:
                p = points[a] + points[b]
                middles[key] = len(points)
                points.append(p / np.linalg.norm(p))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    return np.array(points), np.array(faces)


def write_glb(path, points, triangles):
    points, triangles = points.astype("<f4"), triangles.astype("<u4")
    blob = points.tobytes() + triangles.tobytes()
    root = {
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}],
        "buffers": [{"byteLength": len(blob)}],
        "bufferViews": [{"buffer": 0, "byteLength": points.nbytes},
                        {"buffer": 0, "byteOffset": points.nbytes, "byteLength": triangles.nbytes}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": len(points), "type": "VEC3",
                       "min": points.min(0).tolist(), "max": points.max(0).tolist()},
                      {"bufferView": 1, "componentType": 5125, "count": triangles.size, "type": "SCALAR"}],
    }
    text = json.dumps(root).encode()
    text += b" " * (-len(text) % 4)
    with open(path, "wb") as out:
        out.write(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(blob)))
        out.write(struct.pack("<I4s", len(text), b"JSON") + text)
        out.write(struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def read_model(path, name=""):
    """Positions and triangles of the meshes whose names hold `name`, and the set of coordinates that was written last."""
    data = open(path, "rb").read()
    if data[:4] == b"glTF":
        length = struct.unpack_from("<I", data, 12)[0]
        root, blob = json.loads(data[20:20 + length]), data[28 + length:]
    else:
        root = json.loads(data)
        blob = open(os.path.join(os.path.dirname(path), root["buffers"][0]["uri"]), "rb").read()
    kinds = {5121: "<u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
    widths = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}

    def read(index):
        accessor = root["accessors"][index]
        view = root["bufferViews"][accessor["bufferView"]]
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        kind, width = np.dtype(kinds[accessor["componentType"]]), widths[accessor["type"]]
        stride = view.get("byteStride", kind.itemsize * width)
        rows = np.ndarray((accessor["count"], width), kind, blob, start, (stride, kind.itemsize))
        return rows.astype(np.float64 if kind.kind == "f" else np.int64)

    points, triangles, st, first = [], [], [], 0
    for mesh in root["meshes"]:
        if name not in mesh.get("name", "").lower():
            continue
        for primitive in mesh["primitives"]:
            p = read(primitive["attributes"]["POSITION"])
            sets = sorted(name for name in primitive["attributes"] if name.startswith("TEXCOORD_"))
            points.append(p)
            triangles.append(read(primitive["indices"]).reshape(-1, 3) + first)
            st.append(read(primitive["attributes"][sets[-1]]) if sets else np.zeros((len(p), 2)))
            first += len(p)
    return np.concatenate(points), np.concatenate(triangles), np.concatenate(st)


def figures(points, triangles, st):
    """Share of the unit square that is used, L² stretch, and whether (s,t), t down, turns clockwise: not mirrored."""
    p, t = points[triangles], st[triangles]
    e1, e2 = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    d1, d2 = t[:, 1] - t[:, 0], t[:, 2] - t[:, 0]
    area = np.linalg.norm(np.cross(e1, e2), axis=1) / 2
    flat = (d1[:, 0] * d2[:, 1] - d1[:, 1] * d2[:, 0]) / 2
    sound = (area > 1e-12 * area.max()) & (np.abs(flat) > 0)
    scale = area[sound].sum() / np.abs(flat[sound]).sum()
    # ∂P/∂s and ∂P/∂t; σ⁻² summed is their squared length.
    ds = (e1 * d2[:, 1:] - e2 * d1[:, 1:])[sound] / (2 * flat[sound])[:, None]
    dt = (e2 * d1[:, :1] - e1 * d2[:, :1])[sound] / (2 * flat[sound])[:, None]
    squares = ((ds**2).sum(1) + (dt**2).sum(1)) / 2 / scale
    stretch = np.sqrt((squares * area[sound]).sum() / area[sound].sum())
    return np.abs(flat).sum(), stretch, (flat > 0).sum()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("models", nargs="*", metavar="MODEL")
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--target", default="target/release")
    parser.add_argument("--skip", action="store_true")
    parser.add_argument("--models", dest="alone", action="store_true")
    args = parser.parse_args()
    made = {"torus knot": knot(500, 50), "bumpy sphere": bumpy_sphere(224, 113), "icosphere": icosphere(5),
            "torus knot, finer": knot(1000, 100)}
    made["teapot"] = read_model("assets/showcase.glb", "teapot")[:2]
    made = {} if args.alone else made
    print("| mesh | triangles | texrender: s, charts, utilisation, L², overlaps | xatlas: s, charts, utilisation, L², mirrored |")
    print("|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        files = {}
        for name, (points, triangles) in made.items():
            files[name] = os.path.join(folder, name.replace(" ", "") + ".glb")
            write_glb(files[name], points, triangles)
        files.update({os.path.basename(model).split(".")[0]: model for model in args.models})
        for name, path in files.items():
            out, report = os.path.join(folder, "out.glb"), os.path.join(folder, "report.json")
            command = [os.path.join(args.target, "texrender"), "unwrap", path, "-o", out, "--report", report]
            subprocess.run(command + ["--threads", str(args.threads)], check=True, capture_output=True)
            found = json.load(open(report))
            points, triangles, st = read_model(out)
            used, stretch, turned = figures(points, triangles, st)
            ours = f"{found['seconds']:.2f}, {found['charts']}, {used:.2f}, {stretch:.4f}, {found['overlaps']}"
            if turned:
                ours += f" ({turned} triangles turned over)"
            theirs = ""
            if not args.skip:
                import xatlas

                points, triangles, _ = read_model(path)
                atlas = xatlas.Atlas()
                start = time.monotonic()
                atlas.add_mesh(points.astype(np.float32), triangles.astype(np.uint32))
                atlas.generate()
                seconds = time.monotonic() - start
                sources, corners, st = atlas[0]
                used, stretch, turned = figures(points[sources], corners, st)
                theirs = f"{seconds:.2f}, {atlas.chart_count}, {used:.2f}, {stretch:.4f}, {turned} triangles"
            print(f"| {name} | {len(triangles):,} | {ours} | {theirs} |", flush=True)


main()
