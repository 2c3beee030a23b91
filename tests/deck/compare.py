#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Same data? Compares two HDF5 files object by object, apart from /provenance, which tells when and by what each was
written: the same groups, datasets and attributes, of the same shape and type, with the same bytes.

usage: compare.py A B
Exit code: 0 the same, 1 a difference, 2 usage or a file that cannot be read, 77 the Python package h5py is missing."""
import sys

try:
    import h5py
    import numpy as np
except ImportError as error:
    print(f"skipped: the Python package h5py is needed ({error})")
    sys.exit(77)

SHOWN = 20  # differences


def objects(file):
    """Path to group or dataset, /provenance left out."""
    found = {"/": file["/"]}
    file.visititems(lambda name, item: found.update({"/" + name: item}))
    return {path: item for path, item in found.items() if path.split("/")[1] != "provenance"}


def attributes(item):
    """Name to attribute, on the level that knows their types."""
    return {name: item.attrs.get_id(name) for name in item.attrs}


def value_of(item):
    if isinstance(item, h5py.Dataset):
        return np.asarray(item[()])
    value = np.empty(item.shape, item.dtype)
    item.read(value)
    return value


def bits(values):
    """A row of bytes for each number, so that NaN equals itself and -0 is not 0."""
    flat = np.ascontiguousarray(values).reshape(-1)
    if flat.dtype.hasobject:  # strings of any length
        return np.array([hash(repr(value)) for value in flat], dtype=np.int64).reshape(flat.size, 1)
    return flat.view(np.uint8).reshape(flat.size, flat.itemsize)


def compare_values(what, a, b):
    """Yields how two datasets or attributes differ."""
    if a.shape != b.shape:
        yield f"{what}: shape {a.shape} and {b.shape}"
        return
    types = [item.get_type() if isinstance(item, h5py.h5a.AttrID) else item.id.get_type() for item in (a, b)]
    if types[0] != types[1]:
        yield f"{what}: type {a.dtype} and {b.dtype}" + (" (stored differently)" if a.dtype == b.dtype else "")
        return
    left, right = value_of(a), value_of(b)
    differ = np.flatnonzero((bits(left) != bits(right)).any(axis=1))
    if differ.size > 0:
        first = differ[0]
        at = [int(k) for k in np.unravel_index(first, left.shape)]
        yield (f"{what}: {differ.size} of {left.size} values differ, first at {at}: "
               f"{left.reshape(-1).tolist()[first]!r} and {right.reshape(-1).tolist()[first]!r}")


def compare_names(what, a, b, paths):
    for name in sorted(a.keys() ^ b.keys()):
        yield f"{what} {name}: only in {paths[0 if name in a else 1]}"


def compare(a, b, paths):
    """Yields the differences of two dictionaries of objects."""
    yield from compare_names("object", a, b, paths)
    for path in sorted(a.keys() & b.keys()):
        if isinstance(a[path], h5py.Dataset) != isinstance(b[path], h5py.Dataset):
            yield f"{path}: a dataset in one file, a group in the other"
            continue
        if isinstance(a[path], h5py.Dataset):
            yield from compare_values(path, a[path], b[path])
        ours, theirs = attributes(a[path]), attributes(b[path])
        yield from compare_names(f"{path}: attribute", ours, theirs, paths)
        for name in sorted(ours.keys() & theirs.keys()):
            yield from compare_values(f"{path}: attribute {name}", ours[name], theirs[name])


def main(arguments):
    if len(arguments) != 2:
        print(__doc__, file=sys.stderr)
        return 2
    try:
        with h5py.File(arguments[0], "r") as first, h5py.File(arguments[1], "r") as second:
            a, b = objects(first), objects(second)
            differences = list(compare(a, b, arguments))
            n_datasets = sum(isinstance(item, h5py.Dataset) for item in a.values())
            n_attributes = sum(len(item.attrs) for item in a.values())
    except OSError as error:
        print(f"compare.py: {error}", file=sys.stderr)
        return 2
    for line in differences[:SHOWN]:
        print(line)
    if len(differences) > SHOWN:
        print(f"... and {len(differences) - SHOWN} more differences")
    if not differences:
        print(f"the same: {n_datasets} datasets, {n_attributes} attributes")
    return 1 if differences else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
