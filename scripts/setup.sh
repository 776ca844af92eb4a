# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by run.sh and test.sh: installs the Debian packages that are missing and builds preset `release`. Says what it
# does on stderr only, because stdout belongs to the program. Builds `targets` if the caller set them, everything
# otherwise. Leaves the repository root in `root`.

root=$(cd -- "$(dirname -- "${BASH_SOURCE[0]}")/.." && pwd)
log=$root/build/setup.log
packages=(g++ cmake ninja-build libeigen3-dev libboost-dev libfmt-dev catch2 libcli11-dev libtomlplusplus-dev
  nlohmann-json3-dev libhdf5-dev gnuplot-nox patch)

say() { printf '%s\n' "$*" >&2; }

# fail <status> <message>: with the log of the step that failed.
fail() {
  cat -- "$log" >&2
  say "$2"
  exit "$1"
}

missing_packages() {
  local package
  for package in "${packages[@]}"; do
    [ "$(dpkg-query -W -f '${db:Status-Status}' "$package" 2>/dev/null)" = installed ] || printf '%s\n' "$package"
  done
}

install_packages() {
  local missing as_root=()
  mapfile -t missing < <(missing_packages)
  [ ${#missing[@]} -gt 0 ] || return 0
  if ! command -v apt-get >/dev/null; then
    say "These packages (Debian 12 names) are needed and there is no apt-get to install them: ${missing[*]}"
    exit 2
  fi
  if [ "$(id -u)" -ne 0 ]; then as_root=(sudo); fi
  say "installing ${missing[*]}"
  {
    "${as_root[@]}" apt-get update &&
      "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends "${missing[@]}"
  } >"$log" 2>&1 || fail 2 "Could not install: ${missing[*]}"
}

build() {
  local folder=$root/build/release
  if [ ! -e "$folder/build.ninja" ]; then
    say "building for the first time: a few minutes"
    (cd -- "$root" && cmake --preset release) >"$log" 2>&1 || fail 4 "The configuration failed."
  fi
  cmake --build "$folder" --parallel "$(nproc)" ${targets:+--target "${targets[@]}"} >"$log" 2>&1 || fail 4 "The build failed."
}

# One at a time: programs that call run.sh side by side share the build folder.
mkdir -p -- "$root/build"
exec {lock}>"$root/build/setup.lock"
flock "$lock"
install_packages
build
exec {lock}>&-
