#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "ajar/core/error.h"
#include "kit/files.h"
#include "mesh_samples.h"

namespace ajar {
namespace {

Mesh read(const std::string& bytes, int index = 0, const MeshOptions& options = {}) {
  Mesh mesh = parse_serialized(kit::as_bytes(bytes), "a.serialized", index, options);
  EXPECT_EQ(kit::unsound(mesh), "");
  return mesh;
}

std::string serialized_error(const std::string& bytes, int index = 0) {
  try {
    parse_serialized(kit::as_bytes(bytes), "a.serialized", index, {});
  } catch (const Error& e) {
    EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
    return e.what();
  }
  return "no error";
}

Mesh full() {
  Mesh mesh = make_sphere(6, 8);
  for (size_t i = 0; i < mesh.positions.size(); ++i) mesh.colors.push_back(Rgb(float(i), 0.5f, 0.25f));
  return mesh;
}

void expect_same(const Mesh& a, const Mesh& b) {
  EXPECT_EQ(a.positions, b.positions);
  EXPECT_EQ(a.uvs, b.uvs);
  EXPECT_EQ(a.colors, b.colors);
  EXPECT_EQ(a.triangles, b.triangles);
  ASSERT_EQ(a.normals.size(), b.normals.size());
  for (size_t i = 0; i < a.normals.size(); ++i) ASSERT_LT(glm::distance(a.normals[i], b.normals[i]), 1e-6f);
}

TEST(MeshSerialized, versions_and_precisions) {
  const Mesh mesh = full();
  for (const int version : {3, 4}) {
    expect_same(read(kit::serialized_of({kit::payload_of<float>(mesh, version)}, version)), mesh);
    expect_same(read(kit::serialized_of({kit::payload_of<double>(mesh, version)}, version)), mesh);
  }
}

TEST(MeshSerialized, optional_parts) {
  Mesh mesh = full();
  mesh.colors.clear(), mesh.uvs.clear();
  expect_same(read(kit::serialized_of({kit::payload_of<float>(mesh, 4)}, 4)), mesh);
  mesh.normals.clear();
  const std::string bare = kit::serialized_of({kit::payload_of<float>(mesh, 4)}, 4);
  EXPECT_EQ(read(bare).normals.size(), mesh.positions.size());
  expect_same(read(bare, 0, {.face_normals = true}), mesh);
  // The file's own flag for face normals, which no version of Mitsuba heeds.
  expect_same(read(kit::serialized_of({kit::payload_of<float>(full(), 4, 0x10)}, 4), 0), full());
}

TEST(MeshSerialized, several_meshes) {
  for (const int version : {3, 4}) {
    Mesh a = full(), b = make_cube(), c = make_rectangle();
    const std::string file = kit::serialized_of(
        {kit::payload_of<float>(a, version), kit::payload_of<double>(b, version), kit::payload_of<float>(c, version)},
        version);
    const MeshOptions faceted{.face_normals = true};
    expect_same(read(file, 0), a);
    expect_same(read(file, 1, faceted), b);
    expect_same(read(file, 2, faceted), c);
    EXPECT_NE(serialized_error(file, 3).find("shape_index 3, but the file holds 3 meshes (0 to 2)"), std::string::npos);
    EXPECT_NE(serialized_error(file, -1).find("shape_index -1 is negative"), std::string::npos);
    EXPECT_NE(serialized_error(file, 1 << 30).find("holds 3 meshes"), std::string::npos);
  }
}

TEST(MeshSerialized, files_hold_what_bytes_do) {
  const std::string path = testing::TempDir() + "ajar" + std::to_string(::getpid()) + ".serialized";
  const Mesh large = make_sphere(100, 100);
  const std::string bytes =
      kit::serialized_of({kit::payload_of<float>(make_cube(), 4), kit::payload_of<double>(large, 4)}, 4);
  std::ofstream(path, std::ios::binary) << bytes;
  expect_same(read_serialized(path, 0, {}), read(bytes, 0));
  expect_same(read_serialized(path, 1, {}), read(bytes, 1));
  std::ofstream(path, std::ios::binary) << "";
  EXPECT_NE(kit::error_of([&] { read_serialized(path, 0, {}); }).find("too short"), std::string::npos);
  std::filesystem::remove(path);
}

// Of a mesh without normals; Mitsuba 0.x turns its triangles.
TEST(MeshSerialized, an_old_mirror_keeps_the_outside) {
  Mesh bare = make_rectangle();
  bare.normals.clear();
  const std::string bytes = kit::serialized_of({kit::payload_of<float>(bare, 4)}, 4);
  MeshOptions options;
  options.to_world[0][0] = -1;
  for (const bool faceted : {false, true}) {
    options.face_normals = faceted;
    options.keeps_side = false;
    EXPECT_EQ(kit::face_normal(read(bytes, 0, options), 0).z, -1);
    options.keeps_side = true;
    EXPECT_EQ(kit::face_normal(read(bytes, 0, options), 0).z, 1);
  }
}

TEST(MeshSerialized, the_first_mesh_needs_no_dictionary) {
  const std::string file = kit::serialized_of({kit::payload_of<float>(make_rectangle(), 4)}, 4);
  EXPECT_EQ(read(file.substr(0, file.size() - 12)).triangles.size(), 2u);
}

TEST(MeshSerialized, a_large_mesh_survives) {
  const Mesh sphere = make_sphere(224, 224);
  ASSERT_GT(sphere.triangles.size(), 99000u);
  expect_same(read(kit::serialized_of({kit::payload_of<double>(sphere, 4)}, 4)), sphere);
}

TEST(MeshSerialized, errors) {
  const auto has = [](const std::string& bytes, const std::string& part, int index = 0) {
    EXPECT_NE(serialized_error(bytes, index).find(part), std::string::npos) << serialized_error(bytes, index);
  };
  const std::string payload = kit::payload_of<float>(make_rectangle(), 4);
  const std::string file = kit::serialized_of({payload, payload}, 4);
  has("", "too short");
  has("ply\nformat", "no serialized mesh at byte 0");
  has(std::string("\x1c\x04\x02\x00zzzz", 8), "serialized format 2; versions 3 and 4");
  has(file.substr(0, 40), "the compressed data end before the mesh does");
  std::string broken = file;
  broken[4] ^= 0x55;
  has(broken, "the compressed data are damaged");
  broken = file;
  broken[broken.size() - 12] = char(broken.size() - 8);  // offset of mesh 1
  has(broken, "beyond the last", 1);
  broken = file;
  broken.back() = 0x7f;  // count
  has(broken, "no dictionary", 1);
  const auto changed = [&](size_t at, auto value) {
    std::string p = payload;
    std::memcpy(p.data() + at, &value, sizeof value);
    return kit::serialized_of({p}, 4);
  };
  has(changed(0, uint32_t(2)), "neither or both");
  has(changed(0, uint32_t(0x3002)), "neither or both");
  has(changed(9, ~uint64_t(0)), "at most 2^32 - 2");
  has(changed(9, uint64_t(0xfffffffe)), "the compressed data end");  // 50 GB promised: read piece by piece
  has(changed(17, uint64_t(0xfffffffe)), "the compressed data end");
  has(changed(25, std::nanf("")), "(mesh 0): vertex 0 is not finite");
  has(changed(payload.size() - 4, uint32_t(4)), "triangle 1 names a vertex beyond the last of 4");
  std::string endless(100000, 'x');
  kit::put(endless = std::string("\0\x10\0\0", 4) + endless, 0);
  has(kit::serialized_of({endless}, 4), "a mesh name of more than 64 KiB");
  EXPECT_THROW(read_serialized("/no/such/file.serialized", 0, {}), Error);
}

}  // namespace
}  // namespace ajar
