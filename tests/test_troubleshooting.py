"""Every message that the page on troubleshooting quotes is one that the sources can give."""

import ast
import re

import pytest
from documents import ROOT

PAGE = (ROOT / "docs" / "troubleshooting.md").read_text()
MESSAGES = re.findall(r"^`(.+)`\n: ", PAGE, re.MULTILINE)
GAP = "…"


def python_templates(path):
    """Every string of a module, with a gap for each value that is put in."""
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.JoinedStr):
            yield "".join(
                part.value if isinstance(part, ast.Constant) else GAP for part in node.values
            )
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield re.sub(r"%[a-z]|%\.\w+", GAP, node.value)


def cpp_templates(path):
    """Every string of a source of the core; what is added to it becomes a gap."""
    text = re.sub(r'"\s*\n\s*"', "", path.read_text())
    pieces = re.findall(r'"(?:[^"\\\n]|\\.)*"(?:\s*\+[^";]*\+\s*"(?:[^"\\\n]|\\.)*")*', text)
    for piece in pieces:
        yield re.sub(r'"\s*\+[^";]*\+\s*"', GAP, piece).strip('"')


@pytest.fixture(scope="module")
def templates():
    python = [*(ROOT / "metric").rglob("*.py"), *(ROOT / "plugin" / "anistar").rglob("*.py")]
    found = {text for path in python for text in python_templates(path)}
    return found | {
        text for path in (ROOT / "plugin" / "core").rglob("*.cpp") for text in cpp_templates(path)
    }


def test_the_page_explains_forty_messages_and_none_twice():
    assert len(MESSAGES) >= 40
    assert len(set(MESSAGES)) == len(MESSAGES)


@pytest.mark.parametrize("message", MESSAGES)
def test_a_message_of_the_page_is_one_of_the_sources(message, templates):
    words = [part.strip(" ().,;:") for part in message.split(GAP)]
    words = [part for part in words if part]
    pattern = re.compile(".*".join(map(re.escape, words)))
    assert sum(map(len, words)) >= 9
    assert any(pattern.search(template) for template in templates)
