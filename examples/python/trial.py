"""A psychophysics trial in 60 lines: which of two plates is stiffer? A simulated person answers, who judges stiffness with an error of
10 % (Weber fraction); the staircase (two down, one up) goes to the difference that 70.7 % of the answers see. The force is the
program's; nothing of this was tried on people."""

import numpy

import touchstone

random = numpy.random.default_rng(7)
REFERENCE = 400.0  # N/m
press = numpy.stack([numpy.zeros(400), numpy.interp(numpy.arange(400), [0, 200, 399], [0.06, -0.003, 0.06]), numpy.zeros(400)], axis=1)


def plate(stiffness):
    return touchstone.Scene.from_arrays([[-.1, 0, -.1], [-.1, 0, .1], [.1, 0, .1], [.1, 0, -.1]], [[0, 1, 2], [0, 2, 3]],
                                        material=touchstone.Material(stiffness=stiffness))


def felt_stiffness(stiffness):
    """What the person makes of force over depth while the plate is pressed."""
    ticks = touchstone.touch(plate(stiffness), press)
    deep = ticks.penetration > 1e-3
    slope = numpy.median(ticks.force[deep, 1] / ticks.penetration[deep])
    return slope * (1 + 0.1 * random.standard_normal())


def trial(difference):
    """True where the stiffer plate was named."""
    first_is_stiffer = random.random() < 0.5
    plates = [REFERENCE + difference, REFERENCE]
    first, second = plates if first_is_stiffer else plates[::-1]
    return (felt_stiffness(first) > felt_stiffness(second)) == first_is_stiffer


difference, step, right, reversals, rising = 200.0, 1.4, 0, [], None
while len(reversals) < 16:
    if trial(difference):
        right += 1
        if right < 2:
            continue
        right, up = 0, False
    else:
        right, up = 0, True
    if rising is not None and up != rising:
        reversals.append(difference)
    rising = up
    difference *= step if up else 1 / step

print(f"threshold {numpy.exp(numpy.mean(numpy.log(reversals[4:]))):.0f} N/m, "
      f"{100 * numpy.exp(numpy.mean(numpy.log(reversals[4:]))) / REFERENCE:.0f} % of {REFERENCE:.0f} N/m")
