#!/bin/sh
# Generates the host's style headers in its own src/, touching only those that change, and a version
# line without date and user, so that equal sources give equal programs.
set -eu
cd "$1"
keep=$(mktemp -d)
trap 'rm -rf "$keep"' EXIT
cp -p style_*.h version_liggghts.h "$keep" 2>/dev/null || true
for list in style models; do
  said=$(sh Make.sh $list) || { echo "$said"; exit 1; }
done
echo "#define LIGGGHTS_VERSION \"$(cat version_liggghts_branch.txt) $(cat version_liggghts.txt), Calendem plugin\"" >version_liggghts.h
for f in style_*.h version_liggghts.h; do
  if [ -f "$keep/$f" ] && cmp -s "$f" "$keep/$f"; then cp -p "$keep/$f" "$f"; fi
done
