"""folder_search.py SITE: lets the theme's search work where the pages are opened from a folder, too. There a browser
lets no page fetch the index or start a worker from a file: both come as a script, which a server's pages do not load.
"""

import json
import re
import sys
from pathlib import Path

site = Path(sys.argv[1])
index = json.loads((site / "search" / "search_index.json").read_text("utf-8"))
(worker,) = (site / "assets" / "javascripts" / "workers").glob("search.*.js")
code = json.dumps(worker.read_text("utf-8").partition("//# sourceMappingURL")[0])
(site / "search" / "folder.js").write_text(
    f"__search = {{index: Promise.resolve({json.dumps(index)}),\n"
    f'worker: URL.createObjectURL(new Blob([{code}], {{type: "text/javascript"}}))}}\n',
    "utf-8",
)
changed = 0
for page in site.rglob("*.html"):
    text, count = re.subn(
        r'<script src="([^"]*)assets/javascripts/bundle',
        r'<script>if (location.protocol === "file:") '
        r"""document.write('<script src="\1search/folder.js"><\\/script>')</script>\g<0>""",
        page.read_text("utf-8"),
    )
    if count:
        page.write_text(text, "utf-8")
    changed += count
if not changed:
    sys.exit("The theme's script is not where it was: the search would not work from a folder")
