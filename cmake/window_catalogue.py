"""Qt's catalogue of the window's texts, of those that a language's messages have: window_catalogue.py de.json OUT.ts"""

import json
import sys
import xml.etree.ElementTree as tree
from pathlib import Path


def catalogue(messages, language):
    """The .ts document of ``window`` in a language's messages: {context: {English text: text}}."""
    root = tree.Element("TS", version="2.1", language=language, sourcelanguage="en")
    for name, texts in messages["window"].items():
        context = tree.SubElement(root, "context")
        tree.SubElement(context, "name").text = name
        for english, text in texts.items():
            message = tree.SubElement(context, "message")
            tree.SubElement(message, "source").text = english
            tree.SubElement(message, "translation").text = text
    return tree.ElementTree(root)


if __name__ == "__main__":
    source, made = map(Path, sys.argv[1:])
    messages = json.loads(source.read_text(encoding="utf-8"))
    catalogue(messages, source.stem).write(made, encoding="utf-8", xml_declaration=True)
