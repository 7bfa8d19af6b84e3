#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""Reads gcovr's JSON: coverage of lib/codec and lib/param by lines and branches, one line a file, and fails when a branch of the
decoder is not taken that untaken.txt does not excuse. Usage: coverage.py COVERAGE.json"""
import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
DECODER = "arith bits conceal fba fba_body fba_codes fba_decode fba_face fba_header fba_time fba_unsaid models".split()


def excuses():
    with open(os.path.join(HERE, "untaken.txt")) as f:
        rows = [line.rstrip("\n").split(": ", 2) for line in f if line.strip() and line[0] != "#"]
    return [(name, int(count), text) for name, count, text in rows]


def percent(part, whole):
    return "%5.1f %%" % (100.0 * part / whole) if whole else "      -"


def row(name, lines, taken):
    hit = sum(1 for line in lines if line["count"])
    yes = sum(1 for b in taken if b)
    print("%-28s lines %4d of %4d %s   branches %4d of %4d %s" %
          (name, hit, len(lines), percent(hit, len(lines)), yes, len(taken), percent(yes, len(taken))))


def untaken(path, lines, excused):
    with open(path) as f:
        source = f.read().split("\n")
    for line in lines:
        count, text = sum(1 for b in line["branches"] if not b["count"]), source[line["line_number"] - 1]
        allowed = [n for name, n, part in excused if name == os.path.basename(path) and part in text]
        if count > (allowed[0] if allowed else 0):
            yield "%s:%d: %d of %d branches are not taken: %s" % (path, line["line_number"], count,
                                                                   len(line["branches"]), text.strip())


def main():
    with open(sys.argv[1]) as f:
        files = json.load(f)["files"]
    missed, decoder = [], []
    for entry in sorted(files, key=lambda e: e["file"]):
        lines = [line for line in entry["lines"] if not line.get("gcovr/noncode")]
        if not lines or "_test.c" in entry["file"] or not entry["file"].endswith(".c"):
            continue
        row(entry["file"], lines, [b["count"] for line in lines for b in line["branches"]])
        if os.path.splitext(os.path.basename(entry["file"]))[0] in DECODER:
            decoder += lines
            missed += untaken(entry["file"], lines, excuses())
    row("the decoder", decoder, [b["count"] for line in decoder for b in line["branches"]])
    for text in missed:
        print("FAIL: " + text)
    return 1 if missed or not decoder else 0


if __name__ == "__main__":
    sys.exit(main())
