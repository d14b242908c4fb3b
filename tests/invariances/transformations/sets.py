"""Parameter sets and the tables that they were fitted to."""
import math
import subprocess
import tomllib

from bench import Scene, near, skip_if
from transformations.common import element_length, transformation


def table_of(case):
    """The rows of energies of atoms that the first set of the scene was fitted to."""
    name = case.scene.sets()[0]
    path = case.bench.data("parameters") / f"{name}-stiffness.csv"
    skip_if(not path.exists(), "its set has no table of atoms")
    lines = path.read_text().splitlines()
    body = [line for line in lines if not line.startswith("#")]
    names = body[0].split(",")
    return name, lines, [dict(zip(names, line.split(","))) for line in body[1:]]


@transformation
def tube_and_its_atoms(case):
    """A tube that is stretched and twisted, by `energy` in the elements of the scene, and by the atoms of its set."""
    name, _, rows = table_of(case)
    kinds = ("stretch-twist", "wide-stretch-twist", "pull")
    rows = [r for r in rows if r["kind"] in kinds and float(r["energy_eV"]) > 0.5]
    a, count = element_length(case), 12
    # Of the pull what follows the atoms: up to the end that the set states.
    text = tomllib.loads((case.bench.data("parameters") / f"{name}.toml").read_text())["bond"]
    end = text.get("pull", {}).get("end", {}).get("value", text["anharmonic"]["max_strain"]["value"])
    for row in case.random.sample(rows, 6) + [r for r in rows if r["kind"] == "pull"][-4::2]:
        strain, twist = float(row["strain"]), float(row["twist_rad_per_nm"])
        if strain > end:
            continue
        state = case.base.state().without_memory()
        state.notes = [f"# element_length_nm: {a!r}"]
        state.rows = [(0, (0.0, 0.0, k * a * (1 + strain)), (math.cos(k * a * twist / 2), 0.0, 0.0,
                                                             math.sin(k * a * twist / 2)),
                       (0.0, 0.0, 0.0), (0.0, 0.0, 0.0)) for k in range(count)]
        tube = Scene({"parameters": name, "contact": {"law": "none"}})
        found = case.energy(state, tube)["energy_eV"]["total"] / ((count - 1) * a)
        near(f"energy per nm at strain {strain:.3g} and twist {twist:.3g}/nm", found,
             float(row["energy_eV"]) / float(row["length_nm"]), 0.03)


@transformation
def table_of_atoms_fitted_again(case):
    """The order of the rows of a table that is fitted, and from where its energies count, if that is not refused."""
    name, lines, rows = table_of(case)
    program = case.bench.build / "calibrate" / "ropewalk-calibrate"
    skip_if(not program.exists(), "ropewalk-calibrate is not built")
    case.kept(f"fit of {name}", lambda _: fit_again(case, program, name, lines, rows))


def fit_again(case, program, name, lines, rows):
    (case.folder / "fit.toml").write_text(
        f'format = "ropewalk-fit-1"\nmodel = "stiffness"\nbase = "{name}"\nfree = ["EA", "GJ", "EI"]\n')
    rows = [r for r in rows if r["kind"] == "stretch-twist" or r["kind"].startswith("bend-")]

    def fitted(some):
        text = [line for line in lines if line.startswith("#")] + [",".join(some[0])]
        text += [",".join(r.values()) for r in some]
        (case.folder / "fit.csv").write_text("\n".join(text) + "\n")
        done = subprocess.run([str(program), "fit", "fit.csv", "fit.toml"], cwd=case.folder, capture_output=True,
                              text=True)
        if done.returncode != 0:
            return None
        return {w[0]: float(w[1]) for w in map(str.split, done.stdout.splitlines()) if w and w[0] in ("EA", "GJ", "EI")}

    first = fitted(rows)
    for words, other in (("in another order", fitted(case.random.sample(rows, len(rows)))),
                         ("with 0.5 eV more in each row",
                          fitted([{**r, "energy_eV": repr(float(r["energy_eV"]) + 0.5)} for r in rows]))):
        if other is None and "more" in words:
            continue  # it is refused
        for key, value in first.items():
            near(f"{key} {words}", value, (other or {}).get(key, math.nan), 1e-3)
    return first
