# The C++ of a document as one program: the lines of its blocks in their order, includes before main.
/^```cpp$/ { inside = 1; next }
/^```$/ { inside = 0; next }
!inside { next }
/^#include/ { includes = includes $0 "\n"; next }
{ body = body "  " $0 "\n" }
END { printf "%s\nint main() {\n%s}\n", includes, body }
