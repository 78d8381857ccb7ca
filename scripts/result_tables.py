#!/usr/bin/env python3
"""Makes the tables and charts of the documentation from the files in bench/results.

mkdocs calls on_page_markdown for each page (see mkdocs.yml). In a page, a fenced block that begins with ```results FILE.csv
becomes a table:

    ```results solve_times.csv
    where threads=1                                  keep the rows in which all of these columns have these values
    rows scene polygons                              columns that name a row of the table
    scene (polygons) = {scene} ({polygons})          a column of the table: its heading, and a template of its cells
    time at 2% = {wall_s} s | requested_percent=2    a column that takes only some rows of the file
    ```

and one that begins with ```chart FILE.csv becomes a picture:

    ```chart solve_times.csv
    where threads=1
    x wall_s: time, s                                column and label of an axis
    y true_error_percent: true error, %
    curve {scene}                                    one curve for each value of this template
    log xy                                           logarithmic axes
    ```

Without `rows`, every row of the file is a row of the table; without columns, every column of the file is one. A cell is empty if the
file has no value for it; a part of a template in [brackets] is left out in that case.

    result_tables.py FILE.md          fills the tables between <!-- results FILE.csv ... --> and <!-- end --> of a Markdown file
    result_tables.py --check FILE.md  exits with 1 if they are not as they would be filled"""
import csv
import math
import pathlib
import re
import sys

root = pathlib.Path(__file__).resolve().parent.parent
results = root / "bench/results"
studies = root / "docs/studies"


class BadBlock(Exception):
    """A block that names a file, column or row that does not exist."""


def read_rows(name):
    path = studies / name.removeprefix("studies/") if name.startswith("studies/") else results / name
    if not path.exists():
        raise BadBlock(f"{path} does not exist")
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def conditions(text):
    return [condition.split("=", 1) for condition in re.findall(r"\S+=(?:\"[^\"]*\"|\S+)", text)]


def matches(row, wanted):
    for column, value in wanted:
        if column not in row:
            raise BadBlock(f"no column {column}")
        if row[column] != value.strip('"'):
            return False
    return True


def grouped(number):
    """Digits of a whole number from 10,000 on in groups of three."""
    return f"{int(number):,}" if re.fullmatch(r"\d{5,}", number) else number


def fill(template, row):
    """The template with the values of a row. A part in [brackets] is left out if a value of it is missing; otherwise the
    cell is empty."""
    template = re.sub(r"\[([^][]*)\]", lambda part: part[1] if fill(part[1], row) else "", template)
    columns = re.findall(r"{(\w+)}", template)
    for column in columns:
        if column not in row:
            raise BadBlock(f"no column {column}")
    if columns and not all(row[column] for column in columns):
        return ""
    return re.sub(r"{(\w+)}", lambda match: grouped(row[match[1]]), template).replace("|", "\\|")


def parse(lines):
    """Settings by their first word, and the columns of a table as (heading, template, condition)."""
    settings, columns = {}, []
    for line in filter(None, map(str.strip, lines)):
        word, _, rest = line.partition(" ")
        if word in ("where", "rows", "x", "y", "curve", "log"):
            settings[word] = rest.strip()
        else:
            heading, equals, template = line.partition(" = ")
            if not equals:
                raise BadBlock(f"cannot read the line '{line}'")
            template, _, condition = template.partition(" | ")
            columns.append((heading.strip(), template.strip(), conditions(condition)))
    return settings, columns


def table(name, lines):
    settings, columns = parse(lines)
    rows = [row for row in read_rows(name) if matches(row, conditions(settings.get("where", "")))]
    if not rows:
        raise BadBlock(f"{name} has no such rows")
    if not columns:
        columns = [(column.replace("_", " "), "{%s}" % column, []) for column in rows[0]]
    keys = settings.get("rows", "").split()
    groups = {}
    for number, row in enumerate(rows):
        groups.setdefault(tuple(row[key] for key in keys) if keys else number, []).append(row)
    out = [[heading for heading, _, _ in columns], ["---"] * len(columns)]
    for group in groups.values():
        fitting = ([row for row in group if matches(row, condition)] for _, _, condition in columns)
        out.append([fill(template, of[-1]) if of else "" for (_, template, _), of in zip(columns, fitting)])
    return "\n".join("| " + " | ".join(cells) + " |" for cells in out) + "\n"


def ticks(low, high, is_log):
    if is_log:
        steps = (1, 2, 5) if high - low < 3 else (1,)
        powers = range(math.floor(low) - 1, math.ceil(high) + 1)
        return [at for p in powers for s in steps if low - 1e-9 <= (at := p + math.log10(s)) <= high + 1e-9]
    step = 10 ** math.floor(math.log10((high - low) / 4))
    step *= 5 if (high - low) / step > 20 else 2 if (high - low) / step > 8 else 1
    return [step * i for i in range(math.ceil(low / step), math.floor(high / step) + 1)]


def chart(name, lines):
    """An SVG picture with a curve for each value of the template `curve`."""
    settings, _ = parse(lines)
    (x, x_label), (y, y_label) = ([part.strip() for part in settings[axis].split(":", 1)] for axis in "xy")
    logs = [axis in settings.get("log", "") for axis in "xy"]
    curves = {}
    for row in read_rows(name):
        if matches(row, conditions(settings.get("where", ""))) and row[x] and row[y]:
            point = [math.log10(float(v)) if is_log else float(v) for v, is_log in zip((row[x], row[y]), logs)]
            curves.setdefault(fill(settings["curve"], row), []).append(point)
    if not curves:
        raise BadBlock(f"{name} has no such rows")
    points = [point for curve in curves.values() for point in curve]
    ranges = []
    for axis in (0, 1):
        low, high = min(p[axis] for p in points), max(p[axis] for p in points)
        margin = 0.05 * (high - low) or 1
        ranges.append((low - margin if logs[axis] else min(0, low), high + margin))
    left, top, width, height = 70, 12, 470, 300

    def place(point):
        u, v = ((value - low) / (high - low) for value, (low, high) in zip(point, ranges))
        return left + width * u, top + height * (1 - v)

    def number(value, is_log):
        return f"{10 ** value if is_log else value:.4g}"

    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + width + 170} {top + height + 48}" '
           'font-family="sans-serif" font-size="13" style="max-width: 710px; background: white">']
    for at in ticks(*ranges[0], logs[0]):
        px = place((at, ranges[1][0]))[0]
        out.append(f'<path d="M{px:.1f} {top}V{top + height}" stroke="#ddd"/>'
                   f'<text x="{px:.1f}" y="{top + height + 18}" text-anchor="middle">{number(at, logs[0])}</text>')
    for at in ticks(*ranges[1], logs[1]):
        py = place((ranges[0][0], at))[1]
        out.append(f'<path d="M{left} {py:.1f}H{left + width}" stroke="#ddd"/>'
                   f'<text x="{left - 6}" y="{py + 4:.1f}" text-anchor="end">{number(at, logs[1])}</text>')
    out.append(f'<rect x="{left}" y="{top}" width="{width}" height="{height}" fill="none" stroke="#888"/>')
    colours = ["#4477aa", "#ee6677", "#228833", "#aa3377", "#ccbb44", "#66ccee", "#222222", "#999999"]
    for i, (label, curve) in enumerate(curves.items()):
        colour = colours[i % len(colours)]
        line = " ".join("%.1f,%.1f" % place(point) for point in sorted(curve))
        out.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        out += ['<circle cx="%.1f" cy="%.1f" r="3" fill="%s"/>' % (*place(point), colour) for point in curve]
        out.append(f'<text x="{left + width + 10}" y="{top + 14 + 19 * i}" fill="{colour}">{label}</text>')
    out.append(f'<text x="{left + width / 2}" y="{top + height + 40}" text-anchor="middle">{x_label}</text>')
    out.append(f'<text transform="translate(16 {top + height / 2}) rotate(-90)" text-anchor="middle">{y_label}</text>')
    return "".join(out) + "</svg>\n"


def expand(markdown, place):
    """A page with its blocks replaced. `place` names the page in messages."""
    def replaced(match):
        try:
            return (table if match[1] == "results" else chart)(match[2], match[3].split("\n"))
        except (BadBlock, KeyError, ValueError) as problem:
            raise SystemExit(f"error: {place}: block '{match[1]} {match[2]}': {problem}")
    return re.sub(r"^```(results|chart) (\S+)\n(.*?)^```\n", replaced, markdown, flags=re.M | re.S)


def on_page_markdown(markdown, page, **_):
    return expand(markdown, page.file.src_path)


def filled(text, place):
    def replaced(match):
        block = "```results " + match[1] + "\n" + match[2] + "```\n"
        return f"<!-- results {match[1]}\n{match[2]}-->\n{expand(block, place)}<!-- end -->"
    return re.sub(r"<!-- results (\S+)\n(.*?)-->\n.*?<!-- end -->", replaced, text, flags=re.S)


if __name__ == "__main__":
    checks = "--check" in sys.argv
    differs = False
    for name in [argument for argument in sys.argv[1:] if argument != "--check"]:
        text = pathlib.Path(name).read_text()
        new = filled(text, name)
        differs |= new != text
        if new != text and not checks:
            pathlib.Path(name).write_text(new)
    if checks and differs:
        sys.exit("error: a table is not as bench/results has it; run scripts/result_tables.py on the file")
