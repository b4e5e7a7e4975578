"""Mitsuba's pictures for the test and the benchmark `mitsuba`: reads a list of jobs as JSON from the input.

    render.py            renders each job `passes` times with `samples` samples a pixel and other random numbers, and writes to the
                         job's `output` the means and then the variances of the means as f64, row by row; prints a line a job
    render.py --probe    renders a small picture and ends with success if this variant of Mitsuba works here

A job's `scene` is what mitsuba.load_dict takes, with these additions: `to_world` is the sixteen numbers of a matrix, row by row;
`falloff` of a spot light is [inner, outer] in radians of the fall-off of KHR_lights_punctual; `environment` is a lat-long picture,
a file or f32 texels, in the orientation of CONVENTIONS.md, times `intensity` and turned by `turn` degrees about +Y.

LUMISPHERE_MITSUBA_VARIANT names the variant of Mitsuba; scalar_rgb if it is not set.
"""

import json
import math
import os
import sys
import time

import mitsuba
import numpy

mitsuba.set_variant(os.environ.get("LUMISPHERE_MITSUBA_VARIANT", "scalar_rgb"))
Transform = mitsuba.ScalarTransform4f

# Texels along a side of the picture that a spot light projects.
SPOT_TEXELS = 1024


def environment(told):
    """Our bilinear picture, exactly, as Mitsuba's.

    Ours has its texels' centres at u = (i + 0.5)/w and v = (j + 0.5)/h, and beyond a pole lies the polar row half a turn away.
    Mitsuba's has them at u = (i + 0.5)/w too, but at v = j/(h - 1). With 2h + 1 rows its knots are ours and those half-way between.
    Its u starts at -Z and runs by way of +X: ours is that turned by a quarter about +Y.
    """
    if "file" in told:
        bitmap = mitsuba.Bitmap(told["file"]).convert(mitsuba.Bitmap.PixelFormat.RGB, mitsuba.Struct.Type.Float32, False)
        rows = numpy.array(bitmap)
    else:
        rows = numpy.fromfile(told["texels"], dtype=numpy.float32).reshape(told["height"], -1, 3)
    rows = rows * numpy.float32(told["intensity"])
    height, width, _ = rows.shape
    across = numpy.roll(rows, width // 2, axis=1)
    fine = numpy.empty((2 * height + 1, width, 3), dtype=numpy.float32)
    fine[1::2] = rows
    fine[2:-1:2] = 0.5 * (rows[:-1] + rows[1:])
    fine[0] = 0.5 * (rows[0] + across[0])
    fine[-1] = 0.5 * (rows[-1] + across[-1])
    turn = Transform().rotate([0, 1, 0], 90 + told["turn"])
    return {"type": "envmap", "bitmap": mitsuba.Bitmap(fine), "to_world": turn}


def spot(told):
    """A spot light whose fall-off is a picture that it projects; Mitsuba's own is linear in the angle."""
    inner, outer = told.pop("falloff")
    cutoff = 1.05 * outer
    along = (numpy.arange(SPOT_TEXELS) + 0.5) / SPOT_TEXELS * 2 - 1
    x, y = numpy.meshgrid(along * math.tan(cutoff), along * math.tan(cutoff))
    cosine = 1 / numpy.sqrt(1 + x * x + y * y)
    linear = (cosine - math.cos(outer)) / max(math.cos(inner) - math.cos(outer), 1e-3)
    texels = (numpy.clip(linear, 0, 1) ** 2).astype(numpy.float32)
    picture = {"type": "bitmap", "bitmap": mitsuba.Bitmap(texels[..., None]), "raw": True, "wrap_mode": "clamp"}
    degrees = math.degrees(cutoff)
    return {**told, "cutoff_angle": degrees, "beam_width": 0.999 * degrees, "texture": picture}


def loadable(value):
    if not isinstance(value, dict):
        return value
    if "falloff" in value:
        value = spot(value)
    if "intensity" in value and "turn" in value:
        return environment(value)
    matrix = lambda key, x: Transform(numpy.array(x).reshape(4, 4)) if key == "to_world" and isinstance(x, list) else loadable(x)
    return {key: matrix(key, x) for key, x in value.items()}


def render(job):
    scene = mitsuba.load_dict(loadable(job["scene"]))
    passes, total, squares = job["passes"], 0.0, 0.0
    start = time.perf_counter()
    for seed in range(passes):
        # The conversion waits for the picture.
        picture = numpy.array(mitsuba.render(scene, spp=job["samples"], seed=job["seed"] + seed), dtype=numpy.float64)[..., :3]
        total, squares = total + picture, squares + picture * picture
        if seed == 0:
            first = time.perf_counter() - start
    seconds = time.perf_counter() - start
    mean = total / passes
    variance = numpy.maximum(squares / passes - mean * mean, 0) / max(passes - 1, 1)
    numpy.concatenate([mean.ravel(), variance.ravel()]).tofile(job["output"])
    print(json.dumps({"name": job["name"], "seconds": seconds, "first": first}), flush=True)


def probe():
    sphere = {"type": "sphere", "bsdf": {"type": "diffuse"}, "light": {"type": "area", "radiance": 1.0}}
    film = {"type": "hdrfilm", "width": 4, "height": 4, "rfilter": {"type": "box"}}
    sensor = {"type": "perspective", "film": film, "to_world": Transform().look_at([0, 0, 3], [0, 0, 0], [0, 1, 0])}
    sky = {"type": "envmap", "bitmap": mitsuba.Bitmap(numpy.ones((2, 4, 3), dtype=numpy.float32))}
    scene = {"type": "scene", "integrator": {"type": "path"}, "sensor": sensor, "sphere": sphere, "sky": sky}
    mean = numpy.array(mitsuba.render(mitsuba.load_dict(scene), spp=4)).mean()
    if not mean > 0:
        sys.exit("the probe's picture is black")


if sys.argv[1:] == ["--probe"]:
    probe()
else:
    for job in json.load(sys.stdin):
        render(job)
