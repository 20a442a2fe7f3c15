#!/usr/bin/env python3
"""Opens the report in headless Chromium, 390 and 1,440 px wide: no broken image, no console
message, nothing wider than the window. Screenshots of the whole page are left in OUTDIR, in pieces from the top:
page-390-00.png and so on; with --open all details are open in them.

usage: check_page.py [--open] INDEX.html OUTDIR
"""
import argparse
import os
import re
import subprocess
import sys

PIECE = 3600  # px of the page to a screenshot
PROBE = """<script>addEventListener('load', () => {
    const broken = [...document.images].filter(i => !i.complete || !i.naturalWidth).map(i => i.getAttribute('src'));
    document.title = 'broken: ' + broken.length + ' ' + broken.slice(0, 3).join(' ') + '; images: ' + document.images.length +
        '; height: ' + document.documentElement.scrollHeight +
        '; overflow: ' + Math.max(0, document.documentElement.scrollWidth - document.documentElement.clientWidth);
});</script>"""


def chromium(*options):
    done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--allow-file-access-from-files",
                           "--enable-logging=stderr", "--v=0", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def opened(text):
    return text.replace("<details>", "<details open>")


class Probe:
    """The page with all images loaded at once and something added, beside it for as long as this lasts."""

    def __init__(self, page):
        self.path = os.path.join(os.path.dirname(page), "probe.html")
        with open(page, encoding="utf-8") as f:
            self.text = f.read().replace(' loading="lazy"', "")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        os.unlink(self.path)

    def load(self, text, head, *options):
        with open(self.path, "w", encoding="utf-8") as f:
            f.write(text.replace("</head>", head + "</head>"))
        return chromium(*options, "--virtual-time-budget=20000", "file://" + self.path)

    def title(self, text, width):
        """What the probe says, and console messages."""
        dom, messages = self.load(text, PROBE, f"--window-size={width},{PIECE}", "--dump-dom")
        return re.search(r"<title>(.*?)</title>", dom)[1], messages

    def shoot(self, text, width, out):
        height = int(re.search(r"height: (\d+)", self.title(text, width)[0])[1])
        for piece in range((height + PIECE - 1) // PIECE):
            moved = f"<style>body {{ position: relative; top: {-piece * PIECE}px }} html {{ overflow: hidden }}</style>"
            self.load(text, moved, f"--window-size={width},{PIECE}", f"--screenshot={os.path.join(out, f'page-{width}-{piece:02d}.png')}")


def main():
    parser = argparse.ArgumentParser(description="Checks the report's page in headless Chromium.")
    parser.add_argument("--open", action="store_true", help="screenshots with all details open")
    parser.add_argument("page")
    parser.add_argument("out")
    args = parser.parse_args()
    os.makedirs(args.out, exist_ok=True)
    failed = 0
    with Probe(os.path.abspath(args.page)) as probe:
        for width in (390, 1440):
            title, messages = probe.title(opened(probe.text), width)
            print(f"{width} px: {title}; console messages: {len(messages)}")
            for line in messages[:3]:
                print(f"  {line}")
            failed += bool(messages) or not re.match(r"broken: 0 .*overflow: 0$", title)
            probe.shoot(opened(probe.text) if args.open else probe.text, width, args.out)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
