"""Writes the docstrings of a stub file (.pyi) as a C++ header, so that help() says what editors show."""
import ast
import pathlib
import sys

stub, header = map(pathlib.Path, sys.argv[1:])
docs = {}


def read(node, prefix):
    for part in node.body:
        if isinstance(part, (ast.ClassDef, ast.FunctionDef)):
            if text := ast.get_docstring(part):
                docs[prefix + part.name] = text
        if isinstance(part, ast.ClassDef):
            read(part, part.name + ".")


read(ast.parse(stub.read_text()), "")
lines = [f'    {{"{name}", R"doc({text})doc"}},\n' for name, text in docs.items()]
header.write_text(
    "#pragma once\n\n#include <string_view>\n\nnamespace insonate::python {\n\n"
    "struct StubDoc {\n  std::string_view name;\n  const char* text;\n};\n\n"
    "inline constexpr StubDoc kStubDocs[] = {\n" + "".join(lines) + "};\n\n}  // namespace insonate::python\n")
