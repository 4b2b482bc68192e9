#!/usr/bin/env bash
# cases.sh CASE BIN WORK: one case of the tests of the pages. Exit status 0 passed, 1 failed, 77 skipped.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
bin=$2 work=$3

report() { # WHAT: fails when there are lines on stdin
  local found
  found=$(cat)
  [ -z "$found" ] || { echo "$found"; echo "FAILED: $*"; exit 1; }
}
pages() { find README.md CONTRIBUTING.md CHANGELOG.md docs -name '*.md' | LC_ALL=C sort; }

site_builds() { # Sphinx takes a dead link, a missing picture or a page in no table of contents for a mistake
  local status=0
  tools/docs --no-install-dependencies -o "$work/site" || status=$?
  [ $status -ne 2 ] || { echo "skipped: no Sphinx; tools/install-dependencies --docs brings it"; exit 77; }
  [ $status -eq 0 ] || exit 1
  [ -f "$work/site/_static/mathjax/MathJax.js" ] || { echo "FAILED: no MathJax in the site"; exit 1; }
  { grep -rnoE '<(script|img|link|iframe)[^>]* (src|href)="(https?:)?//[^"]*"' "$work/site" --include='*.html' || true; } |
    report "the site must not load anything from elsewhere"
}
# shellcheck disable=SC2016 # backticks of Markdown
paths_exist() { # those of the repository that stand in code, and links of the pages beside docs/
  local page path
  pages | while read -r page; do
    { grep -oE '`(src_plugin|tools|tests|input_scripts|patches|docs)/[A-Za-z0-9_./-]*`' "$page" || true; } | tr -d '`' |
      while read -r path; do [ -e "$path" ] || echo "$page: $path"; done
    { grep -oE '\]\([^)#:]+[)#]' "$page" || true; } | sed 's/^](//; s/.$//' |
      while read -r path; do
        [ -z "$path" ] || [ -e "$(dirname "$page")/$path" ] || echo "$page: $path"
      done
  done | report "these are not there"
}
# Names in the tables of files of the folders' READMEs, and `library/file` in that of the command line.
# shellcheck disable=SC2016 # backticks of Markdown
readmes_name_files() {
  local folder=tools/calendem page name
  grep -oE '`(base|bank|compare|electrode|films|inference|simulate|measure|press|report|diagnose|predict|commands)/[a-z_/]+`' -r "$folder" --include=README.md |
    tr -d '`' | while IFS=: read -r page name; do compgen -G "$folder/$name*" >/dev/null || echo "$page: $name"; done |
    report "these are not there"
  for folder in report inference; do # a table of files, or a list of them: * `name`: …
    page=tools/calendem/$folder/README.md
    grep -qE '^\| file \||^\* `[a-z_]+`:' "$page" || { echo "FAILED: $page lists no files"; exit 1; }
    awk -F'|' '/^\| file \|/ { on = 1 } !/^\|/ { on = 0 } on { print $2 } /^\* `[a-z_]+`:/' "$page" |
      { grep -oE '`[a-z_./]+`' || true; } | tr -d '`' |
      while read -r name; do compgen -G "tools/calendem/$folder/$name*" >/dev/null || echo "$page: $name"; done
  done | report "these are not there"
}
# Lines of commands in blocks of shell, continued lines joined.
# shellcheck disable=SC2016 # awk's
commands() {
  pages | xargs awk '/^```sh/ { in_block = 1; next } /^```/ { in_block = 0 } in_block' |
    sed -e ':a' -e '/\\$/ { N; s/\\\n */ /; ba' -e '}'
}
commands_exist() {
  local program verb help option
  { commands | grep -oE '(build/bin/calendem [a-z]+|tools/[a-z-]+)( [^|;&#]*)?' || true; } |
    while read -r program verb rest; do
      [ ! -d "$program" ] || continue # a folder among the words of a command
      case $program in
        tools/*) help=$("$program" --help) rest="$verb $rest" ;;
        *) help=$("$bin/calendem" "$verb" --help 2>&1) || { echo "no verb: $program $verb"; continue; } ;;
      esac
      for option in $(grep -oE -- '(^| )--[a-z-]+' <<<"$rest" || true); do
        grep -qE -- "(^|[^a-z-])$option([^a-z-]|\$)" <<<"$help" || echo "$program $verb has no $option"
      done
    done | report "commands of the pages that the programs do not know"
}
styles_have_pages() { # each style that the plugin registers has a page with its name
  grep -hoE '^ *((Fix|Compute|Dump|Command)Style\([a-z/_]+|(NORMAL|COHESION|SURFACE)_MODEL\([A-Z_]+, [a-z_]+)|DumpStyle\(platen/vtk|ComputeStyle\(bond/bpm/body' \
    src_plugin/liggghts/*/*.h | sed 's/.*[( ]//' | sort -u |
    while read -r style; do
      grep -qE "^# .*$style" docs/reference/styles/*.md || echo "$style"
    done | report "styles without a page in docs/reference/styles"
}
# shellcheck disable=SC2016 # Markdown
columns_have_a_meaning() { # of every table that the run of the tutorial left
  local file column my
  my=$(dirname "$work")/pages/own_recipe/tree/my/recipe
  [ -f "$my/run/curve.csv" ] || { echo "FAILED: docs.own_recipe left no $my/run/curve.csv"; exit 1; }
  for file in "$my"/{run,electrode}/{curve,breaks,bodies,cracks,thresholds,packing}.csv; do
    [ ! -f "$file" ] || head -n 1 "$file" | tr ',' '\n' | sed -E 's/^(wall|inside_bodies|am_am|am_cbd|cbd_cbd)_/..._/' |
      while read -r column; do
        grep -qF "\`$column\`" docs/reference/files.md || echo "$(basename "$file"): $column"
      done
  done | report "columns that docs/reference/files.md does not have"
}
# shellcheck disable=SC2016 # Markdown
readme_is_short() {
  awk 'END { if (NR > 120) print NR " lines" }' README.md | report "README.md may have 120 lines"
  { grep -v '^```' docs/figures/demo_output.md | grep -vxFf README.md || true; } | report "what the demo prints differs in README.md"
  sed '/^```/,/^```/d; s/\](\([^)]*\))/]/g' README.md | tr '\n' ' ' | { grep -oE '\([^()]*\)' || true; } | awk 'NF > 8' |
    report "a parenthesis of README.md may have 8 words"
}
# shellcheck disable=SC2016 # Markdown
tutorials_have_a_folder_each() { # so that they can be typed one after another
  for page in docs/tutorials/*.md; do
    sed -n '/^```\(sh\|console\)$/,/^```$/p' "$page" | { grep -oE '(-o|mkdir -p|>) ?my/[a-z_]+' || true; } |
      sed "s|.*my/|$page: my/|" | sort -u
  done | sort | awk -F': ' '{ if (++of[$1] > 1 || ++pages[$2] > 1) print }' | report "a tutorial writes into another folder, or into another one's"
}
validation_pages_are_short() { # one question a page
  for page in docs/validation/*.md; do
    awk -v page="$page" 'END { if (NR > 120) print page ": " NR " lines" }' "$page"
  done | report "a page of the validation may have 120 lines; what was tried belongs into docs/validation/history.md"
}
case ${1:-} in
  "" | *[!a-z_]*) echo "usage: cases.sh CASE BIN WORK" >&2; exit 1 ;;
  *) "$1" ;;
esac
