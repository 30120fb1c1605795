// Enters: a command of the program.
// Leaves: options that several commands share, and checks of what is typed. The one header that brings CLI11 with it.
#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace ajar {

/// For check(): a whole number in that range; one that no type holds is refused as well.
CLI::Validator whole(uint64_t least, uint64_t most);
/// The same for any number.
CLI::Validator number(double least, double most);
/// For check(CLI::IsMember()): the names of an enumeration's values.
std::vector<std::string> listed(std::span<const char* const> names);
/// The value whose name that is; the check let no other pass.
size_t index_of(std::span<const char* const> names, const std::string& name);
/// The option --threads; 0 where it is not given: all.
void add_threads(CLI::App& command, int& threads);
/// The option --at of commands that look at one moment.
void add_time(CLI::App& command, std::optional<double>& at);
/// Whole numbers are decimal: 010 is ten.
void read_decimal(CLI::App& command);
/// Values that are there but empty are errors: they come of shell variables that nobody set.
void refuse_empty(CLI::App& command);

}  // namespace ajar
