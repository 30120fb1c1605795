#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>

#include "ajar/core/error.h"
#include "digits.h"
#include "mesh.h"

namespace ajar {
namespace {

static_assert(std::endian::native == std::endian::little);

enum class Format : uint8_t { ascii, little, big };
enum class Type : uint8_t { i8, u8, i16, u16, i32, u32, f32, f64 };

constexpr std::array<size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
constexpr std::array<double, 8> largest{127, 255, 32767, 65535, 2147483647, 4294967295, 1, 1};  // as a colour: 1

size_t size_of(Type t) { return sizes[size_t(t)]; }
bool is_integer(Type t) { return t < Type::f32; }

// What a property is to us. The scalar roles of a vertex come first and number its values.
enum Role : uint8_t { x, y, z, nx, ny, nz, u, v, scalar_roles, indices, other };

struct Property {
  std::string name;
  Role role = other;
  Type type = Type::f32;       // of a list: its entries'
  std::optional<Type> length;  // of a list: its length's
};

struct Element {
  std::string name;
  size_t count = 0;
  std::vector<Property> properties;

  bool has(std::initializer_list<Role> roles) const {
    return std::all_of(roles.begin(), roles.end(), [&](Role r) {
      return std::any_of(properties.begin(), properties.end(), [&](const Property& p) { return p.role == r; });
    });
  }
};

struct Header {
  Format format = Format::ascii;
  std::vector<Element> elements;
};

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
constexpr Name vertex_names[] = {{"x", x}, {"y", y}, {"z", z}, {"nx", nx}, {"ny", ny},       {"nz", nz},
                                 {"u", u}, {"v", v}, {"s", u}, {"t", v},   {"texture_u", u}, {"texture_v", v}};
constexpr Name face_names[] = {{"vertex_indices", indices}, {"vertex_index", indices}};

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

  Type type(size_t i) const {
    const int t = look_up(type_names, word(i), -1);
    if (t < 0) fail(fmt::format("unknown type \"{}\"; char to double, int8 to float64 are known", word(i)));
    return Type(t);
  }

  Format format() const {
    constexpr Name names[] = {{"ascii", 0}, {"binary_little_endian", 1}, {"binary_big_endian", 2}};
    const int f = look_up(names, word(1), -1);
    if (f < 0) fail(fmt::format("unknown format \"{}\"; ascii and binary_little/big_endian are known", word(1)));
    return Format(f);
  }

  Element element() const {
    int64_t count = -1;
    const std::string_view digits = word(2);
    const char* stop = digits.data() + digits.size();
    if (read_integer(digits.data(), stop, count) != stop || count < 0)
      fail(fmt::format("\"{}\" is not a number of elements", digits));
    return {std::string(word(1)), size_t(count), {}};
  }

  Property property(const std::string& element) const {
    Property out;
    const bool list = word(1) == "list";
    if (list) out.length = type(2);
    out.type = type(list ? 3 : 1);
    const std::string_view name = word(list ? 4 : 2);
    out.name = name;
    if (!list && element == "vertex") out.role = Role(look_up(vertex_names, name, other));
    if (list && element == "face") out.role = Role(look_up(face_names, name, other));
    if (list && !is_integer(*out.length)) fail(fmt::format("the length of list \"{}\" is not an integer", name));
    if (out.role == indices && !is_integer(out.type)) fail(fmt::format("the entries of \"{}\" are not integers", name));
    return out;
  }
};

Header read_header(HeaderReader& in) {
  Header header;
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
  return header;
}

struct Polygons {
  std::vector<uint32_t> corners;
  std::vector<size_t> ends;           // one past each polygon's last corner
  std::vector<Attribute> attributes;  // a value a polygon
};

// Properties that are one attribute of a mesh.
struct Group {
  std::string name;
  std::array<size_t, 3> parts{};  // indices of properties; a single number is all three
  bool color = false;             // integers are parts of 1
};

const Property* scalar(const Element& e, size_t i) {
  return i < e.properties.size() && !e.properties[i].length ? &e.properties[i] : nullptr;
}

std::optional<size_t> index_of(const Element& e, std::string_view name) {
  for (size_t i = 0; i < e.properties.size(); ++i)
    if (e.properties[i].name == name && scalar(e, i)) return i;
  return {};
}

// Mitsuba's convention: r g b (or red green blue) is "color"; NAME_x y z, NAME_0 1 2 and NAME_1 2 3 side by side are
// NAME, NAME_r g b is NAME_color; a fourth part is passed over, and the first alone is a single number.
std::vector<Group> groups_of(const Element& e, const std::string& prefix) {
  std::vector<Group> groups;
  for (const auto& names : {std::array{"r", "g", "b"}, {"red", "green", "blue"}}) {
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
      for (const Property* p = nullptr; n < 4 && (p = scalar(e, begin + n)) && p->name == stem + letters[n];) ++n;
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

// The body, value by value.
template <Format F>
struct Body {
  const char* p;
  const char* end;
  const std::string& file;
  const Element* element = nullptr;
  size_t row = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}: {} {} of {}: {}", file, element->name, row, element->count, what));
  }

  template <class T>
  double binary() {
    if (size_t(end - p) < sizeof(T)) fail("the file ends here");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), p, sizeof(T));
    if constexpr (F == Format::big) std::reverse(raw.begin(), raw.end());
    p += sizeof(T);
    return double(std::bit_cast<T>(raw));
  }

  double ascii() {
    const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    while (p != end && blank(*p)) ++p;
    if (p == end) fail("the file ends here");
    double value;
    const char* rest = read_number(p, end, value);
    if (rest == p || (rest != end && !blank(*rest))) {
      const char* stop = std::find_if(p, p + std::min<ptrdiff_t>(end - p, 20), blank);
      fail(fmt::format("\"{}\" is not a number", std::string(p, stop)));
    }
    p = rest;
    return value;
  }

  double take(Type type) {
    if constexpr (F == Format::ascii) {
      return ascii();
    } else {
      switch (type) {
        case Type::i8:
          return binary<int8_t>();
        case Type::u8:
          return binary<uint8_t>();
        case Type::i16:
          return binary<int16_t>();
        case Type::u16:
          return binary<uint16_t>();
        case Type::i32:
          return binary<int32_t>();
        case Type::u32:
          return binary<uint32_t>();
        case Type::f32:
          return binary<float>();
        default:
          return binary<double>();
      }
    }
  }

  // An integer from 0 below limit.
  size_t take_integer(Type type, size_t limit, const char* what) {
    const double value = take(type);
    if (!(value >= 0 && value < double(limit)) || value != std::floor(value))
      fail(fmt::format("{} {} is not from 0 to {}", what, value, double(limit) - 1));
    return size_t(value);
  }

  size_t bytes_left() const { return size_t(end - p); }
  // The least room that a value takes.
  static size_t least(Type type) { return F == Format::ascii ? 1 : size_of(type); }

  size_t take_length(const Property& list) {
    const size_t n = take_integer(*list.length, size_t(1) << 32, "list length");
    if (n > bytes_left() / least(list.type)) fail(fmt::format("a list of {} entries, but the file ends before", n));
    return n;
  }

  void skip(const Property& property) {
    size_t n = property.length ? take_length(property) : 1;
    if constexpr (F != Format::ascii) {
      if (n > bytes_left() / size_of(property.type)) fail("the file ends here");
      p += n * size_of(property.type);
    } else {
      for (; n > 0; --n) ascii();
    }
  }

  // Counts are checked against what is left of the file before anything is allocated.
  void start(const Element& e) {
    element = &e, row = 0;
    size_t least_row = 0;
    for (const Property& property : e.properties) least_row += least(property.length.value_or(property.type));
    if (least_row > 0 && e.count > bytes_left() / least_row)
      throw Error(fmt::format("{}: the header promises {} x {}, but the file ends before; is it whole?", file, e.count,
                              e.name));
  }

  // One row's values, lists aside: those are handed to `list`.
  template <class List>
  void read_row(const Element& e, std::vector<double>& values, const List& list) {
    values.resize(e.properties.size());
    for (size_t i = 0; i < e.properties.size(); ++i)
      if (e.properties[i].length)
        list(e.properties[i]);
      else
        values[i] = take(e.properties[i].type);
  }

  static Rgb value_of(const Element& e, const Group& group, const std::vector<double>& values) {
    const auto part = [&](size_t i) { return values[i] / (group.color ? largest[size_t(e.properties[i].type)] : 1); };
    return Rgb(part(group.parts[0]), part(group.parts[1]), part(group.parts[2]));
  }

  void read_vertices(const Element& e, Mesh& mesh) {
    start(e);
    if (!e.has({x, y, z})) throw Error(fmt::format("{}: element vertex lacks x, y or z", file));
    const bool normals = e.has({nx, ny, nz}), uvs = e.has({u, v});
    const std::vector<Group> groups = groups_of(e, "vertex_");
    mesh.attributes.clear();
    for (const Group& group : groups) mesh.attributes.push_back({group.name, false, {}});
    mesh.positions.reserve(e.count);
    if (normals) mesh.normals.reserve(e.count);
    if (uvs) mesh.uvs.reserve(e.count);
    for (Attribute& a : mesh.attributes) a.values.reserve(e.count);
    std::vector<double> values;
    std::array<double, scalar_roles> value{};
    for (row = 0; row < e.count; ++row) {
      read_row(e, values, [&](const Property& list) { skip(list); });
      for (size_t i = 0; i < values.size(); ++i)
        if (e.properties[i].role < scalar_roles) value[e.properties[i].role] = values[i];
      mesh.positions.emplace_back(value[x], value[y], value[z]);
      if (normals) mesh.normals.emplace_back(value[nx], value[ny], value[nz]);
      if (uvs) mesh.uvs.emplace_back(value[u], value[v]);
      for (size_t k = 0; k < groups.size(); ++k) mesh.attributes[k].values.push_back(value_of(e, groups[k], values));
    }
  }

  void read_faces(const Element& e, Polygons& out) {
    start(e);
    if (e.count > 0 && !e.has({indices}))
      throw Error(fmt::format("{}: element face lacks the list vertex_indices", file));
    const std::vector<Group> groups = groups_of(e, "face_");
    out.attributes.clear();
    for (const Group& group : groups) out.attributes.push_back({group.name, true, {}});
    out.ends.reserve(e.count), out.corners.reserve(e.count * 3);
    std::vector<double> values;
    for (row = 0; row < e.count; ++row) {
      read_row(e, values, [&](const Property& list) {
        if (list.role != indices) return skip(list);
        for (size_t n = take_length(list); n > 0; --n)
          out.corners.push_back(uint32_t(take_integer(list.type, none, "vertex index")));
      });
      for (size_t k = 0; k < groups.size(); ++k) out.attributes[k].values.push_back(value_of(e, groups[k], values));
      out.ends.push_back(out.corners.size());
    }
  }

  void skip_element(const Element& e) {
    start(e);
    if (e.properties.empty()) return;
    for (row = 0; row < e.count; ++row)
      for (const Property& property : e.properties) skip(property);
  }
};

template <Format F>
Mesh read_body(const Header& header, const char* p, const char* end, const std::string& file) {
  Body<F> body{p, end, file};
  Mesh mesh;
  Polygons polygons;
  for (const Element& e : header.elements) {
    if (e.name == "vertex" && mesh.positions.empty())
      body.read_vertices(e, mesh);
    else if (e.name == "face" && polygons.ends.empty())
      body.read_faces(e, polygons);
    else if (e.name == "tristrips")
      throw Error(file + ": triangle strips are not supported; convert them to faces");
    else
      body.skip_element(e);
  }
  // vertex_color has its own place
  if (!mesh.attributes.empty() && mesh.attributes[0].name == "vertex_color") {
    mesh.colors = std::move(mesh.attributes[0].values);
    mesh.attributes.erase(mesh.attributes.begin());
  }
  const size_t of_faces = mesh.attributes.size();
  for (const Attribute& a : polygons.attributes) mesh.attributes.push_back({a.name, true, {}});
  mesh.triangles.reserve(polygons.ends.size());
  for (size_t f = 0, begin = 0; f < polygons.ends.size(); begin = polygons.ends[f++]) {
    const std::span corners(polygons.corners.data() + begin, polygons.ends[f] - begin);
    for (const uint32_t i : corners)
      if (i >= mesh.positions.size())
        throw Error(fmt::format("{}: face {} names vertex {} of {}", file, f, i, mesh.positions.size()));
    add_polygon(mesh, corners);
    for (size_t k = 0; k < polygons.attributes.size(); ++k)
      mesh.attributes[of_faces + k].values.resize(mesh.triangles.size(), polygons.attributes[k].values[f]);
  }
  return mesh;
}

}  // namespace

Mesh parse_ply(std::span<const std::byte> bytes, const std::string& name, const MeshOptions& options) {
  const char* begin = reinterpret_cast<const char*>(bytes.data());
  HeaderReader in{begin, begin + bytes.size(), name};
  const Header header = read_header(in);
  const auto read = header.format == Format::ascii    ? read_body<Format::ascii>
                    : header.format == Format::little ? read_body<Format::little>
                                                      : read_body<Format::big>;
  Mesh mesh = read(header, in.p, in.end, name);
  complete(mesh, options, name);
  return mesh;
}

Mesh read_ply(const std::string& path, const MeshOptions& options) {
  const std::string bytes = read_bytes(path);
  return parse_ply(std::as_bytes(std::span(bytes)), path, options);
}

}  // namespace ajar
