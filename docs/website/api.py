# SPDX-License-Identifier: BSD-3-Clause
"""The headers of include/dem as pages of Markdown: every declaration, its comment as text, and a table of members."""
import pathlib
import re
import sys

COMMENT = r"(?:/\*\*(?!<)(?P<text>(?:(?!\*/).)*)\*/\s*)?"
DECLARATIONS = (r"(?P<code>^typedef (?:struct|enum) (?P<type>\w+) \{.*?\} (?P=type);"
                r"|^typedef struct (?P<opaque>\w+) \w+;"
                r"|^typedef \w+ \(\*(?P<callback>\w+)\)[^;]*;"
                r"|^DEM_API [^;(]*?(?P<function>\w+)\([^;]*;"
                r"|^static inline [^;(]*?(?P<inline>\w+)\((?=[^;{]*\{)[^{/]*|^enum \{.*?\};)")


def declared(text):
    """(name, code, comment) of all declarations, in their order; enumerators without a type have no name."""
    for found in re.finditer(COMMENT + DECLARATIONS, text, re.M | re.S):
        names = (found[kind] for kind in ("type", "opaque", "callback", "function", "inline"))
        code = found["code"].strip().removeprefix("DEM_API ")
        yield next(filter(None, names), ""), code if code.endswith(";") else code + ";", found["text"] or ""


MEANINGS = (r"(?P<members>[^;{}]*);[ \t]*/\*\*<(?P<of_members>(?:(?!\*/).)*)\*/"
            r"|(?P<constant>\b[A-Z_0-9]+)(?: = [^,/]*)?,?[ \t]*/\*\*<(?P<of_constant>(?:(?!\*/).)*)\*/")


def bare(code):
    """Without comments, and what they were aligned by."""
    code = re.sub(r"[ \t]*/\*.*?\*/", "", code, flags=re.S)
    return re.sub(r"(?<=\S) {2,}", " ", code)


def meanings(code):
    """(names, comment) of members and constants."""
    for found in re.finditer(MEANINGS, code, re.S):
        if found["constant"]:
            yield found["constant"], found["of_constant"]
        else:
            declared_names = re.findall(r"(\w+)(?:\[\d+\])*\s*(?:,|$)", bare(found["members"]).strip())
            yield ", ".join(declared_names), found["of_members"]


class Pages:
    """The page of each header, and where on them every name is."""

    def __init__(self, root):
        sys.path.insert(0, str(root / "src/fortran"))
        from headers import read_headers  # what there has to be
        self.headers = read_headers(root / "include/dem", with_mpi=True)
        self.texts = {header.name: (root / "include/dem" / header.name).read_text(encoding="utf-8")
                      for header in self.headers}
        self.places = {name: f"{pathlib.Path(header).stem}.md#{name}" for header, text in self.texts.items()
                       for name, _, _ in declared(text) if name}
        wanted = {name for h in self.headers for name in (*h.structs, *h.opaque, *h.functions, *h.inline)}
        wanted |= {name for h in self.headers for name, _ in h.enums if name}
        if missing := sorted(wanted - set(self.places)):
            raise SystemExit(f"the pages of the headers lack {', '.join(missing)}")

    def link(self, found):
        name, call = found[1], found[2] or ""
        return f"[`{name}{call}`]({self.places[name]})" if name in self.places else f"`{name}{call}`"

    def prose(self, comment):
        """A comment without its frame, as Markdown: what was indented is code, names are links."""
        lines = [re.sub(r"^\s*\* ?", "", line).rstrip() for line in comment.strip().splitlines()]
        text = "\n".join(line if line.startswith("     ") else line.strip() for line in lines)
        text = re.sub(r"\n?\\param(?:\[\w+\])?\s+(\S+)", r"\n\n- *\1*:", text)
        text = re.sub(r"\s*\\return\b", r"\n\nReturns", text)
        return "\n".join(line if line.startswith("     ") else self.linked(line) for line in text.splitlines())

    def linked(self, line):
        line = re.sub(r"\s+\((\d+)\)$", r" ([equation \1](../method.md#the-ten-equations))", line)
        line = re.sub(r"docs/(\w+)\.md", r"[\1.md](../\1.md)", line.replace("<", "&lt;"))
        return re.sub(r"(?<![\w`/])(dem_\w+)(\(\))?(?![\w`.])", self.link, line)

    def table(self, code):
        rows = [(names, " ".join(self.prose(comment).split()).replace("|", "\\|")) for names, comment in meanings(code)]
        head = ["| member | meaning |", "|---|---|"] if rows else []
        return head + [f"| `{names}` | {text} |" for names, text in rows]

    def page(self, header):
        text = self.texts[header]
        about = re.search(r"/\*\*(?!<)((?:(?!\*/).)*)\*/\s*#ifndef", text, re.S).group(1)
        lines = [f"# dem/{header}", "", self.prose(about), ""]
        body = text[text.index("#ifndef"):]
        for name, code, comment in declared(body):
            lines += [f"## {name or 'Constants'}", "", "```c", bare(code), "```", "", self.prose(comment), ""]
            lines += [*self.table(code), ""]
        return "\n".join(lines)

    def write(self, folder):
        folder.mkdir()
        for header in self.texts:
            (folder / pathlib.Path(header).with_suffix(".md")).write_text(self.page(header), encoding="utf-8")
