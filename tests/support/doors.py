"""What processes listen on, as the kernel tells: every socket by which another process could begin to speak to them."""

import os
import socket
import struct
from pathlib import Path

from support.workers import descendants

LISTENS, UNCONNECTED = "0A", "07"  # states of TCP and UDP
ACCEPTS = 0x10000  # a flag of UNIX sockets
DATAGRAMS, ALONE = (
    2,
    "01",
)  # a kind and a state of them: a name alone lets letters in where there is no other end


def doors(pid, family=True):
    """["PID NAME: KIND ADDRESS"] of a process and, with ``family``, of all that descend from it."""
    found = []
    for one in [pid, *(descendants(pid) if family else ())]:
        try:
            name = Path("/proc", str(one), "comm").read_text().strip()
            found += [f"{one} {name}: {door}" for door in _of_process(Path("/proc", str(one)))]
        except OSError:  # it has ended
            continue
    return found


def _of_process(process):
    held = set()
    for number in os.scandir(process / "fd"):
        try:
            text = os.readlink(number.path)
        except OSError:
            continue
        if text.startswith("socket:["):
            held.add(text[len("socket:[") : -1])
    if not held:
        return []
    found = []
    for kind, state in (
        ("tcp", LISTENS),
        ("tcp6", LISTENS),
        ("udp", UNCONNECTED),
        ("udp6", UNCONNECTED),
    ):
        for words in _rows(process / "net" / kind):
            if words[3] == state and words[9] in held:
                found.append(f"{kind} {_address(words[1])}")
    for words in _rows(process / "net" / "unix"):
        kind, state = int(words[4], 16), words[5]
        named = kind == DATAGRAMS and state == ALONE and len(words) > 7
        if words[6] in held and (int(words[3], 16) & ACCEPTS or named):
            found.append(f"unix {' '.join(words[7:]) or 'without a name'}")
    return found


def _rows(path):
    try:
        return [line.split() for line in path.read_text().splitlines()[1:]]
    except FileNotFoundError:  # a kernel without IPv6
        return []


def _address(text):
    host, port = text.split(":")
    words = struct.pack(
        f"={len(host) // 8}I", *(int(host[k : k + 8], 16) for k in range(0, len(host), 8))
    )
    family = socket.AF_INET if len(words) == 4 else socket.AF_INET6
    return f"{socket.inet_ntop(family, words)}:{int(port, 16)}"
