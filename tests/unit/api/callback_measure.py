"""Whether a Python callback at 60 Hz costs the servo of a session at 1 kHz ticks: sessions with and without it in turns.

    PYTHONPATH=build/release/python python3 tests/unit/api/callback_measure.py assets/scenes [TURNS [SECONDS]]

Run by CTest in a short form, which asserts no time."""

import pathlib
import sys

import numpy

import touchstone

TURNS = int(sys.argv[2]) if len(sys.argv) > 2 else 2
SECONDS = float(sys.argv[3]) if len(sys.argv) > 3 else 1.0


def session_of(scene, callback):
    """(ticks, missed and skipped, p99 of a tick in us, calls) of one session."""
    calls = []
    with touchstone.Session("stroke:circle", keep=int(2000 * SECONDS)) as session:
        session.touch(scene)

        def called(state):
            calls.append(state.time)
            numpy.linalg.svd(numpy.outer(state.force, state.hip) + numpy.eye(3))  # what a picture may take

        session.run(SECONDS, called if callback else None)
        state, ticks = session.pump(), session.take()
        return state.ticks, state.missed + state.skipped, float(numpy.percentile(ticks.step_ns, 99)) / 1e3, len(calls)


scene = touchstone.Scene(pathlib.Path(sys.argv[1]) / "doughnut.glb", fit="workspace")
rows = {False: [], True: []}
for turn in range(TURNS):
    for callback in (False, True):
        rows[callback].append(session_of(scene, callback))
        ticks, missed, p99, calls = rows[callback][-1]
        print(f"{'callback' if callback else 'alone':8} {ticks} ticks, {missed} missed, p99 of a tick {p99:.1f} us, {calls} calls", flush=True)
for callback, made in rows.items():
    ticks, missed = sum(row[0] for row in made), sum(row[1] for row in made)
    print(f"{'with callback' if callback else 'without':13} {missed} of {ticks} missed; median of p99 {numpy.median([row[2] for row in made]):.1f} us")
    assert ticks > 0.2 * 1000 * SECONDS * TURNS, "the servo stood still"
assert all(row[3] > 0 for row in rows[True])
