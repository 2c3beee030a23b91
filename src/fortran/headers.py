# SPDX-License-Identifier: BSD-3-Clause
"""What the headers of include/dem declare. They are regular; whatever is not understood here is an error."""
import re
from collections import namedtuple

# `type` without const and stars; `shape` of `[2]` is (2,); `const` is that of what a pointer points to.
Item = namedtuple("Item", "name type const stars shape")
Function = namedtuple("Function", "name result arguments")  # the result is an Item


class Header:
    """The declarations of one file, in its order."""

    def __init__(self, path):
        text = path.read_text(encoding="utf-8")
        self.name = path.name
        self.includes = re.findall(r"#include <dem/([\w.]+)>", text)
        self.enums = []  # (name or "", {constant: value}), ...
        self.structs = {}  # name -> [Item, ...]
        self.opaque = []
        self.callbacks = {}  # name -> Function; a member m of a struct s is s_m, an argument a of a function f is f_a
        self.functions = {}  # name -> Function: what the library exports
        self.inline = {}  # name -> Function: what the header itself defines
        for declaration in declarations(text):
            self.read_declaration(declaration)

    def read_callback(self, text, owner):
        """`int (*keep)(void *context, const double x[2])`."""
        result, name, arguments = re.fullmatch(r"([\w* ]+?)\(\*(\w+)\)\s*\((.*)\)", text).groups()
        full = f"{owner}_{name}" if owner else name
        self.callbacks[full] = self.read_function(result, full, arguments)
        return Item(name, full, False, 0, ())

    def read_function(self, result, name, arguments):
        items = [self.read_callback(a, name) if "(*" in a else read_item(a) for a in split_list(arguments)]
        return Function(name, read_item(result), [item for item in items if item.type != "void" or item.stars])

    def read_members(self, owner, body):
        members = []
        for line in (part.strip() for part in body.split(";")):
            if "(*" in line:
                members.append(self.read_callback(line, owner))
            elif line:  # `const double *x, *v`
                kind = re.match(r"(const )?(unsigned )?\w+ ", line).group(0)
                members += [read_item(kind + part.removeprefix(kind)) for part in split_list(line)]
        return members

    def read_declaration(self, text):
        if match := re.fullmatch(r"(?:typedef )?enum (?:\w+ )?\{(.*)\} ?(\w*)", text):
            self.enums.append((match.group(2), read_constants(match.group(1))))
        elif match := re.fullmatch(r"typedef struct \w+ \{(.*)\} (\w+)", text):
            self.structs[match.group(2)] = self.read_members(match.group(2), match.group(1))
        elif match := re.fullmatch(r"typedef struct (\w+) \1", text):
            self.opaque.append(match.group(1))
        elif re.fullmatch(r"typedef [\w* ]+\(\*\w+\)\(.*\)", text):
            self.read_callback(text.removeprefix("typedef "), "")
        elif match := re.fullmatch(r"(DEM_API|static inline) ([\w ]+?\**) ?\b(\w+)\((.*)\)", text):
            where, result, name, arguments = match.groups()
            functions = self.functions if where == "DEM_API" else self.inline
            functions[name] = self.read_function(result, name, arguments)
        elif text != "typedef int64_t dem_index":
            raise SyntaxError(f"{self.name}: not understood: '{text}'")


def declarations(text):
    """One by one, without comments, bodies of functions, and what is for the preprocessor or for C++."""
    text = re.sub(r"/\*.*?\*/", " ", text, flags=re.S)
    text = re.sub(r"(?ms)^#ifdef __cplusplus$.*?^#endif$", "", text)
    text = re.sub(r"(?m)^#.*$", "", text)
    text = re.sub(r"(?ms)^(static inline [^{;]*)\{.*?^\}", r"\1;", text)
    return [part.strip() for part in re.findall(r"((?:\{[^{}]*\}|[^;{}])*);", " ".join(text.split()))]


def split_list(text):
    """At commas outside parentheses."""
    return [part.strip() for part in re.split(r",(?![^(]*\))", text) if part.strip()]


def read_item(text):
    """`const double *x`, `dem_index nodes[4]`, `void`."""
    match = re.fullmatch(r"(const )?((?:unsigned )?\w+) ?(\**)(\w*)((?:\[\d+\])*)", text.strip())
    if not match:
        raise SyntaxError(f"not understood: '{text}'")
    const, kind, stars, name, extents = match.groups()
    return Item(name, kind, bool(const), len(stars), tuple(int(n) for n in re.findall(r"\d+", extents)))


def read_constants(body):
    constants, value = {}, -1
    for part in split_list(body):
        name, _, given = part.partition("=")
        value = int(given) if given else value + 1
        constants[name.strip()] = value
    return constants


def read_headers(folder, with_mpi=False):
    """Every header of the folder, each after those that it includes. That with types of MPI's own is for C so far."""
    found = {path.name: Header(path) for path in sorted(folder.glob("*.h")) if with_mpi or path.name != "mpi.h"}
    ordered = []

    def place(header):
        if header not in ordered:
            for name in header.includes:
                place(found[name])
            ordered.append(header)

    for header in found.values():
        place(header)
    return ordered
