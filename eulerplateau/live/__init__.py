"""A live film: a page in the browser that drags its load, served from this machine alone.

    worker.py   the film in a thread: of the values that wait only the newest is solved
    answers.py  what pages are told, as JSON: points, shapes, what can be varied
    pages.py    the pages that are open, which share one film
    server.py   which requests are answered, and for how long
    page.html, live.css, live.js, visited.js   the page; it draws with the gallery's scripts

The film itself is `runs.LiveFilm`; nothing here computes. Needs aiohttp, which the extra
`live` brings.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
