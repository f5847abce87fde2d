# SPDX-License-Identifier: Apache-2.0
"""OpenEXR scan-line files in plain Python: writes uncompressed, reads uncompressed and ZIP. From the file layout
document of the OpenEXR project; shares no code with the program under test."""
import struct
import zlib

HALF, FLOAT = 1, 2
ZIP_LINES = {0: 1, 2: 1, 3: 16}
FORMAT = {HALF: "e", FLOAT: "f"}
SIZE = {HALF: 2, FLOAT: 4}


def attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def write(path, channels, width, height, origin=(0, 0), display=None, extra=(), aspect=1):
    """channels: name -> (HALF or FLOAT, list of width * height numbers); display: (x, y, width, height); aspect: of pixels."""
    names = sorted(channels)
    chlist = b"".join(n.encode() + b"\0" + struct.pack("<iBBBBii", channels[n][0], 0, 0, 0, 0, 1, 1) for n in names)
    x, y = origin
    dx, dy, dw, dh = display or (x, y, width, height)
    header = attribute("channels", "chlist", chlist + b"\0")
    header += attribute("compression", "compression", b"\0")
    header += attribute("dataWindow", "box2i", struct.pack("<4i", x, y, x + width - 1, y + height - 1))
    header += attribute("displayWindow", "box2i", struct.pack("<4i", dx, dy, dx + dw - 1, dy + dh - 1))
    header += attribute("lineOrder", "lineOrder", b"\0")
    header += attribute("pixelAspectRatio", "float", struct.pack("<f", aspect))
    header += attribute("screenWindowCenter", "v2f", struct.pack("<2f", 0, 0))
    header += attribute("screenWindowWidth", "float", struct.pack("<f", 1))
    for item in extra:
        header += attribute(*item)
    start = struct.pack("<ii", 20000630, 2) + header + b"\0"
    lines = []
    for row in range(height):
        data = b"".join(
            struct.pack(f"<{width}{FORMAT[channels[n][0]]}", *channels[n][1][row * width:(row + 1) * width]) for n in names)
        lines.append(struct.pack("<ii", y + row, len(data)) + data)
    offset = len(start) + 8 * height
    table = b""
    for line in lines:
        table += struct.pack("<Q", offset)
        offset += len(line)
    with open(path, "wb") as file:
        file.write(start + table + b"".join(lines))


def read_header(data):
    assert struct.unpack_from("<ii", data) == (20000630, 2), "not a plain scan-line EXR"
    at, attributes = 8, {}
    while data[at] != 0:
        end = data.index(b"\0", at)
        name, at = data[at:end].decode(), end + 1
        end = data.index(b"\0", at)
        kind, at = data[at:end].decode(), end + 1
        size = struct.unpack_from("<i", data, at)[0]
        attributes[name] = (kind, data[at + 4:at + 4 + size])
        at += 4 + size
    return attributes, at + 1


def unzip(data, size):
    if len(data) == size:
        return data
    raw = bytearray(zlib.decompress(data))
    for k in range(1, len(raw)):
        raw[k] = (raw[k - 1] + raw[k] - 128) & 255
    half = (len(raw) + 1) // 2
    out = bytearray(len(raw))
    out[0::2], out[1::2] = raw[:half], raw[half:]
    return bytes(out)


class Picture:
    def __init__(self, path):
        with open(path, "rb") as file:
            data = file.read()
        self.attributes, at = read_header(data)
        x0, y0, x1, y1 = struct.unpack("<4i", self.attributes["dataWindow"][1])
        self.width, self.height, self.origin = x1 - x0 + 1, y1 - y0 + 1, (x0, y0)
        d = struct.unpack("<4i", self.attributes["displayWindow"][1])
        self.display = (d[0], d[1], d[2] - d[0] + 1, d[3] - d[1] + 1)
        self.aspect = struct.unpack("<f", self.attributes["pixelAspectRatio"][1])[0]
        kinds = self.read_channel_list()
        self.channels = {name: [] for name in kinds}
        lines = ZIP_LINES[self.attributes["compression"][1][0]]
        for block in range((self.height + lines - 1) // lines):
            start = struct.unpack_from("<Q", data, at + 8 * block)[0]
            size = struct.unpack_from("<i", data, start + 4)[0]
            rows = min(lines, self.height - block * lines)
            self.read_block(kinds, data[start + 8:start + 8 + size], rows)

    def read_channel_list(self):
        data, at, kinds = self.attributes["channels"][1], 0, {}
        while data[at] != 0:
            end = data.index(b"\0", at)
            kinds[data[at:end].decode()] = struct.unpack_from("<i", data, end + 1)[0]
            at = end + 17
        return kinds

    def read_block(self, kinds, data, rows):
        data = unzip(data, rows * self.width * sum(SIZE[k] for k in kinds.values()))
        at = 0
        for _ in range(rows):
            for name, kind in kinds.items():
                self.channels[name] += struct.unpack_from(f"<{self.width}{FORMAT[kind]}", data, at)
                at += self.width * SIZE[kind]

    def value(self, x, y, name="G"):
        return self.channels[name][y * self.width + x]

    def total(self, name="G"):
        return sum(self.channels[name])

    def centroid(self, name="G"):
        values, total = self.channels[name], self.total(name)
        x = sum(v * (k % self.width + 0.5) for k, v in enumerate(values)) / total
        y = sum(v * (k // self.width + 0.5) for k, v in enumerate(values)) / total
        return x, y
