// Enters: the words of a command line.
// Leaves: what they ask for, done; help and the version on standard output.
#pragma once

#include <string>
#include <vector>

namespace ajar {

/// WORDS are those after the program's name, subcommand first. Throws Error for a line that cannot be understood and
/// for what the command cannot do, Interrupted for one that was stopped.
void run_command_line(std::vector<std::string> words);

}  // namespace ajar
