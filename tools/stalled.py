"""stalled.py RUNS STOPS PROGRAM [ARGUMENT...]: the program, which in turn runs for about RUNS s and stands still for about STOPS s, each of them
up to twice as long at random; for tools/test-stalls. Its exit status is 0 where the program's is."""

import random, signal, subprocess, sys, time


def main(runs, stops, command):
    with subprocess.Popen(command) as process:
        try:
            while process.poll() is None:
                time.sleep(random.uniform(0.0, 2.0 * runs))
                process.send_signal(signal.SIGSTOP)
                time.sleep(random.uniform(0.0, 2.0 * stops))
                process.send_signal(signal.SIGCONT)
        finally:
            process.kill()
        return process.wait()


sys.exit(main(float(sys.argv[1]), float(sys.argv[2]), sys.argv[3:]) != 0)
