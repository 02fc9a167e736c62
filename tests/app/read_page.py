#!/usr/bin/python3
"""Reads the page of a run as a browser does, with the standard library alone.

Usage: read_page.py PAGE             prints what is in it: key = value, one a line
       read_page.py PAGE --frame N   prints the particles of a frame as CSV: id, body, x, y, z, fields
"""
import argparse
import array
import base64
import json
import re
import zlib

CODES = {"u8": "B", "u16": "H", "u32": "I", "f32": "f", "f64": "d"}


class RunPage:
    def __init__(self, text):
        found = dict(re.findall(r'<script id="([a-z0-9-]+)" type="application/[a-z-]+">(.*?)</script>', text, re.S))
        self.scripts = found
        self.run = json.loads(found["run"])

    def block(self, told):
        code = CODES[told["type"]]
        data = zlib.decompress(base64.b64decode(self.scripts[f"block-{told['id']}"]))
        width, count = array.array(code).itemsize, told["count"]
        assert len(data) == width * count, (len(data), told)
        if told["planes"]:
            whole = bytearray(len(data))
            for plane in range(width):
                whole[plane::width] = data[plane * count:(plane + 1) * count]
            data = bytes(whole)
        values = array.array(code, data).tolist()
        if told["delta"]:
            for i in range(1, count):
                values[i] = (values[i] + values[i - 1]) % 2 ** (8 * width)
        return values

    def quantised(self, told, low, high):
        return [low + (high - low) * q / 65534 if q < 65535 else float("nan") for q in self.block(told)]

    def places(self, part):
        axes = [self.quantised(part[axis], part["low"][d], part["high"][d]) for d, axis in enumerate("xyz") if part[axis]]
        return axes + [[0.0] * len(axes[0])] * (3 - len(axes))

    def frame(self, number):
        particles = self.run["particles"]
        frame = particles["frames"][number]
        ids = self.block(frame["id"])
        body = self.block(frame["body"]) if frame["body"] else [0] * len(ids)
        fields = [self.quantised(told, field["low"], field["high"]) for told, field in zip(frame["fields"], particles["fields"])]
        return list(zip(ids, body, *self.places(frame), *fields))


def told(page):
    run = page.run
    particles, mesh = run["particles"], run["mesh"]
    yield "title", run["title"]
    yield "up", run["up"]
    yield "live", run["live"]
    yield "status", run["summary"] and run["summary"]["status"]
    for note in run["notes"]:
        yield "note", note
    for warning in run["warnings"]:
        yield "warning", f"{warning.get('line')}: {warning['text']}"
    yield "particles", particles and f"{particles['shown']} of {particles['total']}"
    if particles:
        yield "fields", [field["name"] for field in particles["fields"]]
        yield "frames", [round(frame["time"], 6) for frame in particles["frames"]]
        yield "ids", [len(page.block(frame["id"])) for frame in particles["frames"]]
        yield "radius", particles["radius"]
        yield "growth", [max(page.block(frame["growth"])) if frame["growth"] else 0 for frame in particles["frames"]]
    yield "mesh", mesh and (f"{mesh['count']} nodes, {len(page.block(mesh['outline'])) // 2} outline, "
                            f"{len(page.block(mesh['cells'])) // 2 if mesh['cells'] else 0} edges")
    if ground := run["ground"]:
        corners = page.block(ground["rigid"])
        assert max(corners) < ground["count"]
        heights = page.places(ground)[2 if run["dimension"] == 3 else 1]
        yield "ground", (f"{ground['count']} nodes, {len(corners) // run['dimension']} facets, {len(page.block(ground['layers'])) // 2} layer edges, "
                         f"{min(heights):.6g} to {max(heights):.6g} m")
    else:
        yield "ground", None
    for b, body in enumerate(run.get("rigid", [])):
        corners = page.block(body["triangles"])
        assert max(corners) < body["count"]
        ends = ", ".join(f"{min(axis):.6g} to {max(axis):.6g}" for axis in page.places(body)[:run["dimension"]])
        yield f"rigid.{body['name']}", f"{body['count']} nodes, {len(corners) // 3} triangles, {ends} m"
        for frame in particles["frames"] if particles else []:
            numbers = page.block(frame["rigid"])[7 * b:7 * b + 7] if frame["rigid"] else ["none"]
            yield f"rigid.{body['name']} at {frame['time']:.6g} s", " ".join(map(str, numbers))
    for name in ("history", "run_out"):
        if table := run[name]:
            values, rows = page.block(table["values"]), table["rows"]
            for c, column in enumerate(table["columns"]):
                yield f"{name}.{column['name']} [{column['unit']}]", f"{values[c * rows]:.6g} to {values[(c + 1) * rows - 1]:.6g} in {rows} rows"
        else:
            yield name, None
    for metric in run["metrics"]:
        yield f"{metric['group']}.{metric['name']} [{metric['unit']}]", f"{metric['value']:.6g}"


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("page")
    parser.add_argument("--frame", type=int)
    options = parser.parse_args()
    with open(options.page, encoding="utf-8") as file:
        page = RunPage(file.read())
    if options.frame is None:
        for key, value in told(page):
            print(f"{key} = {value}")
    else:
        for row in page.frame(options.frame):
            print(",".join(f"{value:.9g}" for value in row))


if __name__ == "__main__":
    main()
