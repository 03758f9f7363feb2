"""Pages that write themselves: the keys of case and experiment files, and the verbs of the command line.

``field-reference`` takes a pydantic model, as ``wrinklewave.config.case:Case``, and lists its sections and keys;
``command-reference`` prints the help of every verb. What stands there is what the program reads and says.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

from docutils import nodes
from reference_text import command_reference, model_reference
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective


def setup(app: Sphinx) -> dict[str, Any]:
    """Register both directives."""
    app.add_directive("field-reference", FieldReference)
    app.add_directive("command-reference", CommandReference)
    return {"parallel_read_safe": True}


class FieldReference(SphinxDirective):
    """All sections of a file and their keys, from the model that reads it."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Return the sections as nodes."""
        module, _, name = self.arguments[0].partition(":")
        text = "\n".join(model_reference(getattr(import_module(module), name)))
        return self.parse_text_to_nodes(text, allow_section_headings=True)


class CommandReference(SphinxDirective):
    """The help of every verb."""

    def run(self) -> list[nodes.Node]:
        """Return one heading and one block per verb."""
        return self.parse_text_to_nodes("\n".join(command_reference()), allow_section_headings=True)
