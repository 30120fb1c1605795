#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "ajar/core/error.h"
#include "ajar/core/srgb.h"
#include "digits.h"
#include "mesh.h"
#include "ply.h"

namespace ajar {
namespace {

static_assert(std::endian::native == std::endian::little);

struct Polygons {
  std::vector<uint32_t> corners;
  std::vector<size_t> ends;           // one past each polygon's last corner
  std::vector<Attribute> attributes;  // a value a polygon
};

// The body, value by value.
template <PlyFormat F>
struct Body {
  const char* p;
  const char* end;
  const std::string& file;
  bool encoded = false;  // MeshOptions::encoded
  const PlyElement* element = nullptr;
  size_t row = 0;

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(fmt::format("{}: {} {} of {}: {}", file, element->name, row, element->count, what));
  }

  template <class T>
  double binary() {
    if (size_t(end - p) < sizeof(T)) fail("the file ends here; is it whole?");
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), p, sizeof(T));
    if constexpr (F == PlyFormat::big) std::reverse(raw.begin(), raw.end());
    p += sizeof(T);
    return double(std::bit_cast<T>(raw));
  }

  double ascii() {
    const auto blank = [](char c) { return c == ' ' || (c >= '\t' && c <= '\r'); };
    while (p != end && blank(*p)) ++p;
    if (p == end) fail("the file ends here; is it whole?");
    double value;
    const char* rest = read_number(p, end, value);
    if (rest == p || (rest != end && !blank(*rest))) {
      const char* stop = std::find_if(p, p + std::min<ptrdiff_t>(end - p, 20), blank);
      fail(fmt::format("\"{}\" is not a number", std::string(p, stop)));
    }
    p = rest;
    return value;
  }

  double take(PlyType type) {
    if constexpr (F == PlyFormat::ascii) {
      return ascii();
    } else {
      switch (type) {
        case PlyType::i8:
          return binary<int8_t>();
        case PlyType::u8:
          return binary<uint8_t>();
        case PlyType::i16:
          return binary<int16_t>();
        case PlyType::u16:
          return binary<uint16_t>();
        case PlyType::i32:
          return binary<int32_t>();
        case PlyType::u32:
          return binary<uint32_t>();
        case PlyType::f32:
          return binary<float>();
        default:
          return binary<double>();
      }
    }
  }

  // An integer from 0 below limit.
  size_t take_integer(PlyType type, size_t limit, const char* what) {
    const double value = take(type);
    if (!(value >= 0 && value < double(limit)) || value != std::floor(value))
      fail(fmt::format("{} {} is not from 0 to {}", what, value, double(limit) - 1));
    return size_t(value);
  }

  size_t bytes_left() const { return size_t(end - p); }
  // The least room that a value takes.
  static size_t least(PlyType type) { return F == PlyFormat::ascii ? 1 : size_of(type); }

  size_t take_length(const PlyProperty& list) {
    const size_t n = take_integer(*list.length, size_t(1) << 32, "list length");
    if (n > bytes_left() / least(list.type))
      fail(fmt::format("a list of {} entries, but the file ends before; is it whole?", n));
    return n;
  }

  void skip(const PlyProperty& property) {
    size_t n = property.length ? take_length(property) : 1;
    if constexpr (F != PlyFormat::ascii) {
      if (n > bytes_left() / size_of(property.type)) fail("the file ends here; is it whole?");
      p += n * size_of(property.type);
    } else {
      for (; n > 0; --n) ascii();
    }
  }

  // Counts are checked against what is left of the file before anything is allocated.
  void start(const PlyElement& e) {
    element = &e, row = 0;
    size_t least_row = 0;
    for (const PlyProperty& property : e.properties) least_row += least(property.length.value_or(property.type));
    if (least_row > 0 && e.count > bytes_left() / least_row)
      throw Error(fmt::format("{}: the header promises {} x {}, but the file ends before; is it whole?", file, e.count,
                              e.name));
  }

  // One row's values, lists aside: those are handed to `list`.
  template <class List>
  void read_row(const PlyElement& e, std::vector<double>& values, const List& list) {
    values.resize(e.properties.size());
    for (size_t i = 0; i < e.properties.size(); ++i)
      if (e.properties[i].length)
        list(e.properties[i]);
      else
        values[i] = take(e.properties[i].type);
  }

  Rgb value_of(const PlyElement& e, const PlyGroup& group, const std::vector<double>& values) const {
    const auto part = [&](size_t i) {
      const PlyType type = e.properties[i].type;
      const double x = values[i] / (group.color || encoded ? ply_largest[size_t(type)] : 1);
      return encoded && is_integer(type) ? decode_srgb(x) : x;
    };
    return Rgb(part(group.parts[0]), part(group.parts[1]), part(group.parts[2]));
  }

  void read_vertices(const PlyElement& e, Mesh& mesh) {
    start(e);
    if (!e.has({role_x, role_y, role_z})) throw Error(fmt::format("{}: element vertex lacks x, y or z", file));
    const bool normals = e.has({role_nx, role_ny, role_nz}), uvs = e.has({role_u, role_v});
    const std::vector<PlyGroup> groups = ply_groups(e, "vertex_");
    mesh.attributes.clear();
    for (const PlyGroup& group : groups) mesh.attributes.push_back({group.name, false, {}});
    mesh.positions.reserve(e.count);
    if (normals) mesh.normals.reserve(e.count);
    if (uvs) mesh.uvs.reserve(e.count);
    for (Attribute& a : mesh.attributes) a.values.reserve(e.count);
    std::vector<double> values;
    std::array<double, scalar_roles> value{};
    for (row = 0; row < e.count; ++row) {
      read_row(e, values, [&](const PlyProperty& list) { skip(list); });
      for (size_t i = 0; i < values.size(); ++i)
        if (e.properties[i].role < scalar_roles) value[e.properties[i].role] = values[i];
      mesh.positions.emplace_back(value[role_x], value[role_y], value[role_z]);
      if (normals) mesh.normals.emplace_back(value[role_nx], value[role_ny], value[role_nz]);
      if (uvs) mesh.uvs.emplace_back(value[role_u], value[role_v]);
      for (size_t k = 0; k < groups.size(); ++k) mesh.attributes[k].values.push_back(value_of(e, groups[k], values));
    }
  }

  void read_faces(const PlyElement& e, Polygons& out) {
    start(e);
    if (e.count > 0 && !e.has({role_indices}))
      throw Error(fmt::format("{}: element face lacks the list vertex_indices", file));
    const std::vector<PlyGroup> groups = ply_groups(e, "face_");
    out.attributes.clear();
    for (const PlyGroup& group : groups) out.attributes.push_back({group.name, true, {}});
    out.ends.reserve(e.count), out.corners.reserve(e.count * 3);
    std::vector<double> values;
    for (row = 0; row < e.count; ++row) {
      read_row(e, values, [&](const PlyProperty& list) {
        if (list.role != role_indices) return skip(list);
        for (size_t n = take_length(list); n > 0; --n)
          out.corners.push_back(uint32_t(take_integer(list.type, none, "vertex index")));
      });
      for (size_t k = 0; k < groups.size(); ++k) out.attributes[k].values.push_back(value_of(e, groups[k], values));
      out.ends.push_back(out.corners.size());
    }
  }

  void skip_element(const PlyElement& e) {
    start(e);
    if (e.properties.empty()) return;
    for (row = 0; row < e.count; ++row)
      for (const PlyProperty& property : e.properties) skip(property);
  }
};

template <PlyFormat F>
Mesh read_body(const PlyHeader& header, const char* p, const char* end, const std::string& file, bool encoded) {
  Body<F> body{p, end, file, encoded};
  Mesh mesh;
  Polygons polygons;
  for (const PlyElement& e : header.elements) {
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
        throw Error(
            fmt::format("{}: face {} names vertex {} of {}; is the file whole?", file, f, i, mesh.positions.size()));
    add_polygon(mesh, corners);
    for (size_t k = 0; k < polygons.attributes.size(); ++k)
      mesh.attributes[of_faces + k].values.resize(mesh.triangles.size(), polygons.attributes[k].values[f]);
  }
  return mesh;
}

// As MeshLab writes them.
bool has_corner_uvs(const PlyHeader& header) {
  return std::any_of(header.elements.begin(), header.elements.end(), [](const PlyElement& e) {
    return e.name == "face" && e.count > 0 &&
           std::any_of(e.properties.begin(), e.properties.end(),
                       [](const PlyProperty& p) { return p.length && p.name == "texcoord"; });
  });
}

}  // namespace

Mesh parse_ply(std::span<const std::byte> bytes, const std::string& name, const MeshOptions& options) {
  const char *p = reinterpret_cast<const char*>(bytes.data()), *end = p + bytes.size();
  const PlyHeader header = read_ply_header(p, end, name);
  const auto read = header.format == PlyFormat::ascii    ? read_body<PlyFormat::ascii>
                    : header.format == PlyFormat::little ? read_body<PlyFormat::little>
                                                         : read_body<PlyFormat::big>;
  Mesh mesh = read(header, p, end, name, options.encoded);
  complete(mesh, options, name);
  if (options.notes && has_corner_uvs(header))
    options.notes->push_back(name +
                             ": texture coordinates of the faces' corners (the list texcoord) are not used; write them "
                             "as u and v of the vertices");
  return mesh;
}

Mesh read_ply(const std::string& path, const MeshOptions& options) {
  const std::string bytes = read_bytes(path);
  return parse_ply(std::as_bytes(std::span(bytes)), path, options);
}

}  // namespace ajar
