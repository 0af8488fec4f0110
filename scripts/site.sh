#!/usr/bin/env bash
# Builds the documentation as a site, build/site: open build/site/index.html. Installs what it needs first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/bootstrap.sh

usage="Usage: scripts/site.sh

Builds the pages of docs/, and a reference of the C, C++ and Python interfaces, as a site in build/site. Its search works
without a server. Exit code 1 if a link leads nowhere or a page is missing in mkdocs.yml.
  -h, --help   print this help"

case "$#:${1:-}" in
    0:) ;;
    1:-h | 1:--help) echo "$usage" && exit 0 ;;
    *) refuse "'$*': expected no arguments" ;;
esac

bootstrap test

# Said at every start: what will replace MkDocs. With --quiet, --strict would not see warnings.
export NO_MKDOCS_2_WARNING=1
.venv/bin/python -m mkdocs build --strict || fail "mkdocs build" "See its messages above"
echo "Built the site: open build/site/index.html"
