#!/usr/bin/python3
# Figure and table of the page on powder, and the numbers behind them, from the runs of its study:
#   docs/figures/powder.py build/studies/powder/runs/*/
# Without runs they are made again from the numbers (input_scripts/cases/studies/results/powder.csv).
import csv
import json
import pathlib
import statistics
import sys

here = pathlib.Path(__file__).resolve().parent
table = here.parent.parent / "input_scripts/cases/studies/results/powder.csv"
# MPa: porosity, %, under load, after release (doi:10.1021/acsami.6c03789, Figure 4a, digitised)
measured = {50: (33.87, 34.51), 100: (30.40, 32.01), 150: (27.19, 29.42), 200: (23.35, 27.00), 250: (20.63, 25.46),
            300: (None, 23.98), 350: (15.68, 22.12)}
names, colours = ["under load", "after release"], ["#0060ad", "#c04020"]

if len(sys.argv) > 1:
    rows = []
    for run in map(pathlib.Path, sys.argv[1:]):
        seed = json.load(open(run / "electrode.json"))["provenance"]["seed"]
        for press in json.load(open(run / "summary.json"))["presses"]:
            rows.append([seed, round(press["pressure_MPa"])] +
                        [round(100 * press[key], 2) for key in ("porosity_loaded", "porosity_released", "cracked_fraction", "broken_fraction")])
    with open(table, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(["seed", "pressure_MPa", "porosity_under_load_percent", "porosity_after_percent", "cracked_percent", "broken_percent"])
        out.writerows(sorted(rows))
runs = list(csv.DictReader(open(table)))
values = lambda pressure, key: [float(r[key]) for r in runs if float(r["pressure_MPa"]) == pressure]
keys = ["porosity_under_load_percent", "porosity_after_percent"]

print("| MPa | under load, simulated | measured | difference | after release, simulated | measured | difference | broken bonds |\n" + "|---" * 8 + "|")
for pressure, truth in measured.items():
    cells = [str(pressure)]
    for key, value in zip(keys, truth):
        mean, error = statistics.mean(values(pressure, key)), statistics.stdev(values(pressure, key)) / len(values(pressure, key)) ** 0.5
        cells += [f"{mean:.1f} ± {error:.1f}"] + ([f"{value:.1f}", f"{mean - value:+.1f}".replace("-", "−")] if value else ["–", "–"])
    print("| " + " | ".join(cells + [f'{statistics.mean(values(pressure, "broken_percent")):.1f} %']) + " |")

width, height, left, top, bottom, most = 620, 400, 56, 34, 48, 370
x = lambda pressure: left + pressure * (width - left - 12) / most
y = lambda porosity: top + (40 - porosity) * (height - top - bottom) / 30
svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
       'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="#fff"/>']
for tick in (10, 20, 30, 40):
    svg.append(f'<path d="M{left} {y(tick):.1f}H{width - 12}" stroke="#e4e6ea"/><text x="{left - 8}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick}</text>')
for tick in range(0, most, 100):
    svg.append(f'<text x="{x(tick):.1f}" y="{height - bottom + 18}" text-anchor="middle">{tick}</text>')
svg.append(f'<text x="{(left + width) / 2}" y="{height - 8}" text-anchor="middle">Pressure (MPa)</text>'
           f'<text transform="translate(16 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">Porosity (%)</text>')
for k, (name, colour) in enumerate(zip(names, colours)):
    svg.append(f'<circle cx="{left + 10 + 140 * k}" cy="16" r="5" fill="{colour}"/><text x="{left + 22 + 140 * k}" y="20">{name}</text>')
    known = [(pressure, truth[k]) for pressure, truth in measured.items() if truth[k]]
    svg.append(f'<polyline points="{" ".join(f"{x(p):.1f},{y(v):.1f}" for p, v in known)}" fill="none" stroke="{colour}"/>')
    svg += [f'<circle cx="{x(p):.1f}" cy="{y(v):.1f}" r="5" fill="{colour}"/>' for p, v in known]
    svg += [f'<circle cx="{x(float(r["pressure_MPa"])):.1f}" cy="{y(float(r[keys[k]])):.1f}" r="4" fill="#fff" stroke="{colour}" stroke-width="1.5"/>' for r in runs]
svg.append(f'<text x="{width - 12}" y="20" text-anchor="end">filled: measured; open: three packings</text>')
(here / "powder.svg").write_text("\n".join(svg + ["</svg>", ""]))
