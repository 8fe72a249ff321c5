"""Drag the slider of a live film in a headless browser, and print how fast it follows."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import click
import numpy as np
import psutil

from eulerplateau.arrays import FloatArray
from scripts.studies.common import ROOT, machine, markdown_table
from tests.helpers.browser import Browser, chromium

# What is dragged: a run, and what is replaced in it. The soap film stays short of its jump.
FILMS = {
    "springs": ("elongated", "sweep.loads=[1,3000]"),
    "area": ("area", "sweep.loads=[1400,1840]"),
}
# To and fro in 20 s, as a hand may, told 60 times a second as a mouse does.
_DRAG = """((id, period) => {
  const slider = document.getElementById(id);
  const [low, high] = [Number(slider.min), Number(slider.max)];
  const start = performance.now();
  window.dragging = setInterval(() => {
    const part = 0.5 - 0.5 * Math.cos(2 * Math.PI * (performance.now() - start) / period);
    slider.value = low + part * (high - low);
    slider.dispatchEvent(new Event("input"));
  }, 1000 / 60);
})(arguments[0], 20000)"""
# Seconds: of dragging that does not count, and of a part of what does.
_WARM, _PART = 5.0, 20.0
_HEAD = (
    "film", "films a second", "median (ms)", "95 % (ms)", "CPU a film (ms): server",
    "browser", "memory (MB): server", "page", "busy",
)  # fmt: skip


@dataclass(frozen=True)
class Part:
    """What happened in some seconds of dragging.

    Attributes
    ----------
    waits : (n,) float, ms from a slider's move to the film drawn for it
    server, browser : float, seconds of CPU
    memory, heap : float, MB, of the server and of the page's objects
    busy : float, processes that wanted a core, the system's mean of a minute
    """

    seconds: float
    waits: FloatArray
    server: float
    browser: float
    memory: float
    heap: float
    busy: float

    def row(self, film: str) -> tuple[str, ...]:
        """Return the line of a table."""
        drawn = len(self.waits)
        middle, high = np.percentile(self.waits, [50, 95]) if drawn else (np.nan, np.nan)
        return (
            film,
            f"{drawn / self.seconds:.1f}",
            f"{middle:.0f}",
            f"{high:.0f}",
            f"{1e3 * self.server / max(drawn, 1):.0f}",
            f"{1e3 * self.browser / max(drawn, 1):.0f}",
            f"{self.memory:.0f}",
            f"{self.heap:.1f}",
            f"{self.busy:.1f}",
        )


@contextmanager
def served(film: str, folder: Path) -> Iterator[tuple[str, psutil.Process]]:
    """Serve a film; yield its address and the server's process."""
    run, setting = FILMS[film]
    command = [
        sys.executable,
        "-P",
        "-m",
        "eulerplateau",
        "live",
        f"{ROOT}/runs/{run}.toml",
    ]
    command += ["--set", setting, "--no-browser", "--out", str(folder / run)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as server:
        assert server.stdout is not None
        try:
            yield server.stdout.readline().strip(), psutil.Process(server.pid)
        finally:
            server.terminate()


def dragged(browser: Browser, server: psutil.Process, seconds: float) -> Iterator[Part]:
    """Drag for so long; yield what happened in each part of it."""
    browser.wait_for(lambda: browser.evaluate("document.body.dataset.drawn") is not None)
    slider = browser.evaluate("document.querySelector('#varied input').id")
    browser.evaluate(_DRAG, slider)
    time.sleep(_WARM)
    end = time.monotonic() + seconds
    driver = psutil.Process(browser.driver.service.process.pid)
    while (left := end - time.monotonic()) > 1:
        browser.evaluate("latencies.splice(0)")
        started, before = time.monotonic(), (cpu(server), cpu(driver))
        time.sleep(min(_PART, left))
        waits = np.array(browser.evaluate("latencies"), dtype=float)
        took, after = time.monotonic() - started, (cpu(server), cpu(driver))
        own, its = after[0] - before[0], after[1] - before[1]
        browser.driver.execute_cdp_cmd("HeapProfiler.collectGarbage", {})
        heap = browser.evaluate("performance.memory.usedJSHeapSize") / 1e6
        memory = server.memory_info().rss / 1e6
        yield Part(took, waits, own, its, memory, heap, os.getloadavg()[0])
    browser.evaluate("clearInterval(window.dragging)")


def cpu(process: psutil.Process) -> float:
    """Return the CPU seconds of a process and all that it has started and still runs."""
    every = [process, *process.children(recursive=True)]
    return float(sum(sum(each.cpu_times()[:2]) for each in every))


@click.command()
@click.option("--film", "films", type=click.Choice([*FILMS]), multiple=True)
@click.option("--seconds", type=float, default=_PART, show_default=True)
def main(films: tuple[str, ...], seconds: float) -> None:
    """Drag the slider of each film for so long, in a headless Chromium.

    Prints a line for every 20 s: films drawn a second; how long after the slider's move a
    film is drawn; CPU time of the server for each; memory; how busy the machine was.
    """
    rows: list[tuple[str, ...]] = [_HEAD]
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for film in films or tuple(FILMS):
            with served(film, folder) as (address, server), chromium(folder / film) as page:
                page.visit(address)
                for part in dragged(page, server, seconds):
                    rows.append(part.row(film))
                    click.echo(" | ".join(rows[-1]), err=True)
                assert page.complaints() == []
    click.echo(f"{machine()}\n")
    click.echo(markdown_table(rows, 1), nl=False)


if __name__ == "__main__":
    main()
