"""python3 -m touchstone touch SCENE --path HIP.csv --out TICKS.csv: `touchstone touch` out of Python."""

import argparse
import csv
import sys

import numpy

import touchstone

COLUMNS = ",".join(["t"] + [f"{what}_{axis}" for what in ("hip", "proxy", "normal", "force") for axis in "xyz"] +
                   ["contacts", "friction_state", "penetration", "step_ns"] + [f"command_{axis}" for axis in "xyz"])


def read_path(file):
    """times (N,) and positions (N, 3) of a HIP.csv: columns t, x, y, z in any order."""
    with open(file, newline="", encoding="utf-8-sig") as text:
        rows = csv.reader(text)
        names = next(rows, [])
        try:
            columns = [names.index(name) for name in "txyz"]
        except ValueError as missing:
            raise touchstone.InputError(f"{file}: line 1: {missing}: begin the file with the line t,x,y,z") from None
        try:
            values = numpy.array([[float(row[i]) for i in columns] for row in rows if row])
        except (ValueError, IndexError) as problem:
            raise touchstone.InputError(f"{file}: {problem}") from None
    if values.size == 0:
        raise touchstone.InputError(f"{file}: has no sample")
    return values[:, 0].copy(), values[:, 1:].copy()


def write_ticks(ticks, file):
    """The columns of `touchstone touch`; every number reads back to the last bit."""
    columns = [ticks.time, *ticks.hip.T, *ticks.proxy.T, *ticks.normal.T, *ticks.force.T, ticks.contacts, ticks.friction,
               ticks.penetration, ticks.step_ns, *ticks.command.T]
    with open(file, "w", encoding="ascii") as out:
        out.write(COLUMNS + "\n")
        for row in zip(*(column.tolist() for column in columns)):
            out.write(",".join(map(repr, row)) + "\n")


def assignment(text):
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"'{text}' is not of the form NAME=VALUE")
    return name, value


def touch(options):
    scene = touchstone.Scene(options.scene, fit=options.fit, iso=options.iso)
    for warning in scene.warnings:
        print(f"touchstone: warning: {options.scene}: {warning}", file=sys.stderr)
    settings = dict(options.set or [])
    if options.path:
        times, positions = read_path(options.path)
        ticks = touchstone.touch(scene, positions, times, settings=settings)
    else:
        ticks = touchstone.touch(scene, scene.stroke(options.stroke), settings=settings)
    write_ticks(ticks, options.out)
    print(f"{len(ticks)} ticks, {int((ticks.contacts > 0).sum())} in contact, written to {options.out}")


def main():
    parser = argparse.ArgumentParser(prog="python3 -m touchstone", description=__doc__.split(":")[0])
    commands = parser.add_subparsers(required=True, metavar="COMMAND")
    command = commands.add_parser("touch", help="touch a model along a path, offline")
    command.add_argument("scene", metavar="SCENE")
    command.add_argument("--path", metavar="HIP.csv", help="positions of the hand: columns t, x, y, z")
    command.add_argument("--stroke", metavar="NAME", default="tour", help="without --path: a stroke of the simulated hand [tour]")
    command.add_argument("--out", metavar="TICKS.csv", required=True)
    command.add_argument("--set", metavar="NAME=VALUE", type=assignment, action="append", help="may be given again")
    command.add_argument("--fit", choices=("none", "workspace"), default="none")
    command.add_argument("--iso", type=float, help="of a volume: the value at its surface")
    command.set_defaults(run=touch)
    command = commands.add_parser("settings", help="list every setting")
    command.set_defaults(run=lambda _: print("\n".join(map(repr, touchstone.settings()))))
    options = parser.parse_args()
    try:
        options.run(options)
    except (touchstone.Error, OSError) as problem:
        print(f"touchstone: {problem}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
