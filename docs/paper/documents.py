# SPDX-License-Identifier: GPL-3.0-or-later
"""Makes tables (Markdown) and figures (PNG, JPEG) from the numbers that ReproducePaper has written:

    python3 docs/paper/documents.py RESULTS [EXPERIMENT...] [--tables] [--page docs/evaluation.md]

RESULTS: the folder that ReproducePaper got (-o), or its folder `quick`; the documents are written there.
Without names: all experiments whose numbers are there. --tables: no figures, which need matplotlib.
--page: also replaces the tables between "<!-- FILE.md -->" and "<!-- end -->" of this page, and the
pictures images/FILE beside the page that the page shows. Prints the tables of `completeness`."""

import argparse
import io
import json
import os
import pathlib
import re
import sys

import clouds
import reconstruction
import simulations

TABLES = {"figure2": simulations.figure2, "runtime": simulations.runtime, "figure3": simulations.figure3,
          "figure4": simulations.figure4, "reconstruction": reconstruction.reconstruction,
          "sensitivity": clouds.sensitivity, "need": clouds.need}
END = "<!-- end -->"


def written(path, content):
    """Replaces the file at once, so that an interrupted run leaves no half of a file."""
    temporary = path.with_name(path.name + ".part")
    temporary.write_bytes(content)
    os.replace(temporary, path)


def results_in(folder, names):
    """{experiment: its results}, read from <folder>/<experiment>.json."""
    found = {}
    for file in sorted(folder.glob("*.json")):
        known = file.stem in TABLES or file.stem.startswith("completeness_")
        if known and (not names or file.stem in names):
            try:
                found[file.stem] = json.loads(file.read_text())
            except ValueError as error:
                sys.exit(f"{file}: is not JSON: {error}")
    missing = [name for name in names if name not in found]
    if missing or not found:
        sys.exit(f"{folder}: has no numbers of {', '.join(missing) or 'an experiment'}")
    return found


def checked_page(page, names):
    """The text of the page. Refuses a page that shows nothing of an experiment, or has a table without end."""
    text = page.read_text()
    for name in names:
        if f"<!-- {name}" not in text and f"images/{name}" not in text:
            sys.exit(f"{page}: has no line such as '<!-- {name}.md -->' for a table, and no figure")
    for match in re.finditer(r"<!-- (\w+\.md) -->\n", text):
        end, following = text.find(END, match.end()), text.find("<!--", match.end())
        if end < 0 or following < end:
            sys.exit(f"{page}: '{match[0].strip()}' has no '{END}' after its table")
    return text


def with_tables(text, documents):
    """The page's text with these tables in place of the old ones."""
    return re.sub(rf"<!-- (\w+\.md) -->\n.*?{END}",
                  lambda old: old[0] if old[1] not in documents
                  else f"<!-- {old[1]} -->\n\n{documents[old[1]]}\n{END}", text, flags=re.DOTALL)


def draw(results, folder):
    """Draws the figures of one experiment. Returns their files."""
    import figures  # needs matplotlib
    make = getattr(figures, results["experiment"], lambda _: {})
    files = []
    for name, figure in make(results).items():
        picture = io.BytesIO()
        figure.savefig(picture, format=name.rsplit(".", 1)[1], dpi=80, bbox_inches="tight")
        written(folder / name, picture.getvalue())
        files.append(folder / name)
    return files


def parsed():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("experiments", nargs="*")
    parser.add_argument("--tables", action="store_true")
    parser.add_argument("--page", type=pathlib.Path)
    return parser.parse_intermixed_args()


def main():
    arguments = parsed()
    folder, page = arguments.results, arguments.page
    found = results_in(folder, arguments.experiments)
    # `completeness` is in no page.
    text = checked_page(page, found.keys() & TABLES.keys()) if page else ""
    for name, results in found.items():
        documents = TABLES.get(name, clouds.completeness)(results)
        for file, content in documents.items():
            written(folder / file, content.encode())
        if name not in TABLES:
            print(*documents.values(), sep="", end="")
        text = with_tables(text, documents)
        drawn = [] if arguments.tables else draw(results, folder)
        for file in drawn:
            if f"images/{file.name}" in text:
                written(page.parent / "images" / file.name, file.read_bytes())
    if page:
        written(page, text.encode())


if __name__ == "__main__":
    main()
