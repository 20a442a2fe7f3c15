#!/usr/bin/env python3
"""watch-line.py VALUE: polls a gpio-sim line until SIGTERM. Prints `watching`, then each
value that the line had and for how many milliseconds.

It runs at real-time priority and sleeps between looks, so that on the guest's one processor
it is always served before the program it watches: however slow the machine, no pulse that
lasts longer than a look's sleep goes unseen."""
import os
import signal
import sys
import time

stopped = []
signal.signal(signal.SIGTERM, lambda *_: stopped.append(True))
os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(50))
line = os.open(sys.argv[1], os.O_RDONLY)
value, since = os.pread(line, 1, 0), time.monotonic()
print("watching", flush=True)
while not stopped:
    time.sleep(0.001)
    new, now = os.pread(line, 1, 0), time.monotonic()
    if new != value:
        print(value.decode(), round(1000 * (now - since), 1))
        value, since = new, now
print(value.decode(), round(1000 * (time.monotonic() - since), 1))
