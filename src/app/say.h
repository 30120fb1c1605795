// Enters: what the user should be told; the three streams as the shell left them.
// Leaves: it, on standard output or error. Where nobody reads these any more it is lost, and the work goes on.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <vector>

namespace ajar {

/// Before anything else: Ctrl-C is heard, which shells have what scripts leave to the background ignore; a reader that
/// has gone and a limit on the size of files become errors of writing, where they would end the program without a word;
/// and no file that is opened takes the place of a stream that was closed.
void guard_streams();

/// Never throws, as fmt::print does where a pipe is broken. Standard output is looked at once more at the end.
template <class... T>
void say(std::FILE* to, fmt::format_string<T...> format, T&&... values) {
  const std::string text = fmt::format(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), to);
}

/// A line on standard error for each.
void say_notes(const std::vector<std::string>& notes);

}  // namespace ajar
