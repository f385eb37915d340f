#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Prepares README, the pages of share/doc and the files that they link to for Doxygen.

    site-pages.py SOURCE WORK SITE

Writes the pages to WORK/pages and the navigation to WORK/layout.xml, empties the folder SITE of the site and copies the
pictures there. Each page gets the name of its file: share/doc/tutorial.md becomes tutorial.html. File names
must differ between folders. Links to pages, headings, public headers and source files become links within the site. Doxygen
1.9.4 resolves none of the links to headings by itself.
"""
import os
import re
import shutil
import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

INDEX = "share/doc/index.md"
HEADERS = "libs/include/psi_slam"
PICTURES = (".png", ".svg")
LINK = re.compile(r"(!?)\[((?:[^][]|\[[^][]*\])*)\]\(([^() ]+)\)")
HEADING = re.compile(r"^(#{1,6}) +(.*?) *$")
FENCE = re.compile(r"^ *```")
TARGET = re.compile(r"`((?:[\w.]+-)+\w+)::(\w[\w-]*)`")  # a CMake target, which Doxygen takes for a C++ name


def anchor_of(heading):
    """The anchor that GitHub gives to a heading, in ASCII: Doxygen accepts no other letters."""
    text = re.sub(r"[^\w -]", "", heading.lower().replace("ψ", "psi")).replace(" ", "-")
    return text.encode("ascii", "ignore").decode()


class Site:
    """The files of the site, and the names of their pages."""

    def __init__(self, source):
        self.source = source
        names = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md"]
        names += sorted(path.relative_to(source).as_posix() for path in (source / "share/doc").rglob("*.md"))
        self.pages = {name: self.page_name(name) for name in names}
        self.files = {}  # linked source files and the names of their pages
        self.pictures = set()

    @staticmethod
    def page_name(name):
        if name == "README.md":
            return "index"
        return "all-pages" if name == INDEX else Path(name).stem.lower()

    def target_of(self, page, target):
        """Where a link of a page leads in the site."""
        if re.match(r"[a-z]+:", target):
            return target
        path, _, anchor = target.partition("#")
        name = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
        if name in self.pages:
            there = self.pages[name]
            return f"{there}.html" + (f"#{there}-{anchor_of(anchor)}" if anchor else "")
        if name.endswith(PICTURES):
            self.pictures.add(name)
            return os.path.basename(name)
        if name.startswith(HEADERS + "/"):
            return os.path.basename(name).replace("_", "__").replace(".", "_8") + ".html"
        if not (self.source / name).is_file():
            sys.exit(f"site-pages.py: {page} links to {target}, which is no file")
        self.files.setdefault(name, re.sub(r"\W", "_", name).lower())
        return f"{self.files[name]}.html"

    def page_text(self, page):
        """A page for Doxygen: with anchors at its headings and with links within the site."""
        lines, seen, level, in_code = [], {}, 0, False
        text = (self.source / page).read_text(encoding="utf-8")
        for line in re.sub(r"(?m)^<!--.*?-->\n", "", text, flags=re.DOTALL).splitlines():
            if FENCE.match(line):
                in_code = not in_code
            heading = None if in_code else HEADING.match(line)
            if heading:
                level = min(len(heading[1]), level + 1)  # Doxygen accepts no heading that skips a level
                line = self.heading(page, level, heading[2], seen)
            lines.append(line)
        parts = re.split(r"(?ms)(^ *```.*?^ *```$)", "\n".join(lines))
        parts[::2] = [self.with_links(page, part) for part in parts[::2]]
        return "".join(parts) + "\n"

    def heading(self, page, level, words, seen):
        name = self.pages[page]
        if level == 1 and not seen:
            seen[""] = 0
            return f"# {words} {{#{'mainpage' if name == 'index' else name}}}"
        anchor, words = anchor_of(words), words.replace("`", "")  # Doxygen 1.9.4 shows the tags of code in headings
        repeated = seen.get(anchor, 0)
        seen[anchor] = repeated + 1
        return f"{'#' * level} {words} {{#{name}-{anchor}{f'-{repeated}' if repeated else ''}}}"

    def with_links(self, page, text):
        def link(match):
            bang, words, target = match.groups()
            if bang:
                return f'<img src="{self.target_of(page, target)}" alt={quoteattr(words)}>'
            return f"[{words}]({self.target_of(page, target)})"

        return TARGET.sub(r"<code>\1\\::\2</code>", LINK.sub(link, text))

    def file_text(self, name):
        command = r"\include{lineno}" if name.endswith((".cpp", ".h", ".py")) else r"\verbinclude"
        return f"# {Path(name).name} {{#{self.files[name]}}}\n\n`{name}`\n\n{command} {name}\n"

    def groups(self):
        """The groups of the index: names, each with pairs of title and page."""
        groups = []
        for line in (self.source / INDEX).read_text(encoding="utf-8").splitlines():
            heading, link = HEADING.match(line), LINK.search(line)
            if heading and heading[1] == "##":
                groups.append((heading[2], []))
            elif link and groups:
                groups[-1][1].append((link[2], self.target_of(INDEX, link[3])))
        return groups

    def layout(self):
        """The navigation of the site in the format of Doxygen."""
        lines = ['<doxygenlayout version="1.0">', "  <navindex>", '    <tab type="mainpage" visible="yes" title="psi-slam"/>']
        for name, pages in self.groups():
            lines.append(f'    <tab type="usergroup" visible="yes" title={quoteattr(name)} url="[none]">')
            for title, page in pages:
                lines.append(f'      <tab type="user" visible="yes" title={quoteattr(title)} url={quoteattr(page)}/>')
            lines.append("    </tab>")
        lines += [
            '    <tab type="usergroup" visible="yes" title="C++ reference" url="[none]">',
            '      <tab type="classlist" visible="yes" title="Classes"/>',
            '      <tab type="filelist" visible="yes" title="Headers"/>',
            '      <tab type="namespacemembers" visible="yes" title="All names"/>',
            "    </tab>",
            '    <tab type="user" visible="yes" title="All pages" url="all-pages.html"/>',
            "  </navindex>",
            "</doxygenlayout>",
        ]
        return "\n".join(lines) + "\n"


def main():
    if len(sys.argv) != 4:
        sys.exit("usage: site-pages.py SOURCE WORK SITE")
    source, work, out = (Path(argument).resolve() for argument in sys.argv[1:])
    site = Site(source)
    shutil.rmtree(work, ignore_errors=True)
    shutil.rmtree(out, ignore_errors=True)
    (work / "pages").mkdir(parents=True)
    out.mkdir(parents=True)
    texts = {f"{site.pages[page]}.md": site.page_text(page) for page in site.pages}
    texts.update({f"{site.files[name]}.md": site.file_text(name) for name in site.files})
    for name, text in texts.items():
        (work / "pages" / name).write_text(text, encoding="utf-8")
    (work / "layout.xml").write_text(site.layout(), encoding="utf-8")
    for picture in site.pictures:
        shutil.copy(source / picture, out)


if __name__ == "__main__":
    main()
