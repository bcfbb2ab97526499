# SPDX-License-Identifier: GPL-3.0-or-later
"""Ways to damage a file or an option, each decided by random numbers."""

import json
import os
import re
import shutil
import struct

NUMBERS = ("nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "0", "-1", "4294967295",
           "18446744073709551615", "99999999999999999999999", "2147483648", "1e5", "x", "")
VALUES = (None, True, 0, -1, 1e308, 2 ** 63, "", "x", [], {}, [[]], [None], "nan", {"a": []})
OPTION_VALUES = ("", " ", "-1", "0", "1", "nan", "inf", "-inf", "1e308", "-1e308", "1e-320", "x",
                 "99999999999999999999", "2147483648", "0.5", "true", ".", "..", "no/such/folder/x",
                 "a\nb", "\u00e9\U0001f41f", "%s%n", "1,2,3", "0,0,0", "nan,nan,nan", ",", ":", "=",
                 "x" * 300, "sim", "scene.mvs", "housing.json", "-", "--", "*", "\x01", "1 2")
TEXTS = (".txt", ".json", ".cfg", ".obj", ".mtl", ".md", ".csv")


def flip_bits(random, data):
    data = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 5, 50))):
        if data:
            data[random.randrange(len(data))] ^= 1 << random.randrange(8)
    return bytes(data)


def truncate(random, data):
    return data[:random.randrange(len(data) + 1)]


def append(random, data):
    return data + random.choice((b"\0", b"\n", b"x", b"\xff" * 9, data[:1000], random.randbytes(64)))


def set_number(random, data):
    """Overwrites four or eight bytes, often near the beginning, by an extreme number."""
    kind, values = random.choice((
        ("<I", (0, 1, 2 ** 31, 2 ** 32 - 1, 2 ** 24)), ("<Q", (0, 2 ** 40, 2 ** 63, 2 ** 64 - 1)),
        ("<f", (float("nan"), float("inf"), 3e38, -1.0)),
        ("<d", (float("nan"), float("inf"), 1e300, -1.0, 0.0))))
    end = min(len(data), 400) if random.random() < 0.6 else len(data)
    at = random.randrange(max(1, end))
    number = struct.pack(kind, random.choice(values))
    return data[:at] + number + data[at + len(number):]


def remove_part(random, data):
    begin = random.randrange(len(data) + 1)
    return data[:begin] + data[begin + random.choice((1, 4, 8, 100, 1000)):]


def repeat_part(random, data):
    begin = random.randrange(len(data) + 1)
    return data[:begin + random.choice((1, 4, 100, 1000))] + data[begin:]


def change_lines(random, data):
    lines = data.split(b"\n")
    i, j = random.randrange(len(lines)), random.randrange(len(lines))
    kind = random.randrange(4)
    if kind == 0:
        del lines[i]
    elif kind == 1:
        lines.insert(i, lines[j])
    elif kind == 2:
        lines[i], lines[j] = lines[j], lines[i]
    else:
        words = lines[i].split(b" ")
        words.insert(random.randrange(len(words) + 1), random.choice((b"", b"0", b"x", b"#")))
        lines[i] = b" ".join(words)
    return b"\n".join(lines)


def change_number(random, data):
    """Replaces a number in a text."""
    places = list(re.finditer(rb"-?\d+(\.\d+)?([eE][-+]?\d+)?", data[:200000]))
    if not places:
        return append(random, data)
    place = random.choice(places)
    return data[:place.start()] + random.choice(NUMBERS).encode() + data[place.end():]


def places_in(value, place=()):
    """The places of all values in a JSON value."""
    yield place
    items = (value.items() if isinstance(value, dict) else
             enumerate(value) if isinstance(value, list) else ())
    for key, part in items:
        yield from places_in(part, (*place, key))


def change_json(random, data):
    try:
        value = json.loads(data)
    except ValueError:
        return change_number(random, data)
    places = [place for place in places_in(value) if place]
    if not places:
        return b"[]"
    *folders, last = random.choice(places)
    part = value
    for key in folders:
        part = part[key]
    kind = random.randrange(4)
    if kind == 0:
        del part[last]
    elif kind == 1 and isinstance(part, dict):
        part[random.choice(("", "x", last + "x"))] = part[last]
    else:
        part[last] = random.choice(VALUES)
    return json.dumps(value).encode()


BINARY = (flip_bits, flip_bits, truncate, append, set_number, set_number, remove_part, repeat_part)
TEXT = (flip_bits, truncate, append, change_lines, change_lines, change_number, change_number,
        remove_part)


def put_other_thing(random, path, others):
    """Puts something else in the place of the file."""
    kind = random.randrange(7)
    path.unlink()
    if kind == 0:
        path.mkdir()
    elif kind == 1:
        os.mkfifo(path)
    elif kind == 2:
        path.symlink_to("no_such_file")
    elif kind == 3:
        path.symlink_to(path.name)
    elif kind == 4 or (kind == 5 and not others):
        path.write_bytes(b"")
    elif kind == 5:
        shutil.copyfile(random.choice(others), path)


def damage(random, folder, file, files):
    """Damages `file` in `folder`. `files`: other files that may take its place."""
    path = folder / file
    if random.random() < 0.15:
        others = [folder / name for name in files
                  if name != file and (folder / name).is_file()]
        put_other_thing(random, path, others)
        return
    data = path.read_bytes()
    is_header = data.startswith((b"ply", b"glTF"))
    kinds = TEXT if path.suffix in TEXTS else BINARY
    if path.suffix == ".json" and random.random() < 0.6:
        kinds = (change_json,)
    if is_header and random.random() < 0.4:
        end = data.find(b"end_header") + 11
        path.write_bytes(random.choice(TEXT)(random, data[:end]) + data[end:])
        return
    for _ in range(random.choice((1, 1, 1, 2))):
        data = random.choice(kinds)(random, data)
    path.write_bytes(data)


def nasty_option(random, options, names):
    """The options with one more, or with another value of one."""
    value = random.choice(OPTION_VALUES)
    values = [i for i in range(1, len(options)) if options[i - 1].startswith("-")
              and not options[i].startswith("-")]
    if random.random() < 0.3 and values:
        i = random.choice(values)
        return [*options[:i], value, *options[i + 1:]]
    return [*options, f"--{random.choice(names)}={value}"]
