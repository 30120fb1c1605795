// Enters: the values of a JSON file.
// Leaves: the same, asked for by name, or an Error that names file, element and cure.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "ajar/report/json.h"

namespace ajar {

/// A value and its place in the file, for messages. The file's JSON must outlive it.
struct Element {
  const nlohmann::ordered_json* value = nullptr;
  std::string file, place;  ///< place: "scenes[1].size"; empty: the whole file
};

[[noreturn]] void fail(const Element& element, const std::string& what);
/// Fails unless it is an object with these keys only.
void require_keys(const Element& element, const std::vector<std::string>& known);
std::optional<Element> find(const Element& element, const std::string& key);
/// Fails where the key is missing; cure is what to write.
Element get(const Element& element, const std::string& key, const std::string& cure);
std::vector<Element> items(const Element& element, const std::string& cure);

std::string text(const Element& element);
bool flag(const Element& element);
/// A finite number in [least, most].
double number(const Element& element, double least, double most);
int64_t integer(const Element& element, int64_t least, int64_t most);
/// One of the words; its index.
size_t choice(const Element& element, const std::vector<std::string>& words);

}  // namespace ajar
