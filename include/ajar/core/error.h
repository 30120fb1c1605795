// Enters: what went wrong in the user's input.
// Leaves: the one exception type that the command line turns into one line on stderr and exit code 2.
#pragma once

#include <stdexcept>
#include <string>

namespace ajar {

/// An error of the user's making (a file, an option); what() is one line that names file, element and cure.
struct Error : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace ajar
