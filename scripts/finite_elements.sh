#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# finite_elements.sh: natural frequencies of the free annulus and the free rectangle of Zhang's Table 2 by CalculiX, a
# finite-element program independent of this one, as CSV on stdout; the report natural-frequencies is made with it.
#   finite_elements.sh                                          every mesh and Poisson ratio of the report
#   finite_elements.sh BODY PLANE POISSON_RATIO ALONG ACROSS    one run: annulus or rectangle, stress or strain, and the
#                                                               elements around or along the body and across it
# Quadratic elements, fully integrated and curved on the annulus. The three rigid motions are left out.
set -euo pipefail

case $#:${1-}:${2-} in
  0::* | 5:annulus:stress | 5:annulus:strain | 5:rectangle:stress | 5:rectangle:strain) ;;
  *)
    printf 'usage: finite_elements.sh [annulus|rectangle stress|strain POISSON_RATIO ALONG ACROSS]\n' >&2
    exit 2
    ;;
esac
command -v ccx >/dev/null || {
  printf 'finite_elements.sh: there is no ccx (CalculiX) on this machine; in Debian: apt-get install calculix-ccx\n' >&2
  exit 2
}
folder=$(mktemp -d)
trap 'rm -rf -- "$folder"' EXIT

# mesh BODY PLANE POISSON_RATIO ALONG ACROSS: the input of CalculiX, in SI units. It turns plane elements into one layer
# of solid ones; in plane stress these must be thin beside their width (1/50: frequencies within 1e-7).
mesh() {
  awk -v body="$1" -v plane="$2" -v poisson_ratio="$3" -v along="$4" -v across="$5" '
    # Nodes lie on half elements (i, j); around the annulus the last column is the first.
    function node(i, j) { return i % columns + columns * j + 1 }
    BEGIN {
      turn = 8 * atan2(1, 1)
      columns = body == "annulus" ? 2 * along : 2 * along + 1
      print "*NODE, NSET=nodes"
      for (j = 0; j <= 2 * across; j++)
        for (i = 0; i < columns; i++) {
          if (i % 2 && j % 2) continue  # the middle of an element has no node
          u = i / (2 * along); v = j / (2 * across)
          radius = 5e-4 - 2.5e-4 * v
          x = body == "annulus" ? radius * cos(turn * u) : 5e-4 * u
          y = body == "annulus" ? radius * sin(turn * u) : 2.5e-4 * v
          printf "%d, %.12e, %.12e\n", node(i, j), x, y
        }
      print "*ELEMENT, ELSET=body, TYPE=" (plane == "stress" ? "CPS8" : "CPE8")
      for (j = 0; j < 2 * across; j += 2)
        for (i = 0; i < 2 * along; i += 2)
          printf "%d, %d, %d, %d, %d, %d, %d, %d, %d\n", ++element,
            node(i, j), node(i + 2, j), node(i + 2, j + 2), node(i, j + 2),
            node(i + 1, j), node(i + 2, j + 1), node(i + 1, j + 2), node(i, j + 1)
      print "*MATERIAL, NAME=solid\n*ELASTIC\n650, " poisson_ratio "\n*DENSITY\n1000"
      printf "*SOLID SECTION, ELSET=body, MATERIAL=solid\n%.12e\n", 2.5e-4 / across / 50
      print "*STEP\n*FREQUENCY\n18\n*END STEP"
    }'
}

# run BODY PLANE POISSON_RATIO ALONG ACROSS: one line a mode. Rigid motions come out below 0.1 Hz.
run() {
  mesh "$@" >"$folder/plate.inp"
  ccx -i "$folder/plate" >"$folder/log" || {
    cat -- "$folder/log" >&2
    exit 1
  }
  awk -v body="$1" -v plane="$2" -v poisson_ratio="$3" -v elements="$4x$5" '
    /P A R T I C I P A T I O N/ { exit }
    NF == 5 && $1 ~ /^[0-9]+$/ && $4 > 1 {
      printf "%s,%s,%s,%s,%d,%.7g\n", body, plane, poisson_ratio, elements, ++mode, $4
    }' "$folder/plate.dat"
}

echo body,plane,poisson_ratio,elements,mode,frequency_hz
if [ $# -gt 0 ]; then
  run "$@"
  exit
fi
for plane in stress strain; do
  for refinement in 1 2 4; do
    run annulus "$plane" 0.3 $((48 * refinement)) $((8 * refinement))
    run rectangle "$plane" 0.3 $((32 * refinement)) $((16 * refinement))
  done
  for poisson_ratio in 0 0.05 0.1 0.15 0.2 0.25 0.35 0.4 0.45 0.49; do
    run annulus "$plane" "$poisson_ratio" 48 8
    run rectangle "$plane" "$poisson_ratio" 32 16
  done
done
