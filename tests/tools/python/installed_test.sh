#!/usr/bin/env bash
# Installs the Python module and the assets into an empty folder, moves it, and runs the example with it.
#   installed_test.sh CMAKE BUILD PYTHON EXAMPLE
set -euo pipefail
cmake=$1
build=$2
python=$3
example=$4
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
for component in assets python; do
  "$cmake" --install "$build" --component "$component" --prefix "$work/installed" >/dev/null
done
mv "$work/installed" "$work/moved"
folder=$(dirname "$(dirname "$(find "$work/moved" -name '__init__.pyi')")")
for file in __init__.py py.typed; do
  [ -e "$folder/insonate/$file" ] || fail "$file is not installed"
done
cd "$work"
env -u INSONATE_ASSETS PYTHONPATH="$folder" "$python" "$example" >"$work/out" || fail "the example does not run"
grep -q 'most similar 0 mm to the side' "$work/out" || fail "$(cat "$work/out")"
grep -q "did you mean 'gain_db'?" "$work/out" || fail "$(cat "$work/out")"
# Every name of the module stands in the stubs, and every name of the stubs in the module.
PYTHONPATH="$folder" "$python" - <<'PY'
import ast, insonate, pathlib
tree = ast.parse((pathlib.Path(insonate.__file__).parent / "__init__.pyi").read_text())
stubs = {}
for node in tree.body:
    if isinstance(node, ast.ClassDef):
        stubs[node.name] = {part.name for part in node.body if isinstance(part, ast.FunctionDef)}
    elif isinstance(node, ast.FunctionDef):
        stubs[node.name] = set()
described_only = {"Truth", "LabelledImages", "Stages"}  # of dictionaries
assert set(stubs) - described_only == set(insonate.__all__), set(stubs) ^ set(insonate.__all__)
for name in set(stubs) - described_only - {"InputError"}:
    thing = getattr(insonate, name)
    if isinstance(thing, type):
        own = {part for part in vars(thing) if not part.startswith("_") or part in ("__enter__", "__exit__")}
        assert own == stubs[name] - {"__init__"}, (name, own ^ (stubs[name] - {"__init__"}))


# help() says what the stubs say.
def check_docs(body, thing):
    for part in body:
        if isinstance(part, (ast.ClassDef, ast.FunctionDef)) and part.name not in described_only:
            its = getattr(thing, part.name)
            text = ast.get_docstring(part)
            assert not text or text in its.__doc__, (part.name, its.__doc__)
            if isinstance(part, ast.ClassDef):
                check_docs(part.body, its)


check_docs(tree.body, insonate)
PY
