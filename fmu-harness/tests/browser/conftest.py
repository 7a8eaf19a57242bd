"""The browser, and the pages in it: on a screen and on a phone."""

import json
import os
import shutil
from pathlib import Path

import pytest
from playwright.sync_api import sync_playwright

PAGES = Path(os.environ["SLIDERCRANK_PAGES"])
NAMES = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable"]
# A machine without a display or a network, and a caller who may be root.
FLAGS = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
]
SCREEN = {"viewport": {"width": 1280, "height": 900}}
PHONE = {"viewport": {"width": 390, "height": 844}, "has_touch": True, "is_mobile": True}


def found():
    named = os.environ.get("SLIDERCRANK_BROWSER")
    if named:
        assert Path(named).is_file(), f"SLIDERCRANK_BROWSER: {named} is no file"
        return named
    paths = [shutil.which(name) for name in NAMES]
    return next(filter(None, paths), None) or pytest.skip("no browser: on Debian, apt-get install chromium")


@pytest.fixture(scope="session")
def browser():
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=found(), args=FLAGS)
        yield browser
        browser.close()


class Opened:
    """A page, what it complained of and what it asked the network for."""

    def __init__(self, browser, scene, device):
        self.complaints, self.requests = [], []
        self.context = browser.new_context(**device)
        self.page = self.context.new_page()
        loud = ("error", "warning")
        self.page.on("console", lambda told: self.complaints.append(told.text) if told.type in loud else None)
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        self.page.on("request", lambda request: self.requests.append(request.url))
        self.page.goto((PAGES / f"report-{scene}.html").as_uri())
        self.page.wait_for_function("document.querySelectorAll('figure.plot:not(.js-plotly-plot)').length === 0")
        self.film = json.loads(self.page.locator("#film").text_content())

    def set(self, control, value):
        """Moves a slider, from 0 to 1 of its way."""
        script = """(slider, share) => {
            slider.value = Number(slider.min) + share * (slider.max - slider.min);
            slider.dispatchEvent(new Event("input"));
        }"""
        self.page.locator(f"#{control}").evaluate(script, value)

    def frame(self, number):
        self.set("scrub", number / (len(self.film["time"]) - 1))

    def slider(self):
        """[mm, mm, degrees] Where the slider is drawn."""
        words = self.page.locator("#slider").get_attribute("transform")
        return [float(word) for word in words.replace("translate(", "").replace("rotate(", "").replace(")", "").split()]


@pytest.fixture
def fresh(browser):
    """Opens a page as a reader finds it."""
    pages = []

    def fresh(scene, device=SCREEN):
        pages.append(Opened(browser, scene, device))
        return pages[-1]

    yield fresh
    for page in pages:
        page.context.close()


@pytest.fixture(scope="session")
def opened(browser):
    """Opens a page once for all tests that set what they rely on: drawing it takes seconds."""
    pages = {}

    def opened(scene, device=SCREEN):
        key = scene, str(device)
        if key not in pages:
            pages[key] = Opened(browser, scene, device)
        return pages[key]

    yield opened
    for page in pages.values():
        page.context.close()
