#!/bin/sh
# lookup.sh PYTHON MOD FOLDER: writes the man pages (man/*.1.gz) and what completes the command in shells
# (completion/SHELL), made from the parser of the command line in MOD.
set -e
rm -rf "$3/man" "$3/completion"
mkdir -p "$3/completion"
cd "$2"
export PYTHONDONTWRITEBYTECODE=1
"$1" -m beltgrinding.cli.man "$3/man"
gzip -9n "$3"/man/*.1
for shell in bash zsh fish; do
    "$1" -m beltgrinding completion $shell >"$3/completion/$shell"
done
