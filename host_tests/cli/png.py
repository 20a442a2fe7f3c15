"""Reading the PNG files that our programs write."""
import struct
import zlib


def png_chunks(data):
    """Tag and content of each chunk, checksums held."""
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    at = 8
    while at < len(data):
        length, tag = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        assert zlib.crc32(tag + body) == struct.unpack(">I", data[at + 8 + length:at + 12 + length])[0]
        yield tag, body
        at += 12 + length


def unfilter(kind, row, above):
    """A row of RGB pixels, in place, by the PNG filter of that number."""
    for i, byte in enumerate(row):
        left, up, corner = row[i - 3] if i >= 3 else 0, above[i], above[i - 3] if i >= 3 else 0
        if kind == 4:
            base = left + up - corner
            guess = min((left, up, corner), key=lambda v: abs(base - v))  # the first of equals
        else:
            guess = (0, left, up, (left + up) // 2)[kind]
        row[i] = (byte + guess) & 255
    return row


def png_pixels(path):
    """Width and height and the rows of an 8-bit RGB PNG, by zlib alone; of an animated one the first frame."""
    with open(path, "rb") as f:
        chunks = list(png_chunks(f.read()))
    width, height, depth, colour = struct.unpack(">IIBB", dict(chunks)[b"IHDR"][:10])
    assert (depth, colour) == (8, 2)
    raw, stride = zlib.decompress(b"".join(body for tag, body in chunks if tag == b"IDAT")), 3 * width
    rows, above = [], bytes(stride)
    for y in range(height):
        at = y * (stride + 1)
        above = bytes(unfilter(raw[at], bytearray(raw[at + 1:at + 1 + stride]), above))
        rows.append(above)
    return (width, height), rows
