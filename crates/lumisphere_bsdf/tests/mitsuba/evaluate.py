"""Mitsuba's answers for the test `mitsuba`: reads questions from the input, prints one line of numbers for each.

    case JSON         the following pairs are for this BSDF, as mitsuba.load_dict takes it
    X Y Z x y z       of that BSDF: f cos (red, green, blue) and pdf for the viewer XYZ and the light xyz
    dielectric C N    Fresnel's reflectance at cosine C and index N
    conductor C N K   the same for the index N + iK
"""

import json
import sys

import mitsuba

mitsuba.set_variant("scalar_rgb")


def numbers(words):
    return [float(word) for word in words]


def answers(lines):
    context = mitsuba.BSDFContext()
    surface = mitsuba.SurfaceInteraction3f()
    bsdf = None
    for line in lines:
        first, _, rest = line.strip().partition(" ")
        if first == "case":
            bsdf = mitsuba.load_dict(json.loads(rest))
        elif first == "dielectric":
            cosine, index = numbers(rest.split())
            yield [mitsuba.fresnel(cosine, index)[0]]
        elif first == "conductor":
            cosine, real, imaginary = numbers(rest.split())
            yield [mitsuba.fresnel_conductor(cosine, mitsuba.Complex2f(real, imaginary))]
        else:
            six = numbers(line.split())
            # Mitsuba's wi is where the camera is: our wo.
            surface.wi = six[:3]
            light = mitsuba.Vector3f(six[3:])
            yield [*bsdf.eval(context, surface, light), bsdf.pdf(context, surface, light)]


for answer in answers(sys.stdin):
    print(*[repr(float(number)) for number in answer])
