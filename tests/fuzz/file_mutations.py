"""Ways in which a file is damaged: each takes bytes and returns others."""

import re

import numpy as np

NUMBER = re.compile(rb"-?\d+(?:\.\d+)?(?:e[+-]?\d+)?")
EVIL = (
    b"-1",
    b"0",
    b"99999999999",
    b"4294967297",
    b"9007199254740993",
    b"-9223372036854775808",
    b"nan",
    b"1e400",
    b"1" * 5000,
    b"",
    b"[" * 3000,
    b"Infinity",
)


def cut(rng, data):
    return data[: rng.integers(len(data))]


def cut_at_a_line(rng, data):
    ends = [i + 1 for i, byte in enumerate(data) if byte == 10] or [0]
    return data[: ends[rng.integers(len(ends))]]


def flip_a_bit(rng, data):
    damaged = np.frombuffer(data, np.uint8).copy()
    damaged[rng.integers(len(data))] ^= np.uint8(1 << rng.integers(8))
    return damaged.tobytes()


def overwrite(rng, data):
    damaged = np.frombuffer(data, np.uint8).copy()
    at = rng.integers(len(data), size=rng.integers(1, 6))
    damaged[at] = rng.integers(256, size=len(at))
    return damaged.tobytes()


def insert(rng, data):
    at = int(rng.integers(len(data)))
    return (
        data[:at]
        + rng.integers(256, size=rng.integers(1, 40), dtype=np.uint8).tobytes()
        + data[at:]
    )


def delete(rng, data):
    at = int(rng.integers(len(data)))
    return data[:at] + data[at + int(rng.integers(1, 40)) :]


def zero_a_block(rng, data):
    at, length = int(rng.integers(len(data))), int(rng.integers(1, 600))
    return data[:at] + bytes(len(data[at : at + length])) + data[at + length :]


def change_a_number(rng, data):
    found = list(NUMBER.finditer(data))
    if not found:
        return flip_a_bit(rng, data)
    chosen = found[rng.integers(len(found))]
    return data[: chosen.start()] + EVIL[rng.integers(len(EVIL))] + data[chosen.end() :]


def drop_a_line(rng, data):
    lines = data.splitlines(keepends=True)
    at = int(rng.integers(len(lines)))
    return b"".join(lines[:at] + lines[at + 1 :])


def repeat_a_line(rng, data):
    lines = data.splitlines(keepends=True)
    at = int(rng.integers(len(lines)))
    return b"".join([*lines[: at + 1], lines[at], *lines[at + 1 :]])


def repeat_lines(rng, data):
    """A run of lines comes again, there or at another place: sections given twice."""
    lines = data.splitlines(keepends=True)
    first, last = sorted(rng.integers(len(lines) + 1, size=2))
    to = int(rng.integers(len(lines) + 1)) if rng.random() < 0.5 else int(last)
    return b"".join([*lines[:to], *lines[first:last], *lines[to:]])


def repeat_all(rng, data):
    return data + data


def swap_lines(rng, data):
    lines = data.splitlines(keepends=True)
    one, other = rng.integers(len(lines), size=2)
    lines[one], lines[other] = lines[other], lines[one]
    return b"".join(lines)


def append(rng, data):
    return data + rng.integers(256, size=rng.integers(1, 200), dtype=np.uint8).tobytes()


MUTATIONS = (
    cut,
    cut_at_a_line,
    flip_a_bit,
    overwrite,
    insert,
    delete,
    zero_a_block,
    change_a_number,
    drop_a_line,
    repeat_a_line,
    repeat_lines,
    repeat_all,
    swap_lines,
    append,
)
WITHOUT_LOSS = (cut, cut_at_a_line, repeat_a_line, repeat_lines, repeat_all, append)
"""Those after which a file that is read has to give all that it gave before."""
