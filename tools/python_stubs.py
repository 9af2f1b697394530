#!/usr/bin/python3
"""Writes the type stubs of the Python package, python/tassilo/__init__.pyi, from the built module.

usage: tools/python_stubs.py FOLDER [--check]     FOLDER holds the built package, as build/release/python; --check only
                                                  says whether the stubs are what the module says (exit code 1: not)
The signatures are those that pybind11 writes at the head of each docstring, so stubs and module cannot disagree.
"""
import inspect
import pathlib
import re
import sys
import textwrap

STUBS = pathlib.Path(__file__).resolve().parent.parent / "python/tassilo/__init__.pyi"
HEAD = '''# Written by tools/python_stubs.py from the module; do not edit.
import os
from typing import Any, Dict, List, Literal, Optional, Tuple, Union, overload

import numpy
from numpy.typing import ArrayLike, NDArray

__version__: str
'''
# What the interpreter itself asks for says nothing to a type checker, or is there anyway.
LEFT_OUT = {"__module__", "__doc__", "__getstate__", "__setstate__", "__repr__", "__new__", "__dict__", "__weakref__"}


def python_type(text):
    """A type as pybind11 names it, in the words of the stubs."""
    text = text.replace("tassilo.", "").replace("os.PathLike", "Union[str, os.PathLike[str]]")
    text = re.sub(r"numpy\.ndarray\[(numpy\.\w+)\]", r"NDArray[\1]", text)
    text = text.replace("numpy.ndarray", "NDArray[Any]")
    return re.sub(r"\b(dict|list)\b(?!\[)", lambda m: {"dict": "Dict[str, Any]", "list": "List[Any]"}[m.group(1)], text)


def signatures(name, docstring):
    """[(parameters, result, words)] of a function, one for each overload."""
    head = rf"{re.escape(name)}\((.*)\) -> (.+)"
    if "\nOverloaded function.\n" not in docstring:
        first, _, words = docstring.partition("\n")
        found = re.fullmatch(head, first)
        return [(found.group(1), found.group(2), words.strip())]
    parts = re.split(rf"^\d+\. {head}$", docstring, flags=re.MULTILINE)[1:]
    return [(parts[k], parts[k + 1], parts[k + 2].strip()) for k in range(0, len(parts), 3)]


def docstring_lines(words, indent):
    if not words:
        return []
    words = textwrap.indent(words, indent).strip()
    return [f'{indent}"""{words}"""']


def function(name, docstring, indent="", static=False):
    lines = []
    overloads = signatures(name, docstring)
    for parameters, result, words in overloads:
        parameters = re.sub(r"^self: [\w.]+", "self", python_type(parameters))
        parameters = re.sub(r"^arg0: object", "self", parameters) if indent and not static else parameters
        if name == "__eq__":
            parameters = "self, other: object"
        lines += [f"{indent}@overload"] if len(overloads) > 1 else []
        lines += [f"{indent}@staticmethod"] if static else []
        body = docstring_lines(words, indent + "    ")
        lines.append(f"{indent}def {name}({parameters}) -> {python_type(result)}:" + ("" if body else " ..."))
        lines += body
    return lines


def members(cls):
    lines = []
    for name, member in vars(cls).items():
        if name in LEFT_OUT or name.startswith("_pybind11"):
            continue
        if isinstance(member, property):
            result = re.search(r" -> (.+)", member.fget.__doc__).group(1)
            body = docstring_lines(member.__doc__ or "", "        ")
            lines += ["    @property", f"    def {name}(self) -> {python_type(result)}:" + ("" if body else " ...")] + body
        elif isinstance(member, staticmethod):
            lines += function(name, member.__func__.__doc__, "    ", static=True)
        elif callable(member) and member.__doc__ and member.__doc__.startswith(name + "("):
            lines += function(name, member.__doc__, "    ")
    return lines


def stubs(module):
    lines = [HEAD.rstrip()]
    for name in module.__all__:
        value = getattr(module, name)
        lines.append("")
        if inspect.isclass(value):
            base = "" if value.__base__.__module__ == "pybind11_builtins" else f"({value.__base__.__name__})"
            lines.append(f"class {name}{base}:")
            lines += docstring_lines(value.__doc__ or "", "    ")
            lines += members(value) if not base else []
        else:
            lines += function(name, value.__doc__)
    return "\n".join(lines) + "\n"


def main():
    arguments = [a for a in sys.argv[1:] if a != "--check"]
    if len(arguments) != 1:
        sys.exit(__doc__)
    sys.path.insert(0, arguments[0])
    sys.dont_write_bytecode = True
    import tassilo

    text = stubs(tassilo)
    if "--check" not in sys.argv:
        STUBS.write_text(text, encoding="utf-8")
        return 0
    if STUBS.read_text(encoding="utf-8") == text:
        return 0
    print(f"{STUBS.name} is not what the module says; tools/python_stubs.py {arguments[0]} writes it", file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
