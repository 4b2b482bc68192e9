#!/usr/bin/python3
# Figure of the page on simulation and press, and the table behind it, from the finished study:
#   docs/figures/from_paper.py build/from_paper
import csv
import json
import pathlib
import statistics
import sys

here = pathlib.Path(__file__).resolve().parent
table = here.parent.parent / "input_scripts/cases/studies/results/from_paper.csv"
steps = ["the paper's model", "particles of grains,\nwith a surface", "strength, hardness\nas measured", "friction 0.2", "binder yields:\nreference material"]
measured = {80: (27.75, 0.23), 150: (25.17, 1.2)}  # Table 1
study = pathlib.Path(sys.argv[1])
rows = []
for run in csv.DictReader(open(study / "study.csv")):
    presses = json.load(open(study / "runs" / run["run"] / "summary.json"))["presses"]
    for press in presses:
        rows.append([(int(run["number"]) - 1) // 3 + 1, run["recipe.seed"], round(press["pressure_MPa"])] +
                    [round(100 * press[key], 2) for key in ("porosity_loaded", "porosity_released", "cracked_fraction")])
with open(table, "w", newline="") as file:
    out = csv.writer(file, lineterminator="\n")
    out.writerow(["step", "seed", "pressure_MPa", "porosity_under_load_percent", "porosity_after_percent", "cracked_percent"])
    out.writerows(rows)

width, height, left, top, bottom = 760, 400, 56, 46, 78
x = lambda step: left + (step - 0.5) * (width - left - 12) / len(steps)
y = lambda porosity: top + (40 - porosity) * (height - top - bottom) / 30
colours = {80: "#0060ad", 150: "#c04020"}
svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
       f'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">', '<rect width="100%" height="100%" fill="#fff"/>']
for tick in (10, 20, 30, 40):
    svg.append(f'<path d="M{left} {y(tick):.1f}H{width - 12}" stroke="#e4e6ea"/><text x="{left - 8}" y="{y(tick) + 4:.1f}" text-anchor="end">{tick}</text>')
svg.append(f'<text transform="translate(16 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">Porosity after release (%)</text>')
for k, (pressure, colour) in enumerate(colours.items()):
    value, sd = measured[pressure]
    svg.append(f'<rect x="{left}" y="{y(value + sd):.1f}" width="{width - left - 12}" height="{y(value - sd) - y(value + sd):.1f}" fill="{colour}" opacity="0.25"/>')
    svg.append(f'<circle cx="{left + 10 + 190 * k}" cy="16" r="5" fill="{colour}"/><text x="{left + 22 + 190 * k}" y="20">simulated, {pressure} MPa</text>')
    points = []
    for step in range(1, len(steps) + 1):
        values = [r[4] for r in rows if r[0] == step and r[2] == pressure]
        mean, error = statistics.mean(values), statistics.stdev(values) / len(values) ** 0.5
        points.append(f"{x(step):.1f},{y(mean):.1f}")
        svg.append(f'<path d="M{x(step):.1f} {y(mean - error):.1f}V{y(mean + error):.1f}" stroke="{colour}" stroke-width="2"/>'
                   f'<circle cx="{x(step):.1f}" cy="{y(mean):.1f}" r="5" fill="{colour}"/>')
    svg.append(f'<polyline points="{" ".join(points)}" fill="none" stroke="{colour}" stroke-dasharray="4 4"/>')
svg.append(f'<rect x="{left + 390}" y="9" width="22" height="14" fill="#888" opacity="0.35"/><text x="{left + 418}" y="20">measured (Table 1), ± 1 sd</text>')
for step, name in enumerate(steps, 1):
    for line, part in enumerate(name.split("\n")):
        svg.append(f'<text x="{x(step):.1f}" y="{height - bottom + 24 + 16 * line}" text-anchor="middle" font-size="12">{part}</text>')
(here / "from_paper.svg").write_text("\n".join(svg + ["</svg>", ""]))
