"""The gallery: runs as one page that opens in any browser, with no server and no network.

    page(collect([Path("runs/elongated"), Path("runs/elongated-branches")]))

The page's own parts lie here as page.html, style.css and *.js; the libraries it draws with,
three.js and Chart.js, in vendor/ as one file, since no wheel brings them at this size.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
