#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# test.sh: sets up and builds what is missing, then runs the tests labelled fast and ladder.
#   --all        every test: slow and seeded ones too
#   --label L    only the tests labelled L, such as theory-vs-bisection
set -euo pipefail

case "$#:${1-}" in
  0:) selection=(--label-regex '^(fast|ladder)$') ;;
  1:--all) selection=() ;;
  2:--label) selection=(--label-regex "^$2\$") ;;
  *)
    printf 'usage: test.sh [--all | --label LABEL]\n' >&2
    exit 2
    ;;
esac

# shellcheck source=scripts/setup.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

exec ctest --test-dir "$root/build/release" --parallel "$(nproc)" --output-on-failure --no-tests=error "${selection[@]}"
