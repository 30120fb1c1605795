#include "element.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "ajar/core/error.h"

namespace ajar {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

void fail(const Element& e, const std::string& what) {
  throw Error(e.place.empty() ? fmt::format("{}: {}", e.file, what) : fmt::format("{}: {}: {}", e.file, e.place, what));
}

void require_keys(const Element& e, const std::vector<std::string>& known) {
  if (!e.value->is_object()) fail(e, fmt::format("is {}; write an object {{...}}", short_text_of(*e.value)));
  for (const auto& [key, value] : e.value->items())
    if (std::find(known.begin(), known.end(), key) == known.end())
      fail(e, fmt::format("unknown key \"{}\"; known are {}", key, fmt::join(known, ", ")));
}

std::optional<Element> find(const Element& e, const std::string& key) {
  const auto at = e.value->find(key);
  if (at == e.value->end()) return {};
  return Element{&*at, e.file, e.place.empty() ? key : e.place + "." + key};
}

Element get(const Element& e, const std::string& key, const std::string& cure) {
  const auto found = find(e, key);
  if (!found) fail(e, fmt::format("\"{}\" is missing; {}", key, cure));
  return *found;
}

std::vector<Element> items(const Element& e, const std::string& cure) {
  if (!e.value->is_array() || e.value->empty()) fail(e, fmt::format("is {}; {}", short_text_of(*e.value), cure));
  std::vector<Element> list;
  for (size_t i = 0; i < e.value->size(); ++i) {
    const Json& item = (*e.value)[i];
    const bool named = item.is_object() && item.contains("name") && item["name"].is_string();
    list.push_back({&item, e.file,
                    named ? fmt::format("{} \"{}\"", e.place, item["name"].get<std::string>())
                          : fmt::format("{}[{}]", e.place, i)});
  }
  return list;
}

std::string text(const Element& e) {
  if (!e.value->is_string() || e.value->get<std::string>().empty())
    fail(e, fmt::format("is {}; write a text in quotes", short_text_of(*e.value)));
  return e.value->get<std::string>();
}

bool flag(const Element& e) {
  if (!e.value->is_boolean()) fail(e, fmt::format("is {}; write true or false", short_text_of(*e.value)));
  return e.value->get<bool>();
}

double number(const Element& e, double least, double most) {
  if (!e.value->is_number() || !(e.value->get<double>() >= least && e.value->get<double>() <= most))
    fail(e, fmt::format("is {}; write a number from {} to {}", short_text_of(*e.value), least, most));
  return e.value->get<double>();
}

int64_t integer(const Element& e, int64_t least, int64_t most) {
  const double whole = number(e, double(least), double(most));
  if (whole != std::floor(whole)) fail(e, fmt::format("is {}; write a whole number", short_text_of(*e.value)));
  return int64_t(whole);
}

size_t choice(const Element& e, const std::vector<std::string>& words) {
  const std::string word = text(e);
  const auto at = std::find(words.begin(), words.end(), word);
  if (at == words.end()) fail(e, fmt::format("\"{}\" is unknown; known are {}", word, fmt::join(words, ", ")));
  return size_t(at - words.begin());
}

}  // namespace ajar
