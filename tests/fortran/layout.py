# SPDX-License-Identifier: BSD-3-Clause
"""Writes two programs that print the same if the module dem agrees with the headers: every constant, the size of every
type, offset and bytes of every member at rest, and what the inline functions return.
`layout.py SOURCE_ROOT PROGRAM.c PROGRAM.f90`"""
import pathlib
import sys

root = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(root / "src" / "fortran"))
from headers import read_headers  # noqa: E402

C = """\
#include <stdio.h>
%s
static void show(const char *name, long long number, const void *data, size_t size)
{
    const signed char *bytes = data;
    printf("%%s %%lld", name, number);
    for (size_t k = 0; k < size; ++k) printf(" %%d", bytes[k]);
    printf("\\n");
}

int main(void)
{
%s
    return 0;
}
"""
FORTRAN = """\
program layout
  use dem
  implicit none
  character(*), parameter :: form = '(a, *(1x, i0))'
%s
contains
  integer(c_intptr_t) function place(address)
    type(c_ptr), intent(in) :: address
    place = transfer(address, place)
  end function
end program
"""

headers = read_headers(root / "include" / "dem")
structs = {name: members for header in headers for name, members in header.structs.items()}
in_c, in_fortran = [], []


def show_members(label, struct, value):
    """`value` makes one, the same in both languages."""
    in_c.append(f"{{ static const {struct} zero; const {struct} s = {value or 'zero'}; (void)zero;")
    in_c.append(f'show("{label}", (long long)sizeof s, NULL, 0);')
    in_fortran.append(f"block; type({struct}), target :: s; {f's = {value}' if value else ''}")
    in_fortran.append(f"write (*, form) '{label}', c_sizeof(s)")
    show_items(label, struct, struct, [])
    in_c.append("}")
    in_fortran.append("end block")


def show_items(label, struct, whole, path):
    """Members of a struct, `path` being its names in the whole one."""
    for item in structs[struct]:
        names = [*path, item.name]
        here, there, name = ".".join(names), "%".join(names), f"{label}.{item.name}"
        if item.type in structs and not item.stars:
            show_items(name, item.type, whole, names)
            continue
        if item.name == "struct_size":  # in Fortran there from the start, in C set by the caller
            in_c.append(f'{{ const size_t n = sizeof({struct}); '
                        f'show("{name}", (long long)offsetof({whole}, {here}), &n, sizeof n); }}')
        else:
            in_c.append(f'show("{name}", (long long)offsetof({whole}, {here}), &s.{here}, sizeof s.{here});')
        in_fortran.append(f"write (*, form) '{name}', place(c_loc(s%{there})) - place(c_loc(s)), &")
        in_fortran.append(f"  transfer(s%{there}, [0_c_int8_t])")


def show_result(function):
    """Of one struct of doubles, which are 1, 2, 4, ...: every subset has a sum of its own."""
    struct = function.arguments[0].type
    values = [(item.name, f"{2 ** k}.0") for k, item in enumerate(structs[struct])]
    in_c.append(f"{{ const {struct} s = {{{', '.join(f'.{n} = {v}' for n, v in values)}}};")
    in_c.append(f'const double r = {function.name}(s); show("{function.name}", 0, &r, sizeof r); }}')
    in_fortran.append(f"write (*, form) '{function.name}', 0, transfer({function.name}({struct}( &")
    in_fortran.append(", &\n".join(f"  {n}={v}_c_double" for n, v in values) + ")), [0_c_int8_t])")


for header in headers:
    for enum, constants in header.enums:
        if enum:
            in_c.append(f'show("{enum}", (long long)sizeof({enum}), NULL, 0);')
            in_fortran.append(f"write (*, form) '{enum}', c_sizeof(0_{enum})")
        for name in constants:
            in_c.append(f'show("{name}", {name}, NULL, 0);')
            in_fortran.append(f"write (*, form) '{name}', {name}")
    for name in header.structs:
        show_members(name, name, "")
    for function in header.inline.values():
        if function.arguments:
            show_result(function)
        else:
            show_members(function.name, function.result.type, f"{function.name}()")

includes = "".join(f"#include <dem/{header.name}>\n" for header in headers)
pathlib.Path(sys.argv[2]).write_text(C % (includes, "\n".join(in_c)), encoding="utf-8")
pathlib.Path(sys.argv[3]).write_text(FORTRAN % "\n".join(in_fortran), encoding="utf-8")
