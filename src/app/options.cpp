#include "options.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "ajar/core/parallel.h"

namespace ajar {
namespace {
template <class T>
CLI::Validator within(T least, T most, const char* kind) {
  const auto check = [=](const std::string& text) -> std::string {
    T x = 0;
    const char* end = text.data() + text.size();
    const auto [rest, failed] = std::from_chars(text.data(), end, x);
    if (failed == std::errc() && rest == end && x >= least && x <= most) return {};
    return fmt::format("{} is no {} from {} to {}", text, kind, least, most);
  };
  return CLI::Validator(check,
                        most < T(1 << 20) ? fmt::format("{} to {}", least, most) : fmt::format("from {}", least));
}

// CLI11 reads numbers as C does: 010 would be eight.
std::string decimal(std::string& text) {
  const size_t sign = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  if (const std::string begin = text.substr(sign, 2); begin == "0x" || begin == "0X")
    return fmt::format("{} is no decimal number; write one, such as 8", text);
  if (text.find_first_not_of("0123456789", sign) != text.npos) return {};  // told as it stands
  if (text.find_first_not_of('0', sign) != text.npos)
    text.erase(sign, text.find_first_not_of('0', sign) - sign);
  else if (text.size() > sign)
    text = "0";
  return {};
}

}  // namespace

CLI::Validator whole(uint64_t least, uint64_t most) { return within(least, most, "whole number"); }
CLI::Validator number(double least, double most) { return within(least, most, "number"); }

std::vector<std::string> listed(std::span<const char* const> names) { return {names.begin(), names.end()}; }
size_t index_of(std::span<const char* const> names, const std::string& name) {
  return size_t(std::find(names.begin(), names.end(), name) - names.begin());
}

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads (default: all)")->check(whole(1, most_threads));
}

void add_time(CLI::App& command, std::optional<double>& at) {
  command.add_option("--at", at,
                     "time at which the scene's <animation>s are read (default: when the shutter opens, else 0)");
}

void read_decimal(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](CLI::Option*) { return true; }))
    if (const std::string type = option->get_type_name(); type.starts_with("INT") || type.starts_with("UINT"))
      option->transform(CLI::Validator(decimal, ""));
}

void refuse_empty(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](CLI::Option*) { return true; }))
    option->check([option](const std::string& text) {
      if (!text.empty()) return "";
      return option->get_required() ? "is empty; give it a value" : "is empty; leave it out, or give it a value";
    });
}

}  // namespace ajar
