#!/usr/bin/python3
# Figure and table of the index of the validation pages, measured against simulated: four films pressed of the reference
# material, and the numbers behind them, from the study as far as it is finished:
#   docs/figures/films_pressed.py build/films_pressed
# Without a folder they are made again from the numbers (docs/validation/films_pressed.csv).
import csv
import html
import json
import math
import pathlib
import statistics
import sys
import tomllib

here = pathlib.Path(__file__).resolve().parent
cases, numbers = here.parent.parent / "input_scripts/cases", here.parent / "validation/films_pressed.csv"
films = {"Table 1": "paper", "ARTISTIC 42 %": "real/artistic_96", "BLB 90:6:4": "real/blb_nmc111_90", "Zhang 42.4 %": "real/zhang_nmc111_96"}
shown = ["Table 1", "ARTISTIC, 42 %", "BLB, 90 : 6 : 4", "Zhang, 96 : 2 : 2"]
colours = ["#0060ad", "#c04020", "#1a8050", "#8040a0"]
fitted = ["yes", "yes", "no", "no"]  # one value of the material: calibrated_on in nmc111.toml
ONE_PACKING, ENOUGH = 1.0, 8  # points: standard deviation of one packing's porosity, where fewer differences of packings tell it


def between(points, x):
    """Linear between the first point and the last, level beyond them."""
    (x0, y0), (x1, y1) = points[0], points[-1]
    return y0 + (y1 - y0) * min(max((x - x0) / (x1 - x0), 0), 1)


def first_met(file, pressure, column):
    """Value of a column where the film is first loaded that far; the platen stops a little below its target."""
    before = None
    for row in csv.DictReader(line for line in open(file) if not line.startswith("#")):
        now = float(row["pressure_MPa"]), float(row[column])
        if now[0] >= 0.995 * pressure:
            part = min((pressure - before[0]) / (now[0] - before[0]), 1)
            return before[1] + (now[1] - before[1]) * part
        before = now
    raise SystemExit(f"{file}: {pressure} MPa were not reached")


def conditions(film):
    with open(cases / films[film] / "experiment.toml", "rb") as file:
        return [c for c in tomllib.load(file)["condition"] if "porosity_after_percent" in c and "max_pressure_MPa" in c]


def read(study):
    """Rows of the table of numbers. A film springs back linearly in the pressure between its two presses."""
    rows = []
    for run in csv.DictReader(open(study / "study.csv")):
        folder = study / "runs" / run["run"]
        if run["status"] != "done":
            continue
        presses = json.load(open(folder / "summary.json"))["presses"]
        back = [(p["pressure_MPa"], p["porosity_released"] - p["porosity_loaded"]) for p in presses]
        for condition in conditions(run["recipe.name"]):
            at = condition["max_pressure_MPa"]["value"]
            press = min(presses, key=lambda p: abs(math.log(p["pressure_MPa"] / at)))
            met = abs(press["pressure_MPa"] / at - 1) < 0.02
            loaded = press["porosity_loaded"] if met else first_met(folder / "curve.csv", at, "porosity_total")
            after = press["porosity_released"] if met else loaded + between(back, at)
            cracked = first_met(folder / "cracks.csv", at, "cracked_fraction")
            rows.append([run["recipe.name"], run["recipe.seed"], at] + [round(100 * v, 2) for v in (loaded, after, cracked)])
    return sorted(rows, key=lambda r: (list(films).index(r[0]), r[2], r[1]))


header = ["film", "seed", "pressure_MPa", "porosity_under_load_percent", "porosity_after_percent", "cracked_percent"]
if len(sys.argv) > 1:
    with open(numbers, "w", newline="") as file:
        out = csv.writer(file, lineterminator="\n")
        out.writerow(header)
        out.writerows(read(pathlib.Path(sys.argv[1])))
runs = list(csv.DictReader(open(numbers)))

# Each reading, and the error of its simulation: of the packings, and of the pressure by the measured film's own slope.
readings, scatters = [], []
for n, film in enumerate(films):
    for condition in conditions(film):
        at = condition["max_pressure_MPa"]
        same = [r for r in runs if r["film"] == film and float(r["pressure_MPa"]) == at["value"]]
        if not same:
            continue
        after, cracked = ([float(r[key]) for r in same] for key in ("porosity_after_percent", "cracked_percent"))
        if len(after) > 1:
            scatters.append((statistics.variance(after), len(after) - 1))
        measured = condition["porosity_after_percent"]
        readings.append({"film": n, "at": at["value"], "pressure": at["sd_relative"], "measured": measured["value"], "sd": measured["sd"],
                         "after": statistics.mean(after), "cracked": statistics.mean(cracked), "packings": len(after)})
more = sum(n for _, n in scatters)
packing = math.sqrt(sum(v * n for v, n in scatters) / more) if more >= ENOUGH else ONE_PACKING
for r in readings:
    curve = [q for q in readings if q["film"] == r["film"]]
    k = curve.index(r)
    low, high = curve[max(k - 1, 0)], curve[min(k + 1, len(curve) - 1)]
    slope = (high["measured"] - low["measured"]) / math.log(high["at"] / low["at"]) if high is not low else 0
    r["own"] = math.hypot(slope * r["pressure"], packing / math.sqrt(r["packings"]))
    r["z"] = (r["after"] - r["measured"]) / math.hypot(r["own"], r["sd"])

lines = ["| film | fitted to | MPa | measured, % | simulated, % | difference, points | in standard deviations | cracked particles, % |", "|---|---|---|---|---|---|---|---|"]
for r in readings:
    off = r["after"] - r["measured"]
    lines.append(f'| {shown[r["film"]]} | {fitted[r["film"]]} | {r["at"]:.3g} | {r["measured"]:.1f} ± {r["sd"]:.1f} | {r["after"]:.1f} ± {packing / math.sqrt(r["packings"]):.1f} '
                 f'| {off:+.1f} | {r["z"]:+.1f} | {r["cracked"]:.0f} |'.replace("-", "−").replace("|−−−", "|---"))
offs = sorted(abs(r["after"] - r["measured"]) for r in readings)
packings = [len({r["seed"] for r in runs if r["film"] == film}) for film in films if any(r["film"] == film for r in runs)]
lines += ["", f'Median error {statistics.median(offs):.1f} points; {sum(abs(r["z"]) <= 2 for r in readings)} of {len(readings)} porosities within two standard deviations. '
          f'Packings of each film: {", ".join(map(str, packings))}.', ""]
print("\n".join(lines))

width, height, left, right, top, bottom, least, most = 560, 480, 56, 12, 16, 48, 10, 45
x = lambda porosity: left + (width - left - right) * (porosity - least) / (most - least)
y = lambda porosity: height - bottom - (height - top - bottom) * (porosity - least) / (most - least)
svg = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
       'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="#fff"/>']
for at in range(least, most + 1, 5):
    svg.append(f'<path d="M{x(at):.1f} {top}V{height - bottom}M{left} {y(at):.1f}H{width - right}" stroke="#e4e6ea"/>')
    if at % 10 == 0:
        svg.append(f'<text x="{x(at):.1f}" y="{height - bottom + 18}" text-anchor="middle">{at}</text>'
                   f'<text x="{left - 8}" y="{y(at) + 4:.1f}" text-anchor="end">{at}</text>')
svg.append(f'<path d="M{x(least)} {y(least)}L{x(most)} {y(most)}" stroke="#888"/>'
           f'<text x="{(left + width) / 2}" y="{height - 8}" text-anchor="middle">Porosity after release, measured (%)</text>'
           f'<text transform="translate(16 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">Simulated (%)</text>')
for row, n in enumerate(sorted({r["film"] for r in readings})):
    svg.append(f'<circle cx="{left + 16}" cy="{top + 16 + 18 * row}" r="5" fill="{colours[n]}"/>'
               f'<text x="{left + 28}" y="{top + 20 + 18 * row}">{html.escape(shown[n])}</text>')
for n in range(len(shown)):
    points = " ".join(f'{x(r["measured"]):.1f},{y(r["after"]):.1f}' for r in readings if r["film"] == n)
    svg.append(f'<polyline points="{points}" fill="none" stroke="{colours[n]}" stroke-dasharray="4 4"/>')
for r in readings:
    a, b, sd, own = r["measured"], r["after"], r["sd"], r["own"]
    svg.append(f'<g stroke="{colours[r["film"]]}" fill="{colours[r["film"]]}"><path d="M{x(a - sd):.1f} {y(b):.1f}H{x(a + sd):.1f}'
               f'M{x(a):.1f} {y(b - own):.1f}V{y(b + own):.1f}"/><circle cx="{x(a):.1f}" cy="{y(b):.1f}" r="4"/></g>'
               f'<text x="{x(a) + 7:.1f}" y="{y(b) - 6:.1f}" font-size="11" fill="{colours[r["film"]]}">{r["at"]:.3g}</text>')
(here / "films_pressed.svg").write_text("\n".join(svg + ["</svg>", ""]))
