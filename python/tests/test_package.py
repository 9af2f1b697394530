"""The package: stubs that say what the module says, documentation that runs, an example that makes its picture."""
import ast
import os
import pathlib
import re
import subprocess
import sys

import tassilo
from conftest import ROOT

PACKAGE = pathlib.Path(tassilo.__file__).parent


def test_stubs_are_what_the_module_says():
    checked = subprocess.run([sys.executable, ROOT / "tools/python_stubs.py", PACKAGE.parent, "--check"], capture_output=True,
                             text=True)
    assert checked.returncode == 0, checked.stderr


def test_stubs_name_everything_with_its_parameters():
    tree = ast.parse((PACKAGE / "__init__.pyi").read_text(encoding="utf-8"))
    defined = {node.name: node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    assert set(defined) == set(tassilo.__all__)
    for name, node in defined.items():
        if isinstance(node, ast.FunctionDef):
            parameters = [argument.arg for argument in node.args.args]
            assert all(f"{p}: " in getattr(tassilo, name).__doc__ for p in parameters), name
    assert (PACKAGE / "py.typed").exists()


def test_everything_has_a_docstring():
    for name in tassilo.__all__:
        value = getattr(tassilo, name)
        words = value.__doc__ if isinstance(value, type) else value.__doc__.partition("\n")[2]
        assert words and words.strip(), name


def test_no_argument_is_without_a_name():
    for name in tassilo.__all__:
        value = getattr(tassilo, name)
        docs = [value.__doc__] if not isinstance(value, type) else [
            getattr(m, "__func__", m).__doc__ or "" for n, m in vars(value).items() if callable(m) and not n.startswith("__")]
        assert not any(re.search(r"\barg\d", doc) for doc in docs), name


def test_the_code_of_the_tour_runs(tmp_path, monkeypatch):
    blocks = re.findall(r"^```python\n(.*?)^```", (ROOT / "docs/python.md").read_text(encoding="utf-8"),
                        re.MULTILINE | re.DOTALL)
    assert len(blocks) >= 4
    (tmp_path / "data").symlink_to(ROOT / "data")
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in blocks:
        exec(compile(block, "docs/python.md", "exec"), names)


def test_the_example_makes_its_picture(tmp_path):
    picture = tmp_path / "picture.png"
    run = subprocess.run([sys.executable, ROOT / "examples/python/see.py", picture], capture_output=True, text=True,
                         cwd=ROOT, env=os.environ)
    assert run.returncode == 0, run.stderr
    assert tassilo.read_png(picture).shape[1] >= 768 and "ball" in run.stdout
