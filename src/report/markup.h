// Enters: text.
// Leaves: the same as it can stand in HTML and SVG.
#pragma once

#include <string>

#include "ajar/report/json.h"

namespace ajar {

/// Bytes that are no UTF-8, and control characters, are replaced: XML has none.
inline std::string escaped(const std::string& text) {
  const auto valid = nlohmann::ordered_json::parse(text_of(text, -1)).get<std::string>();
  std::string out;
  for (const char c : valid)
    out += c == '<' ? "&lt;" : c == '&' ? "&amp;" : c >= 0 && c < ' ' ? " " : std::string(1, c);
  return out;
}

}  // namespace ajar
