#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <limits>

#include "loader.h"

namespace ajar {
namespace {

constexpr std::string_view blanks = " \t\r\n";

std::string_view trimmed(std::string_view s) {
  const size_t begin = s.find_first_not_of(blanks);
  return begin == s.npos ? std::string_view() : s.substr(begin, s.find_last_not_of(blanks) - begin + 1);
}

// Elements that plugins may have inside.
bool is_parameter(const Node& node) {
  static constexpr const char* tags[] = {"float", "integer", "string",    "boolean",   "rgb",      "srgb", "spectrum",
                                         "point", "vector",  "transform", "blackbody", "texture",  "ref",  "medium",
                                         "bsdf",  "emitter", "volume",    "phase",     "animation"};
  return std::find(std::begin(tags), std::end(tags), node.tag) != std::end(tags);
}

// Whether it is spelt as a number, but is too large for one.
bool is_huge(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  return error == std::errc::result_out_of_range && end == text.data() + text.size();
}

double checked(const Loader& loader, const Node& node, std::string_view value) {
  const std::optional<double> x = to_number(value);
  if (!x && !is_huge(value))
    fail(loader, node, fmt::format("\"{}\" is not a number{}", value.substr(0, 80), about_suffix(value)));
  if (!x || std::abs(*x) > std::numeric_limits<float>::max())
    fail(loader, node, fmt::format("{} is beyond the range of numbers; rescale the scene", value.substr(0, 80)));
  return *x;
}

double number_of(const Loader& loader, const Node& node) {
  if (node.tag != "float" && node.tag != "integer" && node.tag != "string" && node.tag != "spectrum" &&
      node.tag != "rgb")
    fail(loader, node, "one number is expected here: <float name=\"...\" value=\"...\"/>");
  return checked(loader, node, value_of(loader, node));
}

// Mitsuba 0.6 reads an element's numbers and colours first, wherever they stand, and then what is an object.
bool overrules(const Params& params, const Node& later, const Node& earlier) {
  const auto is_object = [](const Node& node) { return node.tag == "texture" || node.tag == "ref"; };
  return !params.loader.document.old || is_object(later) || !is_object(earlier);
}

// Takes the next word of a list from its text; empty at the end.
std::string_view take_word(std::string_view& text) {
  constexpr std::string_view between = ", \t\r\n";
  text.remove_prefix(std::min(text.find_first_not_of(between), text.size()));
  const std::string_view word = text.substr(0, text.find_first_of(between));
  text.remove_prefix(word.size());
  return word;
}

}  // namespace

const std::string& value_of(const Loader& loader, const Node& node) {
  const std::string* value = attribute(node, "value");
  if (value == nullptr) fail(loader, node, "needs value=\"...\"");
  return *value;
}

std::optional<double> to_number(std::string_view text) {
  text = trimmed(text);
  if (text.starts_with('+')) text.remove_prefix(1);
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (text.empty() || end != text.data() + text.size()) return {};
  if (error == std::errc::result_out_of_range) {  // 1e-999 is zero, 1e999 is no number
    const size_t e = text.find_first_of("eE");
    if (e == text.npos || e + 1 >= text.size() || text[e + 1] != '-') return {};
    return 0.0;
  }
  if (error != std::errc() || !std::isfinite(x)) return {};
  return x;
}

std::optional<std::vector<double>> to_numbers(std::string_view text) {
  std::vector<double> list;
  for (std::string_view word; !(word = take_word(text)).empty();) {
    const std::optional<double> x = to_number(word);
    if (!x) return {};
    list.push_back(*x);
  }
  return list;
}

std::string about_suffix(std::string_view text) {
  for (std::string_view word; !(word = take_word(text)).empty();) {
    word.remove_prefix(word.rfind(':') + 1);  // of wavelength:value
    const bool suffixed = word.ends_with('f') || word.ends_with('F');
    if (suffixed && to_number(word.substr(0, word.size() - 1)))
      return fmt::format(": leave out the {}, which Mitsuba does not take either", word.back());
  }
  return {};
}

double number_attribute(const Loader& loader, const Node& node, const char* name, double otherwise) {
  const std::string* value = attribute(node, name);
  const bool left_out = value == nullptr || (value->empty() && loader.document.old);
  return left_out ? otherwise : checked(loader, node, *value);
}

DVec3 vector_of(const Loader& loader, const Node& node, double otherwise) {
  const std::string* value = attribute(node, "value");
  const bool apart = attribute(node, "x") || attribute(node, "y") || attribute(node, "z");
  if (value && apart) fail(loader, node, "has both value and x, y, z; leave one of them out");
  const bool mistyped = !node.attributes.empty() && node.tag != "rotate";
  if (!value && !apart && (mistyped || node.tag == "scale"))
    fail(loader, node, "has neither value nor x, y, z; write one");
  if (value == nullptr)
    return {number_attribute(loader, node, "x", otherwise), number_attribute(loader, node, "y", otherwise),
            number_attribute(loader, node, "z", otherwise)};
  const auto list = to_numbers(*value);
  if (!list || (list->size() != 3 && list->size() != 1))
    fail(loader, node, fmt::format("\"{}\" should be three numbers{}", value->substr(0, 80), about_suffix(*value)));
  for (const double x : *list)
    if (std::abs(x) > std::numeric_limits<float>::max()) fail(loader, node, "is beyond the range of numbers");
  return list->size() == 1 ? DVec3((*list)[0]) : DVec3((*list)[0], (*list)[1], (*list)[2]);
}

const Node* find(Params& params, std::initializer_list<const char*> names) {
  const Node* found = nullptr;
  for (size_t i = 0; i < params.node.children.size(); ++i) {
    const Node& child = params.node.children[i];
    if (std::find(names.begin(), names.end(), child.name) == names.end() || !is_parameter(child)) continue;
    params.used[i] = true;
    const bool counts = found == nullptr || overrules(params, child, *found);
    if (found != nullptr)
      note(params.loader, params.node,
           fmt::format("\"{}\" is given more than once: the {} counts", child.named, counts ? "last one" : "texture"));
    if (counts) found = &child;
  }
  return found;
}

bool has(Params& params, const char* name) {
  return std::any_of(params.node.children.begin(), params.node.children.end(),
                     [&](const Node& child) { return child.name == name; });
}

double number(Params& params, const char* name, double otherwise) {
  const Node* node = find(params, {name});
  return node == nullptr ? otherwise : number_of(params.loader, *node);
}

double positive(Params& params, const char* name, double otherwise) {
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const double x = number_of(params.loader, *node);
  // denormals would become infinite where they divide
  if (!(x >= double(std::numeric_limits<float>::min())))
    fail(params.loader, *node, fmt::format("{} should be greater than 0", value_of(params.loader, *node)));
  return x;
}

int integer(Params& params, const char* name, int otherwise, int low, int high) {
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const double x = number_of(params.loader, *node);
  if (x != std::floor(x) || x < low || x > high)
    fail(params.loader, *node,
         fmt::format("{} should be a whole number from {} to {}", value_of(params.loader, *node), low, high));
  return int(x);
}

int hint(Params& params, const char* name, int otherwise, bool or_unlimited) {
  constexpr double limit = 1 << 30;
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const double x = number_of(params.loader, *node);
  if (!(x >= 1 || (x == -1 && or_unlimited)) || x != std::floor(x))
    fail(params.loader, *node,
         fmt::format("{} should be a whole number, 1 or more{}", value_of(params.loader, *node),
                     or_unlimited ? ", or -1 for no limit" : ""));
  return int(std::min(x, limit));
}

bool boolean(Params& params, const char* name, bool otherwise) {
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const std::string value = lower(std::string(trimmed(value_of(params.loader, *node))));
  if (value == "true" || value == "1") return true;
  if (value == "false" || value == "0") return false;
  fail(params.loader, *node, fmt::format("\"{}\" should be true or false", value.substr(0, 80)));
}

std::string text(Params& params, const char* name, const std::string& otherwise) {
  const Node* node = find(params, {name});
  return node == nullptr ? otherwise : std::string(trimmed(value_of(params.loader, *node)));
}

std::string choice(Params& params, const char* name, const std::string& otherwise,
                   std::initializer_list<const char*> words) {
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const std::string value = lower(std::string(trimmed(value_of(params.loader, *node))));
  if (std::find(words.begin(), words.end(), value) != words.end()) return value;
  unsupported(params.loader, *node,
              fmt::format("\"{}\" is unknown here; known are {}", value.substr(0, 80), fmt::join(words, ", ")),
              otherwise.empty() ? "as if it were not there" : fmt::format("read as {}", otherwise));
  return otherwise;
}

std::string file(Params& params, const char* name) {
  const Node* node = find(params, {name});
  if (node == nullptr) fail(params.loader, params.node, fmt::format("needs <string name=\"{}\" value=\"...\"/>", name));
  const std::string& value = value_of(params.loader, *node);
  const std::string path = find_file(params.loader.document, *node, value);
  if (path.empty()) fail(params.loader, *node, missing_file(params.loader.document, *node, value));
  count_file(params.loader, *node, path);
  return path;
}

std::vector<const Node*> nested(Params& params, std::string_view tag) {
  std::vector<const Node*> list;
  for (size_t i = 0; i < params.node.children.size(); ++i) {
    const Node& child = params.node.children[i];
    const Node& meant = follow(params.loader, child);
    if (meant.tag != tag) continue;
    list.push_back(&meant);
    params.used[i] = true;
  }
  return list;
}

void note_unused(Params& params, std::initializer_list<const char*> harmless) {
  for (size_t i = 0; i < params.node.children.size(); ++i) {
    const Node& child = params.node.children[i];
    if (!params.used[i] && std::find(harmless.begin(), harmless.end(), child.name) == harmless.end())
      note(params.loader, params.node,
           child.name.empty() ? fmt::format("a nested <{}> is not used", child.tag)
                              : fmt::format("the parameter \"{}\" is not used", child.named));
  }
}

void finish(Params& params, std::initializer_list<const char*> harmless) {
  for (size_t i = 0; i < params.node.children.size(); ++i) {
    const Node& child = params.node.children[i];
    if (params.used[i] || is_parameter(child)) continue;
    unsupported(params.loader, child,
                fmt::format("is unknown inside <{} type=\"{}\">", params.node.tag, params.node.written), "left out");
    params.used[i] = true;
  }
  note_unused(params, harmless);
}

}  // namespace ajar
