#include "options.h"

#include <fmt/format.h>

#include <charconv>

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
}  // namespace

CLI::Validator whole(uint64_t least, uint64_t most) { return within(least, most, "whole number"); }
CLI::Validator number(double least, double most) { return within(least, most, "number"); }

void add_threads(CLI::App& command, int& threads) {
  command.add_option("--threads", threads, "threads (default: all)")->check(whole(1, 4096));
}

void add_time(CLI::App& command, std::optional<double>& at) {
  command.add_option("--at", at,
                     "time at which the scene's <animation>s are read (default: when the shutter opens, else 0)");
}

void refuse_empty(CLI::App& command) {
  for (CLI::Option* option : command.get_options([](CLI::Option*) { return true; }))
    option->check(
        [](const std::string& text) { return text.empty() ? "is empty; leave it out, or give it a value" : ""; });
}

}  // namespace ajar
