#!/usr/bin/env python3
"""Writes sky.hdr beside itself: an evening sky as latitude-longitude image, 128 x 64, 32 kB.

The centre of the image is seen towards +z, its top towards +y (docs/scene-format.md).
"""

import math
import pathlib

WIDTH, HEIGHT = 128, 64
# Directions toward the light: x, y, z; how far its edge spreads in degrees; radiance.
LIGHTS = [
    ((-0.70, 0.50, 0.55), 5.0, (130.0, 100.0, 66.0)),  # the low sun, behind the camera on the left
    ((0.85, 0.35, -0.25), 16.0, (1.6, 2.4, 4.0)),  # a bright cloud on the right
]


def direction(x, y):
    theta = math.pi * (y + 0.5) / HEIGHT
    phi = 2.0 * math.pi * (x + 0.5) / WIDTH
    return (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))


def radiance(d):
    up = d[1]
    blend = 1.0 / (1.0 + math.exp(-12.0 * up))  # from ground to sky
    height = max(0.0, up) ** 0.5
    horizon, zenith, ground = (0.95, 0.62, 0.42), (0.16, 0.27, 0.50), (0.10, 0.08, 0.07)
    color = [
        g + blend * (h + height * (z - h) - g) for h, z, g in zip(horizon, zenith, ground)
    ]
    for toward, spread, strength in LIGHTS:
        norm = math.sqrt(sum(t * t for t in toward))
        cosine = sum(a * t for a, t in zip(d, toward)) / norm
        falloff = math.exp((cosine - 1.0) / (1.0 - math.cos(math.radians(spread))))
        color = [c + falloff * s for c, s in zip(color, strength)]
    return color


def rgbe(color):
    """Radiance's pixel format: three mantissas and their common exponent."""
    exponent = math.frexp(max(color))[1]
    scale = math.ldexp(256.0, -exponent)
    return bytes([min(255, int(c * scale)) for c in color] + [exponent + 128])


def main():
    pixels = b"".join(
        rgbe(radiance(direction(x, y))) for y in range(HEIGHT) for x in range(WIDTH)
    )
    header = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n"
    pathlib.Path(__file__).with_name("sky.hdr").write_bytes(header.encode() + pixels)


if __name__ == "__main__":
    main()
