"""Hook of mkdocs: what docs/ alone lacks.  Pages from elsewhere in the tree, sources that pages link to (as coloured copies), mathematics,
a search that works from a folder.  A link that leads nowhere, and a page that the navigation lacks, end the build.
"""
import html
import json
import os
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import TextLexer, get_lexer_for_filename
from pygments.util import ClassNotFound

ROOT = Path(__file__).resolve().parents[2]
HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE))
import python_reference  # noqa: E402

KATEX = Path("/usr/share/javascript/katex")    # Debian: libjs-katex, fonts-katex
FENCED = re.compile(r"^(```|~~~).*?^\1", re.S | re.M)
LINK = re.compile(r"(\]\()([^)#\s]+)(#[^)\s]*)?(\))")
PICTURES = {".png", ".svg", ".jpg"}
OUTER = ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md", "THIRD_PARTY.md"]
written = Path(tempfile.mkdtemp(prefix="talus_site_"))    # what the site has and the tree has not


def tracked():
    """Files of the repository, the ones not yet committed included."""
    listed = subprocess.run(["git", "ls-files", "-co", "--exclude-standard"], cwd=ROOT, check=True, capture_output=True, text=True).stdout
    return {name for name in listed.split("\n") if name and (ROOT / name).is_file()}


def outer_pages(files):
    return OUTER + sorted(name for name in files if re.fullmatch(r"(benchmarks|scenes)/[^/]+/README\.md", name))


def place_of(name):
    """Where a file of the repository stands on the site."""
    if name.startswith("docs/"):
        return name[len("docs/"):]
    if name in OUTER:
        return "project/" + ("about.md" if name == "README.md" else name.lower())
    if name.endswith(".md") or Path(name).suffix in PICTURES:
        return name
    return f"source/{name}.html"


def in_tree(page):
    """The file of the repository that a page was made of."""
    return posixpath.normpath(os.path.relpath(page.file.abs_src_path, ROOT))


def links_outside_code(text):
    """Matches of links that are not part of a fenced block."""
    blocks = [match.span() for match in FENCED.finditer(text)]
    return [m for m in LINK.finditer(text) if "://" not in m[2] and not m[2].startswith("mailto:") and not any(a <= m.start() < b for a, b in blocks)]


def targets(name):
    for match in links_outside_code((ROOT / name).read_text(encoding="utf-8")):
        yield posixpath.normpath(posixpath.join(posixpath.dirname(name), match[2]))


def coloured(name):
    """A source file as a page of its own."""
    text = (ROOT / name).read_text(encoding="utf-8")
    try:
        lexer = get_lexer_for_filename(name)
    except ClassNotFound:
        lexer = TextLexer()
    title = html.escape(name)
    style = posixpath.relpath("site/code.css", posixpath.dirname(place_of(name)))
    body = highlight(text, lexer, HtmlFormatter(linenos="inline", cssclass="highlight", lineanchors="line", anchorlinenos=False))
    return (f"<!doctype html>\n<html lang=en><meta charset=utf-8><meta name=viewport content='width=device-width'><title>{title}</title>\n"
            f"<link rel=stylesheet href='{style}'>\n<h1 style='font: bold 1.1rem sans-serif'>{title}</h1>\n{body}</html>\n")


def give(files, config, site_name, text):
    """Adds a file with this text to the site."""
    path = written / site_name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")
    files.append(File(site_name, str(written), config["site_dir"], use_directory_urls=False))


def bring(files, config, name):
    """Adds a file of the repository to the site, in the place where links find it."""
    file = File(place_of(name), str(ROOT), config["site_dir"], use_directory_urls=False)
    file.abs_src_path = str(ROOT / name)
    files.append(file)


def on_config(config):
    if not (KATEX / "katex.min.js").exists():
        raise PluginError(f"{KATEX} is missing: install libjs-katex")
    names = tracked()
    for section, folder in (("Verification", "benchmarks"), ("Examples", "scenes")):
        entries = [place_of(name) for name in outer_pages(names) if name.startswith(folder + "/")]
        next(item[section] for item in config["nav"] if section in item).extend(entries)
    return config


def on_files(files, config):
    names = tracked()
    pages = outer_pages(names)
    for name in pages:
        bring(files, config, name)
    wanted = {t for page in [*pages, *(n for n in names if n.startswith("docs/") and n.endswith(".md"))] for t in targets(page) if t in names}
    for name in sorted(wanted - set(pages)):
        if name.startswith("docs/") and (name.endswith(".md") or Path(name).suffix in PICTURES):
            continue
        if Path(name).suffix in PICTURES:
            bring(files, config, name)
        else:
            give(files, config, f"source/{name}.html", coloured(name))
    for path in ["katex.min.css", "katex.min.js", *(f"fonts/{f.name}" for f in sorted((KATEX / "fonts").glob("*.woff2")))]:
        file = File(f"katex/{path}", str(KATEX), config["site_dir"], use_directory_urls=False)
        file.abs_src_path = str((KATEX / path).resolve())
        files.append(file)
    for name in ("mathematics.js", "search.js", "site.css"):
        file = File(f"site/{name}", str(HERE), config["site_dir"], use_directory_urls=False)
        file.abs_src_path = str(HERE / name)
        files.append(file)
    try:
        give(files, config, "reference/python.md", python_reference.page())
    except (ImportError, ValueError) as error:
        raise PluginError(f"reference of the Python package: {error}") from error
    give(files, config, "site/code.css", HtmlFormatter(style="default").get_style_defs(".highlight"))
    give(files, config, "site/words.js", "")    # filled when all pages are known
    return files


def on_nav(nav, config, files):
    in_nav = {page.file.src_uri for page in nav.pages}
    lost = sorted(f.src_uri for f in files.documentation_pages() if f.src_uri not in in_nav)
    if lost:
        raise PluginError("the navigation in tools/site/mkdocs.yml lacks " + ", ".join(lost))
    return nav


def on_page_markdown(markdown, page, config, files):
    here = in_tree(page)

    def moved(match):
        target = posixpath.normpath(posixpath.join(posixpath.dirname(here), match[2]))
        if (ROOT / target).is_dir():
            if not (ROOT / target / "README.md").is_file() or files.get_file_from_path(place_of(f"{target}/README.md")) is None:
                return None
            target += "/README.md"
        if not (ROOT / target).exists():
            raise PluginError(f"{here}: link to {match[2]}, which is not there")
        return f"{match[1]}{posixpath.relpath(place_of(target), posixpath.dirname(page.file.src_uri))}{match[3] or ''}{match[4]}"

    out, end = [], 0
    for match in links_outside_code(markdown):
        new = moved(match)
        if new is None:    # a folder: the words stay, the link goes
            start = markdown.rfind("[", end, match.start())
            out += [markdown[end:start], markdown[start + 1:match.start()]]
        else:
            out += [markdown[end:match.start()], new]
        end = match.end()
    return "".join(out) + markdown[end:]


def on_page_content(content, page, config, files):
    """What the search looks through: the sections of each page."""
    for level, anchor, title, body in re.findall(r'<h([1-3]) id="([^"]+)">(.*?)<a class="headerlink".*?</h\1>(.*?)(?=<h[1-3] id=|\Z)', content, re.S):
        words = re.sub(r"\\[()\[\]]", "", html.unescape(re.sub(r"<[^>]+>", " ", body)))    # less what marks formulas
        sections.append({"at": f"{page.file.url}#{anchor}", "page": page.title, "title": html.unescape(re.sub(r"<[^>]+>", "", title)),
                         "text": re.sub(r"\s+", " ", words).strip(), "level": int(level)})
    return content


sections = []


def lost_links(site):
    """Links and anchors of all pages that lead nowhere; mkdocs looks at Markdown only, and at no anchor."""
    pages = {path.relative_to(site).as_posix(): path.read_text(encoding="utf-8") for path in sorted(site.rglob("*.html"))}
    anchors = {name: set(re.findall(r'\bid="([^"]+)"', text)) for name, text in pages.items()}
    for name, text in pages.items():
        for link in re.findall(r'\b(?:href|src)="([^"]+)"', text):
            if "://" in link or link.startswith(("mailto:", "data:", "/")) or name == "404.html":
                continue
            path, _, anchor = html.unescape(link).partition("#")
            target = posixpath.normpath(posixpath.join(posixpath.dirname(name), path)) if path else name
            if not (site / target).exists() or (anchor and target in anchors and anchor not in anchors[target]):
                yield f"{name}: {link}"


def on_post_build(config):
    text = "window.talus_sections = " + json.dumps(sections, ensure_ascii=False, separators=(",", ":")) + ";\n"
    (Path(config["site_dir"]) / "site/words.js").write_text(text, encoding="utf-8")
    shutil.rmtree(written)
    if lost := list(lost_links(Path(config["site_dir"]))):
        raise PluginError("links that lead nowhere:\n  " + "\n  ".join(lost))
