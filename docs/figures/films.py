#!/usr/bin/python3
# Figure of the page on predictions, measured against predicted, each film left out in turn; prints the page's tables:
#   build/bin/calendem calibrate EXPERIMENT... -o build/four
#   docs/figures/films.py build/four/model.json
import html
import json
import math
import pathlib
import statistics
import sys

model = json.load(open(sys.argv[1]))
readings = [r for r in model["left_out"] if r["number"] == "porosity_after"]
colours = ["#0060ad", "#c04020", "#1a8050", "#8040a0"]
width, height, left, right, top, bottom = 640, 400, 56, 12, 96, 48
low, high, most = 15, 250, 50  # MPa, MPa, %


def x(pressure):
    return left + (width - left - right) * math.log(pressure / low) / math.log(high / low)


def y(porosity):
    return height - bottom - (height - top - bottom) * min(porosity, most) / most


out = [f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
       'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="#fff"/>']
for at in (20, 50, 100, 200):
    out.append(f'<path d="M{x(at):.1f} {top}V{height - bottom}" stroke="#e4e6ea"/>'
               f'<text x="{x(at):.1f}" y="{height - bottom + 18}" text-anchor="middle">{at}</text>')
for at in range(0, most + 1, 10):
    out.append(f'<path d="M{left} {y(at):.1f}H{width - right}" stroke="#e4e6ea"/>'
               f'<text x="{left - 8}" y="{y(at) + 4:.1f}" text-anchor="end">{at}</text>')
out.append(f'<text x="{(left + width) / 2}" y="{height - 8}" text-anchor="middle">Pressure (MPa)</text>'
           f'<text transform="translate(16 {(top + height - bottom) / 2}) rotate(-90)" text-anchor="middle">'
           'Porosity after release (%)</text>')
films = list(dict.fromkeys(r["film"] for r in readings))
for n, film in enumerate(films):
    out.append(f'<circle cx="{left + 8}" cy="{14 + 18 * n}" r="5" fill="{colours[n]}"/>'
               f'<text x="{left + 22}" y="{18 + 18 * n}">{html.escape(film)}</text>')
out.append(f'<text x="{width - right}" y="18" text-anchor="end">filled: measured</text>'
           f'<text x="{width - right}" y="36" text-anchor="end">open, bar: predicted, 90 %</text>'
           f'<text x="{width - right}" y="54" text-anchor="end">cross: Meyer\'s law</text>')
for r in readings:
    n, at = films.index(r["film"]), x(r["pressure_MPa"])
    at += 5 * (n - (len(films) - 1) / 2)
    low90, high90, predicted, measured, meyer = (
        y(100 * v) for v in (r["low90"], r["high90"], r["median"], r["measured"], r["rules"]["Meyer"]))
    out.append(f'<g stroke="{colours[n]}"><path d="M{at:.1f} {low90:.1f}V{high90:.1f}"/>'
               f'<circle cx="{at:.1f}" cy="{predicted:.1f}" r="4" fill="#fff"/>'
               f'<circle cx="{at:.1f}" cy="{measured:.1f}" r="4.5" fill="{colours[n]}"/>'
               f'<path d="M{at - 4:.1f} {meyer - 4:.1f}l8 8m0 -8l-8 8"/></g>')
out.append("</svg>\n")
(pathlib.Path(__file__).resolve().parent / "films.svg").write_text("\n".join(out))

sd = {(d["film"], d["condition"], d["number"]): d["sd"] for d in model["data"]}
names = [f["name"] for f in model["films"]]
print("| film left out | MPa | measured | predicted | 90 % | Heckel | Meyer |\n|---|---|---|---|---|---|---|")
for r in readings:
    error = sd[names.index(r["film"]), r["condition"], r["number"]]
    print(f"| {r['film']} | {r['pressure_MPa']:.0f} | {100 * r['measured']:.1f} ± {100 * error:.1f} | {100 * r['median']:.1f} "
          f"| {100 * r['low90']:.1f}–{100 * r['high90']:.1f} | " + " | ".join(f"{100 * r['rules'][k]:.1f}" for k in ("Heckel", "Meyer")) + " |")


def summary(name, chosen, rules=()):
    off = lambda value: 100 * statistics.median(abs(value(r) - r["measured"]) for r in chosen)
    print(f"{name}: median error {off(lambda r: r['median']):.1f} points, "
          f"{sum(r['low90'] <= r['measured'] <= r['high90'] for r in chosen)} of {len(chosen)} inside, mean width "
          f"{100 * statistics.mean(r['high90'] - r['low90'] for r in chosen):.1f} points"
          + "".join(f", {k} {off(lambda r: r['rules'][k]):.1f}" for k in rules))


summary("left out", readings, ("Heckel", "Meyer"))
from_all = [{**r, **r["without"]} for r in model["learnt"] if r["number"] == "porosity_after"]
summary("from all others, those of its own film included", from_all)
materials = [m["material"] for m in model["effects"][0]["materials"]]
print("\n| | " + " | ".join(materials) + " |\n" + "|---" * (len(materials) + 1) + "|")
parameters = {row["parameter"]: row for row in model["parameters"]}
for name in dict.fromkeys(p.split(", ")[0] for p in parameters if p.endswith(materials[0])):
    rows = [parameters[f"{name}, {m}"] for m in materials]
    print(f"| {name} | " + " | ".join(f"{r['median']:.4g} ({r['low90']:.4g}–{r['high90']:.4g})" for r in rows) + " |")
for effect in model["effects"]:
    cells = (f"{m.get('median') or 0:.2g} ({m.get('low90') or 0:.2g}–{m.get('high90') or 0:.2g}); {100 * m['probability']:.0f}" for m in effect["materials"])
    print(f"| {effect['name']}; acts, % | " + " | ".join(cells) + " |")
