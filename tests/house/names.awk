# Files of a room are compiled joined, a number at a time that differs from build to build: what two of them have for
# themselves may not share a name. Reads files src/ROOM/...cpp; prints, of what begins a line in their namespaces without a
# name, each type, constant and function (by the types of its arguments) that two files define.
FNR == 1 { inside = open = 0; split(FILENAME, folders, "/"); room = folders[2] }
/^namespace \{/ { inside = 1; next }
/^\}  \/\/ namespace$/ { inside = 0; next }
!inside || /^(template|using|namespace|static_assert|\/\/|#|\}|$)/ { next }
/^[^ ]/ { text = $0; open = 1 }
/^ / && open { sub(/^ +/, " "); text = text $0 }
open && /[{;]/ {
  open = 0
  gsub(/\[\[[^]]*\]\] */, "", text)
  head = text
  sub(/[{;=(].*/, "", head)
  sub(/(\[| :).*/, "", head)
  sub(/ +$/, "", head)
  arguments = ""
  if (substr(text, length(head) + 1, 1) == "(") {
    given = substr(text, length(head) + 2)
    sub(/\)[^)]*[{;].*/, "", given)
    count = split(given, each, ",")
    for (i = 1; i <= count; i++) {
      sub(/ = .*/, "", each[i])
      sub(/[A-Za-z_0-9]+$/, "", each[i])
      arguments = arguments "," each[i]
    }
    gsub(/ /, "", arguments)
    arguments = "(" substr(arguments, 2) ")"
  }
  count = split(head, each, /[ *&]/)
  name = each[count] arguments
  if ((room, name) in seen && seen[room, name] != FILENAME) print FILENAME ": " seen[room, name] " has a " name " too"
  seen[room, name] = FILENAME
}
