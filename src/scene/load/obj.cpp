#include "obj.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "cursor.h"
#include "node.h"

namespace ajar {
namespace {

using Corner = ObjFile::Corner;
using Face = ObjFile::Face;

void read_vertex(Cursor& in, ObjFile& out) {
  double x[7];
  const int n = in.numbers(x, 7);
  if (n < 3) in.fail(fmt::format("v has {} coordinates; it needs x y z", n));
  const Vec3 p(x[0], x[1], x[2]);
  if (!is_finite(p)) in.fail("a coordinate of v is not finite (or beyond the range of 32-bit floats)");
  out.v.push_back(p);
  const bool colored = n >= 6;  // v x y z w has no colour; v x y z r g b is a common extension
  if (!colored && out.colors.empty()) return;
  out.colors.resize(out.v.size(), Rgb(1));
  if (!colored) return;
  const Rgb color(x[n - 3], x[n - 2], x[n - 1]);
  if (!is_finite(color)) in.fail("a colour of v is not finite");
  out.colors.back() = color;
}

void read_texture_vertex(Cursor& in, ObjFile& out) {
  double x[2] = {0, 0};
  if (in.numbers(x, 2) < 1) in.fail("vt has no coordinates");
  out.vt.push_back(finite_or_zero(Vec2(x[0], x[1])));
}

void read_normal(Cursor& in, ObjFile& out) {
  double x[3];
  const int n = in.numbers(x, 3);
  if (n < 3) in.fail(fmt::format("vn has {} coordinates; it needs x y z", n));
  const double largest = std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
  const glm::dvec3 d = glm::dvec3(x[0], x[1], x[2]) / largest;  // its square stays in range
  const double length = glm::length(d);                         // NaN where all are zero
  out.vn.push_back(length > 0 && std::isfinite(length) ? Vec3(d / length) : Vec3(0));
}

// A number from 1, or one counted back from the latest (-1). Numbers ahead of their statements are checked later. Some
// files write 0 for what a corner lacks, none here.
uint32_t read_index(Cursor& in, size_t so_far, const char* what, bool may_lack = true) {
  int64_t i = 0;
  const char* rest = read_integer(in.p, in.end, i);
  if (rest == in.p) in.fail(fmt::format("\"{}\" is not a corner of a face (v, v/vt, v//vn or v/vt/vn)", in.token()));
  if (i == 0 && may_lack) {
    in.p = rest;
    return none;
  }
  if (i < 0) i += int64_t(so_far) + 1;
  if (i < 1 || i >= none) in.fail(fmt::format("\"{}\": there is no such {}; {} so far", in.token(), what, so_far));
  in.p = rest;
  return uint32_t(i - 1);
}

void read_face(Cursor& in, ObjFile& out, uint32_t material) {
  std::vector<FaceRange>& runs = out.runs[material];
  if (runs.empty() || runs.back().second < out.faces.size()) runs.emplace_back(out.faces.size(), out.faces.size());
  out.faces.push_back({out.corners.size(), in.line, material});
  runs.back().second = out.faces.size();
  while (!in.at_end()) {
    Corner c{read_index(in, out.v.size(), "v", false), none, none};
    if (!in.at_break() && *in.p == '/') {
      ++in.p;
      if (!in.ends_token() && *in.p != '/') c.vt = read_index(in, out.vt.size(), "vt");
      if (!in.at_break() && *in.p == '/') {
        ++in.p;
        if (!in.ends_token()) c.vn = read_index(in, out.vn.size(), "vn");
      }
    }
    if (!in.ends_token()) in.fail(fmt::format("\"{}\" after a corner of a face", in.token()));
    out.corners.push_back(c);
    out.lacks_normals |= c.vn == none;
  }
  // Elsewhere such faces are left out, as they have no area.
  if (const size_t corners = out.corners.size() - out.faces.back().first; in.p == in.end && corners < 3)
    in.fail(fmt::format("the file ends in a face of {} corner{}; is it whole?", corners, corners == 1 ? "" : "s"));
}

// Index of a material by its name, a new one where there is none yet.
uint32_t name_material(ObjFile& out, const std::string& name) {
  const auto [at, added] = out.by_name.emplace(name, uint32_t(out.materials.size()));
  if (added) out.materials.push_back(name), out.runs.emplace_back();
  return at->second;
}

// Open addressing from corners to vertices of the mesh.
struct VertexTable {
  std::vector<uint32_t> slots;  // vertex, or none
  std::vector<Corner> keys;     // by vertex

  static uint64_t mix(const Corner& c) { return hash(uint64_t(c.v) << 32 | c.vt, c.vn); }

  // Vertex of the corner; a new one (the last) where there is none yet.
  uint32_t find(const Corner& c) {
    if (2 * (keys.size() + 1) > slots.size()) grow();
    const size_t mask = slots.size() - 1;
    size_t i = mix(c) & mask;
    for (; slots[i] != none; i = (i + 1) & mask)
      if (keys[slots[i]] == c) return slots[i];
    keys.push_back(c);
    return slots[i] = uint32_t(keys.size() - 1);
  }

  void grow() {
    slots.assign(std::max<size_t>(64, slots.size() * 4), none);
    const size_t mask = slots.size() - 1;
    for (size_t k = 0; k < keys.size(); ++k) {
      size_t i = mix(keys[k]) & mask;
      while (slots[i] != none) i = (i + 1) & mask;
      slots[i] = uint32_t(k);
    }
  }
};

void check_range(const ObjFile& in, const Face& face, const Corner& c) {
  const auto check = [&](uint32_t i, size_t n, const char* what) {
    if (i != none && i >= n)
      throw Error(
          fmt::format("{}:{}: f names {} {} of {}; is the file whole?", in.name, face.line, what, uint64_t(i) + 1, n));
  };
  check(c.v, in.v.size(), "v");
  check(c.vt, in.vt.size(), "vt");
  check(c.vn, in.vn.size(), "vn");
}

bool takes(const MeshOptions& options, const std::string& material) {
  return options.material.empty() ? !options.without.contains(material) : options.material == material;
}

// The faces that the options take, in order. An obj may have thousands of parts: none walks over the others' faces.
std::vector<FaceRange> taken_runs(const ObjFile& in, const MeshOptions& options) {
  std::vector<FaceRange> runs;
  if (options.group >= 0) {
    const FaceRange group = faces_of(in, options.group);  // of one material
    if (takes(options, in.materials[in.faces[group.first].material])) runs = {group};
  } else if (!options.material.empty()) {
    const auto found = in.by_name.find(options.material);
    if (found != in.by_name.end()) runs = in.runs[found->second];
  } else if (options.without.empty()) {
    runs = {{0, in.faces.size()}};
  } else {
    for (size_t i = 0; i < in.materials.size(); ++i)
      if (takes(options, in.materials[i])) runs.insert(runs.end(), in.runs[i].begin(), in.runs[i].end());
    std::sort(runs.begin(), runs.end());
  }
  return runs;
}

// What a corner shares its vertex by.
Corner key_of(const ObjFile& in, const Corner& c) {
  if (in.same_v.empty() || c.vn != none) return c;
  return {in.same_v[c.v], c.vt == none ? none : in.same_vt[c.vt], none};
}

// The faces of some runs, as one mesh.
Mesh join_corners(const ObjFile& in, const std::vector<FaceRange>& runs) {
  Mesh mesh;
  VertexTable table;
  std::vector<uint32_t> polygon;
  if (runs.size() == 1 && runs[0] == FaceRange{0, in.faces.size()}) mesh.triangles.reserve(in.corners.size() / 2);
  const auto add_face = [&](size_t f) {
    const size_t end = f + 1 < in.faces.size() ? in.faces[f + 1].first : in.corners.size();
    polygon.clear();
    for (size_t i = in.faces[f].first; i < end; ++i) {
      const Corner& c = in.corners[i];
      check_range(in, in.faces[f], c);
      polygon.push_back(table.find(key_of(in, c)));
      if (table.keys.size() > mesh.positions.size()) mesh.positions.push_back(in.v[c.v]);
    }
    add_polygon(mesh, polygon);
  };
  for (const auto& [first, end] : runs)
    for (size_t f = first; f < end; ++f) add_face(f);
  // Left empty where no corner says anything; absent ones among others are 0: no texture, normal to be computed.
  const auto gather = [&](auto& to, const auto& from, uint32_t Corner::*index) {
    if (std::none_of(table.keys.begin(), table.keys.end(), [&](const Corner& c) { return c.*index != none; })) return;
    to.reserve(table.keys.size());
    for (const Corner& c : table.keys)
      to.push_back(c.*index == none ? std::decay_t<decltype(from[0])>(0) : from[c.*index]);
  };
  gather(mesh.uvs, in.vt, &Corner::vt);
  gather(mesh.normals, in.vn, &Corner::vn);
  if (!in.colors.empty()) gather(mesh.colors, in.colors, &Corner::v);
  return mesh;
}

// For each value the first that is equal to it.
template <class V>
std::vector<uint32_t> firsts_of(const std::vector<V>& values) {
  size_t size = 64;
  while (size < 2 * values.size()) size *= 2;
  std::vector<uint32_t> slots(size, none), firsts;
  firsts.reserve(values.size());
  for (uint32_t i = 0; i < values.size(); ++i) {
    const V v = values[i] + 0.0f;  // -0 is 0
    size_t at = hash(uint64_t(std::bit_cast<uint32_t>(v[0])) << 32 | std::bit_cast<uint32_t>(v[1]),
                     std::bit_cast<uint32_t>(v[V::length() - 1])) &
                (size - 1);
    while (slots[at] != none && values[slots[at]] != v) at = (at + 1) & (size - 1);
    if (slots[at] == none) slots[at] = i;
    firsts.push_back(slots[at]);
  }
  return firsts;
}

bool computes_normals(const ObjFile& in, const MeshOptions& options) {
  return !options.face_normals && (options.max_smooth_angle >= 0 || in.lacks_normals);
}

void append(Mesh& to, const Mesh& mesh) {
  const uint32_t before = uint32_t(to.positions.size());
  const auto add = [&](auto& all, const auto& some, size_t n) {
    if (all.empty() && some.empty()) return;
    all.resize(before);  // those before, or these, may have none
    all.insert(all.end(), some.begin(), some.end());
    all.resize(before + n);
  };
  const size_t n = mesh.positions.size();
  add(to.normals, mesh.normals, n), add(to.uvs, mesh.uvs, n), add(to.colors, mesh.colors, n);
  to.positions.insert(to.positions.end(), mesh.positions.begin(), mesh.positions.end());
  for (const glm::uvec3& t : mesh.triangles) to.triangles.push_back(t + before);
}

// One mesh of groups whose normals are computed by themselves. Each run begins with one of them.
Mesh join_groups(const ObjFile& file, const std::vector<FaceRange>& runs, const MeshOptions& options) {
  Mesh all;
  for (const FaceRange& run : runs) {
    auto group = std::lower_bound(file.groups.begin(), file.groups.end(), run.first);
    for (; group != file.groups.end() && *group < run.second; ++group) {
      Mesh mesh = join_corners(file, {faces_of(file, int(group - file.groups.begin()))});
      complete(mesh, options, file.name);
      append(all, mesh);
    }
  }
  return all;
}

}  // namespace

void weld(ObjFile& file) {
  if (!file.colors.empty() || !file.lacks_normals) return;  // equal places may differ in colour
  file.same_v = firsts_of(file.v), file.same_vt = firsts_of(file.vt);
}

FaceRange faces_of(const ObjFile& file, int group) {
  if (group < 0) return {0, file.faces.size()};
  const size_t g = size_t(group);
  if (g >= file.groups.size())
    throw Error(fmt::format("{}: shapeIndex {}: the file has {} groups of faces, counted from 0", file.name, g,
                            file.groups.size()));
  return {file.groups[g], g + 1 < file.groups.size() ? file.groups[g + 1] : file.faces.size()};
}

ObjFile scan_obj(std::string_view text, const std::string& name) {
  ObjFile out;
  out.name = name;
  uint32_t material = name_material(out, "");
  bool begins = true;  // another group, with the next face
  text = without_mark(text);
  out.v.reserve(text.size() / 128), out.corners.reserve(text.size() / 32);
  Cursor in{text.data(), text.data() + text.size(), name};
  for (; in.p != in.end; in.skip_line()) {
    if (in.at_end()) continue;
    const std::string_view keyword = in.word();
    if (keyword == "v")
      read_vertex(in, out);
    else if (keyword == "vt")
      read_texture_vertex(in, out);
    else if (keyword == "vn")
      read_normal(in, out);
    else if (keyword == "f") {
      if (std::exchange(begins, false)) out.groups.push_back(out.faces.size());
      read_face(in, out, material);
    } else if (keyword == "g")
      begins = true;
    else if (keyword == "mtllib")
      out.libraries.emplace_back(read_name(in));
    else if (keyword == "usemtl")
      begins = true, material = name_material(out, std::string(read_name(in)));
  }
  return out;
}

Mesh join(const ObjFile& file, const MeshOptions& options) {
  const std::vector<FaceRange> runs = taken_runs(file, options);
  if (options.apart && options.group < 0 && file.groups.size() > 1 && computes_normals(file, options))
    return join_groups(file, runs, options);
  Mesh mesh = join_corners(file, runs);
  complete(mesh, options, file.name);
  return mesh;
}

Mesh parse_obj(std::string_view text, const std::string& name, const MeshOptions& options) {
  ObjFile file = scan_obj(text, name);
  if (options.weld) weld(file);
  return join(file, options);
}

Mesh read_obj(const std::string& path, const MeshOptions& options) {
  return parse_obj(read_bytes(path), path, options);
}

}  // namespace ajar
