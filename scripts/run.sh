#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# run.sh [ARGUMENTS]: sets up and builds what is missing, then runs sphstab with the arguments in the caller's folder.
# Without arguments the main job: the report of Zhang's plate, into reports/.
set -euo pipefail
targets=(sphstab) # read by setup.sh
# shellcheck source=scripts/setup.sh
. "$(dirname -- "${BASH_SOURCE[0]}")/setup.sh"

if [ $# -eq 0 ]; then
  cd -- "$root"
  set -- report zhang-plate --output reports --overwrite
fi
exec "$root/build/release/sphstab" "$@"
