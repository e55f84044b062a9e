# SPDX-License-Identifier: GPL-3.0-or-later
"""An independent reader of binary glTF 2.0, from the specification (ISO/IEC 12113): container, accessors with their bounds, scene graph, animation by
linear keys, morph targets."""
import json
import struct

import numpy as np

DTYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class Glb:
    def __init__(self, path):
        data = open(path, "rb").read()
        magic, version, length = struct.unpack_from("<4sII", data)
        assert (magic, version, length) == (b"glTF", 2, len(data)), (magic, version, length, len(data))
        chunks, at = [], 12
        while at < length:
            size, kind = struct.unpack_from("<I4s", data, at)
            assert size % 4 == 0
            chunks.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        assert [c[0] for c in chunks] == [b"JSON", b"BIN\0"]
        self.json, self.bin = json.loads(chunks[0][1]), chunks[1][1]
        assert self.json["asset"]["version"] == "2.0"
        assert len(self.json["buffers"]) == 1 and 0 <= len(self.bin) - self.json["buffers"][0]["byteLength"] < 4
        for k in range(len(self.json["accessors"])):
            self.read(k)

    def read(self, k):
        a = self.json["accessors"][k]
        view = self.json["bufferViews"][a["bufferView"]]
        kind, width = np.dtype(DTYPES[a["componentType"]]), WIDTHS[a["type"]]
        first = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        assert first % kind.itemsize == 0 and a["count"] > 0
        assert a["count"] * width * kind.itemsize <= view["byteLength"] and first + a["count"] * width * kind.itemsize <= len(self.bin)
        values = np.frombuffer(self.bin, kind, a["count"] * width, first).reshape(-1, width)
        for bound, own in (("min", values.min(axis=0)), ("max", values.max(axis=0))):
            if bound in a:
                assert (np.array(a[bound], kind) == own).all(), (k, bound, a[bound], own)
        return values / 65535 if a.get("normalized") else values

    def sampled(self, key, node, path, default):
        """Value of an animated property at key number `key`."""
        for animation in self.json.get("animations", []):
            for channel in animation["channels"]:
                if channel["target"] == {"node": node, "path": path}:
                    sampler = animation["samplers"][channel["sampler"]]
                    assert sampler["interpolation"] == "LINEAR"
                    t, values = self.read(sampler["input"])[:, 0], self.read(sampler["output"])
                    assert (np.diff(t) > 0).all() and "min" in self.json["accessors"][sampler["input"]]
                    return values.reshape(len(t), -1)[key]
        return default

    def regions(self, key=0):
        """Name, positions in the world, triangles and colours of each mesh at key number `key` of the animation."""
        found = {}

        def walk(index, parent):
            node = self.json["nodes"][index]
            q = np.array(self.sampled(key, index, "rotation", node.get("rotation", [0, 0, 0, 1])), float)
            assert abs(np.linalg.norm(q) - 1) < 1e-6
            x, y, z, w = q / np.linalg.norm(q)
            K = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
            R = np.eye(3) + 2 * w * K + 2 * K @ K
            to = np.array(self.sampled(key, index, "translation", node.get("translation", [0, 0, 0])), float)
            here = lambda p: parent(p @ R.T + to)
            if "mesh" in node:
                mesh = self.json["meshes"][node["mesh"]]
                (part,) = mesh["primitives"]
                assert part.get("mode", 4) == 4 and "min" in self.json["accessors"][part["attributes"]["POSITION"]]
                points = self.read(part["attributes"]["POSITION"]).astype(float)
                weights = self.sampled(key, index, "weights", mesh.get("weights", []))
                assert len(weights) == len(part.get("targets", []))
                for weight, target in zip(weights, part.get("targets", [])):
                    points = points + weight * self.read(target["POSITION"])
                triangles = self.read(part["indices"])[:, 0].reshape(-1, 3)
                assert triangles.max() < len(points)
                normals, colours = self.read(part["attributes"]["NORMAL"]), self.read(part["attributes"]["COLOR_0"])
                assert len(normals) == len(colours) == len(points) and abs(np.linalg.norm(normals, axis=1) - 1).max() < 1e-5
                found[node["name"]] = here(points), triangles, colours
            for child in node.get("children", []):
                walk(child, here)

        for root in self.json["scenes"][self.json["scene"]]["nodes"]:
            walk(root, lambda p: p)
        return found


def volume(points, triangles):
    """By the divergence theorem; outward faces give a positive one."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
