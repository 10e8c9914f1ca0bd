"""Sphinx's settings for the site of ./dev docs. The pages are what tools/docs/build_site.py lays into build/docs."""

import os

import mmdr
from docutils import nodes

project = "spidar_g"
author = "the spidar_g contributors"
html_title = f"spidar_g {os.environ['SPIDAR_G_VERSION']}"
extensions = ["myst_parser"]
root_doc = "index"
html_theme = "furo"
# Pages open from a folder, without a server: no fonts, scripts or pictures of other hosts.
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
html_permalinks_icon = "#"
pygments_style = "friendly"
pygments_dark_style = "github-dark"
myst_heading_anchors = 6
myst_links_external_new_tab = False
# Pygments does not know all of GDScript, for example $NODE at the end of a line: it colors the rest.
suppress_warnings = ["misc.highlighting_failure"]


class DrawMermaid:
    """Mermaid diagrams become pictures when the site is built: the browser needs no library for them."""

    def __init__(self, app):
        self.folder = os.path.join(app.outdir, "_images")
        self.count = 0

    def __call__(self, app, doctree):
        for block in list(doctree.findall(nodes.literal_block)):
            if block.get("language") != "mermaid":
                continue
            os.makedirs(self.folder, exist_ok=True)
            depth = app.env.current_document.docname.count("/")
            name = f"{app.env.current_document.docname.replace('/', '_')}_{self.count}.svg"
            self.count += 1
            mmdr.render(block.astext()).save(os.path.join(self.folder, name))
            picture = f'<img class="diagram" src="{"../" * depth}_images/{name}" alt="Diagram">'
            block.replace_self(nodes.raw("", picture, format="html"))


def link_classes(app, doctree, docname):
    """`SpidarGHand` and `SpidarGHand.contact_margin` in a text lead to the class help."""
    labels = app.env.get_domain("std").anonlabels
    for literal in list(doctree.findall(nodes.literal)):
        words = literal.astext().split("(")[0].split(".")
        if len(words) > 2 or not words[0].startswith("SpidarG"):
            continue
        up = literal.parent
        while up is not None and not isinstance(up, (nodes.reference, nodes.title)):
            up = up.parent
        target = labels.get("-".join(["help", *words]).lower())
        if up is not None or target is None or target[0] == docname:
            continue
        address = f"{app.builder.get_relative_uri(docname, target[0])}#{target[1]}"
        reference = nodes.reference("", "", internal=True, refuri=address)
        literal.replace_self(reference)
        reference += literal


def setup(app):
    app.connect("builder-inited", lambda app: app.connect("doctree-read", DrawMermaid(app)))
    app.connect("doctree-resolved", link_classes)
    app.add_css_file("site.css")


html_static_path = ["static"]
