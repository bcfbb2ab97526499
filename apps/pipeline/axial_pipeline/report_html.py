# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of report.html: texts, tables and pictures in one file that needs no other file and no network."""

import base64
import html
import pathlib
import re
import string

MOST_BYTES = 3_000_000  # of a picture in the page

PAGE = string.Template("""<!doctype html>
<html lang="en"><head><meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
@page { size: A4; margin: 18mm 16mm; }
* { box-sizing: border-box; }
body { max-width: 178mm; margin: 0 auto; padding: 6mm; color: #111; font: 10.5pt/1.4 "DejaVu Sans", sans-serif; }
h1 { font-size: 18pt; margin: 0 0 3mm; }
h2 { font-size: 13pt; margin: 7mm 0 2mm; break-after: avoid; }
p { margin: 0 0 2mm; break-inside: avoid; orphans: 3; widows: 3; }
table { width: 100%; border-collapse: collapse; margin: 0 0 3mm; font-size: 9.5pt; font-variant-numeric: tabular-nums; }
thead { display: table-header-group; }
tr { break-inside: avoid; }
caption { text-align: left; padding-bottom: 1mm; color: #444; break-after: avoid; }
th, td { text-align: left; vertical-align: top; padding: 0.8mm 2mm 0.8mm 0; border-bottom: 0.2mm solid #bbb;
         overflow-wrap: anywhere; }
th { font-weight: 600; }
tbody th { font-weight: 400; color: #444; }
figure { margin: 0 0 4mm; break-inside: avoid; }
img { display: block; max-width: 100%; max-height: 190mm; }
figcaption { color: #444; font-size: 9.5pt; padding-top: 1mm; }
ul { margin: 0 0 3mm; padding-left: 5mm; }
li { overflow-wrap: anywhere; break-inside: avoid; }
code { font-size: 8.5pt; overflow-wrap: anywhere; }
@media print { body { max-width: none; margin: 0; padding: 0; } }
</style></head><body>
<h1>$title</h1>
$body
</body></html>
""")


# A path at the begin of a text, or behind one of these signs. A report is published, and the folders of a computer can
# contain the name of its user.
FOLDERS = re.compile(r"""(?:(?<=^)|(?<=[\s=:,'"(\[]))/(?:[^\s=:,;'")\]/]+/)+(?=[^\s=:,;'")\]/])""")


def without_folders(text):
    """A text whose paths are shortened to their last names. Of the folders, only the home of the user may have a name
    with a blank."""
    home = str(pathlib.Path.home())
    return FOLDERS.sub("", text if home == "/" else text.replace(home, ""))


def word_without_folders(word):
    """The same of a word of a command, which may be one path with blanks."""
    return without_folders(re.sub("(^|=)/(?:[^/]+/)+(?=[^/])", r"\1", word))


def page(title, sections):
    """`sections`: pairs of a heading and the HTML below it. Sections without HTML are left out."""
    body = "\n".join(f"<h2>{html.escape(heading)}</h2>\n{text}" for heading, text in sections if text)
    return PAGE.substitute(title=html.escape(title), body=body)


def paragraph(text):
    return f"<p>{html.escape(text)}</p>\n"


def bullets(lines):
    items = "".join(f"<li>{html.escape(line)}</li>\n" for line in lines)
    return f"<ul>\n{items}</ul>\n" if items else ""


def code(text):
    return f"<p><code>{html.escape(text)}</code></p>\n"


def row(cells):
    """A row of a table; its first cell is its heading."""
    first, *others = (html.escape(str(cell)) for cell in cells)
    return f'<tr><th scope="row">{first}</th>{"".join(f"<td>{cell}</td>" for cell in others)}</tr>\n'


def table(rows, heads=(), caption=""):
    """A table of texts. None without rows."""
    rows = list(rows)
    if not rows:
        return ""
    title = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    head = "".join(f'<th scope="col">{html.escape(text)}</th>' for text in heads)
    top = f"<thead><tr>{head}</tr></thead>" if head else ""
    return f"<table>{title}{top}<tbody>\n{''.join(map(row, rows))}</tbody></table>\n"


def figure(path, caption):
    """A figure that holds the JPEG or PNG `path`."""
    data = base64.b64encode(path.read_bytes()).decode()
    kind = "jpeg" if path.suffix == ".jpg" else "png"
    return (f'<figure><img src="data:image/{kind};base64,{data}" alt="{html.escape(caption)}">'
            f"<figcaption>{html.escape(caption)}</figcaption></figure>\n")


def picture(path, caption):
    """A figure that holds the JPEG `path`. A line names a file that is too large. Nothing without a file."""
    if not path.is_file():
        return ""
    if path.stat().st_size > MOST_BYTES:
        return paragraph(f"{caption}: see {path.name}, which is too large for this report.")
    return figure(path, caption)
