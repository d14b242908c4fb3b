#!/usr/bin/env python3
"""Stops short runs of all kinds of scenes, by every means and at random places, lets them go on, and compares their
files byte for byte with those of runs that were never stopped.

    tests/cli/stops.py ROPEWALK [--stops 300] [--seed 1] [--in FOLDER] [--only SCENE] [--means WORD]
"""
import argparse
import hashlib
import pathlib
import random
import re
import shutil
import signal
import subprocess
import tempfile
import time

HEAD = 'format = "ropewalk-scene-1"\nparameters = "cnt-10-10-tersoff"\n'
GRIPS = '[[grip]]\nend = "lower"\n[[grip]]\nend = "upper"\n'
TURNED = HEAD + "[rope]\ntubes = 7\nlength_nm = 14\n" + GRIPS + "about_z = { rotation_deg = [[0, 0], [9, 40]] }\n"
LINKED = HEAD + """[rope]
tubes = 7
length_nm = 30
[[links]]
per_nm = 0.2
stiffness_nN_per_nm = 100
breaks_at_nN = 5
forming_per_nm_ps = 0.002
most_per_nm = 0.6
[failure]
strain = 0.02
strain_deviation = 0.004
[[friction]]
from = "atoms"
""" + GRIPS + "z = { strain = [[0, 0], [20, 0.05]] }\n"
TETHERED = HEAD + """[rope]
tubes = 7
length_nm = 14
[[tether]]
tube = 0
elements = [0]
to_point_nm = [0, 0, -12]
stiffness_nN_per_nm = 20
breaks_at_nm = 6
""" + GRIPS.replace('"lower"\n', '"lower"\nz = "free"\n') + "z = { displacement_nm = [[0, 0], [8, 5]] }\n"
REFINED = HEAD + """element_length_nm = 4
[rope]
tubes = 7
length_nm = 30
[twist]
moment_nN_nm = 25
rate_nN_nm_per_ps = 4
"""
PAIR = HEAD + """element_length_nm = 1.356
[state]
file = "pair.csv"
[damping]
contact_viscosity_eV_ps_per_nm2 = 0
bond_damping_per_ps = 0
"""
FILES = ("final.csv", "final-memory.csv", "log.csv", "frames.gsd", "frames.lammpstrj", "limits.json", "events.csv")
MEANS = ("steps", "until", "steps twice", "TERM", "KILL", "KILL twice", "wall time", "limit", "rule", "branch")
ON_A_DEVICE = ("--device", "c++")


def run_table(duration, rows, frames, checkpoints):
    return (f"[run]\nduration_ps = {duration}\nlog_every_ps = {rows}\nframes_every_ps = {frames}\n"
            f"checkpoint_every_s = {checkpoints}\n")


# Two tubes that fly at one another, so that steps are halved.
def pair():
    text = "tube,x_nm,y_nm,z_nm,qw,qx,qy,qz,vx_nm_per_ps,vy_nm_per_ps,vz_nm_per_ps,"
    text += "wx_rad_per_ps,wy_rad_per_ps,wz_rad_per_ps\n"
    for tube, side in ((0, -1), (1, 1)):
        for k in range(10):
            text += f"{tube},{8 * side},0,{1.356 * k},1,0,0,0,{-3 * side},0,0,0,0,0\n"
    return text


# A template as a run of a fraction of a second: small, and all that happens forty times as early.
def shortened(text):
    def put(key, value):
        nonlocal text
        text = re.sub(rf"(?m)^{key} *= [^\[].*$", f"{key} = {value}", text)

    def number(key):
        found = re.search(rf"(?m)^{key} *= ([\d.]+)", text)
        return float(found[1]) if found else None

    yarn = "[periodic]" in text and "tube_length_nm" in text
    most = {"length_nm": 40 if yarn else 24, "tube_length_nm": 12, "tube_length_deviation_nm": 2, "hold_ps": 4,
            "unloaded_ps": 4, "placed_at_ps": 3, "width_nm": 40, "depth_nm": 40, "elements": 30,
            "tubes": 19 if "18]" in text else 8 if "[film]" in text else 7}
    for key, value in most.items():
        if number(key) is not None:
            put(key, f"{min(number(key), value):g}")
    for key, value in (("rate_nN_nm_per_ps", 6), ("unload_rate_nN_nm_per_ps", 6), ("force_tolerance_nN", 1e-5),
                       ("wave_nm", 0.3)):
        put(key, value)

    def sooner(line):
        by = 60 if "displacement" in line else 10
        return re.sub(r"\[(\d+(?:\.\d+)?), (-?[\d.]+)\]",
                      lambda m: f"[{float(m[1]) / 40:g}, {float(m[2]) / by:g}]", line)

    text = "\n".join(map(sooner, text.splitlines())) + "\n"
    text = re.sub(r"rate_((?:nm_|deg_|nN_)?per_ps) = ([\d.]+)", lambda m: f"rate_{m[1]} = {20 * float(m[2]):g}", text)
    return text if is_relaxation(text) else re.sub(r"(?m)^\[run\]$(\n.*)?", "", text)


def is_relaxation(text):
    return 'mode = "relax"' in text


class Bench:
    def __init__(self, program, folder, seed):
        self.program, self.folder, self.random = program, pathlib.Path(folder), random.Random(seed)
        self.scenes = {}  # name: (text, options)
        self.whole = {}   # name: facts of the run that was never stopped

    def run(self, *arguments):
        return subprocess.run([self.program, *map(str, arguments)], cwd=self.folder, capture_output=True, text=True)

    def add_all(self):
        pick = self.random.choice
        for line in self.run("new", "--list").stdout.splitlines():
            kind = line.split()[0]
            self.run("new", "template", "--kind", kind, "--short", "--force")
            text = shortened((self.folder / "template.toml").read_text())
            if is_relaxation(text):
                text += "checkpoint_every_s = 0.02\n"
            else:
                text += run_table(pick([7, 8.3, 11]), pick([0.3, 1, 4.1]), pick([0.9, 2.2]), pick([0.01, 1000]))
            self.scenes[kind] = (text, [])
        (self.folder / "pair.csv").write_text(pair())
        refine = ["--on-limit", "refine"]
        as_text = run_table(12, 1, 2, 0.01) + 'frames_format = "lammpstrj"\n'
        for name, text, table, options in (
                ("turned", TURNED, run_table(20, 2, 5, 1000), []), ("as-text", TURNED, as_text, []),
                ("turned-on-a-device", TURNED, run_table(20, 2, 5, 0.01), [*ON_A_DEVICE]),
                ("collided", PAIR, run_table(30, 1, 5, 0.01), []),
                ("collided-on-a-device", PAIR, run_table(30, 1, 5, 0.01), [*ON_A_DEVICE]),
                ("linked", LINKED, run_table(22, 1, 5, 0.01), []),
                ("tethered", TETHERED, run_table(12, 1, 3, 0.01), []),
                ("refined", REFINED, run_table(8, 0.7, 2, 0.01), refine),
                ("refined-few-rows", REFINED, run_table(8, 6.1, 3, 0.01), refine)):
            self.scenes[name] = (text + table, options)

    # A run and those in which it goes on.
    def stages(self, name):
        return sorted(p for p in self.folder.iterdir() if p.name == name or p.name.startswith(name + ".fine"))

    def hashes(self, name):
        return {f"{stage.name[len(name):]}/{file}": hashlib.sha256((stage / file).read_bytes()).hexdigest()
                for stage in self.stages(name) for file in FILES if (stage / file).exists()}

    def clear(self, name):
        for stage in self.stages(name):
            shutil.rmtree(stage)

    def make_whole(self, name):
        text, options = self.scenes[name]
        (self.folder / f"{name}.toml").write_text(text)
        self.clear("whole")
        began = time.time()
        done = self.run("run", f"{name}.toml", "--out", "whole", "--quiet", "--threads", 1, *options)
        if done.returncode not in (0, 7):
            raise SystemExit(f"{name}: {done.returncode} {done.stderr}")
        facts = {"seconds": time.time() - began, "hashes": self.hashes("whole"), "back": done.stderr.count("back to")}
        last = {stage.name[5:]: self.last_row(stage) for stage in self.stages("whole")}
        end = list(last.values())[-1]
        facts["steps"], facts["time"] = int(end["step"]), end["time_ps"]
        # Of each stage, had it gone on to the end: more are no steps of its scene.
        facts["most"] = {name: int(row["step"] + (end["time_ps"] - row["time_ps"]) / (1e-3 * row["time_step_fs"]))
                         if row["time_step_fs"] > 0 else int(row["step"]) for name, row in last.items()}
        self.clear("whole")
        self.whole[name] = facts

    @staticmethod
    def last_row(stage):
        names, *rows = [line.split(",") for line in (stage / "log.csv").read_text().splitlines()]
        return {n: float(x) for n, x in zip(names, rows[-1]) if n in ("step", "time_ps", "time_step_fs")}

    # The command that goes on with the last stage that can; None: there is none.
    def resume(self, options):
        for stage in reversed(self.stages("part")):
            if any((stage / f"checkpoint{end}.bin").exists() for end in ("", "-before")):
                return ["resume", stage.name, "--quiet", "--threads", 1,
                        *[o for o in options if o not in ON_A_DEVICE]]
        return None

    def kill(self, command, after, how):
        child = subprocess.Popen([self.program, *map(str, command)], cwd=self.folder, stdout=subprocess.DEVNULL,
                                 stderr=subprocess.DEVNULL)
        time.sleep(after)
        child.send_signal(how)
        child.wait()

    # Stops a run of this scene. Returns where, and the hashes that are expected; None: it cannot be stopped so.
    def stop(self, name, means):
        text, options = self.scenes[name]
        facts, pick = self.whole[name], self.random
        expected = facts["hashes"]
        start = ["run", f"{name}.toml", "--out", "part", "--quiet", "--threads", 1, *options]
        if means in ("steps", "until", "steps twice"):
            ends = sorted(pick.randrange(0, max(2, facts["steps"])) for _ in range(1 + means.endswith("twice")))
            option = "--until" if means == "until" and not is_relaxation(text) else "--steps"
            if option == "--until":
                ends = [end * facts["time"] / facts["steps"] for end in ends]

            def within(stage, end):
                return min(end, facts["most"][stage]) if option == "--steps" else end

            ends[0] = within("", ends[0])
            self.run(*start, option, ends[0])
            for k in range(1, len(ends)):
                command = self.resume(options)
                ends[k] = within(command[1][len("part"):], ends[k])
                self.run(*command, option, ends[k])
            return f"{option} {ends}", expected
        if means in ("TERM", "KILL", "KILL twice"):
            delays = [pick.uniform(0.02, 1 / (1 + k)) * facts["seconds"] for k in range(1 + means.endswith("twice"))]
            how = signal.SIGTERM if means == "TERM" else signal.SIGKILL
            for k, delay in enumerate(delays):
                command = start if k == 0 else self.resume(options)
                if command:
                    self.kill(command, delay, how)
            return f"after {delays} s", expected
        if means == "wall time":
            self.run(*start, "--wall-time", 1)
            return "after half a second", expected
        if options or is_relaxation(text):
            return None
        if means == "limit":
            return ("at a limit", expected) if self.run(*start, "--on-limit", "stop").returncode == 5 else None
        at = pick.uniform(0.1, 0.95) * facts["time"]
        if means == "rule":
            rule = f'[[stop]]\nwhen = "above"\ncolumn = "time_ps"\nvalue = {at}\n'
            (self.folder / "ruled.toml").write_text(text + rule)
            self.run("run", "ruled.toml", *start[2:])
            (self.folder / "part" / "scene.toml").write_text(text)
            return f"by a rule at {at} ps", expected
        if "[rope]" not in text:
            return None
        changed = text.replace("[run]", "[observe]\nneighbour_radius_nm = 2\n[run]")
        (self.folder / "changed.toml").write_text(changed)
        self.run("run", "changed.toml", *start[2:])
        expected = self.hashes("part")
        self.clear("part")
        (self.folder / "branched.toml").write_text(
            f'format = "ropewalk-sweep-1"\nscene = "changed.toml"\n[vary]\nname = ["a"]\n[branch]\nat_ps = {at}\n'
            "[branch.vary]\nobserve.neighbour_radius_nm = [2]\n")
        shutil.rmtree(self.folder / "branched", ignore_errors=True)
        self.run("sweep", "branched.toml", "--out", "branched", "--quiet", "-j", 1)
        shutil.move(str(next((self.folder / "branched" / "points").iterdir())), str(self.folder / "part"))
        return f"from a branch at {at} ps", expected

    # The files that differ in a run of this scene that was stopped and went on, and where it stopped; None: as stop().
    def differ(self, name, means):
        self.clear("part")
        stopped = self.stop(name, means)
        command = stopped and self.resume(self.scenes[name][1])
        if not command:
            return None
        done = self.run(*command)
        where, expected = stopped
        found = self.hashes("part")
        wrong = sorted(f for f in {*found, *expected} if found.get(f) != expected.get(f))
        return where + (f" ({done.stderr.strip()[-150:]})" if wrong and done.returncode not in (0, 7) else ""), wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--stops", type=int, default=300)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--in", dest="folder")
    parser.add_argument("--only", default="", help="part of the name of a scene")
    parser.add_argument("--means", default="", help="part of the name of a means")
    a = parser.parse_args()
    folder = a.folder or tempfile.mkdtemp(prefix="ropewalk-stops-")
    pathlib.Path(folder).mkdir(parents=True, exist_ok=True)
    bench = Bench(str(pathlib.Path(a.program).resolve()), folder, a.seed)
    bench.add_all()
    names, means = [n for n in bench.scenes if a.only in n], [m for m in MEANS if a.means in m]
    for name in names:
        bench.make_whole(name)
        f = bench.whole[name]
        print(f"{name}: {f['steps']} steps, {f['time']:.4g} ps, {f['seconds']:.2f} s, {f['back']} times back", flush=True)
    tried, wrong, count = 0, 0, {}
    for k in range(20 * a.stops):
        name, how = names[k % len(names)], means[(k // len(names) + k) % len(means)]
        result = bench.differ(name, how) if tried < a.stops else None
        if result is None:
            continue
        tried += 1
        count[how] = count.get(how, 0) + 1
        if result[1]:
            wrong += 1
            print(f"differs: {name}, {how} {result[0]}: {', '.join(result[1])}", flush=True)
    print(f"{tried} stops, {wrong} differ; {count}")
    raise SystemExit(wrong > 0)


if __name__ == "__main__":
    main()
