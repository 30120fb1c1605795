#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "ajar/core/error.h"
#include "digits.h"
#include "ply.h"

namespace ajar {
namespace {

struct Name {
  std::string_view text;
  int value;
};

template <size_t N>
int look_up(const Name (&table)[N], std::string_view text, int otherwise) {
  for (const Name& n : table)
    if (n.text == text) return n.value;
  return otherwise;
}

constexpr Name type_names[] = {{"char", 0},   {"int8", 0},    {"uchar", 1},  {"uint8", 1},  {"short", 2}, {"int16", 2},
                               {"ushort", 3}, {"uint16", 3},  {"int", 4},    {"int32", 4},  {"uint", 5},  {"uint32", 5},
                               {"float", 6},  {"float32", 6}, {"double", 7}, {"float64", 7}};
constexpr Name vertex_names[] = {{"x", role_x},   {"y", role_y},   {"z", role_z},         {"nx", role_nx},
                                 {"ny", role_ny}, {"nz", role_nz}, {"u", role_u},         {"v", role_v},
                                 {"s", role_u},   {"t", role_v},   {"texture_u", role_u}, {"texture_v", role_v}};
constexpr Name face_names[] = {{"vertex_indices", role_indices}, {"vertex_index", role_indices}};

// Splits the header into lines and words; afterwards p is at the body.
struct HeaderReader {
  const char* p;
  const char* end;
  const std::string& file;
  int line = 0;
  std::vector<std::string_view> words{};

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}:{}: PLY header: {}", file, line, what));
  }

  void next() {
    ++line;
    words.clear();
    const char* stop = static_cast<const char*>(p == end ? nullptr : std::memchr(p, '\n', size_t(end - p)));
    if (!stop) fail("no end_header; is the file whole?");
    const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (p != stop) {
      const char* begin = p;
      while (p != stop && !blank(*p)) ++p;
      if (p != begin) words.emplace_back(begin, size_t(p - begin));
      if (p != stop) ++p;
    }
    ++p;
  }

  std::string_view word(size_t i) const {
    if (i >= words.size()) fail(fmt::format("\"{}\" lacks a word", words[0]));
    return words[i];
  }

  PlyType type(size_t i) const {
    const int t = look_up(type_names, word(i), -1);
    if (t < 0) fail(fmt::format("unknown type \"{}\"; char to double, int8 to float64 are known", word(i)));
    return PlyType(t);
  }

  PlyFormat format() const {
    constexpr Name names[] = {{"ascii", 0}, {"binary_little_endian", 1}, {"binary_big_endian", 2}};
    const int f = look_up(names, word(1), -1);
    if (f < 0) fail(fmt::format("unknown format \"{}\"; ascii and binary_little/big_endian are known", word(1)));
    return PlyFormat(f);
  }

  PlyElement element() const {
    int64_t count = -1;
    const std::string_view digits = word(2);
    const char* stop = digits.data() + digits.size();
    if (read_integer(digits.data(), stop, count) != stop || count < 0)
      fail(fmt::format("\"{}\" is not a number of elements", digits));
    return {std::string(word(1)), size_t(count), {}};
  }

  PlyProperty property(const std::string& element) const {
    PlyProperty out;
    const bool list = word(1) == "list";
    if (list) out.length = type(2);
    out.type = type(list ? 3 : 1);
    const std::string_view name = word(list ? 4 : 2);
    out.name = name;
    if (!list && element == "vertex") out.role = PlyRole(look_up(vertex_names, name, role_other));
    if (list && element == "face") out.role = PlyRole(look_up(face_names, name, role_other));
    if (list && !is_integer(*out.length)) fail(fmt::format("the length of list \"{}\" is not an integer", name));
    if (out.role == role_indices && !is_integer(out.type))
      fail(fmt::format("the entries of \"{}\" are not integers", name));
    return out;
  }
};

// Texture coordinates by the first of these names that are there, as in Mitsuba.
void choose_uvs(PlyElement& e) {
  bool found = false;
  for (const auto& [u, v] : {std::pair("u", "v"), {"texture_u", "texture_v"}, {"s", "t"}}) {
    const auto named = [&](const char* name) {
      return [name](const PlyProperty& p) { return p.name == name && !p.length; };
    };
    const auto at_u = std::find_if(e.properties.begin(), e.properties.end(), named(u));
    const auto at_v = std::find_if(e.properties.begin(), e.properties.end(), named(v));
    if (at_u == e.properties.end() || at_v == e.properties.end()) continue;
    if (found) at_u->role = at_v->role = role_other;
    found = true;
  }
}

const PlyProperty* scalar(const PlyElement& e, size_t i) {
  return i < e.properties.size() && !e.properties[i].length ? &e.properties[i] : nullptr;
}

std::optional<size_t> index_of(const PlyElement& e, std::string_view name) {
  for (size_t i = 0; i < e.properties.size(); ++i)
    if (e.properties[i].name == name && scalar(e, i)) return i;
  return {};
}

}  // namespace

PlyHeader read_ply_header(const char*& p, const char* end, const std::string& file) {
  HeaderReader in{p, end, file};
  PlyHeader header;
  bool has_format = false;
  for (in.next(); in.words.size() != 1 || in.words[0] != "ply";) in.fail("the first line is not \"ply\"");
  for (in.next(); in.words.empty() || in.words[0] != "end_header"; in.next()) {
    if (in.words.empty() || in.words[0] == "comment" || in.words[0] == "obj_info") continue;
    if (in.words[0] == "format") {
      header.format = in.format(), has_format = true;
    } else if (in.words[0] == "element") {
      header.elements.push_back(in.element());
    } else if (in.words[0] == "property") {
      if (header.elements.empty()) in.fail("a property before the first element");
      header.elements.back().properties.push_back(in.property(header.elements.back().name));
    } else {
      in.fail(fmt::format("unknown keyword \"{}\"", in.words[0]));
    }
  }
  if (!has_format) in.fail("no format line");
  for (PlyElement& e : header.elements) choose_uvs(e);
  p = in.p;
  return header;
}

std::vector<PlyGroup> ply_groups(const PlyElement& e, const std::string& prefix) {
  std::vector<PlyGroup> groups;
  for (const auto& names :
       {std::array{"r", "g", "b"}, {"red", "green", "blue"}, {"diffuse_red", "diffuse_green", "diffuse_blue"}}) {
    const auto r = index_of(e, names[0]), g = index_of(e, names[1]), b = index_of(e, names[2]);
    if (r && g && b && groups.empty()) groups.push_back({prefix + "color", {*r, *g, *b}, true});
  }
  constexpr std::string_view series[] = {"xyzw", "rgba", "0123", "1234"};
  for (size_t i = 0; i < e.properties.size();) {
    const size_t begin = i++;
    const std::string& first = e.properties[begin].name;
    if (first.size() < 3 || first[first.size() - 2] != '_' || !scalar(e, begin)) continue;
    const std::string stem = first.substr(0, first.size() - 1);
    for (const std::string_view& letters : series) {
      size_t n = 0;
      for (const PlyProperty* p = nullptr; n < 4 && (p = scalar(e, begin + n)) && p->name == stem + letters[n];) ++n;
      if (n == 0) continue;
      i = begin + n;
      if (n == 2) break;  // neither a number nor a colour
      const bool color = letters[0] == 'r';
      const size_t step = n == 1 ? 0 : 1;
      groups.push_back({prefix + (color ? stem + "color" : stem.substr(0, stem.size() - 1)),
                        {begin, begin + step, begin + 2 * step},
                        color});
      break;
    }
  }
  return groups;
}

}  // namespace ajar
