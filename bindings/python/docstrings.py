#!/usr/bin/env python3
"""Writes the comments of the public C++ headers as constants, from which the Python module takes its docstrings.

usage: docstrings.py OUTPUT HEADER...

A comment above `Result<Picture> render(...)` becomes `docs::render`; one inside of a class becomes `docs::Scene::face`, and
that of the class itself `docs::Scene::self`. A docstring whose comment is missing is therefore an error of the compiler.
"""
import re
import sys

CLASS = re.compile(r"^(?:class|struct) (\w+)(?: :[^{]*)? \{$")
FUNCTION = re.compile(r"\b(\w+)\(")
OPERATOR = re.compile(r"\boperator\b")
MEMBER = re.compile(r"(\w+)(?: = [^;]*|\{[^;]*\})?;")


def declarations(lines):
    """Yields (class or None, name, comment) for every declaration with a comment."""
    comment, owner = [], None
    for line in lines:
        text = line.strip()
        if text.startswith("/// "):
            comment.append(text[4:])
            continue
        if opening := CLASS.match(line):
            owner = opening.group(1)
            if comment:
                yield owner, "self", comment
        elif line.startswith("}"):
            owner = None
        elif text:
            code, _, trailing = text.partition("///< ")
            found = FUNCTION.search(code) or MEMBER.search(code)
            told = comment or ([trailing] if trailing else [])
            if found and told and not OPERATOR.search(code) and found.group(1) != owner:
                yield owner, found.group(1), told
        comment = []


def main():
    output, *headers = sys.argv[1:]
    docs = {}
    for header in headers:
        with open(header, encoding="utf-8") as file:
            for owner, name, comment in declarations(file.read().splitlines()):
                docs.setdefault(owner, {}).setdefault(name, "\n".join(comment))
    out = ["// Made by bindings/python/docstrings.py.", "#pragma once", "", "namespace docs {"]
    for owner, names in docs.items():
        out += [f"namespace {owner} {{"] if owner else []
        out += [f'inline constexpr const char* {name} = R"doc({text})doc";' for name, text in names.items()]
        out += ["}"] if owner else []
    out += ["}  // namespace docs", ""]
    with open(output, "w", encoding="utf-8") as file:
        file.write("\n".join(out))


if __name__ == "__main__":
    main()
