#!/usr/bin/env python3
"""Makes the pages of the interfaces for C++ and Python from the comments in their sources.

mkdocs calls on_files when it builds the site (see mkdocs.yml). The page for C++ describes all headers in include/exitance, as far as
doxygen finds comments (`///`) in them; without that folder, the headers that the README's example includes. The page for Python
describes the classes and functions of the modules and stubs (.py, .pyi) in bindings/python/exitance that have a docstring.

    interface_pages.py cpp|python     prints a page"""
import ast
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

root = pathlib.Path(__file__).resolve().parent.parent
settings = """
QUIET = YES
WARNINGS = NO
WARN_IF_UNDOCUMENTED = NO
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
EXTRACT_ALL = YES
AUTOLINK_SUPPORT = NO
JAVADOC_AUTOBRIEF = YES
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
"""


# ------------------------------------------------------------------------------------------------------- C++

def headers():
    found = sorted((root / "include/exitance").rglob("*.hpp"))
    if found:
        return found, root / "include"
    names = re.findall(r"#include <(exitance/[^>]+)>", (root / "README.md").read_text())
    return [root / "src" / name for name in names], root / "src"


def doxygen(files, folder):
    """The XML files that doxygen writes, by the id of what they describe."""
    config = settings + f"INPUT = {' '.join(map(str, files))}\nSTRIP_FROM_PATH = {root}\nOUTPUT_DIRECTORY = {folder}\n"
    subprocess.run(["doxygen", "-"], input=config, text=True, check=True, stdout=subprocess.DEVNULL)
    return {path.stem: tree.parse(path).getroot() for path in pathlib.Path(folder, "xml").glob("*.xml")}


def inline(node):
    """The text of a node, with code and emphasis marked."""
    out = [node.text or ""]
    for child in node:
        text = inline(child)
        if child.tag == "computeroutput":
            text = f"`{text}`"
        elif child.tag == "emphasis":
            text = f"*{text}*"
        elif child.tag == "bold":
            text = f"**{text}**"
        elif child.tag in ("preformatted", "verbatim", "programlisting", "itemizedlist", "orderedlist"):
            text = block(child)
        elif child.tag == "sp":
            text = " " + text
        elif child.tag == "simplesect":
            text = f"\n\n{child.get('kind').capitalize()}: {text.strip()}\n\n"
        out += [text, child.tail or ""]
    return "".join(out)


def block(node):
    if node.tag in ("itemizedlist", "orderedlist"):
        return "\n\n" + "".join(f"- {' '.join(inline(item).split())}\n" for item in node) + "\n"
    lines = "".join(node.itertext()).strip("\n").split("\n")
    indent = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "\n\n```text\n" + "\n".join(line[indent:].rstrip() for line in lines) + "\n```\n\n"


def description(node):
    """Brief and detailed description of a class or member, as Markdown."""
    parts = []
    for tag in ("briefdescription", "detaileddescription"):
        for para in node.find(tag) if node.find(tag) is not None else []:
            text = inline(para)
            pieces = re.split(r"(```text\n.*?\n```)", text, flags=re.S)
            parts += [piece if piece.startswith("```") else re.sub(r"(?<!\n)\n(?![\n-])", " ", piece).strip()
                      for piece in pieces]
    return "\n\n".join(filter(None, parts))


def declaration(member):
    text = "".join(member.find("definition").itertext()) if member.find("definition") is not None else ""
    if member.get("kind") == "function":
        text += "".join(member.find("argsstring").itertext())
    template = member.find("templateparamlist")
    if template is not None:
        names = [" ".join("".join(param.itertext()).split()) for param in template]
        text = f"template <{', '.join(names)}>\n{text}"
    value = member.find("initializer")
    if member.get("kind") == "variable" and value is not None and len(inline(value)) < 40:
        text += " " + inline(value)
    text = re.sub(r"\bexitance::(\w+::)*(?=[\w~]+( |\(|$))", "", text, count=1) if "(" in text else text
    return re.sub(r" ?([<>]) ", r"\1 ", text).replace("exitance::api::", "").replace("exitance::", "").replace("< ", "<").replace(" >", ">")


def cell(text):
    return " ".join(text.replace("|", "\\|").split())


def values(members):
    """Values of a struct or of an enumeration, as a table."""
    rows = []
    for member in members:
        left = member.findtext("name")
        if member.tag != "enumvalue":
            value = member.find("initializer")
            shown = inline(value) if value is not None and len(inline(value)) < 40 else ""
            left = f"{inline(member.find('type'))} {left} {shown}".replace("< ", "<").replace(" >", ">").strip()
        rows.append((left, description(member)))
    return "\n| | |\n|---|---|\n" + "".join(f"| `{cell(left)}` | {cell(right)} |\n" for left, right in rows) if rows else ""


def entry(member, level):
    name = member.findtext("name")
    if member.get("kind") == "enum":
        return f"\n{level} `{name}`\n\n{description(member)}\n" + values(member.findall("enumvalue"))
    return f"\n{level} `{name}`\n\n```cpp\n{declaration(member)};\n```\n\n{description(member)}\n"


def class_section(compound):
    name = compound.findtext("compoundname").removeprefix("exitance::").removeprefix("api::")
    out = f"\n### {compound.get('kind')} `{name}`\n\n{description(compound)}\n"
    members = [m for m in compound.iter("memberdef") if m.get("prot") == "public"]
    out += values([m for m in members if m.get("kind") == "variable"])
    for member in members:
        if member.get("kind") in ("function", "enum") and (description(member) or member.get("kind") == "enum"):
            out += entry(member, "####")
    return out


def cpp_page():
    files, base = headers()
    out = ["# Interface for C++\n\nThis page is generated from the comments of the headers. Everything is in the namespace `exitance::api`. "
           "Functions that read files or options return a `Result`: a value, or an `Error` with message, place and hint.\n"]
    with tempfile.TemporaryDirectory() as folder:
        compounds = [compound for root_node in doxygen(files, folder).values() for compound in root_node.iter("compounddef")]
        for file in files:
            place = str(file.relative_to(root))

            def is_here(node):
                return node.find("location") is not None and node.find("location").get("file") == place
            sections = []
            for compound in compounds:
                if compound.get("kind") in ("class", "struct") and is_here(compound) and description(compound):
                    sections.append((int(compound.find("location").get("line")), class_section(compound)))
                if compound.get("kind") == "namespace":
                    for member in compound.iter("memberdef"):
                        if is_here(member) and description(member) and member.get("kind") in ("function", "enum", "variable", "typedef"):
                            sections.append((int(member.find("location").get("line")), entry(member, "###")))
            head = next((description(c) for c in compounds if c.get("kind") == "file" and is_here(c)), "")
            if sections or head:
                out.append(f"\n## `<{file.relative_to(base)}>`\n\n{head}\n")
                out += [text for _, text in sorted(sections)]
    return "".join(out)


# ---------------------------------------------------------------------------------------------------- Python

def signature(function):
    returns = f" -> {ast.unparse(function.returns)}" if function.returns else ""
    return f"{function.name}({ast.unparse(function.args)}){returns}"


def docstring(node):
    """The docstring as Markdown: indented blocks become code."""
    text = ast.get_docstring(node) or ""
    return re.sub(r"((?:^    .*\n?)+)", lambda match: "\n" + match[1] + "\n", text, flags=re.M)


def python_entries(nodes, level):
    out = []
    for node in nodes:
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and not node.name.startswith("_") and docstring(node):
            is_property = any(isinstance(d, ast.Name) and d.id == "property" for d in node.decorator_list)
            text = f"{node.name}: {ast.unparse(node.returns)}" if is_property and node.returns else signature(node)
            out.append(f"\n{level} `{node.name}`\n\n```python\n{text}\n```\n\n{docstring(node)}\n")
        if isinstance(node, ast.ClassDef) and not node.name.startswith("_") and docstring(node):
            out.append(f"\n{level} class `{node.name}`\n\n{docstring(node)}\n")
            out += python_entries(node.body, level + "#")
    return out


def python_page():
    out = ["# Interface for Python\n\n"]
    folder = root / "bindings/python"
    files = [p for p in sorted((folder / "exitance").rglob("*.py*")) if p.suffix in (".py", ".pyi")]
    stems = {p.with_suffix("") for p in files if p.suffix == ".pyi"}
    for file in files:
        if file.name == "setup.py" or (file.suffix == ".py" and file.with_suffix("") in stems):
            continue
        module = ast.parse(file.read_text())
        entries = python_entries(module.body, "###")
        if entries:
            name = ".".join(file.relative_to(folder).with_suffix("").parts).removesuffix(".__init__").removeprefix("src.")
            out += [f"\n## `{name}`\n\n{docstring(module)}\n", *entries]
    if len(out) == 1:
        out.append("A solution is an HDF5 file, which Python reads with h5py. [Solutions](../formats/solutions.md) describes its data sets.\n")
    return "".join(out)


def on_files(files, config):
    from mkdocs.structure.files import File
    folder = pathlib.Path(tempfile.mkdtemp(prefix="exitance_interfaces_"))
    for name, page in (("reference/cpp.md", cpp_page()), ("reference/python.md", python_page())):
        (folder / name).parent.mkdir(exist_ok=True)
        (folder / name).write_text(page)
        files.append(File(name, str(folder), config["site_dir"], config["use_directory_urls"]))
    return files


if __name__ == "__main__":
    print({"cpp": cpp_page, "python": python_page}[sys.argv[1]]())
