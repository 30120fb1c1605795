// Enters: text.
// Leaves: the numbers at its start, read as the C locale would, whatever the user's locale is.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>

namespace ajar {

/// After the 1. of what Microsoft's libraries write for numbers that are none (1.#INF, -1.#IND00, 1.#QNAN): reads the
/// rest of it. Returns p where there is none.
inline const char* read_no_number(const char* p, const char* end, double& out) {
  const std::string_view text(p, size_t(end - p));
  const auto numbers = std::numeric_limits<double>();
  for (const std::string_view name : {"#INF", "#IND", "#QNAN", "#SNAN"}) {
    if (!text.starts_with(name)) continue;
    out = name == "#INF" ? out * numbers.infinity() : numbers.quiet_NaN();
    for (p += name.size(); p != end && *p == '0';) ++p;
    return p;
  }
  return p;
}

/// Reads a number at [p, end): sign, decimals, exponent (1e-007 too), inf, nan. Returns the first character after it,
/// or p where there is none. Too large a number becomes infinite, too small a one zero.
inline const char* read_number(const char* p, const char* end, double& out) {
  const char* begin = p;
  if (p != end && *p == '+') ++p;
  if (p != end && *p == '-' && p != begin) return begin;
  const auto [rest, error] = std::from_chars(p, end, out);
  if (error == std::errc::invalid_argument) return begin;
  if (error == std::errc::result_out_of_range) out = std::strtod(std::string(p, rest).c_str(), nullptr);
  return rest != end && *rest == '#' && rest[-1] == '.' ? read_no_number(rest, end, out) : rest;
}

/// The same for an integer; p where there is none or where it does not fit.
inline const char* read_integer(const char* p, const char* end, int64_t& out) {
  const char* begin = p;
  if (p != end && *p == '+') ++p;
  if (p != end && *p == '-' && p != begin) return begin;
  const auto [rest, error] = std::from_chars(p, end, out);
  return error == std::errc() ? rest : begin;
}

}  // namespace ajar
