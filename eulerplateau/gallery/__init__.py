"""The gallery: runs as one page that opens in any browser, with no server and no network.

    page(collect([Path("runs/elongated"), Path("runs/elongated-branches")]))

The page's own parts lie here as page.html, style.css and *.js; the libraries it draws with,
three.js and Chart.js, in vendor/ as one file, since no wheel brings them at this size.
"""

from eulerplateau.gallery.collection import Gallery, Mesh, Run, Series, collect
from eulerplateau.gallery.document import page

__all__ = ["Gallery", "Mesh", "Run", "Series", "collect", "page"]
