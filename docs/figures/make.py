#!/usr/bin/python3
# Figures of the pages, from a finished run of the demo:
#   docs/figures/make.py build/demo
# Takes pictures and curves from what `calendem report` makes of the run. Needs python3-pil, and chromium, which draws
# the page's charts.
import base64
import io
import pathlib
import re
import subprocess
import sys
import tempfile

from PIL import Image

here = pathlib.Path(__file__).resolve().parent
calendem = here.parent.parent / "build/bin/calendem"
curves = ["pressure-displacement", "porosity-pressure", "energy-1", "breaks-pressure"]
pictures = ["Electrode: Before", "Electrode: At maximum pressure", "Electrode: After", "Bonds: At maximum pressure"]

with tempfile.TemporaryDirectory() as folder:
    page = pathlib.Path(folder) / "report.html"
    subprocess.run([calendem, "report", sys.argv[1], "-o", page], check=True)
    html = page.read_text()
    browser = ["chromium", "--headless", "--no-sandbox", "--disable-3d-apis", f"--user-data-dir={folder}/profile"]
    drawn = subprocess.run(browser + ["--window-size=700,900", "--dump-dom", page.as_uri()],
                           check=True, capture_output=True, text=True).stdout

for curve in curves:
    size, content = re.search(f'data-chart="{curve}".*?viewBox="0 0 ([0-9. ]+)"[^>]*>(.*?)<g class="pointer"', drawn,
                              re.S).groups()
    width, height = size.split()
    (here / f"demo_{curve.removesuffix('-1')}.svg").write_text(
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" viewBox="0 0 {width} {height}" '
        f'font-family="DejaVu Sans, Verdana, sans-serif" font-size="13">\n<rect width="100%" height="100%" fill="#fff"/>'
        f'\n{content}\n</svg>\n')

shown = []
for name in pictures:
    found = re.search(re.escape(f'aria-label="{name}"') + r'[^>]*><image[^>]*base64,([A-Za-z0-9+/=]+)', html)
    shown.append(Image.open(io.BytesIO(base64.b64decode(found.group(1)))).convert("RGB"))
gap = 16
sheet = Image.new("RGB", (sum(i.width + gap for i in shown) - gap, max(i.height for i in shown)), "white")
at = 0
for picture in shown:
    sheet.paste(picture, (at, sheet.height - picture.height))
    at += picture.width + gap
sheet.quantize(64).save(here / "demo_electrode.png", optimize=True)
