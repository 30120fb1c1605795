// Enters: the text of a Wavefront file, OBJ or MTL.
// Leaves: its lines word by word, number by number, with messages that name the line.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

#include "ajar/core/error.h"
#include "digits.h"

namespace ajar {

struct Cursor {
  const char* p;
  const char* end;
  const std::string& name;
  uint32_t line = 1;

  [[noreturn]] void fail(const std::string& what) const { throw Error(fmt::format("{}:{}: {}", name, line, what)); }

  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  bool at_break() const { return p == end || *p == '\n' || *p == '\r'; }

  // Ends a line: LF, CR LF or CR.
  void take_break() {
    if (p == end) return;
    if (*p == '\r' && p + 1 != end && p[1] == '\n') ++p;
    ++p, ++line;
  }

  // Blanks, and line breaks that a backslash before them takes back.
  void skip_blanks() {
    while (p != end) {
      if (is_blank(*p)) {
        ++p;
      } else if (*p == '\\') {
        const char* q = p + 1;
        while (q != end && is_blank(*q)) ++q;
        if (q != end && *q != '\n' && *q != '\r') return;
        p = q;
        take_break();
      } else {
        return;
      }
    }
  }

  // At the end of what a statement says: a line break or a comment.
  bool at_end() {
    skip_blanks();
    return at_break() || *p == '#';
  }

  // To the start of the next line. A comment is not continued.
  void skip_line() {
    while (!at_break()) ++p;
    take_break();
  }

  bool ends_token() const { return at_break() || is_blank(*p) || *p == '#' || *p == '\\'; }

  std::string token() const {
    const char* q = p;
    while (q != end && q - p < 40 && !is_blank(*q) && *q != '\n' && *q != '\r') ++q;
    return std::string(p, q);
  }

  // The word at which a statement begins.
  std::string_view word() {
    const char* begin = p;
    while (!ends_token()) ++p;
    return {begin, size_t(p - begin)};
  }

  // Up to n numbers; returns how many there were.
  int numbers(double* out, int n) {
    int count = 0;
    for (; count < n && !at_end(); ++count) {
      const char* rest = read_number(p, end, out[count]);
      const char* token_start = std::exchange(p, rest);
      if (rest == token_start || !ends_token()) p = token_start, fail(fmt::format("\"{}\" is not a number", token()));
    }
    return count;
  }
};

/// The rest of the line as a name or several: names have blanks.
inline std::string_view read_name(Cursor& in) {
  in.skip_blanks();
  const char* begin = in.p;
  while (!in.at_break()) ++in.p;
  const char* end = in.p;
  while (end != begin && Cursor::is_blank(end[-1])) --end;
  return {begin, size_t(end - begin)};
}

}  // namespace ajar
