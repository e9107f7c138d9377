"""The tutorial: docs/python.md is its source, a notebook and the outputs on the page are made.

    python docs/make/tutorial.py

runs the blocks of Python one after the other, puts what each prints or returns as a block of text
after it, and writes the same as a notebook.
"""

import ast
import re
from base64 import b64encode
from contextlib import chdir, redirect_stdout
from io import StringIO
from pathlib import Path
from tempfile import TemporaryDirectory

import nbformat
from nbformat import v4

#: A block of Python, and the text beneath it.
BLOCK = re.compile(r"```python\n(.*?)```\n(?:\n```text\n.*?```\n)?", re.DOTALL)


def outputs(code, names):
    """Run ``code`` with the variables ``names``; return (what it prints, its value or None)."""
    *before, last = ast.parse(code).body
    printed, value = StringIO(), None
    with redirect_stdout(printed):
        if not isinstance(last, ast.Expr):
            before.append(last)
        exec(compile(ast.Module(before, []), "<tutorial>", "exec"), names)
        if isinstance(last, ast.Expr):
            value = eval(compile(ast.Expression(last.value), "<tutorial>", "eval"), names)
    return printed.getvalue(), value


def tutorial(page):
    """Return (the text of the page with renewed outputs, the notebook) of the text of a page."""
    parts, cells, names, end = [], [], {}, 0
    for number, block in enumerate(BLOCK.finditer(page), 1):
        before, code = page[end : block.start()], block[1].rstrip("\n")
        printed, value = outputs(code, names)
        png = getattr(value, "_repr_png_", None)
        shown = printed + (f"{value!r}\n" if value is not None and png is None else "")
        shown = re.sub(r" +$", "", shown, flags=re.MULTILINE)
        parts += [before, f"```python\n{code}\n```\n", f"\n```text\n{shown}```\n" if shown else ""]
        found = [v4.new_output("stream", text=printed)] if printed else []
        if value is not None:
            data = {"image/png": b64encode(png()).decode()} if png else {"text/plain": repr(value)}
            found.append(v4.new_output("execute_result", data, execution_count=number))
        cells += [v4.new_markdown_cell(before.strip())] if before.strip() else []
        cells.append(v4.new_code_cell(code, execution_count=number, outputs=found))
        end = block.end()
    cells.append(v4.new_markdown_cell(page[end:].strip()))
    for number, cell in enumerate(cells):
        cell.id = f"cell-{number}"
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    notebook = v4.new_notebook(cells=cells, metadata={"kernelspec": kernel})
    return "".join([*parts, page[end:]]), notebook


if __name__ == "__main__":
    page, kept = Path("docs/python.md").absolute(), Path("docs/tutorial.ipynb").absolute()
    with TemporaryDirectory() as folder, chdir(folder):  # the page saves files
        text, notebook = tutorial(page.read_text(encoding="utf-8"))
    page.write_text(text, encoding="utf-8", newline="\n")
    nbformat.write(notebook, kept)
