"""A headless Chromium for tests: what it shows, what it complains of, what it fetches."""

from __future__ import annotations

import io
import json
import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

Image = NDArray[np.float64]

_FLAGS = (
    "--headless=new",
    "--no-sandbox",  # which root cannot have
    "--disable-gpu",
    "--use-angle=swiftshader",  # WebGL without a graphics card
    "--enable-unsafe-swiftshader",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--disable-dev-shm-usage",
    # Should a page try, no name is found.
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)


def _program(*names: str) -> str:
    found = next((path for name in names if (path := shutil.which(name))), None)
    assert found, (
        f"no {names[0]}: install it (Debian: apt-get install chromium chromium-driver)"
    )
    return found


@contextmanager
def chromium(profile: Path, *flags: str) -> Iterator[Browser]:
    """Start a browser of 1400 x 900 pixels with the new profile folder `profile`."""
    from selenium.webdriver import Chrome, ChromeOptions
    from selenium.webdriver.chrome.service import Service

    options = ChromeOptions()
    options.binary_location = _program("chromium", "chromium-browser", "google-chrome")
    for flag in (*_FLAGS, *flags, f"--user-data-dir={profile}", "--window-size=1400,900"):
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    # With its path given, Selenium does not look for a driver to download.
    driver = Chrome(options, Service(_program("chromedriver")))
    try:
        yield Browser(driver)
    finally:
        driver.quit()


class Browser:
    """A page in a browser, seen and driven from outside."""

    def __init__(self, driver: Any) -> None:
        self.driver = driver

    def open(self, page: Path) -> None:
        """Open a file; the log then holds what this one said and fetched."""
        self.visit(page.as_uri())

    def visit(self, address: str) -> None:
        """Open an address; the log then holds what this page said and fetched."""
        self.driver.get("about:blank")
        for kind in ("browser", "performance"):
            self.driver.get_log(kind)
        self.driver.get(address)
        # On a busy machine the driver takes the blank page's end of loading for this one's.
        self.wait_for(
            lambda: self.evaluate(
                "document.readyState === 'complete' && location.href !== 'about:blank'"
            )
        )

    def evaluate(self, script: str, *arguments: Any) -> Any:
        """Return the value of a JavaScript expression; `arguments` are its arguments."""
        return self.driver.execute_script(f"return {script}", *arguments)

    def wait_for(self, happened: Callable[[], bool]) -> None:
        """Wait until the page has dealt with what was done to it, for at most 60 s."""
        from selenium.webdriver.support.wait import WebDriverWait

        WebDriverWait(self.driver, 60.0, 0.02).until(lambda _: happened())

    def complaints(self) -> list[str]:
        """Return what the page said since it was asked last, but for the driver's chat."""
        entries = self.driver.get_log("browser")
        # "rendering": that reading a screenshot back from the GPU takes time.
        return [entry["message"] for entry in entries if entry["source"] != "rendering"]

    def requested(self) -> list[str]:
        """Return the addresses asked for since the page was opened."""
        events = [
            json.loads(entry["message"])["message"]
            for entry in self.driver.get_log("performance")
        ]
        return [
            event["params"]["request"]["url"]
            for event in events
            if event["method"] == "Network.requestWillBeSent"
        ]

    def press(self, *keys: str) -> None:
        """Press and release keys, one after the other, with the whole page in focus."""
        from selenium.webdriver import ActionChains

        ActionChains(self.driver).send_keys(*keys).perform()

    def click(self, x: float, y: float) -> None:
        """Click at `x`, `y`, in pixels from the page's upper left corner."""
        self._mouse("mousePressed", x, y)
        self._mouse("mouseReleased", x, y)

    def drag(self, x: float, y: float, dx: float, dy: float) -> None:
        """Drag from `x`, `y` by `dx`, `dy`."""
        self._mouse("mousePressed", x, y)
        for part in np.linspace(0.1, 1.0, 10):
            self._mouse("mouseMoved", x + part * dx, y + part * dy)
        self._mouse("mouseReleased", x + dx, y + dy)

    def wheel(self, x: float, y: float, turn: float) -> None:
        """Turn the wheel at `x`, `y`; negative zooms in."""
        self._command(
            "Input.dispatchMouseEvent", type="mouseWheel", x=x, y=y, deltaX=0, deltaY=turn
        )

    def resize(self, width: int, height: int) -> None:
        """Give the page so many pixels."""
        self._command(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=False,
        )

    def become_a_phone(self) -> None:
        """Have a screen of 390 x 844 points that is touched."""
        self._command(
            "Emulation.setDeviceMetricsOverride",
            width=390,
            height=844,
            deviceScaleFactor=2,
            mobile=True,
        )
        self._command("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)

    def touch(self, *ways: list[tuple[float, float]]) -> None:
        """Move one finger along each way, all starting and ending together."""
        for moment, points in enumerate(zip(*ways, strict=True)):
            touched = [{"x": x, "y": y, "id": i} for i, (x, y) in enumerate(points)]
            kind = "touchMove" if moment else "touchStart"
            self._command("Input.dispatchTouchEvent", type=kind, touchPoints=touched)
        self._command("Input.dispatchTouchEvent", type="touchEnd", touchPoints=[])

    def screenshot(self, path: Path) -> None:
        """Write what is to be seen to a PNG file."""
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(self.driver.get_screenshot_as_png())

    def picture(self, name: str) -> Image:
        """Return the element `name` as seen, (height, width, 3), from 0 to 1."""
        from matplotlib.image import imread

        element = self.driver.find_element("id", name)
        image: Image = imread(io.BytesIO(element.screenshot_as_png))[..., :3].astype(float)
        return image

    def _mouse(self, kind: str, x: float, y: float) -> None:
        self._command(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button="left",
            buttons=0 if kind == "mouseReleased" else 1,
            clickCount=1,
        )

    def _command(self, name: str, **arguments: Any) -> None:
        self.driver.execute_cdp_cmd(name, arguments)
