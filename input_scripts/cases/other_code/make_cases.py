# make_cases.py WORK [JOBS]: makes cases.csv and curves/ with Yade and `calendem pack` (both on the PATH). A run takes
# about a minute; finished ones are kept in WORK.
import csv
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

here = os.path.dirname(os.path.abspath(__file__))
work = sys.argv[1]
jobs = int(sys.argv[2]) if len(sys.argv) > 2 else 2
CAUSES = {
    "none": [0, 0, 0, 0, 0, 0],
    "friction": [0.1, 0.2, 0.3, 0.5],
    "cbd_collapse": [15, 25, 40, 60],
    "pre_cracks": [0.2, 0.35, 0.5],
    "weibull_strength": [1.5, 2, 3],
    "body_scatter": [0.4, 0.7, 1],
    "soft_cbd": [0.5, 0.7, 1.4],
    "rolling_resistance": [0.1, 0.3, 0.5],
    "speed": [0.7, 1.5, 2],
}
RECORD = {  # faults of the press, in records of films without a cause
    "machine_compliance": [0.005, 0.01, 0.02, 0.03],  # um/MPa
    "thickness_zero": [0.5, 1, -0.7, -1.2],  # um
}
SOLID_UM = 13.6986  # solid volume over the cell's area: 1369.86 um3 on 100 um2


def truths():
    yield "before", "none", 0
    number, most = 0, max(len(v) for v in CAUSES.values())
    for k in range(most):  # one amount of each cause in turn
        for cause, amounts in CAUSES.items():
            if k < len(amounts):
                number += 1
                yield f"case_{number:02d}", cause, amounts[k]


def press(seed, pressure, cause, amount):
    electrode, out = f"{work}/packing_{seed}", f"{work}/{seed}_{pressure}_{cause}_{amount}.csv"
    if not os.path.exists(f"{electrode}/electrode.data"):
        subprocess.run(["calendem", "pack", f"{here}/../bank/electrode.toml", "-o", electrode, "--seed", str(seed)],
                       check=True, stdout=subprocess.DEVNULL)
    if not os.path.exists(out):
        words = [f"max_pressure_MPa={pressure}", f"seed={seed}"] + ([] if cause == "none" else [f"{cause}={amount}"])
        subprocess.run(["yade", "-n", "-x", "-j1", f"{here}/press_yade.py", electrode, out + ".part", *words], check=True,
                       stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env={**os.environ, "OMP_NUM_THREADS": "1"})
        os.rename(out + ".part", out)
    rows, last = [], []
    with open(out) as file:
        for line in file.readlines()[1:]:
            if line.startswith("#"):
                last = line[1:].split()
            else:
                stage, gap, p = line.split(",")
                rows.append((stage, float(gap), float(p)))
    return rows, dict(zip(last[::2], map(float, last[1::2])))


def main():
    os.makedirs(work, exist_ok=True)
    os.makedirs(f"{here}/curves", exist_ok=True)
    every = list(truths())
    with ThreadPoolExecutor(jobs) as pool:
        runs = [[pool.submit(press, 2 * k + 301 + j, pressure, cause, amount) for j, pressure in enumerate((80, 150))]
                for k, (_, cause, amount) in enumerate(every)]
        films = []
        for (name, cause, amount), pair in zip(every, runs):
            films.append((name, cause, amount, [r.result() for r in pair]))
            print(name, cause, amount, [f"{100 * (1 - SOLID_UM / r['after']):.1f} %, broken {r['broken']:.3f}" for _, r in films[-1][3]],
                  flush=True)
    intact = [pair for name, cause, _, pair in films if cause == "none" and name != "before"]
    number = len(films) - 1
    for cause, amounts in RECORD.items():
        for amount in amounts:
            number += 1
            films.append((f"case_{number:02d}", cause, amount, intact[number % len(intact)]))
    with open(f"{here}/cases.csv", "w") as file:
        table = csv.writer(file, lineterminator="\n")
        table.writerow(["name", "cause", "amount", "thickness_at_80_um", "porosity_after_80_percent", "thickness_at_150_um",
                        "porosity_after_150_percent", "broken_bonds_fraction"])
        for name, cause, amount, pair in films:
            chance, cells = random.Random(name), []
            for pressure, (rows, result) in zip((80, 150), pair):
                compliance = amount if cause == "machine_compliance" else 0.0
                zero = amount if cause == "thickness_zero" else 0.0
                touch = result["top"]  # the zero of displacements is the packing's surface
                with open(f"{here}/curves/{name}_{pressure}.csv", "w") as curve:
                    curve.write("displacement_um,pressure_MPa,stage\n")
                    for s, g, p in rows[::4]:
                        if p > 0.01 * pressure:
                            curve.write(f"{touch - g + compliance * p + chance.gauss(0, 0.05):.3f},{p:.3f},{s}\n")
                cells.append(f"{result['at_max'] + zero + chance.gauss(0, 0.2):.3f}")
                after = result["after"] + zero
                cells.append(f"{100 * (1 - SOLID_UM / after) + chance.gauss(0, 0.4):.2f}")
            table.writerow([name, cause, amount, *cells, f"{pair[1][1]['broken']:.3f}"])


main()
