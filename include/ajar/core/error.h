// Enters: what went wrong in the user's input.
// Leaves: the one exception type that the command line turns into one line on stderr and exit code 2.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

namespace ajar {

/// An error of the user's making (a file, an option); what() is one line that names file, element and cure. Names that
/// it quotes may hold anything: a space stands for what would end the line, or the text.
struct Error : std::runtime_error {
  explicit Error(std::string text) : std::runtime_error(one_line(std::move(text))) {}

 private:
  static std::string one_line(std::string text) {
    for (char& c : text)
      if (static_cast<unsigned char>(c) < ' ') c = ' ';
    return text;
  }
};

}  // namespace ajar
