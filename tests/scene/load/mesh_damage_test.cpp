// Damaged files: every truncation and every damaged byte of small valid ones ends in a sound mesh or in an Error.
// (fuzz_mesh.cpp goes on where this stops.)
#include <gtest/gtest.h>

#include <functional>

#include "ajar/core/error.h"
#include "ajar/core/sampler.h"
#include "mesh_samples.h"

namespace ajar {
namespace {

using Parser = std::function<Mesh(const std::string&, const MeshOptions&)>;

struct Sample {
  std::string name, bytes;
  Parser parse;
};

Mesh small() {
  Mesh mesh = make_sphere(2, 3);
  mesh.colors.assign(mesh.positions.size(), Rgb(0.2f));
  return mesh;
}

std::vector<Sample> samples() {
  const Parser obj = [](const std::string& b, const MeshOptions& o) { return parse_obj(b, "a", o); };
  const Parser ply = [](const std::string& b, const MeshOptions& o) { return parse_ply(kit::as_bytes(b), "a", o); };
  const auto serialized = [](int index) -> Parser {
    return [index](const std::string& b, const MeshOptions& o) {
      return parse_serialized(kit::as_bytes(b), "a", index, o);
    };
  };
  // Damage before compression, which would hide the rest of the mesh behind zlib's checks.
  const Parser payload = [](const std::string& b, const MeshOptions& o) {
    return parse_serialized(kit::as_bytes(kit::serialized_of({b}, 4)), "a", 0, o);
  };
  const std::string four = kit::payload_of<float>(small(), 4), three = kit::payload_of<double>(small(), 3);
  return {
      {"obj",
       "# x\no a\nv 0 0 0\nv 1 0 0 1 0 0\nv 0 1e0 \\\n 0\r\nvt 0 1\nvt 0.5\nvn 0 0 2\nvn 1 0 0\nf 1/1/1 2/2/1 3//2\n"
       "f -3 -2 -1\nf 1 2 3 3\nusemtl b\n",
       obj},
      {"ascii ply",
       "ply\nformat ascii 1.0\ncomment c\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
       "property uchar red\nproperty uchar green\nproperty uchar blue\nelement face 2\nproperty list uchar int "
       "vertex_indices\nelement e 1\nproperty int a\nend_header\n0 0 0 1 2 3\n1 0 0 4 5 6\n0 1 0 7 8 9\n1 1 1 0 0 0\n"
       "4 0 1 2 3\n3 1 2 3\n7\n",
       ply},
      {"little ply", kit::ply_of(small(), false), ply},
      {"big ply", kit::ply_of(small(), true), ply},
      {"serialized 4", kit::serialized_of({four, four}, 4), serialized(1)},
      {"serialized 3", kit::serialized_of({three, three}, 3), serialized(1)},
      {"payload", four, payload}};
}

const MeshOptions all_options[] = {
    {}, {.face_normals = true, .flip_normals = true}, {.flip_normals = true, .flip_v = true, .max_smooth_angle = 30}};

// Returns whether the bytes were accepted.
bool survives(const Sample& sample, const std::string& bytes, const MeshOptions& options) {
  try {
    const std::string wrong = kit::unsound(sample.parse(bytes, options));
    EXPECT_EQ(wrong, "") << sample.name;
    return true;
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()), "");
    return false;
  }
}

TEST(MeshDamage, the_samples_are_valid) {
  for (const Sample& sample : samples())
    for (const MeshOptions& options : all_options) EXPECT_TRUE(survives(sample, sample.bytes, options)) << sample.name;
}

TEST(MeshDamage, truncations) {
  for (const Sample& sample : samples())
    for (size_t n = 0; n < sample.bytes.size(); ++n) survives(sample, sample.bytes.substr(0, n), all_options[n % 3]);
}

TEST(MeshDamage, single_bytes) {
  constexpr uint8_t values[] = {0, 0xff, 0x7f, 0x80, '-', '9', ' ', '\n', '/', '\\'};
  for (const Sample& sample : samples()) {
    std::string bytes = sample.bytes;
    for (size_t i = 0; i < bytes.size(); ++i) {
      for (const uint8_t value : values) {
        bytes[i] = char(value);
        survives(sample, bytes, all_options[i % 3]);
      }
      for (int bit = 0; bit < 8; ++bit) {
        bytes[i] = char(sample.bytes[i] ^ (1 << bit));
        survives(sample, bytes, all_options[i % 3]);
      }
      bytes[i] = sample.bytes[i];
    }
  }
}

TEST(MeshDamage, random_wounds) {
  uint64_t state = 1;
  const auto below = [&](size_t n) { return size_t((state = mix64(state)) % n); };
  for (const Sample& sample : samples()) {
    int accepted = 0;
    for (int round = 0; round < 3000; ++round) {
      std::string bytes = sample.bytes;
      for (size_t wounds = 1 + below(4); wounds > 0 && !bytes.empty(); --wounds) {
        const size_t at = below(bytes.size());
        switch (below(4)) {
          case 0:
            bytes[at] = char(below(256));
            break;
          case 1:
            bytes.erase(at, 1 + below(20));
            break;
          case 2:
            bytes.insert(at, bytes.substr(below(bytes.size()), 1 + below(20)));
            break;
          default:
            bytes[at] = bytes[below(bytes.size())];
            break;
        }
      }
      accepted += survives(sample, bytes, all_options[round % 3]);
    }
    EXPECT_LT(accepted, 3000) << sample.name;
  }
}

}  // namespace
}  // namespace ajar
