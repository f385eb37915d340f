#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Checks the built site: all local links, pictures and anchors exist, and every page can be reached from the first one.

    site_links_test.py SOURCE SITE
"""
import sys
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag


class Page(HTMLParser):
    """Anchors, links and pictures of a page, and the text of its title."""

    def __init__(self, path):
        super().__init__()
        self.anchors, self.links, self.text = {"", "top"}, [], ""
        self.feed(path.read_text(encoding="utf-8"))

    def handle_starttag(self, tag, attributes):
        values = dict(attributes)
        self.anchors.update(values[key] for key in ("id", "name") if values.get(key))
        for key in ("href", "src"):
            if values.get(key):
                self.links.append(values[key])

    def handle_data(self, data):
        self.text += data


def is_local(link):
    return not link.startswith(("http:", "https:", "mailto:", "javascript:", "data:"))


def main():
    source, site = Path(sys.argv[1]), Path(sys.argv[2])
    pages = {path.name: Page(path) for path in site.glob("*.html")}
    wrong = []
    for name, page in sorted(pages.items()):
        for link in filter(is_local, page.links):
            path, anchor = (unquote(part) for part in urldefrag(link))
            path = path or name
            if not (site / path).is_file():
                wrong.append(f"{name} links to {link}, which does not exist")
            elif path in pages and anchor not in pages[path].anchors:
                wrong.append(f"{name} links to {link}, but {path} has no such anchor")
        if "](" in page.text and not name.endswith("_source.html") and "_cpp" not in name and "_py" not in name:
            wrong.append(f"{name} shows the Markdown of a link")
        if "<tt>" in page.text and "_cpp" not in name:
            wrong.append(f"{name} shows a tag of HTML as text")

    reached, waiting = set(), ["index.html"]
    while waiting:
        name = waiting.pop()
        if name in pages and name not in reached:
            reached.add(name)
            waiting += [urldefrag(link)[0] for link in pages[name].links if is_local(link)]
    written = [path.stem.lower() for path in (source / "share/doc").rglob("*.md") if path.name != "index.md"]
    for name in ["all-pages", "contributing", "changelog", *sorted(written)]:
        if f"{name}.html" not in pages:
            wrong.append(f"the site lacks {name}.html")
        elif f"{name}.html" not in reached:
            wrong.append(f"no page links to {name}.html")
        elif name != "all-pages" and f"{name}.html" not in pages["all-pages.html"].links:
            wrong.append(f"share/doc/index.md does not link to {name}")
    if "classpsi__slam_1_1Mapper.html" not in reached:
        wrong.append("the first page does not lead to the reference of Mapper")
    print("\n".join(wrong) or f"{len(pages)} pages are linked correctly")
    sys.exit(bool(wrong))


if __name__ == "__main__":
    main()
