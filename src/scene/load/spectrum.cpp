#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <limits>
#include <sstream>

#include "ajar/core/srgb.h"
#include "loader.h"

namespace ajar {
namespace {

Rgb checked(Loader& loader, const Node& node, Rgb c, Colour kind) {
  if (!is_finite(c)) fail(loader, node, "is beyond the range of numbers; take smaller ones");
  const bool is_number = node.tag == "float" || node.tag == "integer" || node.tag == "string";
  if (std::min({c.x, c.y, c.z}) < 0) {
    note(loader, node,
         is_number ? "a negative number: it was set to 0"
                   : "a colour outside the sRGB primaries: negative parts were set to 0");
    c = glm::max(c, Rgb(0));
  }
  if (kind == Colour::reflectance && max_component(c) > 1) {
    const bool scales = loader.document.old && !is_number;  // as Mitsuba 0.6
    note(loader, node,
         is_number ? "a number above 1 where a share is meant: it was set to 1"
                   : fmt::format("a reflectance above 1 would make light from nothing: it was {}",
                                 scales ? "scaled to 0.99" : "set to 1"));
    c = scales ? c * (0.99f / max_component(c)) : glm::min(c, Rgb(1));
  }
  return c;
}

Rgb rgb_of(const Loader& loader, const Node& node, bool encoded) {
  std::string_view value = value_of(loader, node);
  while (value.starts_with(' ')) value.remove_prefix(1);
  while (value.ends_with(' ')) value.remove_suffix(1);
  DVec3 c;
  if (value.starts_with('#')) {
    uint32_t hex = 0;
    const auto [end, error] = std::from_chars(value.data() + 1, value.data() + value.size(), hex, 16);
    if (value.size() != 7 || error != std::errc() || end != value.data() + value.size())
      fail(loader, node, fmt::format("\"{}\" should be #rrggbb", value.substr(0, 80)));
    c = DVec3(hex >> 16, hex >> 8 & 255, hex & 255) / 255.0;
  } else {
    const auto list = to_numbers(value);
    if (!list || (list->size() != 3 && list->size() != 1))
      fail(loader, node,
           fmt::format("\"{}\" should be one number, three or #rrggbb{}", value.substr(0, 80), about_suffix(value)));
    c = list->size() == 1 ? DVec3((*list)[0]) : DVec3((*list)[0], (*list)[1], (*list)[2]);
  }
  return encoded ? Rgb(decode_srgb(c.x), decode_srgb(c.y), decode_srgb(c.z)) : Rgb(c);
}

using List = std::vector<std::pair<double, double>>;

// "400:0.1, 500:0.2"
List pairs_of(const Loader& loader, const Node& node, std::string value) {
  for (char& c : value)
    if (c == ',') c = ' ';
  List list;
  std::istringstream words(value);
  for (std::string word; words >> word;) {
    const size_t colon = word.find(':');
    std::string second = colon == word.npos ? "" : word.substr(colon + 1);
    if (colon != word.npos && second.empty()) words >> second;  // "400: 0.1"
    const auto nm = to_number(word.substr(0, colon)), x = to_number(second);
    if (!nm || !x)
      fail(loader, node, fmt::format("\"{}\" should be wavelength:value{}", word.substr(0, 80), about_suffix(value)));
    list.emplace_back(*nm, *x);
  }
  return list;
}

List pairs_of_file(Loader& loader, const Node& node, const std::string& name) {
  const std::string path = find_file(loader.document, node, name);
  if (path.empty()) fail(loader, node, missing_file(loader.document, node, name));
  count_file(loader, node, path);
  List list;
  std::istringstream lines{std::string(without_mark(read_text(path)))};
  int number = 0;
  bool more = false;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.erase(std::min(line.find('#'), line.size()));
    const auto pair = to_numbers(line);
    if (pair && pair->size() > 2 && !more) {
      more = true;
      note(loader, node, fmt::format("{}:{}: a wavelength and a value are read of each line", path, number));
    }
    if (!pair || pair->size() == 1)
      fail(loader, node,
           fmt::format("{}:{}: \"{}\" should be a wavelength and a value", path, number, shortened(line)));
    if (!pair->empty()) list.emplace_back((*pair)[0], (*pair)[1]);
  }
  return list;
}

// Mitsuba 0.x lets a list fall to zero over what its wavelengths are apart in the mean.
void let_fall(List& list) {
  std::stable_sort(list.begin(), list.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  const double step = (list.back().first - list.front().first) / double(list.size() - 1);
  if (list.front().second != 0) list.insert(list.begin(), {list.front().first - step, 0});
  if (list.back().second != 0) list.emplace_back(list.back().first + step, 0);
}

// In version 0.x surfaces are seen under equal energy too.
Rgb of_list(Loader& loader, const Node& node, List list, Colour kind) {
  if (list.empty()) fail(loader, node, "holds no wavelengths");
  for (const auto& [nm, x] : list)
    if (!(nm > 0 && nm < 1e6) || !(std::abs(x) < 1e30)) fail(loader, node, fmt::format("{}:{} is out of range", nm, x));
  if (loader.document.old && list.size() > 1) let_fall(list);
  const bool bright = std::any_of(list.begin(), list.end(), [](const auto& pair) { return pair.second > 0; });
  const Rgb c = rgb_of_list(std::move(list), loader.document.old ? Colour::emission : kind);
  if (bright && is_black(c))
    note(loader, node,
         "black, since nothing of it can be seen: wavelengths are in nm, and between two of them, 360 to 830");
  return c;
}

Rgb plain_spectrum(Loader& loader, const Node& node, Colour kind) {
  if (const std::string* name = attribute(node, "filename"))
    return of_list(loader, node, pairs_of_file(loader, node, *name), kind);
  const std::string& value = value_of(loader, node);
  if (value.find(':') != value.npos) return of_list(loader, node, pairs_of(loader, node, value), kind);
  return rgb_of(loader, node, false);
}

double kelvin_of(const Loader& loader, const Node& node, std::string_view value) {
  while (value.ends_with(' ')) value.remove_suffix(1);
  if (value.ends_with('K') || value.ends_with('k')) value.remove_suffix(1);
  const auto kelvin = to_number(value);
  if (!kelvin || !(*kelvin > 0 && *kelvin <= 1e6))
    fail(loader, node, fmt::format("\"{}\" should be a temperature up to 1e6 kelvin", value.substr(0, 80)));
  return *kelvin;
}

// Whether a <spectrum> or <texture>, which are one to Mitsuba 3, has a type.
bool is_plugin(const Node& node) { return (node.tag == "spectrum" || node.tag == "texture") && !node.type.empty(); }

// The texture or spectrum inside a d65, if any; its color is none.
const Node* lit(Params& p) {
  const Node* found = nullptr;
  for (size_t i = 0; i < p.node.children.size(); ++i) {
    const Node &child = p.node.children[i], &meant = follow(p.loader, child);
    if (child.name == "color" || (!is_texture(meant) && !is_plugin(meant))) continue;
    if (found != nullptr) fail(p.loader, child, "is the second texture or spectrum in a d65; leave one of them out");
    found = &child;
    p.used[i] = true;
  }
  return found;
}

// Where a regular spectrum begins and ends. range is how Mitsuba's manual has it.
std::pair<double, double> range_of(Params& p) {
  const std::string words = text(p, "range", "");
  if (words.empty())
    return {number(p, "wavelength_min", number(p, "lambda_min", 360)),
            number(p, "wavelength_max", number(p, "lambda_max", 830))};
  const auto ends = to_numbers(words);
  if (!ends || ends->size() != 2)
    fail(p.loader, p.node, fmt::format("range \"{}\" should be two wavelengths", shortened(words)));
  return {(*ends)[0], (*ends)[1]};
}

// values and wavelengths in separate strings (Mitsuba 2, 3), or one <spectrum> of both (from 3.7 on)
Rgb tabulated(Params& p, Colour kind) {
  if (const Node* list = find(p, {"value"}); list != nullptr && list->tag == "spectrum")
    return colour_of(p.loader, *list, kind);
  const auto values = to_numbers(text(p, "values", text(p, "value", "")));
  if (!values || values->empty()) fail(p.loader, p.node, "needs <string name=\"values\" value=\"...\"/>");
  List list;
  if (p.node.type == "regular") {
    const auto [low, high] = range_of(p);
    if (!(high > low) || values->size() < 2) fail(p.loader, p.node, "needs two values and a range of wavelengths");
    for (size_t i = 0; i < values->size(); ++i)
      list.emplace_back(low + (high - low) * double(i) / double(values->size() - 1), (*values)[i]);
  } else {
    const auto wavelengths = to_numbers(text(p, "wavelengths", ""));
    if (!wavelengths || wavelengths->size() != values->size())
      fail(p.loader, p.node, "needs as many wavelengths as values");
    for (size_t i = 0; i < values->size(); ++i) list.emplace_back((*wavelengths)[i], (*values)[i]);
  }
  return of_list(p.loader, p.node, list, kind);
}

// What stands in the elements <rgb> and <spectrum>, as plugins of these names (from Mitsuba 3.7 on).
Rgb spelt_out(Params& p, Colour kind) {
  const bool list = p.node.type == "spectrum";
  const Node* name = list ? find(p, {"filename"}) : nullptr;
  if (name != nullptr)
    return of_list(p.loader, p.node, pairs_of_file(p.loader, *name, value_of(p.loader, *name)), kind);
  if (!has(p, "value"))
    fail(p.loader, p.node, fmt::format("needs <{} name=\"value\" value=\"...\"/>", list ? "spectrum" : "rgb"));
  return colour(p, "value", Rgb(0), kind);
}

Rgb plugin_spectrum(Loader& loader, const Node& node, Colour kind) {
  Params p(loader, node);
  const Open open(loader, node);
  Rgb c(0);
  const Node* value = find(p, {"value"});
  if (node.type == "rawconstant" && value != nullptr && value->tag == "vector") {
    c = Rgb(vector_of(loader, *value, 0));
  } else if (node.type == "uniform" || node.type == "rawconstant") {
    c = colour(p, "value", Rgb(1), kind);
  } else if (node.type == "d65") {
    c = colour(p, "color", Rgb(1), kind) * float(number(p, "scale", 1));
  } else if (node.type == "srgb" || node.type == "srgb_d65") {
    c = colour(p, "color", Rgb(1), kind) * float(number(p, "scale", 1));
  } else if (node.type == "rgb" || node.type == "spectrum") {
    c = spelt_out(p, kind);
  } else if (node.type == "blackbody") {
    const double kelvin = kelvin_of(loader, node, text(p, "temperature", "0"));
    c = rgb_of_blackbody(kelvin) * float(number(p, "scale", 1));
  } else if (node.type == "regular" || node.type == "irregular") {
    c = tabulated(p, kind);
  } else {
    fail(loader, node,
         "unknown spectrum; supported: uniform, d65, rgb, srgb, srgb_d65, spectrum, rawconstant, blackbody, regular, "
         "irregular, and textures");
  }
  finish(p);
  return c;
}

}  // namespace

Rgb colour_of(Loader& loader, const Node& node, Colour kind) {
  if (node.tag == "spectrum" || node.tag == "texture")
    return checked(loader, node,
                   node.type.empty() ? plain_spectrum(loader, node, kind) : plugin_spectrum(loader, node, kind), kind);
  if (node.tag == "blackbody") {
    const std::string* kelvin = attribute(node, "temperature");
    if (kelvin == nullptr) fail(loader, node, "needs temperature=\"...\"");
    return checked(
        loader, node,
        rgb_of_blackbody(kelvin_of(loader, node, *kelvin)) * float(number_attribute(loader, node, "scale", 1)), kind);
  }
  if (node.tag == "rgb" || node.tag == "srgb")
    return checked(loader, node, rgb_of(loader, node, node.tag == "srgb"), kind);
  if (node.tag == "float" || node.tag == "integer" || node.tag == "string") {
    const std::string& value = value_of(loader, node);
    const auto x = to_number(value);
    if (!x) fail(loader, node, fmt::format("\"{}\" is not a number{}", value.substr(0, 80), about_suffix(value)));
    return checked(loader, node, Rgb(float(*x)), kind);
  }
  fail(loader, node, "a number, <rgb>, <spectrum> or <texture> is expected here");
}

const Node& meant_by(Loader& loader, const Node& node) {
  const Node& meant = follow(loader, node);
  if (!is_plugin(meant) || meant.type != "d65") return meant;
  Params p(loader, meant);
  const Node* inner = lit(p);
  if (inner == nullptr) return meant;
  if (has(p, "color")) fail(loader, meant, "has both a color and a texture or spectrum; leave one of them out");
  finish(p);
  const Open open(loader, meant);
  return meant_by(loader, *inner);
}

Rgb colour(Params& params, const char* name, const Rgb& otherwise, Colour kind) {
  const Node* node = find(params, {name});
  if (node == nullptr) return otherwise;
  const Node& meant = meant_by(params.loader, *node);
  if (is_texture(meant)) fail(params.loader, *node, "has to be one colour here, not a texture");
  return colour_of(params.loader, meant, kind);
}

}  // namespace ajar
