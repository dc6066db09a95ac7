"""falling_bodies.py FOLDER: bodies.glb, a tray of 130 mm whose floor throws 100 cubes of 8 mm (sine of 5 mm at 8 Hz, 1.3 g), and
none.glb, the same objects without physics; for tools/bodies-time."""

import json, math, struct, sys


def box(size):
    """Points, normals and triangles of a box about the origin."""
    half = [s / 2 for s in size]
    points, normals, indices = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            normal = [sign * (k == axis) for k in range(3)]
            indices += [len(points) + i for i in (0, 1, 2, 0, 2, 3)]
            for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                point = [sign * half[k] * (k == axis) for k in range(3)]
                point[(axis + 1) % 3] = a * half[(axis + 1) % 3]
                point[(axis + 2) % 3] = sign * b * half[(axis + 2) % 3]
                points.append(point)
                normals.append(normal)
    return points, normals, indices


class File:
    def __init__(self, physics):
        self.physics, self.data = physics, b""
        self.views, self.accessors, self.meshes, self.shapes, self.nodes = [], [], [], [], []

    def put(self, values, kind, **more):
        whole = kind == "SCALAR" and isinstance(values[0], int)
        packed = struct.pack(f"<{len(values)}{'H' if whole else 'f'}", *values)
        self.views.append({"buffer": 0, "byteOffset": len(self.data), "byteLength": len(packed)})
        self.data += packed + b"\0" * (-len(packed) % 4)
        self.accessors.append({"bufferView": len(self.views) - 1, "componentType": 5123 if whole else 5126, "type": kind,
                               "count": len(values) // (3 if kind == "VEC3" else 1), **more})
        return len(self.accessors) - 1

    def mesh(self, name, size, material):
        points, normals, indices = box(size)
        half = [s / 2 for s in size]
        attributes = {"POSITION": self.put([c for p in points for c in p], "VEC3", min=[-h for h in half], max=half),
                      "NORMAL": self.put([c for n in normals for c in n], "VEC3")}
        self.meshes.append({"name": name, "primitives": [{"attributes": attributes, "indices": self.put(indices, "SCALAR"), "material": material}]})
        self.shapes.append({"type": "box", "box": {"size": size}})
        return len(self.meshes) - 1

    def node(self, name, mesh, place, motion=None):
        node = {"name": name, "mesh": mesh, "translation": place}
        if self.physics:
            body = {"collider": {"geometry": {"shape": mesh}, "physicsMaterial": 0}}
            node["extensions"] = {"KHR_physics_rigid_bodies": {**body, **({"motion": motion} if motion else {})}}
        self.nodes.append(node)

    def shake(self, node, height, amplitude, rate):
        times = [i / 240 for i in range(round(240 / rate) + 1)]
        places = [c for t in times for c in (0, height + amplitude * math.sin(2 * math.pi * rate * t), 0)]
        sampler = {"input": self.put(times, "SCALAR", min=[0], max=[times[-1]]), "output": self.put(places, "VEC3")}
        self.animation = {"name": "shake", "samplers": [sampler], "channels": [{"sampler": 0, "target": {"node": node, "path": "translation"}}]}

    def write(self, path):
        scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": list(range(len(self.nodes)))}], "nodes": self.nodes,
                 "meshes": self.meshes, "materials": [{"name": "tray"}, {"name": "cube", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.5, 0.2, 1]}}],
                 "accessors": self.accessors, "bufferViews": self.views, "buffers": [{"byteLength": len(self.data)}], "animations": [self.animation]}
        if self.physics:
            scene["extensionsUsed"] = ["KHR_physics_rigid_bodies", "KHR_implicit_shapes"]
            scene["extensions"] = {"KHR_implicit_shapes": {"shapes": self.shapes}, "KHR_physics_rigid_bodies": {
                "physicsMaterials": [{"staticFriction": 0.5, "dynamicFriction": 0.5, "restitution": 0.2}]}}
        text = json.dumps(scene).encode()
        text += b" " * (-len(text) % 4)
        with open(path, "wb") as file:
            file.write(struct.pack("<4sIIII", b"glTF", 2, 28 + len(text) + len(self.data), len(text), 0x4E4F534A) + text)
            file.write(struct.pack("<II", len(self.data), 0x004E4942) + self.data)


def tray(physics):
    file = File(physics)
    floor = file.mesh("floor", [0.13, 0.008, 0.13], 0)
    along, across = file.mesh("wall", [0.13, 0.06, 0.005], 0), file.mesh("wall", [0.005, 0.06, 0.13], 0)
    cube = file.mesh("cube", [0.008, 0.008, 0.008], 1)
    file.node("floor", floor, [0, -0.004, 0], {"isKinematic": True})
    for sign in (-1, 1):
        file.node("wall", along, [0, 0.02, sign * 0.0675])
        file.node("wall", across, [sign * 0.0675, 0.02, 0])
    for i in range(100):
        place = [0.012 * (i % 5 - 2), 0.02 + 0.012 * (i // 25), 0.012 * (i // 5 % 5 - 2)]
        file.node(f"cube {i}", cube, place, {"mass": 0.004})
    file.shake(0, -0.004, 0.005, 8)
    return file


tray(True).write(sys.argv[1] + "/bodies.glb")
tray(False).write(sys.argv[1] + "/none.glb")
