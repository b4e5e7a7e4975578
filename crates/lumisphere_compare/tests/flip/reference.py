#!/usr/bin/env python3
"""Prints the table of reference.rs: what NVIDIA's FLIP says of the generated pictures in pictures.rs.

    pip install flip-evaluator==1.7 numpy
    python3 reference.py > reference.rs
"""
import numpy
from flip_evaluator import evaluate

WIDTH, HEIGHT = 64, 48
MASK = 0xFFFFFFFF


def dither(x, y, c, seed):
    """A byte without pattern."""
    h = (x * 374761393 + y * 668265263 + c * 2246822519 + seed * 3266489917) & MASK
    h = ((h ^ (h >> 13)) * 1274126177) & MASK
    return ((h ^ (h >> 16)) >> 8) & 255


def clamp(v):
    return max(0, min(255, v))


def smooth(x, y, c):
    return [x * 4, y * 5, (x + y) * 2][c]


def bars(x, y, c):
    return 230 if (x // 5 + y // 9) % 2 == 0 else [20, 60, 90][c]


def patches(x, y, c):
    k = x // 16 + 4 * (y // 16)
    return ((k * 53 + c * 97 + k * c * 31) * 7) % 256


def wide(x, y, c):
    """Radiance: an exponent by tiles, a mantissa by place, exact in f32."""
    tile = x // 8 + 3 * (y // 8)
    sun = 10 if x in (20, 21) and y in (11, 12) else 0
    return (1 + (x * 5 + y * 3 + c * 40) % 256 / 256) * 2.0 ** (tile * 5 % 9 - 5 + sun)


# Name, ppd, reference and test as functions of (x, y, c).
LDR = [
    ("noise on a gradient", 67.0, smooth, lambda x, y, c: clamp(smooth(x, y, c) + dither(x, y, c, 1) % 61 - 30)),
    ("bars moved by a pixel", 67.0, bars, lambda x, y, c: bars(x + 1, y, c)),
    ("channels turned", 67.0, patches, lambda x, y, c: patches(x, y, (c + 1) % 3)),
    ("bars moved, from afar", 20.0, bars, lambda x, y, c: bars(x + 1, y, c)),
    ("a code of grey", 100.0, lambda x, y, c: 128, lambda x, y, c: 129),
]
HDR = [
    ("noise", 67.0, wide, lambda x, y, c: wide(x, y, c) * (0.75 + dither(x, y, c, 2) / 512)),
    ("no sun", 67.0, wide, lambda x, y, c: min(wide(x, y, c), 16.0)),
    ("dimmer by a tenth", 40.0, wide, lambda x, y, c: wide(x, y, c) * 0.90625),
    ("mostly black", 67.0, lambda x, y, c: wide(x, y, c) if x < 20 else 0.0, lambda x, y, c: wide(x, y, c) / 2 if x < 20 else 0.0),
]
PLACES = [(0, 0), (63, 47), (1, 30), (16, 16), (20, 11), (22, 13), (31, 24), (40, 5), (47, 40), (55, 20), (60, 33), (10, 44)]


def picture(f, scale):
    values = [[[f(x, y, c) / scale for c in range(3)] for x in range(WIDTH)] for y in range(HEIGHT)]
    return numpy.array(values, dtype=numpy.float32)


def row(name, ppd, reference, test, kind):
    scale = 255 if kind == "LDR" else 1
    error, mean, used = evaluate(picture(reference, scale), picture(test, scale), kind,
                                 applyMagma=False, parameters={"ppd": ppd})
    error = error.reshape(HEIGHT, WIDTH)
    at = ", ".join(f"{error[y, x]:.6f}" for x, y in PLACES)
    exposures = f"({used['startExposure']:.6f}, {used['stopExposure']:.6f}, {used['numExposures']})" if kind == "HDR" else "(0.0, 0.0, 1)"
    print(f'    Row {{ name: "{name}", ppd: {ppd}, exposures: {exposures}, mean: {mean:.7f}, largest: {error.max():.6f},')
    print(f"        at: [{at}] }},")


def table(kind, rows):
    print(f"pub const {kind}: [Row; {len(rows)}] = [")
    for name, ppd, reference, test in rows:
        row(name, ppd, reference, test, kind)
    print("];")


print("//! Made by reference.py with flip-evaluator 1.7 (NVIDIA, BSD-3-Clause): do not edit.")
print("use super::Row;\n")
print("/// Where the map is read: (x, y).")
print(f"pub const PLACES: [(usize, usize); {len(PLACES)}] = {PLACES};")
table("LDR", LDR)
table("HDR", HDR)
