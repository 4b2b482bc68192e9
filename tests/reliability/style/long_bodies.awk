# FILE:LINE: LINES of functions with more than 40 lines, where braces stand as clang-format puts them: a body ends with a brace
# as far to the right as the statement that it belongs to begins. NOLINT above a function exempts it.
FNR == 1 { delete begin; head = above = "" }
{ at = match($0, /[^ \t]/) }
/^ *}/ {
  if (begin[at] && FNR - begin[at] > 41)
    print FILENAME ":" begin[at] ": " FNR - begin[at] - 1 " lines"
  delete begin[at]
}
at > 0 && at <= 3 { before = above; head = $0; head_at = at }
/{$/ && !/(namespace|class|struct|enum|union|extern|return|=) ?[^()]*{$/ {
  if ((at <= 3 || head !~ /[;{}:]$/) && head !~ /^ *(class|struct) / && before !~ /NOLINT/)
    begin[head_at] = FNR
}
{ above = $0 }
