"""Opens a report page of made-up runs in Chromium, uses it as a person would, and checks what it shows.

    page_browser_test.py PAGE_EXAMPLE            the test; ends with status 77 where there is no browser to drive
    page_browser_test.py PAGE_EXAMPLE --measure  how long a page of 10,000 runs and 40 pictures takes to be shown

PAGE_EXAMPLE is the program of page_example_main.cpp. What tables must show is computed here from the rows that it
writes as CSV. Debian: chromium, chromium-driver, python3-selenium.
"""
import csv
import decimal
import math
import pathlib
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
import unittest

SKIPPED = 77
CHROMIUM = "/usr/bin/chromium"
CHROMEDRIVER = "/usr/bin/chromedriver"

try:
    from selenium import webdriver
    from selenium.webdriver.common.by import By
    from selenium.webdriver.common.keys import Keys
    from selenium.webdriver.chrome.service import Service
except ImportError:
    webdriver = None

PAGE_EXAMPLE = None


def missing():
    """What is not here that the test needs; empty: nothing."""
    if webdriver is None:
        return "python3-selenium"
    return " and ".join(tool for tool in (CHROMIUM, CHROMEDRIVER) if not pathlib.Path(tool).exists())


def open_browser(folder):
    options = webdriver.ChromeOptions()
    options.binary_location = CHROMIUM
    for flag in ("headless=new", "no-sandbox", "disable-gpu", "disable-quic", "no-first-run", "disable-dev-shm-usage",
                 "disable-background-networking", "disable-component-update", "disable-sync",
                 "disable-default-apps", "window-size=1280,1000", f"user-data-dir={folder / 'browser'}"):
        options.add_argument("--" + flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL", "performance": "ALL"})
    browser = webdriver.Chrome(service=Service(CHROMEDRIVER), options=options)
    browser.set_script_timeout(60)
    return browser


def set_scheme(browser, scheme):
    browser.execute_cdp_cmd("Emulation.setEmulatedMedia",
                            {"features": [{"name": "prefers-color-scheme", "value": scheme}]})


def write_example(folder, runs, pictures):
    page, rows = folder / "page.html", folder / "rows.csv"
    subprocess.run([PAGE_EXAMPLE, page, rows, str(runs), str(pictures)], check=True)
    return page, rows


def wait_until_shown(browser):
    """Milliseconds from the start of the navigation until all that the page draws was on the screen."""
    for _ in range(600):
        shown = browser.execute_script("return performance.getEntriesByName('gridmerge-shown').map(m => m.startTime)")
        if shown:
            return shown[0]
        time.sleep(0.05)
    raise AssertionError("the page was never shown")


def wait_for(condition):
    for _ in range(200):
        if condition():
            return
        time.sleep(0.05)


def wilson(successes, n):
    z, p = 1.959964, successes / n
    middle = (p + z * z / (2 * n)) / (1 + z * z / n)
    half = z / (1 + z * z / n) * math.sqrt(p * (1 - p) / n + z * z / (4 * n * n))
    return max(0.0, middle - half), min(1.0, middle + half)


def fixed(value, digits):
    """As a browser's toFixed: a tie goes up."""
    return str(decimal.Decimal(value).quantize(decimal.Decimal(1).scaleb(-digits), rounding=decimal.ROUND_HALF_UP))


def share_text(successes, n):
    if n == 0:
        return "–"
    low, high = wilson(successes, n)
    return f"{fixed(100 * (successes / n), 1)} % ({fixed(100 * low, 1)}–{fixed(100 * high, 1)})"


def duration_text(seconds):
    def three(value):
        return fixed(value, max(0, 2 - math.floor(math.log10(value))))
    if seconds is None:
        return "–"
    return f"{three(seconds)} s" if seconds >= 1 else f"{three(1e3 * seconds)} ms"


def plain(text):
    return text.replace("\u202f", "").strip()


def series_of(row):
    name = f"{row['method']} ({row['profile']})"
    return f"{name} {row['options']}" if row["options"] else name


def method_rows(rows):
    """Of the table of methods: what each line must say, by method."""
    lines = {}
    for series in {series_of(row) for row in rows}:
        own = [row for row in rows if series_of(row) == series]
        count = {result: sum(row["result"] == result for row in own)
                 for result in ("right", "wrong", "missed", "refused", "false")}
        same = count["right"] + count["wrong"] + count["missed"]
        times = [float(row["align_s"]) for row in own if row["result"] == "right"]
        lines[series] = [series, str(len(own)), "", share_text(count["right"], same), share_text(count["wrong"], same),
                         share_text(count["missed"], same),
                         share_text(count["false"], count["false"] + count["refused"]),
                         duration_text(statistics.median(times) if times else None)]
    return lines


class PageInABrowser(unittest.TestCase):
    maxDiff = None

    @classmethod
    def setUpClass(cls):
        cls.folder = pathlib.Path(tempfile.mkdtemp(prefix="gridmerge-page-"))
        cls.addClassCleanup(shutil.rmtree, cls.folder, ignore_errors=True)
        cls.page, rows = write_example(cls.folder, 600, 10)
        with rows.open(encoding="utf-8", errors="replace", newline="") as file:
            cls.rows = list(csv.DictReader(file))
        cls.pairs = [row for row in cls.rows if int(row["robots"]) <= 2]
        cls.browser = open_browser(cls.folder)
        cls.addClassCleanup(cls.browser.quit)

    def setUp(self):
        set_scheme(self.browser, "light")
        self.browser.get("about:blank")
        self.browser.get(self.page.as_uri())
        wait_until_shown(self.browser)
        self.browser.execute_script("localStorage.clear()")

    def tearDown(self):
        errors = [entry["message"] for entry in self.browser.get_log("browser")]
        self.assertEqual(errors, [], "the console must stay empty")

    # What a person does.
    def all(self, selector):
        return self.browser.find_elements(By.CSS_SELECTOR, selector)

    def one(self, selector):
        return self.browser.find_element(By.CSS_SELECTOR, selector)

    def text_of(self, selector):
        return self.one(selector).get_attribute("textContent")

    def cells(self, table):
        lines = self.browser.execute_script(
            "return [...document.querySelectorAll(arguments[0] + ' tbody tr')]"
            ".map(row => [...row.cells].map(cell => cell.textContent))", table)
        return [[plain(cell) for cell in line] for line in lines]

    def click(self, element):
        self.browser.execute_script("arguments[0].scrollIntoView({block: 'center'})", element)
        element.click()

    def open_filters(self):
        if not self.one("#filters").is_displayed():
            self.one("#open-filters").click()

    def untick(self, key, value):
        self.open_filters()
        for box in self.all(f"#filters input[data-filter='{key}']"):
            if box.get_attribute("data-value") == value:
                self.click(box)
                return
        self.fail(f"no filter {key}: {value}")

    def check_methods(self, pairs):
        shown = {line[0]: line for line in self.cells("#methods-table")}
        self.assertEqual(shown, method_rows(pairs))

    # What must be true.
    def test_the_table_of_methods_says_what_the_rows_say(self):
        self.check_methods(self.pairs)

    def test_numbers_behind_a_chart_say_what_the_rows_say(self):
        self.click(self.one("#success-by-set details summary"))
        wait_for(lambda: self.cells("#success-by-set"))  # a browser tells of the opening a little later
        shown = {(line[0], line[1]): line[2:] for line in self.cells("#success-by-set")}
        expected = {}
        for row in self.pairs:
            if row["result"] in ("right", "wrong", "missed"):
                expected.setdefault((row["set"], series_of(row)), []).append(row["result"] == "right")
        self.assertEqual(shown, {key: [str(len(hits)), str(sum(hits)), share_text(sum(hits), len(hits))]
                                 for key, hits in expected.items()})

    def test_a_filter_acts_on_tables_charts_and_failures(self):
        self.untick("method", "som")
        self.untick("set", "maze")
        self.untick("window", "10 %")
        self.untick("truth", "different")
        left = [row for row in self.rows if row["method"] != "som" and row["set"] != "maze"
                and row["window"] != "10 %" and row["truth"] != "different"]
        self.check_methods([row for row in left if int(row["robots"]) <= 2])
        self.assertIn(f"shows {len(left)} of {len(self.rows)} runs", plain(self.text_of("#filter-note")))
        self.assertIn(f"of {len(left)}", plain(self.text_of("#runs-where")))
        runs = {row["run"] for row in left}
        self.assertLessEqual({card.get_attribute("data-run") for card in self.all(".gallery button")}, runs)
        labels = self.browser.execute_script(
            "return Object.values(Chart.instances).flatMap(c => c.data.datasets.map(d => d.label))")
        self.assertFalse([label for label in labels if label and label.startswith("som")])

    def test_a_filter_survives_a_reload_and_ends_with_a_click(self):
        self.untick("profile", "paper")
        self.browser.refresh()
        wait_until_shown(self.browser)
        self.check_methods([row for row in self.pairs if row["profile"] != "paper"])
        self.click(self.one("#filter-note button"))
        self.check_methods(self.pairs)
        self.assertEqual(self.text_of("#filter-note"), "")

    def test_a_filter_that_leaves_nothing_says_so(self):
        self.open_filters()
        self.click(self.one("#filters fieldset[data-filter='set'] button:last-of-type"))
        self.assertIn("The filter leaves no run", self.text_of("#overview"))
        self.click(self.one("#reset-filters"))
        self.check_methods(self.pairs)

    def test_all_runs_are_sorted_searched_and_paged(self):
        def column(place):
            return [line[place] for line in self.cells("#runs-table")]
        self.assertEqual(column(0), [row["run"] for row in self.rows[:50]])
        heads = self.all("#runs-table th button")
        confidence = [head.text for head in heads].index("Confidence")
        self.click(heads[confidence])
        self.click(heads[confidence])
        highest = sorted((float(row["confidence"]) for row in self.rows), reverse=True)[:50]
        self.assertEqual(column(confidence), [fixed(value, 3) for value in highest])
        self.click(self.one("#runs [aria-label='Next page']"))
        self.assertTrue(plain(self.text_of("#runs-where")).startswith("51–100 of"))
        self.one("#search-runs").send_keys("maze wrong")
        found = [row for row in self.rows if row["set"] == "maze" and row["result"] == "wrong"]
        self.assertTrue(plain(self.text_of("#runs-where")).endswith(f"of {len(found)}"))

    def test_the_rows_are_handed_out_as_csv(self):
        self.browser.execute_cdp_cmd("Browser.setDownloadBehavior",
                                     {"behavior": "allow", "downloadPath": str(self.folder)})
        target = self.folder / "rows.csv"
        target.unlink()
        self.untick("method", "genetic")
        self.click(self.one("#download-csv"))
        for _ in range(100):
            if target.exists():
                break
            time.sleep(0.05)
        with target.open(encoding="utf-8", newline="") as file:
            given = list(csv.DictReader(file))
        left = [row for row in self.rows if row["method"] != "genetic"]
        self.assertEqual([row["run"] for row in given], [row["run"] for row in left])
        for theirs, own in zip(given, left):
            for key in ("set", "pair", "pair_spec", "method", "options", "seed", "result", "reason", "date"):
                self.assertEqual(theirs[key], own[key])
            for key in ("confidence", "error_m", "align_s", "target_walls", "overlap"):
                if own[key] == "nan":
                    self.assertEqual(theirs[key], "")
                else:
                    self.assertAlmostEqual(float(theirs[key]), float(own[key]), delta=1e-6 * abs(float(own[key])))
        self.assertIn("evidence_m", given[0])

    def test_a_failure_opens_with_its_pictures_reason_and_command(self):
        cards = self.all(".gallery button")
        self.assertEqual(len(cards), 10)
        row = next(row for row in self.rows if row["run"] == cards[0].get_attribute("data-run"))
        self.assertEqual(row["result"], "false")
        self.click(cards[0])
        self.assertTrue(self.one("#viewer").is_displayed())
        words = self.text_of("#viewer")
        for part in (row["reason"], series_of(row), row["set"], row["pair"], f"--run {row['run']}"):
            self.assertIn(part, words)
        self.assertEqual(len(self.all("#viewer img")), 2, "at the pose found and the scene; no pose is right")
        widths = self.browser.execute_script(
            "return Promise.all([...document.querySelectorAll('#viewer img')]"
            ".map(img => img.decode().then(() => img.naturalWidth)))")
        self.assertTrue(all(0 < width <= 700 for width in widths), widths)
        self.one("#viewer").send_keys(Keys.ARROW_RIGHT)
        self.assertIn(f"--run {cards[1].get_attribute('data-run')}", self.text_of("#viewer"))
        self.one("#viewer").send_keys(Keys.ESCAPE)
        self.assertFalse(self.one("#viewer").is_displayed())

    def test_any_run_opens_from_the_table(self):
        self.click(self.one("#runs-table tbody tr:nth-child(4) button"))
        self.assertIn(self.rows[3]["seed"], self.text_of("#viewer"))
        self.click(self.one("#viewer .close"))

    def test_curves_follow_their_pickers(self):
        def lines():
            return self.browser.execute_script(
                "return Chart.getChart(document.querySelector('#curve-fitness canvas')).data.datasets.length")
        with_curve = [row for row in self.pairs if series_of(row) == "genetic (paper)" and row["set"] == "maze"]
        for picker, words in (("pick-series", "genetic (paper)"), ("pick-place", "maze, all pairs")):
            for option in self.all(f"#{picker} option"):
                if option.text == words:
                    self.click(option)
                    break
        self.assertEqual(lines(), 1 + len(with_curve), "one line a run and their median")

    def test_every_chart_has_something_on_it(self):
        empty = self.browser.execute_script(
            "return [...document.querySelectorAll('canvas')].filter(canvas => {"
            "  const data = canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data;"
            "  return !data.some(value => value !== 0); }).map(canvas => canvas.ariaLabel)")
        self.assertEqual(empty, [])
        self.assertGreaterEqual(len(self.all("canvas")), 15)

    def test_dark_follows_the_system_and_the_switch(self):
        def ground():
            return self.browser.execute_script("return getComputedStyle(document.body).backgroundColor")
        self.assertEqual(ground(), "rgb(255, 255, 255)")
        set_scheme(self.browser, "dark")
        time.sleep(0.3)
        dark = ground()
        self.assertNotEqual(dark, "rgb(255, 255, 255)")
        self.one("#theme").click()
        self.assertEqual(ground(), "rgb(255, 255, 255)")
        self.one("#theme").click()
        self.assertEqual(ground(), dark)
        self.browser.execute_script("localStorage.clear()")

    def test_it_fits_a_phone(self):
        self.browser.execute_cdp_cmd("Emulation.setDeviceMetricsOverride",
                                     {"width": 375, "height": 760, "deviceScaleFactor": 2, "mobile": True})
        self.browser.refresh()
        wait_until_shown(self.browser)
        width = self.browser.execute_script("return document.documentElement.scrollWidth")
        self.browser.execute_cdp_cmd("Emulation.clearDeviceMetricsOverride", {})
        self.assertLessEqual(width, 375)

    def test_it_prints(self):
        printed = self.browser.execute_cdp_cmd("Page.printToPDF", {"preferCSSPageSize": True})
        self.assertGreater(len(printed["data"]), 10000)

    def test_small_studies_open_as_well(self):
        for runs in (0, 1, 2):
            with self.subTest(runs=runs):
                folder = self.folder / f"small-{runs}"
                folder.mkdir()
                page, _ = write_example(folder, runs, 3)
                self.browser.get(page.as_uri())
                wait_until_shown(self.browser)
                self.assertIn("no runs yet" if runs == 0 else f"{runs} run", self.text_of("#overview"))
                self.assertEqual(len(self.all("#runs-table tbody tr")), runs)

    def test_names_from_files_stay_text(self):
        self.assertEqual(self.text_of("h1"), 'Made-up <study> & "more"')
        self.assertEqual(self.all("main b"), [])
        self.assertIn('hall </script><b>"x"', self.text_of("#runs-table"))

    def test_the_keyboard_reaches_the_filters(self):
        self.one("#open-filters").send_keys(Keys.ENTER)
        focused = self.browser.switch_to.active_element
        self.assertEqual(focused.get_attribute("data-filter"), "method")
        focused.send_keys(Keys.SPACE)
        self.assertIn("Filter (1)", self.text_of("#open-filters"))
        focused.send_keys(Keys.ESCAPE)
        self.assertFalse(self.one("#filters").is_displayed())

    def test_nothing_is_asked_of_a_network(self):
        asked = self.browser.execute_script("return performance.getEntriesByType('resource').map(entry => entry.name)")
        self.assertEqual([name for name in asked if not name.startswith(("data:", "blob:"))], [])
        sent = [entry["message"] for entry in self.browser.get_log("performance")
                if '"Network.requestWillBeSent"' in entry["message"]]
        self.assertEqual([text[:400] for text in sent if '"url":"http' in text], [])


def measure(runs=10000, pictures=40, openings=7):
    with tempfile.TemporaryDirectory(prefix="gridmerge-page-") as name:
        folder = pathlib.Path(name)
        page, _ = write_example(folder, runs, pictures)
        browser = open_browser(folder)
        try:
            shown = []
            for _ in range(openings):
                browser.get("about:blank")
                browser.get(page.as_uri())
                shown.append(wait_until_shown(browser))
        finally:
            browser.quit()
        print(f"{runs} runs, {pictures} failures with pictures, {page.stat().st_size / 1e6:.1f} MB: shown after "
              f"{statistics.median(shown):.0f} ms (median of {openings}; {min(shown):.0f} to {max(shown):.0f} ms)")


def main():
    global PAGE_EXAMPLE
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    if missing():
        print(f"skipped: not here: {missing()}")
        sys.exit(SKIPPED)
    PAGE_EXAMPLE = sys.argv[1]
    if sys.argv[2:] == ["--measure"]:
        measure()
    else:
        unittest.main(argv=sys.argv[:1], verbosity=2)


if __name__ == "__main__":
    main()
