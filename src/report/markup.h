// Enters: text.
// Leaves: the same as it can stand in HTML and SVG.
#pragma once

#include <string>

namespace ajar {

inline std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : std::string(1, c);
  return out;
}

}  // namespace ajar
