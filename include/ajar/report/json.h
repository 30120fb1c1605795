// Enters: a JSON file, or values.
// Leaves: its values, or an Error that names file, place and cure; their text.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace ajar {

/// Throws Error with line, column and cure, also for a key that comes twice.
nlohmann::ordered_json read_json(const std::filesystem::path& path,
                                 const char* cure = "look for a missing comma, quote or bracket");

/// Text over lines indented by so many blanks, or on one line for -1. Bytes that are no UTF-8, as a file's name may
/// have, are replaced.
std::string text_of(const nlohmann::ordered_json& value, int indent);
/// On one line, of forty characters at most: for messages.
std::string short_text_of(const nlohmann::ordered_json& value);

}  // namespace ajar
