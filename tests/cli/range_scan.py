# SPDX-License-Identifier: BSD-2-Clause
# A head's scan seen by a camera 60 cm before it: depth as 16-bit PNG and as PFM, a colour picture, the camera, landmarks in pixels.
# usage: range_scan.py SCAN.ply POINTS.csv FOLDER
import struct
import sys
import zlib

scan, points, folder = sys.argv[1:4]
size, focal, step_mm = 360, 700.0, 0.02
raw = open(scan, "rb").read()
head, body = raw.split(b"end_header\n", 1)
count = {}
width = {}
for line in head.decode().split("\n"):
    word = line.split()
    if word[:1] == ["element"]:
        element, count[word[1]], width[word[1]] = word[1], int(word[2]), 0
    elif word[:1] == ["property"] and word[1] != "list":
        width[element] += {"float": 4, "int": 4, "uchar": 1}[word[1]]
vertices = [struct.unpack_from("<3f", body, i * width["vertex"]) for i in range(count["vertex"])]
at, triangles = count["vertex"] * width["vertex"], []
for _ in range(count["face"]):
    triangles.append(struct.unpack_from("<3i", body, at + 1))
    at += 13


def see(p):  # centimetres to millimetres before the camera, and the pixel
    x, y, z = 10 * p[0], 10 * p[1], 600 - 10 * (p[2] - 9)
    return size / 2 + focal * x / z, size / 2 - focal * y / z, z


seen = [see(v) for v in vertices]
depth = [0.0] * (size * size)
for a, b, c in triangles:
    (ax, ay, az), (bx, by, bz), (cx, cy, cz) = seen[a], seen[b], seen[c]
    area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    if abs(area) < 1e-9:
        continue
    for y in range(max(0, int(min(ay, by, cy)) + 1), min(size - 1, int(max(ay, by, cy))) + 1):
        for x in range(max(0, int(min(ax, bx, cx)) + 1), min(size - 1, int(max(ax, bx, cx))) + 1):
            u = ((x - ax) * (cy - ay) - (y - ay) * (cx - ax)) / area
            v = ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / area
            if u < 0 or v < 0 or u + v > 1:
                continue
            d = 1 / ((1 - u - v) / az + u / bz + v / cz)
            i = y * size + x
            if depth[i] == 0 or d < depth[i]:
                depth[i] = d


def png(path, kind, bits, rows):
    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    body = zlib.compress(b"".join(b"\0" + r for r in rows))
    open(path, "wb").write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", size, size, bits, kind, 0, 0, 0)) +
                           chunk(b"IDAT", body) + chunk(b"IEND", b""))


row = lambda y: depth[y * size:(y + 1) * size]
png(folder + "/depth.png", 0, 16, [b"".join(struct.pack(">H", round(d / step_mm)) for d in row(y)) for y in range(size)])
png(folder + "/colour.png", 2, 8, [b"".join(bytes((200, 60 + y * 150 // size, 90)) for _ in range(size)) for y in range(size)])
with open(folder + "/depth.pfm", "wb") as f:
    f.write(b"Pf\n%d %d\n-1.0\n" % (size, size))
    for y in reversed(range(size)):
        f.write(struct.pack("<%df" % size, *row(y)))
camera = '{ "fx": %g, "fy": %g, "cx": %g, "cy": %g, "unit_mm": %g, "depth": "%s"%s }\n'
open(folder + "/png.json", "w").write(camera % (focal, focal, size / 2, size / 2, step_mm, "depth.png", ', "colour": "colour.png"'))
open(folder + "/pfm.json", "w").write(camera % (focal, focal, size / 2, size / 2, 1, "depth.pfm", ""))
with open(folder + "/pixels.csv", "w") as f:
    for line in open(points):
        name, *xyz = line.strip().split(",")
        if name == "point":
            continue
        u, v, z = see([float(x) for x in xyz])
        x, y = round(u), round(v)
        if 0 <= x < size and 0 <= y < size and depth[y * size + x] > 0 and abs(depth[y * size + x] - z) < 3:
            f.write("%s,%d,%d,px\n" % (name, x, y))
