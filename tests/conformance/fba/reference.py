#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-2-Clause
"""A second FBA encoder, written apart from lib/codec and as plainly as the syntax allows: bits in a list, every frequency
table in full. It draws random planes, writes the stream and the values a decoder must show. Run it to make the files
beside it again, or more of them:  reference.py FIRST_SEED END_SEED [FOLDER]
Source: ISO/IEC 14496-2, face object plane syntax; ranges and steps from fap_tables/faps.csv.
"""
import csv
import os
import random
import sys

HERE = os.path.dirname(os.path.abspath(__file__))
GROUPS = [(1, 2), (3, 18), (19, 30), (31, 38), (39, 42), (43, 47), (48, 50), (51, 60), (61, 64), (65, 68)]


def read_table():
    with open(os.path.join(HERE, "../../../fap_tables/faps.csv")) as f:
        lines = [line for line in f if not line.startswith("#")]
    rows = list(csv.reader(lines))
    names = [cell.split(":")[0] for cell in rows[0]]
    return {int(row[0]): dict(zip(names, row)) for row in rows[1:]}


TABLE = read_table()


def toward_zero(a, b):
    return abs(a) // b * (1 if a >= 0 else -1)


class Bits:
    def __init__(self):
        self.bits = []

    def put(self, n, value):
        self.bits += [value >> i & 1 for i in reversed(range(n))]

    def stuff(self):
        self.bits.append(0)
        while len(self.bits) % 8:
            self.bits.append(1)

    def to_bytes(self):
        return bytes(int("".join(map(str, self.bits[i:i + 8])), 2) for i in range(0, len(self.bits), 8))


class Run:
    """One arithmetic run; counts are a list, one for each symbol."""

    def __init__(self, out):
        self.out, self.low, self.high, self.zeros, self.pending = out, 0, 65535, 0, 0

    def code_bit(self, bit):
        if self.zeros == 22:
            self.out.put(1, 1)
            self.zeros = 0
        self.out.put(1, bit)
        self.zeros = 0 if bit else self.zeros + 1

    def settle(self, bit):
        self.code_bit(bit)
        for _ in range(self.pending):
            self.code_bit(1 - bit)
        self.pending = 0

    def put(self, counts, symbol):
        total, span = sum(counts), self.high - self.low + 1
        self.high = self.low - 1 + span * sum(counts[symbol:]) // total
        self.low = self.low + span * sum(counts[symbol + 1:]) // total
        while True:
            if self.high < 32768:
                self.settle(0)
            elif self.low >= 32768:
                self.settle(1)
                self.low, self.high = self.low - 32768, self.high - 32768
            elif self.low >= 16384 and self.high < 49152:
                self.pending += 1
                self.low, self.high = self.low - 16384, self.high - 16384
            else:
                return
            self.low, self.high = 2 * self.low, 2 * self.high + 1

    def end(self):
        self.pending += 1
        self.settle(0 if self.low < 16384 else 1)


def count(counts, symbol):
    if sum(counts) == 16383:
        counts[:] = [(c + 1) // 2 for c in counts]
    counts[symbol] += 1


class Stream:
    def __init__(self, seed):
        self.random, self.out = random.Random(seed), Bits()
        self.number, self.coded, self.value, self.models, self.ranges = -1, set(), {}, {}, None
        self.quants = self.random.choice([[0], [1], [2], [7], [31], [1, 3, 20]])
        self.expected = []

    def header(self, intra, first):
        out, skip = self.out, self.random.choice([0, 0, 0, 1, 14, 15, 16, 30, 31])
        if self.random.random() < 0.3:
            out.stuff()
            out.put(32, 0x1BB)
        out.put(1, intra)
        out.put(2, 1)
        if intra:
            out.put(2, 0)  # no frame rate, no time code
        out.put(1, skip > 0)
        if skip:
            for _ in range(skip // 15):
                out.put(4, 15)
            out.put(4, skip % 15)
        self.number += skip + 1

    def masks(self):
        self.coded = set()
        for first, last in GROUPS:
            kind = self.random.randint(0, 3)
            self.out.put(1, 1)
            self.out.put(2, kind)
            for fap in range(first, last + 1):
                on = self.random.randint(0, 1) if kind in (1, 2) else kind == 3
                if kind in (1, 2):
                    self.out.put(1, on)
                if on:
                    self.coded.add(fap)

    def default_ranges(self, divisor):
        def bound(fap, name):
            v = int(TABLE[fap][name])
            rounded = (abs(v) + 59) // 60 * 60
            return toward_zero(rounded if v >= 0 else -rounded, divisor)
        self.ranges = [{fap: bound(fap, name) for fap in range(3, 69)} for name in ("i_max", "i_min", "p_max", "p_min")]

    def new_ranges(self, divisor):
        new = [self.random.randint(0, 1) for _ in range(4)]
        for flag in new:
            self.out.put(1, flag)
        for k in range(4):
            for first, last in GROUPS[1:] if new[k] else []:
                for fap in range(first, last + 1):
                    if (fap - first) % 4 == 0:
                        self.out.put(1, 1)
                    if fap in self.coded:
                        n = self.random.randint(0, 31)
                        self.out.put(5, n)
                        self.ranges[k][fap] = (n * 60 // divisor) * (-1 if k % 2 else 1)

    def setup(self):
        self.quant = self.random.choice(self.quants)
        divisor = self.quant or 1
        self.out.put(5, self.quant)
        self.masks()
        self.out.put(2, self.random.randint(0, 1) * 2)  # gender, predictive
        if self.ranges is None:
            self.default_ranges(divisor)
        self.new_ranges(divisor)
        self.models = {}

    def symbol(self, run, key, intra, low, high, step, select_max=None):
        level = self.random.randint(low, high)
        if not intra:
            first, last = low, high
            if select_max is not None:  # a select must stay one
                first, last = max(low, -self.value[key]), min(high, select_max - self.value[key])
            small = self.random.randint(-3, 3) if self.random.random() < 0.7 else level
            level = min(max(small, first), last)
        counts = [1] * (high - low + 1) if intra else self.models.setdefault(key, [1] * (high - low + 1))
        run.put(counts, level - low)
        count(counts, level - low)
        self.value[key] = level * step + (0 if intra else self.value[key])

    def high_level(self, intra, keys, select_max, flags):
        run, q = Run(self.out), self.quant
        strength = (63 + q // 2) // q if q else 63
        for key in keys:
            select = key.startswith("select")
            most = select_max if select else strength
            self.symbol(run, (keys[0], key), intra, 0 if intra else -most, most, 1 if select else q or 1,
                        select_max if select else None)
        run.end()
        values = [self.value[keys[0], key] for key in keys]
        values = [v if k.startswith("select") else min(63, max(0, v)) for k, v in zip(keys, values)]
        for _ in range(flags):
            values.append(self.random.randint(0, 1))
            self.out.put(1, values[-1])
        return values

    def plane(self, first):
        intra = int(first or self.random.random() < 0.15)
        self.header(intra, first)
        if intra:
            self.setup()
        line = [str(self.number)]
        if 1 in self.coded:
            v = self.high_level(intra, ["select_v1", "select_v2", "blend"], 14, 1)
            line += ["V"] + [str(x) for x in v]
        if 2 in self.coded:
            e = self.high_level(intra, ["select_e1", "intensity1", "select_e2", "intensity2"], 6, 2)
            line += ["E"] + [str(x) for x in e]
        run, k = Run(self.out), 0 if intra else 2
        for fap in sorted(self.coded - {1, 2}):
            step = int(TABLE[fap]["quant_step"]) * self.quant or 1
            self.symbol(run, fap, intra, self.ranges[k + 1][fap], self.ranges[k][fap], step)
            line.append("%d:%d" % (fap, self.value[fap]))
        run.end()
        self.expected.append(" ".join(line) + "\n")


def make(seed, folder):
    s = Stream(seed)
    s.out.put(32, 0x1BA)
    for i in range(s.random.randint(1, 30)):
        s.plane(i == 0)
    s.out.stuff()
    s.out.put(32, 0x1B1)
    with open(os.path.join(folder, "random%d.fba" % seed), "wb") as f:
        f.write(s.out.to_bytes())
    with open(os.path.join(folder, "random%d.txt" % seed), "w") as f:
        f.writelines(s.expected)


if __name__ == "__main__":
    for seed in range(int(sys.argv[1]), int(sys.argv[2])):
        make(seed, sys.argv[3] if len(sys.argv) > 3 else HERE)
