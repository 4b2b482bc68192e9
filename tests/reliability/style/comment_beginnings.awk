# Comments that begin with a word that hangs on what stands elsewhere: a comment has a subject and a verb.
FNR == 1 { above = 0; mark = FILENAME ~ /[.](h|cpp|js)$/ ? "//[/!]?<?" : "#" }
{ whole = $0 ~ "^[ \t]*" mark "( |$)" }
$0 ~ "(^|[ \t])" mark " (Of|That|Those|And|Then|The same)([^A-Za-z]|$)" && !(whole && above) { print FILENAME ":" FNR ": " $0 }
{ above = whole }
