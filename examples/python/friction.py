"""The figure of docs/figures/friction.png in a script: the tangential force over a place that is pushed to and fro, by each law of
friction. Needs numpy and matplotlib."""

import sys

import numpy

import touchstone

plane = touchstone.Scene.from_arrays([[-.1, 0, -.1], [-.1, 0, .1], [.1, 0, .1], [.1, 0, -.1]], [[0, 1, 2], [0, 2, 3]],
                                     material=touchstone.Material(stiffness=600, static_friction=0.5, dynamic_friction=0.3))
time = numpy.arange(0, 2, 1e-3)
hand = numpy.stack([0.004 * numpy.sin(2 * numpy.pi * time), numpy.interp(time, [0, 0.1], [0.06, -0.002]), 0 * time], axis=1)
forces = {law: touchstone.touch(plane, hand, time, settings={"friction": law}).force[:, 0]
          for law in ("zilles", "ho", "elastoplastic", "kim")}
for law, force in forces.items():
    print(f"{law:14} at most {numpy.abs(force).max():.4f} N along the surface, {0.5 * 600 * 0.002:.4f} N is static friction's limit")

if len(sys.argv) > 1:  # friction.py PICTURE
    from matplotlib import pyplot

    for law, force in forces.items():
        pyplot.plot(1e3 * hand[200:, 0], force[200:], label=law)
    pyplot.xlabel("hand (mm)")
    pyplot.ylabel("tangential force (N)")
    pyplot.legend()
    pyplot.savefig(sys.argv[1])
