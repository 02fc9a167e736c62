"""Reads particle files (.vtp) and mesh files (.vtu) as talus writes them: appended raw data, LZ4 blocks, 64-bit headers."""
import xml.etree.ElementTree as tree

import lz4.block
import numpy as np

TYPES = {"Float32": "<f4", "Float64": "<f8", "Int32": "<i4", "Int64": "<i8", "UInt8": "u1"}


def read(path):
    """Point data, 'Points' and, of a mesh, 'connectivity', 'offsets' and 'types' of a file as {name: array of shape (n,) or (n, components)}.

    Raises ValueError for another encoding than the one talus writes (VTK file formats, section 'XML file formats').
    """
    raw = path.read_bytes()
    head, mark, appended = raw.partition(b'<AppendedData encoding="raw">')
    start = appended.find(b"_") + 1
    if not mark or b"vtkLZ4DataCompressor" not in head or b'header_type="UInt64"' not in head:
        raise ValueError(f"{path}: not a file with appended raw LZ4 data and 64-bit headers")
    root = tree.fromstring(head + b"</VTKFile>")
    piece = root.find("*/Piece")
    arrays = [*piece.find("PointData"), *piece.find("Points"), *piece.findall("Cells/DataArray")]
    return {array.get("Name"): _array(array, appended, start) for array in arrays}


def _array(node, appended, start):
    """One DataArray: header (blocks, size, size of the last, compressed sizes), then the blocks."""
    at = start + int(node.get("offset"))
    blocks, size, last = (int(n) for n in np.frombuffer(appended, "<u8", 3, at))
    packed = np.frombuffer(appended, "<u8", blocks, at + 24)
    at += 24 + 8 * blocks
    data = b""
    for i, length in enumerate(int(n) for n in packed):
        full = last if i == blocks - 1 and last else size
        data += lz4.block.decompress(appended[at:at + length], uncompressed_size=full)
        at += length
    values = np.frombuffer(data, TYPES[node.get("type")])
    components = int(node.get("NumberOfComponents", 1))
    return values.reshape(-1, components) if components > 1 else values
