"""Threads of Python that step, read, relax, run and go on beside one another, for the thread sanitizer (tests/threads/run)."""
from __future__ import annotations

import os
import tempfile
import threading
from collections.abc import Callable

import ropewalk

SCENE = {
    "parameters": "cnt-10-10-tersoff",
    "rope": {"tubes": 7, "length_nm": 110},
    "start": {"temperature_K": 300, "may_cool": True},
    "run": {"duration_ps": 1, "log_every_ps": 0.2, "frames_every_ps": 0.4},
}
failures: list[BaseException] = []


def beside_one_another(*tasks: Callable[[], object]) -> None:
    def guarded(task: Callable[[], object]) -> None:
        try:
            task()
        except BaseException as error:  # noqa: BLE001: told below
            failures.append(error)

    threads = [threading.Thread(target=guarded, args=(task,)) for task in tasks]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def step_and_read() -> None:
    simulation = ropewalk.Simulation(SCENE)
    for _ in range(5):
        simulation.step(3)
        simulation.measure()
        simulation.state, simulation.force, simulation.energies
    simulation.restore(simulation.checkpoint())
    simulation.step(3)


def read_while_another_steps() -> None:
    simulation, ends = ropewalk.Simulation(SCENE), threading.Event()

    def read() -> None:
        while not ends.is_set():
            repr(simulation)
            try:
                simulation.measure("beta_deg")
            except ropewalk.BusyError:
                pass

    reader = threading.Thread(target=read)
    reader.start()
    try:
        for _ in range(10):
            simulation.step(2)
    finally:
        ends.set()
        reader.join()


def relax() -> None:
    ropewalk.Simulation({**SCENE, "start": {"wave_nm": 0.5}}).relax(max_steps=30)


def run_and_go_on(name: str) -> None:
    ropewalk.run(SCENE, name, steps=30, threads=3)
    ropewalk.resume(name, steps=50)
    run = ropewalk.open(name)
    run.log["vdw_eV"], run.frames[-1].position


with tempfile.TemporaryDirectory() as folder:
    os.chdir(folder)
    ropewalk.set_threads(3)
    beside_one_another(step_and_read, step_and_read, read_while_another_steps, relax)
    beside_one_another(lambda: run_and_go_on("a"), lambda: run_and_go_on("b"), step_and_read)
    os.chdir("/")
if failures:
    raise failures[0]
