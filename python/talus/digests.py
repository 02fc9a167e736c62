"""Digests of arrays as computed by io/checkpoint/array_digest.cpp."""
from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

_FACTOR = np.uint64(0x9E3779B97F4A7C15)
_LANES = 8


def _digest_step(h: np.ndarray, word: np.ndarray) -> np.ndarray:
    mixed = (h ^ word) * _FACTOR  # modulo 2^64
    return (mixed << np.uint64(29)) | (mixed >> np.uint64(35))


def _digests(pieces: Sequence[bytes], seed: int) -> list[int]:
    """Digests of pieces of bytes as in io/checkpoint/array_digest.cpp: eight lanes of words and the remaining bytes, for all pieces at once."""
    if not pieces:
        return []
    size = max(map(len, pieces))
    same = [piece for piece in pieces if len(piece) == size]
    if len(same) < len(pieces):  # the first and the last may be shorter
        done = iter(_digests(same, seed))
        return [next(done) if len(piece) == size else _digests([piece], seed)[0] for piece in pieces]
    blocks, over = divmod(size, 8 * _LANES)
    whole = np.array([np.frombuffer(piece, "<u8", blocks * _LANES) for piece in pieces]).reshape(len(pieces), blocks, _LANES)
    rest = np.array([np.frombuffer(piece[size - over:].ljust(8 * _LANES, b"\0"), "<u8") for piece in pieces])
    start = np.array([seed], np.uint64)
    lanes = np.broadcast_to(_digest_step(start, np.arange(_LANES, dtype=np.uint64)), (len(pieces), _LANES))
    for block in range(blocks):
        lanes = _digest_step(lanes, whole[:, block])
    h = np.broadcast_to(_digest_step(start, np.array([size], np.uint64)), len(pieces))
    for k in range(_LANES):
        h = _digest_step(_digest_step(h, lanes[:, k]), rest[:, k])
    return (h ^ (h >> np.uint64(32))).tolist()


def _digest_of_words(words: Sequence[int], seed: int) -> int:
    return _digests([np.array(words, "<u8").tobytes()], seed)[0]


def fits_digest(name: str, array: Any, values: np.ndarray) -> bool:
    """Whether the values of an array are unchanged since they were written (io/checkpoint/array_digest.cpp): the digest of each piece of rows starts from the
    digest of the meaning of the values, and the attribute `digest` is the digest of these digests."""
    rows, columns = (*values.shape, 1)[:2]
    word = {"f8": "double", "f4": "float", "i4": "int32", "i8": "int64", "u1": "uint8"}.get(values.dtype.str[1:], "text")
    unit = array.attrs.get("unit", b"")
    unit = unit if isinstance(unit, bytes) else str(unit).encode()
    meaning = _digests([f"{name}\n{word}\n{rows} x {columns}\n".encode() + unit], 0)[0]
    data, row_bytes = values.tobytes(), columns * values.dtype.itemsize
    if "pieces" not in array.attrs:
        return _digest_of_words(_digests([data] if rows else [], meaning), meaning) == int(array.attrs["digest"])
    piece, lead, *kept = (int(word) for word in array.attrs["pieces"])
    ends = [*range(piece - lead, rows, piece), rows]
    found = _digests([data[begin * row_bytes:end * row_bytes] for begin, end in zip([0, *ends], ends)], meaning)
    return found == kept and _digest_of_words([piece, lead, *kept], meaning) == int(array.attrs["digest"])
