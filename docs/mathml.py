"""Equations as MathML, which browsers draw by themselves: the site needs no script from elsewhere, and no network."""

import re
import unicodedata
from html import unescape
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert

SPACE = "http://www.w3.org/1998/Math/MathML"
VARIANT = re.compile(r'<mi mathvariant="(bold|bold-italic|script|sans-serif|double-struck)">([^<]+)</mi>')


def setup(app):
    """Offer the renderer `mathml` to Sphinx."""
    app.add_html_math_renderer("mathml", inline_renderers=(_inline, None), block_renderers=(_block, None))
    app.add_css_file("mathml.css")
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def _inline(translator, node):
    translator.body.append(mathml(node.astext(), "inline"))
    raise nodes.SkipNode


def _block(translator, node):
    translator.body.append(translator.starttag(node, "div", CLASS="math notranslate"))
    translator.body.append(f"{mathml(node.astext(), 'block')}</div>")
    raise nodes.SkipNode


def mathml(tex: str, display: str) -> str:
    """An equation with letters in the characters of their style: browsers read no style of MathML but upright."""
    equation = convert(tex, display=display).replace("<mo>&#x0007C;</mo>", '<mo stretchy="false">&#x0007C;</mo>')
    return VARIANT.sub(lambda found: f"<mi>{_styled(found[1], found[2])}</mi>", _overlined(equation))


def _overlined(equation: str) -> str:
    """The equation with each overline as a border of what is below it: as a character few fonts let it grow."""
    ElementTree.register_namespace("", SPACE)
    tree = ElementTree.fromstring(equation)
    for over in tree.iter(f"{{{SPACE}}}mover"):
        if over[1].text == "\N{HORIZONTAL BAR}":
            over.tag = f"{{{SPACE}}}mrow"
            over.set("class", "overline")
            over.remove(over[1])
    return ElementTree.tostring(tree, encoding="unicode")


def _styled(style: str, text: str) -> str:
    words = style.upper() if style in ("sans-serif", "double-struck") else style.upper().replace("-", " ")
    return "".join(_character(words, letter) for letter in unescape(text))


def _character(style: str, letter: str) -> str:
    name = re.sub(r"^(LATIN|GREEK) (\w+) LETTER ", r"\2 ", unicodedata.name(letter, ""))
    for prefix in ("MATHEMATICAL ", ""):  # a few, such as the script F, have been characters for longer
        try:
            return unicodedata.lookup(f"{prefix}{style} {name}")
        except KeyError:
            continue
    return letter
