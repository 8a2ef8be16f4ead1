"""library.py PAGE FOLDER: writes from docs/library.md what its reader types and sees: first.cpp, its first block;
printed, the second; packages, those of the line of apt; commands, the block after it.
"""

import re
import sys
from pathlib import Path

page, folder = map(Path, sys.argv[1:])
blocks = [
    "\n".join(line[4:] for line in block.splitlines()).strip() + "\n"
    for block in re.findall(r"(?:^(?: {4}.*)?\n)+", page.read_text("utf-8"), re.M)
    if block.strip()
]
program, printed = blocks[:2]
(apt,) = [k for k, block in enumerate(blocks) if block.startswith("sudo apt install ")]
folder.joinpath("first.cpp").write_text(program)
folder.joinpath("printed").write_text(printed)
folder.joinpath("packages").write_text("\n".join(blocks[apt].split()[3:]) + "\n")
folder.joinpath("commands").write_text(blocks[apt + 1])
