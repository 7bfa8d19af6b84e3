#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""
glb_check.py FILE.glb VERTICES.csv TOLERANCE_MM: reads a .glb as the glTF 2.0 specification says, sharing no code with the
writer: every offset, every range, every stated least and most; then plays the animation as a viewer would (morph
targets, then joints) at each key frame and compares every vertex with the table that fapplay --csv vertices wrote.
Needs nothing but Python.
"""
import csv
import json
import math
import struct
import sys

COMPONENT = {5120: "b", 5121: "B", 5122: "h", 5123: "H", 5125: "I", 5126: "f"}
WIDTH = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


class Bad(Exception):
    pass


def need(true, text):
    if not true:
        raise Bad(text)


# --- the container ---

def chunks(data):
    need(len(data) >= 20, "too short")
    magic, version, length = struct.unpack_from("<4sII", data)
    need(magic == b"glTF" and version == 2, "not a GLB of version 2")
    need(length == len(data), f"says {length} bytes, has {len(data)}")
    found, at = [], 12
    while at < length:
        need(at % 4 == 0 and at + 8 <= length, "a chunk begins where none can")
        size, kind = struct.unpack_from("<I4s", data, at)
        need(size % 4 == 0 and at + 8 + size <= length, "a chunk does not fit")
        found.append((kind, data[at + 8:at + 8 + size]))
        at += 8 + size
    need([k for k, _ in found] == [b"JSON", b"BIN\0"], "expected one JSON and one BIN chunk")
    return json.loads(found[0][1].decode("utf-8")), found[1][1]


class File:
    def __init__(self, path):
        with open(path, "rb") as f:
            self.json, self.bin = chunks(f.read())
        need(self.json["asset"]["version"] == "2.0", "asset.version")
        need(self.json["buffers"] == [{"byteLength": len(self.bin)}], "the buffer is not the BIN chunk")
        for v in self.json["bufferViews"]:
            need(v["byteLength"] > 0 and v.get("byteOffset", 0) + v["byteLength"] <= len(self.bin), "view out of bounds")
        self.cache = {}

    def raw(self, view, offset, component, width, count, stride_allowed):
        """Rows of numbers out of a view."""
        v = self.json["bufferViews"][view]
        code = COMPONENT[component]
        size = struct.calcsize("<" + code)
        need(stride_allowed or "byteStride" not in v, "a stride where none is allowed")
        stride = v.get("byteStride", size * width)
        start = v.get("byteOffset", 0) + offset
        need(start % size == 0 and stride % size == 0 and stride >= size * width, "not aligned")
        need(offset + (count - 1) * stride + size * width <= v["byteLength"], "accessor out of bounds")
        row = struct.Struct("<" + code * width)
        return [list(row.unpack_from(self.bin, start + i * stride)) for i in range(count)]

    def accessor(self, number):
        """Rows of an accessor, integers turned into fractions where it says so; its least and most are checked."""
        if number in self.cache:
            return self.cache[number]
        a = self.json["accessors"][number]
        width, count, component = WIDTH[a["type"]], a["count"], a["componentType"]
        need(count > 0, "an empty accessor")
        if "bufferView" in a:
            rows = self.raw(a["bufferView"], a.get("byteOffset", 0), component, width, count, True)
            told = rows
        else:
            rows = [[0.0] * width] * count
            told = rows[:1]  # the others are the same
        if "sparse" in a:
            need("bufferView" not in a, "sparse over something")
            s = a["sparse"]
            which = self.raw(s["indices"]["bufferView"], s["indices"].get("byteOffset", 0),
                             s["indices"]["componentType"], 1, s["count"], False)
            where = self.raw(s["values"]["bufferView"], s["values"].get("byteOffset", 0), component, width, s["count"],
                             False)
            need(all(x[0] < y[0] for x, y in zip(which, which[1:])), "sparse indices do not ascend")
            need(which[-1][0] < count, "a sparse index is too large")
            for (i,), value in zip(which, where):
                rows[i] = value
            told = where + (told if s["count"] < count else [])
        need(all(math.isfinite(x) for r in told for x in r), "not a number")
        for key, of in (("min", min), ("max", max)):
            if key in a:
                for k in range(width):
                    got = of(r[k] for r in told)
                    said = struct.unpack("<f", struct.pack("<f", a[key][k]))[0]
                    need(got == said, f"accessor {number}: {key} is {got}, not {said}")
        if a.get("normalized"):
            most = {5121: 255, 5123: 65535}[component]
            rows = [[x / most for x in r] for r in rows]
        self.cache[number] = rows
        return rows


# --- rotations, places ---

def matrix_of(q, move):
    """3x4 of a node."""
    x, y, z, w = q
    return [[1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y), move[0]],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x), move[1]],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y), move[2]]]


def chain(a, b):
    """a after b."""
    b = b + [[0, 0, 0, 1]]
    return [[sum(a[i][k] * b[k][j] for k in range(4)) for j in range(4)] for i in range(3)]


def apply(m, p):
    return [m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2] + m[i][3] for i in range(3)]


# --- a face ---

class Face:
    def __init__(self, f):
        self.f, j = f, f.json
        self.nodes = j["nodes"]
        need(len(j["meshes"]) == 1, "more than one mesh")
        self.mesh = j["meshes"][0]
        self.at_mesh = next(i for i, n in enumerate(self.nodes) if n.get("mesh") == 0)
        self.parent = {}
        for i, n in enumerate(self.nodes):
            for c in n.get("children", []):
                need(c not in self.parent, "a node with two parents")
                self.parent[c] = i
        need(set(j["scenes"][0]["nodes"]) == {i for i in range(len(self.nodes)) if i not in self.parent},
             "the scene does not hold every root")
        self.names = self.mesh["extras"]["targetNames"]
        need(len(set(self.names)) == len(self.names), "two targets of one name")
        self.skin = j["skins"][self.nodes[self.at_mesh]["skin"]]
        # glTF keeps matrices column by column
        self.bind = [[[m[4 * c + r] for c in range(4)] for r in range(3)]
                     for m in f.accessor(self.skin["inverseBindMatrices"])]
        need(len(self.bind) == len(self.skin["joints"]), "not one bind matrix a joint")
        self.primitives = [self.read_primitive(p) for p in self.mesh["primitives"]]
        self.read_animation(j["animations"][0])

    def read_primitive(self, p):
        f, a = self.f, p["attributes"]
        out = {k: f.accessor(v) for k, v in a.items()}
        count = len(out["POSITION"])
        need(all(len(v) == count for v in out.values()), "attributes of different lengths")
        for key in ("POSITION",):
            need("min" in f.json["accessors"][a[key]], "positions without least and most")
        triangles = [r[0] for r in f.accessor(p["indices"])]
        need(len(triangles) % 3 == 0 and max(triangles) < count, "triangles")
        need(0 <= p["material"] < len(f.json["materials"]), "no such material")
        need(all(abs(math.hypot(*n) - 1) < 1e-4 for n in out["NORMAL"]), "a normal that is not of length 1")
        need(all(0 <= x <= 1 for c in out.get("COLOR_0", []) for x in c), "colours")
        material = f.json["materials"][p["material"]]["pbrMetallicRoughness"]
        need(("COLOR_0" in out) != ("baseColorTexture" in material), "neither colours nor a texture, or both")
        need(all(abs(sum(w) - 1) < 1e-6 for w in out["WEIGHTS_0"]), "shares of joints do not add up to 1")
        for joints, weights in zip(out["JOINTS_0"], out["WEIGHTS_0"]):
            for k, w in zip(joints, weights):
                need(k < len(self.skin["joints"]) and (w > 0 or k == 0), "joints")
        need(len(p["targets"]) == len(self.names), "not one name a target")
        out["targets"] = []
        for t in p["targets"]:
            need("min" in f.json["accessors"][t["POSITION"]], "a target without least and most")
            rows = f.accessor(t["POSITION"])
            need(len(rows) == count and len(f.accessor(t["NORMAL"])) == count, "a target of another length")
            out["targets"].append([(i, r) for i, r in enumerate(rows) if any(r)])
        return out

    def read_animation(self, animation):
        self.channel = {}
        for c in animation["channels"]:
            s = animation["samplers"][c["sampler"]]
            need(s.get("interpolation", "LINEAR") == "LINEAR", "interpolation")
            times = [r[0] for r in self.f.accessor(s["input"])]
            need(times[0] >= 0 and all(x < y for x, y in zip(times, times[1:])), "times do not ascend")
            key = (c["target"]["node"], c["target"]["path"])
            need(key not in self.channel, "two channels for one thing")
            rows = self.f.accessor(s["output"])
            if key[1] == "weights":
                width = len(self.names)
                flat = [r[0] for r in rows]
                rows = [flat[i:i + width] for i in range(0, len(flat), width)]
                need(all(0 <= w <= 1 for w in flat), "a weight that importers cut")
            if key[1] == "rotation":
                need(all(abs(math.hypot(*q) - 1) < 1e-5 for q in rows), "a rotation that is none")
            need(len(rows) == len(times), "not one value a time")
            self.channel[key] = rows
            self.times = times

    def node_matrix(self, i, frame):
        n = self.nodes[i]
        move = self.channel.get((i, "translation"))
        turn = self.channel.get((i, "rotation"))
        own = matrix_of(turn[frame] if turn else n.get("rotation", [0, 0, 0, 1]),
                        move[frame] if move else n.get("translation", [0, 0, 0]))
        return chain(self.node_matrix(self.parent[i], frame), own) if i in self.parent else own

    def pose(self, frame):
        """Place of every vertex, by its number in the bank, metres."""
        weights = self.channel[(self.at_mesh, "weights")][frame]
        joints = [chain(self.node_matrix(n, frame), b) for n, b in zip(self.skin["joints"], self.bind)]
        out = {}
        for p in self.primitives:
            place = [list(v) for v in p["POSITION"]]
            for w, target in zip(weights, p["targets"]):
                if w:
                    for i, (x, y, z) in target:
                        v = place[i]
                        v[0] += w * x
                        v[1] += w * y
                        v[2] += w * z
            for v, number, held, share in zip(place, p["_VERTEX"], p["JOINTS_0"], p["WEIGHTS_0"]):
                parts = [(s, apply(joints[k], v)) for k, s in zip(held, share) if s]
                out[int(number[0])] = [sum(s * q[axis] for s, q in parts) for axis in range(3)]
        return out


def read_table(path):
    frames = []
    with open(path, newline="") as f:
        for row in csv.DictReader(f):
            if not frames or frames[-1][0] != row["frame"]:
                frames.append((row["frame"], float(row["time_s"]), {}))
            frames[-1][2][int(row["vertex"])] = [float(row[a]) for a in "xyz"]
    return frames


def main(path, table, tolerance):
    f = File(path)
    face = Face(f)
    for i in range(len(f.json["accessors"])):
        f.accessor(i)
    frames = read_table(table)
    need(len(frames) == len(face.times), f"{len(face.times)} key frames, {len(frames)} in the table")
    worst, total, count = 0, 0, 0
    for i, (_, time, vertices) in enumerate(frames):
        need(abs(time - frames[0][1] - face.times[i]) < 1e-5, "key frames are not when the table's are")
        pose = face.pose(i)
        need(set(pose) == set(vertices), "not the table's vertices")
        for v, p in pose.items():
            d = math.dist([1000 * x for x in p], vertices[v])
            worst, total, count = max(worst, d), total + d * d, count + 1
    said = f.json["asset"]["extras"]["worst_error_mm"]
    print(f"{len(frames)} frames, {len(pose)} vertices: worst {worst:.4f} mm, RMS {math.sqrt(total / count):.5f} mm; "
          f"the file says {said}")
    need(worst <= tolerance, f"a vertex is {worst:.4f} mm off")
    need(abs(worst - said) < 1e-3, "the file says something else about its error")  # tables are rounded to 0.1 um
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1], sys.argv[2], float(sys.argv[3])))
    except Bad as e:
        sys.exit(f"{sys.argv[1]}: {e}")
