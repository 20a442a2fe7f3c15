#!/usr/bin/env python3
"""Opens the report in headless Chromium, 390 and 1,440 px wide: no broken image, no console
message, nothing wider than the window. Screenshots are left beside it.

usage: check_page.py INDEX.html OUTDIR
"""
import os
import re
import subprocess
import sys

PROBE = """<script>addEventListener('load', () => {
    const broken = [...document.images].filter(i => !i.complete || !i.naturalWidth).map(i => i.getAttribute('src'));
    document.title = 'broken: ' + broken.length + ' ' + broken.slice(0, 3).join(' ') + '; images: ' + document.images.length +
        '; overflow: ' + Math.max(0, document.documentElement.scrollWidth - document.documentElement.clientWidth);
});</script>"""


def chromium(*options):
    done = subprocess.run(["chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", "--allow-file-access-from-files",
                           "--enable-logging=stderr", "--v=0", *options], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=True)
    return done.stdout, [line for line in done.stderr.splitlines() if "CONSOLE" in line]


def main():
    if len(sys.argv) != 3:
        sys.exit("usage: check_page.py INDEX.html OUTDIR")
    page, out = os.path.abspath(sys.argv[1]), sys.argv[2]
    os.makedirs(out, exist_ok=True)
    probe = os.path.join(os.path.dirname(page), "probe.html")
    with open(page, encoding="utf-8") as f:  # everything opened and loaded, and a word on it in the title
        text = f.read().replace("<details>", "<details open>").replace(' loading="lazy"', "").replace("</head>", PROBE + "</head>")
    with open(probe, "w", encoding="utf-8") as f:
        f.write(text)
    failed = 0
    for width in (390, 1440):
        dom, messages = chromium(f"--window-size={width},2000", "--virtual-time-budget=60000", "--dump-dom", "file://" + probe)
        title = re.search(r"<title>(.*?)</title>", dom)[1]
        _, more = chromium(f"--window-size={width},6000", f"--screenshot={os.path.join(out, f'page-{width}.png')}", "file://" + page)
        messages += more
        print(f"{width} px: {title}; console messages: {len(messages)}")
        for line in messages[:3]:
            print(f"  {line}")
        failed += bool(messages) or not re.match(r"broken: 0 .*overflow: 0$", title)
    os.unlink(probe)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
