#!/usr/bin/env bash
# The web UI's packages, as webui/package-lock.json names them, into webui/node_modules; nothing when they are there.
# usage: tools/webui_packages.sh
set -euo pipefail
cd "$(dirname "$0")/../webui"

# npm ci starts from nothing each time, so it runs only when the lock file changed since the last time.
lock=package-lock.json stamp=node_modules/.tassilo-lock
is_current() { [ -f "$stamp" ] && cmp -s "$lock" "$stamp"; }

if is_current; then exit 0; fi
# Builds of two presets may both want them.
exec 9>.install.lock
if command -v flock >/dev/null; then flock 9; fi
if is_current; then exit 0; fi
# No package's own scripts: none of ours needs any.
if ! npm ci --ignore-scripts --no-audit --no-fund; then
  echo "webui: npm could not install the packages, see above; -DTASSILO_WEBUI=OFF builds Tassilo without pages" >&2
  exit 1
fi
cp "$lock" "$stamp"
