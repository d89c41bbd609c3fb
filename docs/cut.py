"""Cuts part 1 of 1 of an image into N parts, as `render --part` writes them: python3 docs/cut.py a.png.part-1-of-1 N DIR"""

import hashlib
import json
import os
import sys

source, count, folder = sys.argv[1], int(sys.argv[2]), sys.argv[3]
os.makedirs(folder, exist_ok=True)
with open(source, "rb") as file:
    data = file.read()
first = data.index(b"\n") + 1
at = data.index(b"\n", first) + 1
label = json.loads(data[first:at])
width, height = label["size"]
across = -(-width // 16)


def length(tile):
    """Returns the number of bytes of a tile."""
    row, column = divmod(tile, across)
    return 3 * min(16, width - 16 * column) * min(16, height - 16 * row)


tiles, begin = label["tiles"][1], 0
for part in range(1, count + 1):
    end = part * tiles // count
    label["part"], label["tiles"] = [part, count], [begin, end]
    pixels = sum(map(length, range(begin, end)))
    text = data[:first] + json.dumps(label, separators=(",", ":")).encode() + b"\n" + data[at : at + pixels]
    with open(f"{folder}/a.png.part-{part}-of-{count}", "wb") as file:
        file.write(text + hashlib.sha256(text).digest())
    at, begin = at + pixels, end
