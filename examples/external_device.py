#!/usr/bin/env python3
"""A device for Touchstone in eighty lines: a finger on a spring that presses down and up again.

Start Touchstone with `touchstone SCENE --device udp` (or `touchstone run SCENE --device udp`), then this.
It sends where the finger is a thousand times a second and moves the finger by the force that comes back.
docs/devices.md describes the packets.
"""

import argparse
import math
import select
import socket
import struct
import time

PLACE = struct.Struct("<4sHHII3d4d")  # magic, version, size, sequence, buttons, position, orientation w x y z
FORCE = struct.Struct("<4sHHII3d3d")  # magic, version, size, sequence, answers, force, torque
PAD = struct.Struct("<4sHHII2d")  # declared: reach (m) and rate (m/s) of a contact location display; heard: the location

MASS = 0.08  # kg, of a finger and a light device
SPRING = 300.0  # N/m, from the finger to where it wants to be
DAMPING = 4.0  # N s/m
PERIOD = 0.001  # s
SILENCE = 0.05  # s without a packet, after which there is no force


def wish(t, depth):
    """Where the finger wants to be: from above, down to `depth` and up again every two seconds."""
    share = 0.5 - 0.5 * math.cos(math.pi * t)
    return (0.0, 0.1 + (depth - 0.1) * share, 0.0)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--port", type=int, default=47470)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--depth", type=float, default=0.0, help="how far down, m")
    parser.add_argument("--pad", action="store_true", help="with a contact location display of 8 mm, 0.1 m/s")
    options = parser.parse_args()

    link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    link.connect(("127.0.0.1", options.port))
    link.setblocking(False)
    place, speed, force = list(wish(0.0, options.depth)), [0.0] * 3, (0.0, 0.0, 0.0)
    sequence = answers = malformed = 0
    greatest = 0.0
    location = (0.0, 0.0)
    start = due = heard = time.monotonic()
    while (now := time.monotonic()) - start < options.seconds:
        if now - heard > SILENCE:
            force = (0.0, 0.0, 0.0)
        goal = wish(now - start, options.depth)
        for i in range(3):
            push = SPRING * (goal[i] - place[i]) - DAMPING * speed[i] + force[i]
            speed[i] += push / MASS * PERIOD
            place[i] += speed[i] * PERIOD
        sequence += 1
        packet = PLACE.pack(b"TSXP", 1, PLACE.size, sequence, 0, *place, 1.0, 0.0, 0.0, 0.0)
        due = max(due + PERIOD, now)  # what was slept through is not made up for in a burst
        try:
            link.send(packet)
            if options.pad and answers == 1:  # Touchstone knows this program by now
                link.send(PAD.pack(b"TSXD", 1, PAD.size, sequence, 0, 0.008, 0.1))
            while True:  # what comes until the next place is due, and once if that is now; the newest force counts
                if not select.select([link], [], [], max(due - time.monotonic(), 0.0))[0]:
                    break
                answer = link.recv(256)
                if len(answer) == PAD.size and answer[:4] == b"TSXL":
                    location = PAD.unpack(answer)[5:7]
                    continue
                if len(answer) != FORCE.size or answer[:4] != b"TSXF":
                    malformed += 1
                    continue
                force = FORCE.unpack(answer)[5:8]
                heard = time.monotonic()
                answers += 1
                greatest = max(greatest, math.sqrt(sum(f * f for f in force)))
        except ConnectionRefusedError:
            force = (0.0, 0.0, 0.0)  # Touchstone is not (or no longer) there
            time.sleep(0.1)
    print(f"sent {sequence} places, heard {answers} forces ({malformed} malformed), at most {greatest:.2f} N")
    if options.pad:
        print(f"the last contact location: {1e3 * location[0]:.2f} mm along, {1e3 * location[1]:.2f} mm across")


if __name__ == "__main__":
    main()
