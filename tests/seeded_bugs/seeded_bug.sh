#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A seeded bug is a patch against the sources that opens with two lines
#   # rung: <regular expression of the ctest names that must go red, such as ^model:every kernel>
#   # breaks: <one sentence>
# The name up to the first colon is the folder of the test, so `model` is built by target test_model.
#
# seeded_bug.sh prepare SOURCE WORK BUILD_TYPE PATCH...  copies the sources, builds the tests named, and sees them green
# seeded_bug.sh check WORK PATCH                         applies the bug to the copy, and sees at least one of them red
set -euo pipefail

fail() {
  printf '%s\n' "$*" >&2
  exit 1
}

header() { sed -n "s/^# $1: //p" "$2"; }

rung() {
  local regex
  regex=$(header rung "$1")
  if [ -z "$regex" ] || [ -z "$(header breaks "$1")" ]; then fail "$1: needs the lines '# rung: ' and '# breaks: '"; fi
  printf '%s\n' "$regex"
}

target() { sed -E 's/^\^?([a-z_]+):.*/test_\1/' <<<"$1"; }

build() { cmake --build "$work/build" --parallel "$(nproc)" --target "$@"; }

run_tests() { ctest --test-dir "$work/build" --no-tests=error --timeout 300 --tests-regex "$1"; }

prepare() {
  local source=$1 build_type=$2 patch regex targets=() regexes=()
  shift 2
  rm -rf -- "$work/tree"
  mkdir -p -- "$work/tree"
  tar -C "$source" --exclude=./build --exclude=./.git -cf - . | tar -C "$work/tree" -xf -
  for patch in "$@"; do
    # An earlier run may have been stopped with the bug built in: newer sources than objects.
    sed -n 's|^+++ b/||p' "$patch" | (cd -- "$work/tree" && xargs -d '\n' touch --)
    regex=$(rung "$patch")
    regexes+=("$regex")
    targets+=("$(target "$regex")")
  done
  cmake -S "$work/tree" -B "$work/build" -G Ninja -D CMAKE_BUILD_TYPE="$build_type"
  build "${targets[@]}"
  for regex in "${regexes[@]}"; do
    run_tests "$regex" || fail "without any bug '$regex' is not green"
  done
}

apply() { patch --directory "$work/tree" --strip 1 --fuzz 0 --input "$bug" "$@"; }

check() {
  local regex
  regex=$(rung "$bug")
  apply --dry-run || fail "$bug does not apply any more"
  trap 'apply --reverse' EXIT
  apply
  build "$(target "$regex")" || fail "$bug does not build"
  if run_tests "$regex"; then fail "not caught: '$regex' stays green although $(header breaks "$bug")"; fi
  printf 'caught: %s\n' "$(header breaks "$bug")"
}

command=$1
shift
case $command in
  prepare)
    work=$2
    prepare "$1" "${@:3}"
    ;;
  check)
    work=$1
    bug=$2
    check
    ;;
esac
