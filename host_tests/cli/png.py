"""Reading the PNG files that our programs write."""
import struct
import zlib


def png_pixels(path):
    """Width, height and the RGB rows of an 8-bit PNG with filters 0 and 1, by zlib alone."""
    with open(path, "rb") as f:
        data = f.read()
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at, deflated, size = 8, b"", None
    while at < len(data):
        length, tag = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(tag + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        if tag == b"IHDR":
            size = struct.unpack(">II", body[:8])
        elif tag == b"IDAT":
            deflated += body
        at += 12 + length
    raw, rows, stride = zlib.decompress(deflated), [], 3 * size[0]
    for y in range(size[1]):
        row = bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)])
        if raw[y * (stride + 1)] == 1:
            for x in range(3, stride):
                row[x] = (row[x] + row[x - 3]) & 255
        rows.append(bytes(row))
    return size, rows
