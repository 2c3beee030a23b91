# SPDX-License-Identifier: BSD-3-Clause
"""The files of a run: which there are, whether they are whole, whether two runs have the same data."""
import json
import pathlib
import re
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "deck"))
import compare  # ends the test as skipped where h5py is missing
import h5py

HEADER = struct.Struct("<8sIIQQQ")  # of a checkpoint: magic, byte order, format, bytes, entries, checksum
AT_CHECKSUM = slice(HEADER.size - 8, HEADER.size)
CHANGING = re.compile(rb"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ")  # when a run began, in /provenance
TEMPORARY = (".part", ".new", ".trial")
LOCK = ".lock"  # a file that stays locks nothing


def is_temporary(path):
    return any(mark in path.name for mark in TEMPORARY)


def published(folder):
    """The files that a reader may take for whole."""
    paths = (path for path in pathlib.Path(folder).iterdir() if path.name != "deck.nml")
    return {path.name: path for path in sorted(paths) if path.suffix != LOCK and not is_temporary(path)}


def checkpoints(folder):
    return [path for name, path in published(folder).items() if ".checkpoint" in name]


# ---- whole? ----

def read_hdf5(path):
    """Every number and every string."""
    with h5py.File(path, "r") as file:
        for item in compare.objects(file).values():
            if isinstance(item, h5py.Dataset):
                item[()]
            for name in item.attrs:
                item.attrs[name]


def read_checkpoint(path):
    data = path.read_bytes()
    magic, _, _, size, _, checksum = HEADER.unpack_from(data)
    blank = bytearray(data)
    blank[AT_CHECKSUM] = bytes(8)
    if magic != b"demrec\r\n" or size != len(data) or zlib.crc32(blank) != checksum:
        raise ValueError("it is damaged")


def read_result(path):
    return json.loads(path.read_text(encoding="utf-8"))


def reader_of(path):
    readers = {".vtkhdf": read_hdf5, ".json": read_result, ".checkpoint": read_checkpoint, ".prev": read_checkpoint}
    return readers[path.suffix]


def faults_of_files(folder):
    """Of what is published, at any moment."""
    faults = []
    for path in published(folder).values():
        try:
            reader_of(path)(path)
        except (OSError, RuntimeError, KeyError, ValueError, struct.error) as error:
            faults.append(f"{path.name} cannot be read: {error}")
    return faults


# ---- the same? ----

def same_hdf5(path, other):
    """Equal bytes are the quick way to know it."""
    if CHANGING.sub(b"", path.read_bytes()) == CHANGING.sub(b"", other.read_bytes()):
        return []
    with h5py.File(path, "r") as first, h5py.File(other, "r") as second:
        return list(compare.compare(compare.objects(first), compare.objects(second), [path.name, other.name]))


def same_result(path, other):
    first, second = read_result(path), read_result(other)
    keys = [key for key in first.keys() | second.keys() if not key.startswith("wall")]
    return [f"{path.name}: {key} is {first.get(key)} and {second.get(key)}" for key in sorted(keys)
            if first.get(key) != second.get(key)]


def faults_of_data(folder, reference):
    """Of a run that is done, by the folder of another one."""
    ours, theirs = ({name: path for name, path in published(place).items() if path.suffix in (".vtkhdf", ".json")}
                    for place in (folder, reference))
    faults = [f"{name} is there in one of the runs only" for name in sorted(ours.keys() ^ theirs.keys())]
    faults += [f"{path.name} was left behind" for path in pathlib.Path(folder).iterdir()
               if is_temporary(path)]
    for name in sorted(ours.keys() & theirs.keys()):
        faults += (same_hdf5 if name.endswith(".vtkhdf") else same_result)(ours[name], theirs[name])
    return faults
