# SPDX-License-Identifier: GPL-3.0-or-later
"""Small videos, written with the standard library alone: AVI files with pixels that are not compressed."""

import random
import struct


def chunk(kind, data):
    return kind + struct.pack("<I", len(data)) + data + b"\0" * (len(data) % 2)


def listed(kind, *chunks):
    return chunk(b"LIST", kind + b"".join(chunks))


def avi(frames, width, height, rate=30):
    """The bytes of a video. `frames`: the pixels of each, blue, green and red, the lowest row first. `width`:
    a multiple of 4."""
    count, size = len(frames), 3 * width * height
    main = struct.pack("<14I", 1000000 // rate, size * rate, 0, 0x10, count, 0, 1, size, width, height, 0, 0, 0, 0)
    stream = struct.pack("<4s4sIHHIIIIIIIIHHHH", b"vids", b"DIB ", 0, 0, 0, 0, 1, rate, 0, count, size,
                         0xFFFFFFFF, 0, 0, 0, width, height)
    bitmap = struct.pack("<IiiHHIIiiII", 40, width, height, 1, 24, 0, size, 0, 0, 0, 0)
    header = listed(b"hdrl", chunk(b"avih", main),
                    listed(b"strl", chunk(b"strh", stream), chunk(b"strf", bitmap)))
    index = b"".join(struct.pack("<4sIII", b"00db", 0x10, 4 + number * (8 + size), size) for number in range(count))
    movie = listed(b"movi", *(chunk(b"00db", frame) for frame in frames))
    return chunk(b"RIFF", b"AVI " + header + movie + chunk(b"idx1", index))


def moving_clip(count=24, step=4, width=160, height=120, seed=1):
    """A clip in which a grey texture of random blobs moves to the left by `step` pixels a frame."""
    numbers, blob, wide = random.Random(seed), 8, width + count * step + 8
    coarse = [[numbers.randrange(256) for _ in range(wide // blob + 2)] for _ in range(height // blob + 2)]

    def value(x, y):  # bilinear
        (i, u), (k, v) = divmod(x, blob), divmod(y, blob)
        above, below = (coarse[row][i] * (blob - u) + coarse[row][i + 1] * u for row in (k, k + 1))
        return (above * (blob - v) + below * v) // blob ** 2

    rows = [bytes(level for x in range(wide) for level in (value(x, y),) * 3) for y in range(height)]
    return avi([b"".join(row[3 * step * number:3 * (step * number + width)] for row in rows)
                for number in range(count)], width, height)
