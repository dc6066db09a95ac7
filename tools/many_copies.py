"""many_copies.py MODEL.glb N OUT.glb: N x N x N copies of the first mesh of a binary glTF file, each a node of its own, in a
cube with gaps of half a mesh; for tools/window-time."""

import json, struct, sys


def main(source, count, target):
    with open(source, "rb") as file:
        data = file.read()
    length = struct.unpack_from("<I", data, 12)[0]
    scene, rest = json.loads(data[20:20 + length]), data[20 + length:]
    positions = scene["accessors"][scene["meshes"][0]["primitives"][0]["attributes"]["POSITION"]]
    step = 1.5 * max(high - low for low, high in zip(positions["min"], positions["max"]))
    places = [[step * x, step * y, step * z] for x in range(count) for y in range(count) for z in range(count)]
    scene["nodes"] = [{"mesh": 0, "translation": place} for place in places]
    scene["scenes"] = [{"nodes": list(range(len(places)))}]
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    with open(target, "wb") as file:
        file.write(struct.pack("<4sIIII", b"glTF", 2, 20 + len(text) + len(rest), len(text), 0x4E4F534A) + text + rest)


main(sys.argv[1], int(sys.argv[2]), sys.argv[3])
