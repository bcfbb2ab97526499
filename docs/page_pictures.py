# SPDX-License-Identifier: GPL-3.0-or-later
"""Takes the pictures of docs/view.md from a page that ViewScene wrote:

    python3 docs/page_pictures.py build/demo/refractive_page -o docs/images

Needs Chromium. Each picture is a JPEG file."""

import argparse
import base64
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "tests" / "apps"))
from browser import CHROMIUM, Browser  # noqa: E402

WIDE, NARROW = (1280, 800), (390, 844)  # [CSS px]
QUALITY = 50


def at(browser, x, y):
    """Clicks on the canvas at these shares of its width and height."""
    width, height = browser.value("axial.view.size")
    browser.click(x * width, y * height)


def tab(browser, name):
    browser.click_on(f"[data-tab={name}]")


def point(browser):
    at(browser, 0.5, 0.5)
    browser.wait_for("[...document.querySelectorAll('#point img')].every(image => image.complete)")


def measure(browser):
    tab(browser, "measure")
    for x, y in ((0.4, 0.4), (0.6, 0.4), (0.6, 0.6), (0.4, 0.6)):
        at(browser, x, y)
    browser.click_on(".volume")


def errors(browser):
    browser.value("axial.colours.select.value = 'errors', axial.colours.select.onchange()")


def layer(name):
    def show(browser):
        tab(browser, "map")
        browser.click_on(f"[data-layer={name}]")
        browser.wait_for("axial.map.image && !axial.map.asked")
    return show


def residuals(browser):
    tab(browser, "residuals")


def steps(browser):
    tab(browser, "run")


# The name of each picture, the size of its window, what is done before it, and the part of the page
# without which there is no picture.
PICTURES = {
    "view_point": (WIDE, point, "cameras"),
    "view_measure": (WIDE, measure, "mesh"),
    "view_errors": (WIDE, errors, "truth"),
    "view_map": (WIDE, layer("height"), "map"),
    "view_residuals": (WIDE, residuals, "residuals"),
    "view_run": (WIDE, steps, "run"),
    "view_narrow": (NARROW, point, "cameras"),
    "view_narrow_map": (NARROW, layer("ortho"), "map"),
    "view_narrow_residuals": (NARROW, residuals, "residuals"),
}


def taken(page, size, prepare, part):
    """The picture, or None if the page does not have the part."""
    browser = Browser((page / "index.html").resolve().as_uri(), *size)
    try:
        browser.wait_for("globalThis.axial && axial.ready && axial.view.complete")
        if not browser.value(f"!!axial.scene.{part}"):
            return None
        prepare(browser)
        browser.wait_for("axial.view.complete")
        picture = browser.send("Page.captureScreenshot", format="jpeg", quality=QUALITY)
        return base64.b64decode(picture["data"])
    finally:
        browser.close()


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("page", type=pathlib.Path, help="folder that ViewScene wrote")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True)
    parser.add_argument("--only", nargs="*", choices=PICTURES, default=list(PICTURES))
    given = parser.parse_args()
    if not CHROMIUM:
        sys.exit("Chromium is not installed")
    given.output.mkdir(parents=True, exist_ok=True)
    for name in given.only:
        picture = taken(given.page, *PICTURES[name])
        if picture:
            (given.output / f"{name}.jpg").write_bytes(picture)
        else:
            print(f"{name}: the page lacks the part that this picture shows")


if __name__ == "__main__":
    main()
