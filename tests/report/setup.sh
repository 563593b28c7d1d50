#!/bin/sh
# Puts the pinned Playwright into a folder of the build: setup.sh FOLDER [NPM]. It drives Debian's Chromium and
# brings no browser of its own. Debian 12's node 18 can run this version.
set -eu
folder=$1
npm=${2:-npm}
version=1.60.0

installed=$(sed -n 's/^ *"version": "\(.*\)",*$/\1/p' "$folder/node_modules/playwright-core/package.json" 2>/dev/null || true)
[ "$installed" != "$version" ] || exit 0
mkdir -p "$folder"
cd "$folder"
[ -f package.json ] || echo '{"private": true}' > package.json
if ! PLAYWRIGHT_SKIP_BROWSER_DOWNLOAD=1 "$npm" install --no-save --no-package-lock --ignore-scripts --no-audit --no-fund \
        --fetch-retries=1 --fetch-timeout=60000 "playwright-core@$version"; then
    echo "report test: npm could not install playwright-core $version into $folder; is npm's registry reachable?" >&2
    exit 1
fi
