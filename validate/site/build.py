#!/usr/bin/env python3
"""Builds the site from the pages of the repository, the docstrings and the public headers.

    validate/site/build.py BUILD-FOLDER [SITE-FOLDER]

BUILD-FOLDER: where the project was built. The site is in SITE-FOLDER, default BUILD-FOLDER/site. Needs Debian's packages of
.ci/site-packages.txt. Ends with an error for a link that leads nowhere.
"""

import os
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path
from typing import Dict, List, Optional, Set, Tuple
from urllib.parse import unquote, urldefrag

root = Path(__file__).resolve().parents[2]
own = root / "validate" / "site"


def stands_at_top(page: Path) -> bool:
    """The site's own pages do; all others keep their places."""
    return own in page.parents and page.name != "README.md"


def stage(pages: Path) -> None:
    """Copies all pages, keeping their places, and the files to which they link. Links to other files become downloads."""
    shutil.rmtree(pages, ignore_errors=True)
    parts = ["model", "sim", "validate", "tests", "notebooks-data"]
    for page in [*root.glob("*.md"), *(page for part in parts for page in (root / part).rglob("*.md"))]:
        if stands_at_top(page):
            place = pages / page.relative_to(own)
        else:
            place = pages / page.relative_to(root)
        place.parent.mkdir(parents=True, exist_ok=True)
        for included in re.findall(r"{literalinclude} (\S+)", page.read_text(encoding="utf-8")):
            copy = (place.parent / included).resolve()
            copy.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(root / copy.relative_to(pages.resolve()), copy)
        place.write_text(linked(page.read_text(encoding="utf-8"), page, place, pages), encoding="utf-8")


def linked(text: str, page: Path, place: Path, pages: Path) -> str:
    def changed(match: "re.Match[str]") -> str:
        picture, label, target = match[1], match[2], match[3]
        path, anchor = urldefrag(target)
        if not path or re.match("[a-z]+:", path):
            return match[0]
        file = (page.parent / path).resolve()
        if file.is_dir():
            if not (file / "README.md").exists():
                return label
            return f"[{label}]({os.path.join(path, 'README.md')})"
        if stands_at_top(page) and not stands_at_top(file):
            path = os.path.relpath(pages / file.relative_to(root), place.parent)
        if file.suffix == ".md":
            return f"[{label}]({path}{'#' + anchor if anchor else ''})"
        copy = place.parent / path
        copy.parent.mkdir(parents=True, exist_ok=True)
        if file.exists():
            shutil.copyfile(file, copy)
        if picture:
            return f"![{label}]({path})"
        return "{download}`" + label.replace("`", "") + f" <{path}>`"

    parts = re.split(r"(^```.*?^```$)", text, flags=re.M | re.S)  # not in code
    return "".join(part if part.startswith("```") else re.sub(r"(!?)\[((?:[^][]|\[[^]]*\])*)\]\(([^)\s]+)\)", changed, part)
                   for part in parts)


def pages_of_answers(build: Path, pages: Path) -> None:
    """What the fields of each command's answer mean, as the command says."""
    commands = ["choose", "run", "model", "validate", "scene", "bench", "accuracy", "calibrate"]
    page = pages / "reference" / "answers.md"
    text = page.read_text(encoding="utf-8")
    for command in commands:
        said = subprocess.run([build / "detp", command, "--help", "fields"], check=True, stdout=subprocess.PIPE, text=True).stdout
        text += f"\n## {command}\n\n```text\n{said}```\n"
    page.write_text(text, encoding="utf-8")


def reference_of_headers(build: Path, site: Path) -> None:
    """Doxygen's pages of the headers that are installed."""
    installed = build / "site-headers"
    shutil.rmtree(installed, ignore_errors=True)
    subprocess.run(["cmake", "--install", build, "--prefix", installed, "--component", "development"], check=True,
                   stdout=subprocess.DEVNULL)
    settings = {
        "PROJECT_NAME": "detp", "PROJECT_NUMBER": version(), "INPUT": installed / "include", "RECURSIVE": "YES",
        "OUTPUT_DIRECTORY": site, "HTML_OUTPUT": "cpp", "STRIP_FROM_PATH": installed / "include",
        "STRIP_FROM_INC_PATH": installed / "include", "EXTRACT_ALL": "YES", "GENERATE_LATEX": "NO", "QUIET": "YES",
        "WARNINGS": "NO", "GENERATE_TREEVIEW": "YES", "HAVE_DOT": "NO", "OPTIMIZE_OUTPUT_FOR_C": "NO", "JAVADOC_AUTOBRIEF": "YES",
        "HTML_TIMESTAMP": "NO", "SHOW_NAMESPACES": "YES", "MACRO_EXPANSION": "YES", "PREDEFINED": "DETP_API=",
        "EXPAND_ONLY_PREDEF": "YES",
    }
    text = "".join(f'{name} = "{value}"\n' for name, value in settings.items())
    subprocess.run(["doxygen", "-"], input=text, text=True, check=True, stderr=subprocess.DEVNULL)  # "@uniform" is no command


def python_package(build: Path) -> Dict[str, str]:
    """The package, and the variables with which Python finds it and the library."""
    package = build / "site-package"
    shutil.copytree(root / "validate" / "python" / "detp", package / "detp", dirs_exist_ok=True)
    subprocess.run([sys.executable, root / "validate" / "python" / "declarations.py", root / "validate" / "c" / "detp.h", package / "detp"],
                   check=True, stdout=subprocess.DEVNULL)
    return {"PYTHONPATH": str(package), "DETP_LIBRARY": str(build / "validate" / "libdetp.so.0")}


def version() -> str:
    found = re.search(r"project\(detp VERSION ([0-9.]+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))
    assert found is not None
    return found[1]


class Links(HTMLParser):
    """The targets of a page, and its anchors."""

    def __init__(self) -> None:
        super().__init__()
        self.targets: List[str] = []
        self.anchors: Set[str] = set()

    def handle_starttag(self, tag: str, attributes: List[Tuple[str, Optional[str]]]) -> None:
        for name, value in attributes:
            if name in ("href", "src") and value:
                self.targets.append(value)
            if name in ("id", "name") and value:
                self.anchors.add(value)


def broken_links(site: Path) -> List[str]:
    """Of all pages but Doxygen's, whose links are its own."""
    pages: Dict[Path, Links] = {}

    def read(page: Path) -> Links:
        if page not in pages:
            pages[page] = Links()
            pages[page].feed(page.read_text(encoding="utf-8"))
        return pages[page]

    broken = []
    for page in sorted(site.rglob("*.html")):
        if site / "cpp" in page.parents:
            continue
        for target in read(page).targets:
            path, anchor = urldefrag(target)
            path = path.split("?")[0]
            if re.match("[a-z]+:", target):
                continue
            file = (page.parent / unquote(path)).resolve() if path else page
            if not file.exists():
                broken.append(f"{page.relative_to(site)}: {target}")
            elif anchor and file.suffix == ".html" and unquote(anchor) not in read(file).anchors:
                broken.append(f"{page.relative_to(site)}: {target} has no such place")
    return broken


def main() -> int:
    build = Path(sys.argv[1]).resolve()
    site = Path(sys.argv[2]).resolve() if len(sys.argv) > 2 else build / "site"
    pages = build / "site-pages"
    stage(pages)
    pages_of_answers(build, pages)
    environment = {**os.environ, "DETP_SITE_VERSION": version(), **python_package(build)}
    shutil.rmtree(site, ignore_errors=True)
    subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-j", "auto", "-c", own, "-d", build / "site-cache", pages, site],
                   check=True, env=environment)
    reference_of_headers(build, site)
    broken = broken_links(site)
    print("\n".join(broken) or f"{site}/index.html", file=sys.stderr if broken else sys.stdout)
    return 1 if broken else 0


if __name__ == "__main__":
    sys.exit(main())
