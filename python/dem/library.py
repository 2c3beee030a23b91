# SPDX-License-Identifier: BSD-3-Clause
"""The shared library: where it is, what its statuses become, and its memory as arrays of NumPy."""
from __future__ import annotations

import ctypes
import os
import pathlib
from collections.abc import Callable, Mapping
from ctypes import POINTER, byref, c_double
from typing import Any, ClassVar, TypeVar

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import c_interface as c

Floats = NDArray[np.float64]
Integers = NDArray[np.int64]
Bools = NDArray[np.bool_]
Enumeration = tuple[type[Any], str]  # and the prefix of its names

NAME = "libdem.so.2"  # with the generation of the library


class Error(Exception):
    """A call of the library has failed: `status` is a dem_status, the message is the library's."""

    def __init__(self, status: int, message: str) -> None:
        super().__init__(message)
        self.status = c.dem_status(status)


class ArgumentError(Error, ValueError):
    """A number outside its range, or an unknown name."""


class ModelError(Error, ValueError):
    """An unphysical or inconsistent lattice or obstacle, which the message names."""


class IntegratorError(Error, ArithmeticError):
    """The tolerance cannot be met, or a force is not finite; the simulation has its last good state."""


class ContactError(Error, ArithmeticError):
    """Impacts accumulate faster than time advances; the simulation has its last good state."""


class FileError(Error, OSError):
    """A file cannot be read or written."""

    def __str__(self) -> str:
        return str(self.args[0])


ERRORS: dict[int, type[Error]] = {
    c.dem_status.DEM_ERROR_ARGUMENT: ArgumentError, c.dem_status.DEM_ERROR_MODEL: ModelError,
    c.dem_status.DEM_ERROR_INTEGRATOR: IntegratorError, c.dem_status.DEM_ERROR_CONTACT: ContactError,
    c.dem_status.DEM_ERROR_IO: FileError}


def find() -> str:
    """The path of the library: DEM_LIBRARY, else beside this file, else wherever the loader looks."""
    beside = pathlib.Path(__file__).with_name(NAME)
    return os.environ.get("DEM_LIBRARY") or (str(beside) if beside.exists() else NAME)


def load() -> ctypes.CDLL:
    """The library with the types of all functions. The interpreter is free while one of them runs."""
    found = ctypes.CDLL(find())
    for name, (result, arguments, text) in c.FUNCTIONS.items():
        function = getattr(found, name)
        function.restype, function.argtypes, function.__doc__ = result, arguments, text
    return found


library = load()


def check(status: int) -> int:
    """Raises what a status means; DEM_STOPPED passes."""
    if status < 0:
        message = library.dem_status_message().decode(errors="replace")
        if status == c.dem_status.DEM_ERROR_MEMORY:
            raise MemoryError(message)
        raise ERRORS[status](status, message)
    return status


class Handle:
    """An object of the library that only it knows. It ends when nobody needs it any more: views of its memory keep it,
    and it keeps the handles that it needs itself."""

    def __init__(self, pointer: Any, destroy: Callable[[Any], Any], *needs: Handle) -> None:
        self.pointer, self.needs, self._destroy = pointer, needs, destroy

    def __del__(self) -> None:
        self._destroy(self.pointer)


def make(kind: Any, create: Callable[..., int], destroy: Callable[[Any], Any], *arguments: Any,
         needs: tuple[Handle, ...] = ()) -> Handle:
    """A handle of what create(byref(out), *arguments) makes."""
    out = POINTER(kind)()
    check(create(byref(out), *arguments))
    return Handle(out, destroy, *needs)


def view(pointer: Any, shape: tuple[int, ...], owner: object, writable: bool = False) -> Any:
    """Memory of the library as an array, which keeps its owner alive; None for NULL."""
    if not pointer:
        return None
    count = int(np.prod(shape))
    if count == 0:
        return np.zeros(shape, pointer._type_)
    block = (pointer._type_ * count).from_address(ctypes.addressof(pointer.contents))
    block.owner = owner
    array = np.frombuffer(block, pointer._type_).reshape(shape)
    array.flags.writeable = writable
    return array


def numbers(values: ArrayLike, shape: tuple[int | None, ...] | None = None,
            dtype: DTypeLike = np.float64) -> NDArray[Any]:
    """An array as C has it, of a shape in which None is any extent; raises ValueError for another."""
    array = np.ascontiguousarray(values, dtype)
    if shape is not None and (array.ndim != len(shape) or
                              any(want not in (None, have) for want, have in zip(shape, array.shape))):
        wanted = ", ".join("any" if n is None else str(n) for n in shape)
        raise ValueError(f"an array of shape ({wanted}) is expected, got {array.shape}")
    return array


def pointer(array: NDArray[Any] | None, kind: Any = c_double) -> Any:
    """To the numbers of an array, or NULL for None. The array must live as long as C uses it."""
    return None if array is None else array.ctypes.data_as(POINTER(kind))


def enumerator(kind: type[Any], value: str | int, prefix: str) -> Any:
    """A value of an enumeration by its name without the prefix, in any case: 'strain' of DEM_PLANE_."""
    if not isinstance(value, str):
        return kind(value)
    try:
        return kind[prefix + value.upper()]
    except KeyError:
        names = ", ".join(f"'{name.removeprefix(prefix).lower()}'" for name in kind.__members__)
        raise ValueError(f"'{value}' is none of {names}") from None


Struct = TypeVar("Struct", bound=ctypes.Structure)


def fill(struct: Struct, values: Mapping[str, Any], enumerations: Mapping[str, Enumeration]) -> Struct:
    """Sets fields of a struct by their names; vectors may have two components.
    enumerations: of fields that may be given by a name, the enumeration and its prefix."""
    fields: dict[str, Any] = {name: kind for name, kind, *_ in struct._fields_ if name != "struct_size"}
    for name, value in values.items():
        if name not in fields:
            known = ", ".join(fields)
            raise TypeError(f"{type(struct).__name__} has no '{name}', but {known}")
        if name in enumerations:
            kind, prefix = enumerations[name]
            value = enumerator(kind, value, prefix)
        if hasattr(fields[name], "_length_"):
            setattr(struct, name, fields[name](*value))
        else:
            setattr(struct, name, value)
    return struct


class Record:
    """Numbers of one instant, by their names in the C interface; vectors are arrays. Each struct has a class in
    records, with its text."""
    struct: ClassVar[type[ctypes.Structure]]

    def __init_subclass__(cls) -> None:
        cls.__doc__ = cls.struct.__doc__

    def __init__(self, struct: ctypes.Structure) -> None:
        for name, kind, *_ in struct._fields_:
            if name != "struct_size":
                value = getattr(struct, name)
                setattr(self, name, np.array(value) if hasattr(kind, "_length_") else value)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value}' for name, value in vars(self).items())})"


Made = TypeVar("Made", bound=Record)


def ask(function: Callable[..., int], kind: type[Made], *arguments: Any) -> Made:
    """What a function writes into the struct of such a record."""
    out = kind.struct()
    check(function(*arguments, byref(out)))
    return kind(out)
