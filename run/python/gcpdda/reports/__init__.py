"""One HTML file about a result folder: what was computed, how it ended, pictures, and what the numbers mean.

The file holds its pictures, style and script, and opens without a network.
"""

import pathlib

from ..result import Ensemble, Safety, open_folder
from .ensemble import ensemble_page
from .run import run_page
from .safety import safety_page


def report(directory, out=None, *, title=None, frames=40):
    """Writes a report about the folder of a run, of `gcpdda fos` or of `gcpdda ensemble`, and returns its path.

    out         the file; DIRECTORY/report.html if not given
    title       heading; the name of the folder if not given
    frames      the player shows at most so many frames, fewer where they are large; 0 for no player
    """
    folder = open_folder(directory)
    title = title or folder.path.resolve().name
    if isinstance(folder, Safety):
        page = safety_page(folder, title, frames)
    elif isinstance(folder, Ensemble):
        page = ensemble_page(folder, title)
    else:
        page = run_page(folder, title, frames)
    out = pathlib.Path(out) if out is not None else folder.path / "report.html"
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(page.html(), encoding="utf-8", errors="replace")  # names of folders need not be UTF-8
    return out
