#!/usr/bin/env python3
"""How the service holds a load: reads, submissions and event streams at once, over a store that is
already large. Prints figures; nothing here passes or fails.

    tests/benchmarks/service_load.py build/repose --evaluations 100000 --seconds 60
"""
import argparse
import http.client
import json
import os
import pathlib
import random
import re
import socket
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time

HERE = pathlib.Path(__file__).resolve().parent.parent.parent
STUDY = (HERE / "schemas/examples/valid/boac2010-soybean.json").read_bytes()
DROP = (HERE / "schemas/examples/valid/drop-minimal.json").read_bytes()


class Service:
    """A running `repose serve` on a free port."""

    def __init__(self, program, database):
        self.begin = time.perf_counter()
        self.process = subprocess.Popen(
            [program, "serve", "--port", "0", "--db", database, "--workers", "1"],
            stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True)
        self.port = int(re.search(r":(\d+)/", self.process.stdout.readline()).group(1))
        while (status := self.get("/readyz")[0]) != 200:
            if status != 503:
                sys.exit(f"{program} answers {status} to /readyz: it is not of this source tree")
        self.seconds_to_ready = time.perf_counter() - self.begin

    def connect(self):
        connection = http.client.HTTPConnection("127.0.0.1", self.port, timeout=60)
        connection.connect()
        connection.sock.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        return connection

    def get(self, path):
        connection = self.connect()
        connection.request("GET", path)
        answer = connection.getresponse()
        return answer.status, answer.read()

    def memory(self):
        """Resident, MiB."""
        text = pathlib.Path(f"/proc/{self.process.pid}/status").read_text()
        return int(re.search(r"VmRSS:\s+(\d+)", text).group(1)) / 1024

    def processor_seconds(self):
        fields = pathlib.Path(f"/proc/{self.process.pid}/stat").read_text().rsplit(")", 1)[1].split()
        return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")

    def worked_out(self):
        """Answers worked out within each time, s: without the wait for a processor or the client."""
        page = self.get("/metrics")[1].decode()
        return {float(bound): int(count) for bound, count in
                re.findall(r'repose_request_seconds_bucket\{le="([^"]+)"\} (\d+)', page)}

    def stop(self):
        self.process.terminate()
        self.process.wait()


def fill(database, evaluations):
    """Puts evaluations of one finished calibration into the store of a service that is stopped."""
    store = sqlite3.connect(database)
    key, question, answer, seconds, version, created = store.execute(
        "SELECT key, question, answer, seconds, engine_version, created_at FROM evaluation LIMIT 1"
    ).fetchone()
    owner = store.execute("SELECT min(calibration_id) FROM calibration_evaluation").fetchone()[0]
    first = store.execute("SELECT max(ordinal) + 1 FROM calibration_evaluation").fetchone()[0]
    answer = answer + " " * max(0, 1500 - len(answer))  # as long as one with several observables
    with store:
        store.executemany(
            "INSERT INTO evaluation VALUES (?, ?, ?, ?, ?, ?)",
            ((f"{i:064x}", question, answer, seconds, version, created)
             for i in range(evaluations)))
        store.executemany(
            "INSERT INTO calibration_evaluation VALUES (?, ?, ?)",
            ((owner, first + i, f"{i:064x}") for i in range(evaluations)))
    store.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    store.close()


def pace(service, rate, seconds, ask, threads):
    """Calls ask(connection, number) that many times a second; the times it took, ms, and failures.
    A time counts from when the call was due, so that a stall is not hidden."""
    times, failures, lock = [], [0], threading.Lock()
    begin = time.perf_counter()

    def work(index):
        connection = service.connect()
        for number in range(index, int(rate * seconds), threads):
            due = begin + number / rate
            time.sleep(max(0.0, due - time.perf_counter()))
            good = ask(connection, number)
            with lock:
                times.append(1000 * (time.perf_counter() - due))
                failures[0] += 0 if good else 1

    workers = [threading.Thread(target=work, args=(i,)) for i in range(threads)]
    for worker in workers:
        worker.start()
    return workers, times, failures


def summary(name, rate, times, failures):
    if not times:
        return
    times = sorted(times)
    at = lambda share: times[min(len(times) - 1, int(share * len(times)))]
    print(f"{name:12} {rate:4}/s  {len(times):6} done  {failures[0]:3} failed   "
          f"median {at(0.5):7.1f} ms   p99 {at(0.99):7.1f} ms   longest {times[-1]:7.1f} ms", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("program")
    parser.add_argument("--evaluations", type=int, default=100000)
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--reads", type=int, default=200, help="a second")
    parser.add_argument("--submits", type=int, default=20, help="a second")
    parser.add_argument("--streams", type=int, default=200)
    options = parser.parse_args()
    folder = tempfile.TemporaryDirectory(prefix="repose-load-")
    database = folder.name + "/load.db"

    subprocess.run([options.program, "calibrate", "-", "--db", database, "--no-pictures",
                    "--report", folder.name + "/report.html"],
                   input=DROP, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, check=True)
    fill(database, options.evaluations)
    service = Service(options.program, database)
    print(f"ready after {service.seconds_to_ready:.2f} s with {options.evaluations} evaluations")

    paths = ["/v1/calibrations", "/v1/calibrations/1", "/v1/fits?latest=true", "/v1/best-fits",
             "/metrics"]
    random.seed(1)

    def read(connection, number):
        path = paths[number % len(paths)]
        if number % 4 == 0:
            after = random.randrange(options.evaluations)
            path = f"/v1/calibrations/1/evaluations?limit=20&after={after}"
        connection.request("GET", path)
        answer = connection.getresponse()
        answer.read()
        return answer.status == 200

    submitted = []

    def submit(connection, number):
        connection.request("POST", "/v1/calibrations", STUDY,
                           {"Content-Type": "application/json", "Idempotency-Key": f"load-{number}"})
        answer = connection.getresponse()
        body = json.loads(answer.read())
        if answer.status == 202:
            submitted.append(body["id"])
        return answer.status == 202

    events = [0] * options.streams

    def follow(index):
        stream = socket.create_connection(("127.0.0.1", service.port))
        stream.sendall(b"GET /v1/events HTTP/1.1\r\nHost: localhost\r\n\r\n")
        while block := stream.recv(65536):
            events[index] += block.count(b"\nid: ")

    for index in range(options.streams):
        threading.Thread(target=follow, args=(index,), daemon=True).start()
    while f"repose_event_streams {options.streams}\n".encode() not in service.get("/metrics")[1]:
        time.sleep(0.05)

    memory = service.memory()
    begin = time.perf_counter()
    before, used = service.worked_out(), service.processor_seconds()
    readers = pace(service, options.reads, options.seconds, read, 32)
    writers = pace(service, options.submits, options.seconds, submit, 8)
    over_time = []  # MiB, at the end of each tenth
    for tenth in range(1, 11):
        time.sleep(max(0.0, begin + tenth * options.seconds / 10 - time.perf_counter()))
        over_time.append(service.memory())
    for worker in readers[0] + writers[0]:
        worker.join()
    summary("reads", options.reads, *readers[1:])
    summary("submissions", options.submits, *writers[1:])
    worked_out = {bound: count - before[bound] for bound, count in service.worked_out().items()}
    all_answers = worked_out[float("inf")]  # of all routes, these figures' own among them
    for share in (0.5, 0.99):
        bound = min(b for b, count in worked_out.items() if count >= share * all_answers)
        print(f"in service   {100 * share:.0f} % of {all_answers} answers worked out within "
              f"{1000 * bound:g} ms")
    print(f"processor    {service.processor_seconds() - used:.1f} s by the service in "
          f"{options.seconds:.0f} s; load average {os.getloadavg()[0]:.1f}")
    print(f"streams      {options.streams} open, {min(events)} to {max(events)} events on each")
    print(f"memory       {memory:.0f} MiB before, then by tenths of the time "
          + " ".join(f"{each:.1f}" for each in over_time))
    service.stop()
    with sqlite3.connect(database) as store:
        kept = store.execute("SELECT count(*) FROM calibration").fetchone()[0] - 1
        gaps = store.execute("SELECT max(id) - count(*) FROM event").fetchone()[0]
    print(f"kept         {kept} of {len(set(submitted))} acknowledged, {gaps} gaps among the events")


if __name__ == "__main__":
    sys.exit(main())
