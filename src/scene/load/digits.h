// Enters: text.
// Leaves: the numbers at its start, read as the C locale would, whatever the user's locale is.
#pragma once

#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <string>

namespace ajar {

/// Reads a number at [p, end): sign, decimals, exponent (1e-007 too), inf, nan. Returns the first character after it,
/// or p where there is none. Too large a number becomes infinite, too small a one zero.
inline const char* read_number(const char* p, const char* end, double& out) {
  const char* begin = p;
  if (p != end && *p == '+') ++p;
  if (p != end && *p == '-' && p != begin) return begin;
  const auto [rest, error] = std::from_chars(p, end, out);
  if (error == std::errc::invalid_argument) return begin;
  if (error == std::errc::result_out_of_range) out = std::strtod(std::string(p, rest).c_str(), nullptr);
  return rest;
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
