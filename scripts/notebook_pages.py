#!/usr/bin/env python3
"""Makes a page of the documentation from each notebook of docs/notebooks, with the outputs that are stored in it.

mkdocs calls on_files (see mkdocs.yml). `notebook_pages.py FILE.ipynb FOLDER` writes one page and its pictures into a folder."""
import base64
import json
import pathlib
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parent.parent
notebooks = root / "docs/notebooks"


def fenced(language, text):
    return f"```{language}\n{text.rstrip()}\n```"


def page(path, folder):
    """The notebook as Markdown; writes its pictures into `folder`."""
    parts, pictures = [], 0
    for cell in json.loads(path.read_text())["cells"]:
        text = "".join(cell["source"])
        if cell["cell_type"] == "markdown":
            parts.append(text)
            if len(parts) == 1:  # below the title
                parts.append(f"This page shows a notebook: [{path.name}]({path.name}).")
            continue
        parts.append(fenced("python", text))
        for output in cell["outputs"]:
            data = output.get("data", {})
            if "image/png" in data:
                pictures += 1
                name = f"{path.stem}_{pictures}.png"
                (folder / name).write_bytes(base64.b64decode(data["image/png"]))
                parts.append(f"![Output of the cell above]({name})")
            else:
                parts.append(fenced("text", "".join(output.get("text", data.get("text/plain", "")))))
    return "\n\n".join(parts) + "\n"


def on_files(files, config):
    from mkdocs.structure.files import File
    folder = pathlib.Path(tempfile.mkdtemp(prefix="exitance_notebooks_"))
    (folder / "notebooks").mkdir()
    for path in sorted(notebooks.glob("*.ipynb")):
        (folder / "notebooks" / f"{path.stem}.md").write_text(page(path, folder / "notebooks"))
    for path in sorted(folder.rglob("*.*")):
        files.append(File(str(path.relative_to(folder)), str(folder), config["site_dir"], config["use_directory_urls"]))
    return files


def on_page_markdown(markdown, page, **_):
    """Links of the list of notebooks lead to their pages."""
    return markdown.replace(".ipynb)", ".md)") if page.file.src_path == "notebooks/index.md" else markdown


if __name__ == "__main__":
    source, target = map(pathlib.Path, sys.argv[1:])
    (target / f"{source.stem}.md").write_text(page(source, target))
