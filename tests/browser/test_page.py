"""The page of the report in a real browser: it is drawn, it can be used, it stays by itself."""

import csv
import io
import re
import socket
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

pytestmark = pytest.mark.long

UNFOLD = "document.querySelectorAll('details').forEach(d => d.open = true)"


class Watched:
    """A tab, and what it says, asks for and fails at."""

    def __init__(self, browser: Any, address: str, **options: Any) -> None:
        self.context = browser.new_context(**options)
        self.tab = self.context.new_page()
        self.said: list[str] = []
        self.asked: list[str] = []
        self.tab.on("console", lambda message: self.said.append(message.text))
        self.tab.on("pageerror", lambda error: self.said.append(str(error)))
        self.context.on("request", lambda request: self.asked.append(request.url))
        self.tab.goto(address)


@pytest.fixture
def watched(browser: Any, report: Path) -> Iterator[Watched]:
    found = Watched(browser, report.as_uri())
    yield found
    found.context.close()


@pytest.fixture
def tab(watched: Watched) -> Any:
    return watched.tab


def test_it_says_nothing_and_asks_for_nothing(watched: Watched, report: Path) -> None:
    watched.tab.evaluate(UNFOLD)
    watched.tab.wait_for_load_state("networkidle")
    assert watched.said == []
    others = [address for address in watched.asked if address != report.as_uri()]
    assert all(address.startswith("data:") for address in others)
    pictures = watched.tab.evaluate(
        "[...document.images].map(i => i.complete && i.naturalWidth > 100 && i.alt.length > 40)"
    )
    assert pictures
    assert all(pictures)


TEMPTATION = """address => {
    window.refused = [];
    document.addEventListener('securitypolicyviolation',
                              event => refused.push(event.effectiveDirective));
    for (const name of ['img', 'script', 'video']) {
        const element = document.createElement(name);
        element.src = address;
        document.body.append(element);
    }
    fetch(address).catch(() => {});
    document.body.setAttribute('style', 'color: red');
}"""


def test_it_may_not_ask_a_network_even_if_it_wanted_to(watched: Watched) -> None:
    """Its policy forbids what is tried here."""
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.setblocking(False)
        watched.tab.evaluate(TEMPTATION, f"http://127.0.0.1:{server.getsockname()[1]}/")
        watched.tab.wait_for_function("refused.length == 5")
        with pytest.raises(BlockingIOError):  # nobody has knocked
            server.accept()
    assert set(watched.tab.evaluate("refused")) == {
        "img-src", "script-src-elem", "media-src", "connect-src", "style-src-attr"
    }  # fmt: skip


def test_every_formula_is_drawn(tab: Any) -> None:
    tab.evaluate(UNFOLD)
    sizes = tab.evaluate(
        """[...document.querySelectorAll('math')].map(math => {
            const box = math.getBoundingClientRect();
            return [box.width, box.height, math instanceof MathMLElement, math.textContent];
        })"""
    )
    assert len(sizes) > 500
    assert [one for one in sizes if one[0] < 2 or one[1] < 2 or not one[2]] == []
    assert tab.locator(".equation").count() == tab.locator(".statement math").count() >= 14


def test_formulas_are_laid_out(tab: Any) -> None:
    """What a browser without MathML would put side by side stands above and below."""
    tab.evaluate(UNFOLD)
    wrong = tab.evaluate(
        """(() => {
            const box = element => element.getBoundingClientRect();
            const wrong = [];
            for (const it of document.querySelectorAll('mfrac'))
                if (box(it.children[0]).bottom > box(it.children[1]).top + 1) wrong.push(it);
            for (const it of document.querySelectorAll('math[display] mtable')) {
                const rows = [...it.children].map(box);
                if (rows.some((row, n) => n && row.top < rows[n - 1].bottom - 1)) wrong.push(it);
            }
            for (const it of document.querySelectorAll('msubsup'))
                if (box(it.children[2]).top >= box(it.children[1]).top) wrong.push(it);
            for (const it of document.querySelectorAll('mo[form][stretchy]'))
                if (box(it).height < box(it.parentElement).height * 0.6) wrong.push(it);
            return wrong.map(it => it.outerHTML.slice(0, 200));
        })()"""
    )
    assert tab.locator("mfrac").count() > 50
    assert wrong == []


def pressed_until(tab: Any, key: str, selector: str, most: int) -> None:
    for _ in range(most):
        tab.keyboard.press(key)
        if tab.evaluate("s => document.activeElement.matches(s)", selector):
            return
    raise AssertionError(f"{key} never reached {selector}")


def test_steps_unfold_by_keyboard(tab: Any) -> None:
    steps = tab.locator("#eq-2-step-1")
    assert not steps.is_visible()
    pressed_until(tab, "Tab", "#eq-2-steps > summary", 150)
    tab.keyboard.press("Enter")
    assert steps.is_visible()
    tab.keyboard.press("Space")
    assert not steps.is_visible()


def test_the_keyboard_skips_to_the_content_first(tab: Any) -> None:
    tab.keyboard.press("Tab")
    focused = tab.evaluate("document.activeElement.textContent")
    assert "Skip" in focused
    assert tab.locator(".skip").bounding_box()["x"] >= 0
    tab.keyboard.press("Enter")
    assert tab.evaluate("document.activeElement.id") == "main"


def test_all_steps_unfold_at_once(tab: Any) -> None:
    pressed_until(tab, "Tab", "#unfold", 150)
    tab.keyboard.press("Space")
    heights = tab.evaluate("[...document.querySelectorAll('.steps ol')].map(o => o.offsetHeight)")
    assert all(tab.locator(".steps li").nth(n).is_visible() for n in (0, 10, -1))
    assert min(heights) > 20


def test_a_link_to_a_step_opens_it(browser: Any, report: Path) -> None:
    watched = Watched(browser, f"{report.as_uri()}#eq-3-step-1")
    assert watched.tab.locator("#eq-3-step-1").is_visible()
    watched.context.close()


def test_links_lead_somewhere(tab: Any) -> None:
    broken, ids = tab.evaluate(
        """[[...document.querySelectorAll('a')].map(a => a.getAttribute('href'))
              .filter(href => href.startsWith('#') ? !document.getElementById(href.slice(1))
                                                   : !href.startsWith('data:')),
            [...document.querySelectorAll('[id]')].map(element => element.id)]"""
    )
    assert broken == []
    assert len(ids) == len(set(ids)) > 100
    named = tab.evaluate(
        """[...document.querySelectorAll('[aria-labelledby]')]
              .every(e => document.getElementById(e.getAttribute('aria-labelledby')))"""
    )
    assert named


def test_data_can_be_saved(tab: Any, tmp_path: Path) -> None:
    links = tab.locator("a[download]")
    names = links.evaluate_all("links => links.map(link => link.download)")
    assert len(names) == len(set(names)) >= 4
    for number, name in enumerate(names):
        with tab.expect_download() as saving:
            links.nth(number).click()
        saving.value.save_as(tmp_path / name)
        content = (tmp_path / name).read_text(encoding="utf-8")
        if name.endswith(".csv"):
            lines = [line for line in io.StringIO(content) if not line.startswith("#")]
            rows = list(csv.DictReader(lines))
            assert rows
            assert None not in rows[0].values()
    assert "quantity" in (tmp_path / "small.toml").read_text(encoding="utf-8")


@pytest.mark.parametrize("width", [320, 768, 1440])
def test_the_page_never_scrolls_sideways(browser: Any, report: Path, width: int) -> None:
    watched = Watched(browser, report.as_uri(), viewport={"width": width, "height": 800})
    watched.tab.evaluate(UNFOLD)
    assert watched.tab.evaluate("document.documentElement.scrollWidth") <= width
    watched.context.close()


CONTRAST = """() => {
    const canvas = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
    const known = new Map();
    const rgba = colour => {
        if (!known.has(colour)) known.set(colour, painted(colour));
        return known.get(colour);
    };
    const painted = colour => {
        canvas.clearRect(0, 0, 1, 1);
        canvas.fillStyle = colour;
        canvas.fillRect(0, 0, 1, 1);
        return [...canvas.getImageData(0, 0, 1, 1).data];
    };
    const light = colour => {
        const [r, g, b] = rgba(colour).slice(0, 3).map(value => {
            const part = value / 255;
            return part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4;
        });
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const ground = element => {
        for (; element; element = element.parentElement) {
            const colour = getComputedStyle(element).backgroundColor;
            if (rgba(colour)[3] == 255) return colour;
        }
        return 'white';
    };
    const worst = new Map();
    const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) {
        const element = texts.currentNode.parentElement;
        if (!texts.currentNode.data.trim() || element.closest('style')) continue;
        const style = getComputedStyle(element);
        const colour = element.closest('svg') ? style.fill : style.color;
        const key = colour + ' on ' + ground(element);
        if (worst.has(key)) continue;
        const [high, low] = [light(colour), light(ground(element))].sort((a, b) => b - a);
        worst.set(key, (high + 0.05) / (low + 0.05));
    }
    return [...worst];
}"""


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_contrast(browser: Any, report: Path, scheme: str) -> None:
    """Text of any size stands out by 4.5 or more, as WCAG 2 asks at level AA."""
    watched = Watched(browser, report.as_uri(), color_scheme=scheme)
    watched.tab.evaluate(UNFOLD)
    found = watched.tab.evaluate(CONTRAST)
    grounds = {pair.split(" on ")[1] for pair, _ in found}
    assert len(found) > 6
    assert len(grounds) > 2
    assert [pair for pair, ratio in found if ratio < 4.5] == []
    watched.context.close()


def test_names_and_headings_for_those_who_listen(tab: Any) -> None:
    assert tab.evaluate("document.documentElement.lang") == "en"
    assert tab.title()
    levels = tab.evaluate("[...document.querySelectorAll('h1,h2,h3')].map(h => +h.tagName[1])")
    assert levels.count(1) == 1
    assert all(after <= before + 1 for before, after in pairwise(levels))
    unnamed = tab.evaluate(
        """[...document.querySelectorAll('a, img, input, table, [role=region], section')]
            .filter(e => !(e.textContent.trim() || e.alt || e.getAttribute('aria-label')
                           || e.getAttribute('aria-labelledby') || e.labels?.length))
            .map(e => e.outerHTML.slice(0, 100))"""
    )
    assert unnamed == []
    assert tab.locator("th:not([scope])").count() == 0


def test_it_prints(tab: Any) -> None:
    printed = tab.pdf(prefer_css_page_size=True)
    assert printed.startswith(b"%PDF")
    assert len(re.findall(rb"/Type\s*/Page\b", printed)) >= 10
    # A4 is 595.28 × 841.89 points
    boxes = re.findall(rb"/MediaBox\s*\[0 0 ([\d.]+) ([\d.]+)\]", printed)
    assert {(round(float(width)), round(float(height))) for width, height in boxes} == {(595, 842)}
    tab.emulate_media(media="print")
    assert tab.locator("#eq-2-step-1").is_visible()  # folded on the screen, but not on paper
    assert not tab.locator("nav").is_visible()
    assert not tab.locator("#eq-2-mutants table").is_visible()


def test_nothing_wide_is_cut_off_on_paper(browser: Any, report: Path) -> None:
    width = round((210 - 2 * 17) / 25.4 * 96)  # A4 less its margins, in CSS pixels
    watched = Watched(browser, report.as_uri(), viewport={"width": width, "height": 1000})
    watched.tab.emulate_media(media="print")
    assert watched.tab.evaluate("document.documentElement.scrollWidth") <= width
    watched.context.close()
