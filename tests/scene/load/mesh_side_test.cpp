// Which side is outside, and what normals a mesh gets: the rules at the head of mesh.h.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "ajar/core/error.h"
#include "mesh_samples.h"

namespace ajar {
namespace {

Mat4 scaling(float x, float y, float z) { return glm::scale(Mat4(1), Vec3(x, y, z)); }

Mesh smooth_obj(const std::string& text, const MeshOptions& options = {}) {
  Mesh mesh = parse_obj(text, "a.obj", options);
  EXPECT_EQ(kit::unsound(mesh), "");
  return mesh;
}

std::string without_normals(const std::string& text) {
  std::string out;
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at);
    const std::string line = text.substr(at, end - at);
    if (!line.starts_with("vn")) out += line + "\n";
    at = end + 1;
  }
  for (size_t at; (at = out.find("//1")) != std::string::npos;) out.erase(at, 3);
  return out;
}

const std::string up = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 2//1 3//1\n";
const std::string up_wound_down = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nf 1//1 3//1 2//1\n";

// 1 where the mesh is convex about the origin and all faces look outwards, -1 where all look inwards, else 0.
int outwards(const Mesh& mesh) {
  int side = 2;
  for (size_t t = 0; t < mesh.triangles.size(); ++t) {
    const float d = glm::dot(kit::face_normal(mesh, t), mesh.positions[mesh.triangles[t].x]);
    const int s = d > 0 ? 1 : -1;
    if (side != 2 && s != side) return 0;
    side = s;
  }
  return side;
}

TEST(MeshSide, rectangle) {
  const Mesh m = make_rectangle();
  EXPECT_EQ(kit::face_normal(m, 0), Vec3(0, 0, 1));
  EXPECT_EQ(kit::face_normal(m, 1), Vec3(0, 0, 1));
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(m.uvs[i], Vec2(m.positions[i]) * 0.5f + 0.5f);
}

TEST(MeshSide, a_mirrored_rectangle_emits_on_the_same_side) {
  for (const Mat4& m : {scaling(-1, 1, 1), scaling(1, -1, 1), scaling(-1, -1, 1)}) {
    Mesh mesh = make_rectangle();
    transform(mesh, m);
    for (size_t t = 0; t < 2; ++t) EXPECT_EQ(kit::face_normal(mesh, t), Vec3(0, 0, 1));
  }
  Mesh mesh = make_rectangle();  // its normal itself is mirrored
  transform(mesh, scaling(1, 1, -1));
  for (size_t t = 0; t < 2; ++t) EXPECT_EQ(kit::face_normal(mesh, t), Vec3(0, 0, -1));
}

TEST(MeshSide, cube) {
  Mesh m = make_cube();
  EXPECT_EQ(outwards(m), 1);
  // Two corners of the parameterisation of Mitsuba's cube on each of three faces.
  const auto uv_of = [&](const Vec3& p, const Vec3& n) {
    for (size_t t = 0; t < m.triangles.size(); ++t)
      for (int k = 0; k < 3; ++k)
        if (const uint32_t i = m.triangles[t][k]; m.positions[i] == p && kit::face_normal(m, t) == n) return m.uvs[i];
    return Vec2(-1);
  };
  EXPECT_EQ(uv_of({1, -1, -1}, {0, -1, 0}), Vec2(0, 1));
  EXPECT_EQ(uv_of({1, -1, 1}, {0, -1, 0}), Vec2(1, 1));
  EXPECT_EQ(uv_of({-1, 1, 1}, {0, 1, 0}), Vec2(1, 0));
  EXPECT_EQ(uv_of({1, 1, -1}, {0, 1, 0}), Vec2(0, 1));
  EXPECT_EQ(uv_of({1, 1, -1}, {1, 0, 0}), Vec2(1, 1));
  EXPECT_EQ(uv_of({1, -1, 1}, {1, 0, 0}), Vec2(0, 0));
  EXPECT_EQ(uv_of({1, -1, 1}, {0, 0, 1}), Vec2(0, 1));
  EXPECT_EQ(uv_of({-1, 1, 1}, {0, 0, 1}), Vec2(1, 0));
  EXPECT_EQ(uv_of({-1, 1, 1}, {-1, 0, 0}), Vec2(1, 1));
  EXPECT_EQ(uv_of({-1, -1, -1}, {-1, 0, 0}), Vec2(0, 0));
  EXPECT_EQ(uv_of({1, 1, -1}, {0, 0, -1}), Vec2(0, 1));
  EXPECT_EQ(uv_of({-1, -1, -1}, {0, 0, -1}), Vec2(1, 0));
  transform(m, scaling(-2, 1, 3));
  EXPECT_EQ(outwards(m), 1);
}

TEST(MeshSide, sphere) {
  for (const auto& [rings, segments] : {std::pair{2, 3}, {16, 32}, {101, 7}}) {
    Mesh m = make_sphere(rings, segments);
    EXPECT_EQ(kit::unsound(m), "");
    EXPECT_EQ(m.triangles.size(), size_t(2 * segments * (rings - 1)));
    EXPECT_EQ(outwards(m), 1);
    for (const glm::uvec3& t : m.triangles)  // no triangle spans the seam
      EXPECT_LT(std::abs(m.uvs[t.x].x - m.uvs[t.y].x) + std::abs(m.uvs[t.x].x - m.uvs[t.z].x), 2.1f / float(segments));
    transform(m, scaling(1, -3, 2));
    EXPECT_EQ(outwards(m), 1);
    for (const glm::uvec3& t : m.triangles)  // normals of the ellipsoid, by its gradient
      for (int k = 0; k < 3; ++k) {
        const Vec3 p = m.positions[t[k]];
        EXPECT_LT(glm::distance(m.normals[t[k]], glm::normalize(p / Vec3(1, 9, 4))), 1e-5f);
      }
  }
}

TEST(MeshSide, normals_of_the_file_decide) {
  EXPECT_EQ(kit::face_normal(smooth_obj(up), 0), Vec3(0, 0, 1));
  EXPECT_EQ(kit::face_normal(smooth_obj(up_wound_down), 0), Vec3(0, 0, 1));
  EXPECT_EQ(kit::face_normal(smooth_obj(up_wound_down, {.face_normals = true}), 0), Vec3(0, 0, -1));
}

TEST(MeshSide, a_mirror_keeps_the_side_of_normals_but_turns_bare_winding) {
  const Mat4 mirror = scaling(-1, 1, 1);
  for (const std::string& text : {up, up_wound_down}) {
    EXPECT_EQ(kit::face_normal(smooth_obj(text, {.to_world = mirror}), 0), Vec3(0, 0, 1));
    Mesh later = smooth_obj(text);
    transform(later, mirror);
    EXPECT_EQ(kit::face_normal(later, 0), Vec3(0, 0, 1));
    EXPECT_EQ(later.normals[0], Vec3(0, 0, 1));
  }
  const std::string bare = without_normals(up);
  EXPECT_EQ(kit::face_normal(smooth_obj(bare), 0), Vec3(0, 0, 1));
  const Mesh mirrored = smooth_obj(bare, {.to_world = mirror});
  EXPECT_EQ(kit::face_normal(mirrored, 0), Vec3(0, 0, -1));
  EXPECT_EQ(mirrored.normals[0], Vec3(0, 0, -1));
  EXPECT_EQ(kit::face_normal(smooth_obj(bare, {.face_normals = true, .to_world = mirror}), 0), Vec3(0, 0, -1));
}

TEST(MeshSide, flip_normals_turns_winding_and_normals) {
  for (const std::string& text : {up, without_normals(up)}) {
    const Mesh m = smooth_obj(text, {.flip_normals = true});
    EXPECT_EQ(kit::face_normal(m, 0), Vec3(0, 0, -1));
    EXPECT_EQ(m.normals[0], Vec3(0, 0, -1));
    EXPECT_EQ(kit::face_normal(smooth_obj(text, {.face_normals = true, .flip_normals = true}), 0), Vec3(0, 0, -1));
  }
}

TEST(MeshSide, uneven_scale_tilts_normals_by_the_inverse_transpose) {
  const std::string slope = "v 0 0 0\nv 1 0 -1\nv 0 1 0\nvn 1 0 1\nf 1//1 2//1 3//1\n";
  const Mesh m = smooth_obj(slope, {.to_world = scaling(2, 1, 1)});
  EXPECT_LT(glm::distance(m.normals[0], glm::normalize(Vec3(1, 0, 2))), 1e-6f);
  EXPECT_LT(glm::distance(m.normals[0], kit::face_normal(m, 0)), 1e-6f);
  const Mesh flat = smooth_obj(slope, {.to_world = scaling(1, 1, 0)});  // singular: onto z = 0
  EXPECT_EQ(flat.normals[0], Vec3(0, 0, 1));
}

TEST(MeshSide, extreme_scales) {
  for (const float s : {1e-18f, 1e18f}) {
    const Mesh m = smooth_obj(up, {.to_world = scaling(s, s, s)});
    EXPECT_EQ(m.normals[0], Vec3(0, 0, 1));
    const Mesh bare = smooth_obj(without_normals(up), {.to_world = scaling(s, s, s)});
    EXPECT_EQ(bare.normals[0], Vec3(0, 0, 1));
  }
  EXPECT_THROW(smooth_obj("v 1e30 0 0\nf 1 1 1\n", {.to_world = scaling(1e30f, 1, 1)}), Error);
  Mesh m = smooth_obj("v 1e30 0 0\nf 1 1 1\n");
  EXPECT_THROW(transform(m, scaling(1e30f, 1, 1)), Error);
}

const std::string roof =  // two unit-wide slopes that meet at 90 degrees along y
    "v -1 0 -1\nv 0 0 0\nv 0 1 0\nv -1 1 -1\nv 1 0 -1\nv 1 1 -1\nf 1 2 3 4\nf 2 5 6 3\n";

TEST(MeshSide, a_file_without_normals_gets_smooth_ones) {
  const Mesh m = smooth_obj(roof);
  ASSERT_EQ(m.positions.size(), 6u);
  EXPECT_LT(glm::distance(m.normals[1], Vec3(0, 0, 1)), 1e-6f);  // on the ridge
  EXPECT_LT(glm::distance(m.normals[0], glm::normalize(Vec3(-1, 0, 1))), 1e-6f);
  EXPECT_TRUE(smooth_obj(roof, {.face_normals = true}).normals.empty());
}

TEST(MeshSide, normals_are_weighted_by_angle_not_by_number_of_triangles) {
  // A cube's corner: one face is cut so that two of its triangles meet there.
  const Mesh m = smooth_obj(
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 0 1 1\nv 1 0 1\n"
      "f 1 3 2\nf 1 4 3\nf 1 5 6\nf 1 6 4\nf 1 2 7\nf 1 7 5\n");
  EXPECT_LT(glm::distance(m.normals[m.triangles[0].x], glm::normalize(Vec3(-1))), 1e-6f);
}

TEST(MeshSide, max_smooth_angle_splits_edges_that_are_sharper) {
  EXPECT_EQ(smooth_obj(roof, {.max_smooth_angle = 91}).positions.size(), 6u);
  const Mesh sharp = smooth_obj(roof, {.max_smooth_angle = 89});
  EXPECT_EQ(sharp.positions.size(), 8u);
  for (size_t t = 0; t < sharp.triangles.size(); ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT(glm::distance(sharp.normals[sharp.triangles[t][k]], kit::face_normal(sharp, t)), 1e-6f);
  EXPECT_EQ(smooth_obj(roof, {.max_smooth_angle = 0}).positions.size(), 8u);  // coplanar halves of a quad stay together
  EXPECT_EQ(smooth_obj(roof, {.face_normals = true, .max_smooth_angle = 20}).positions.size(), 6u);
}

TEST(MeshSide, max_smooth_angle_ignores_seams_and_old_normals) {
  // The same roof with texture coordinates that differ along the ridge, and normals that are nonsense.
  const std::string text =
      "v -1 0 -1\nv 0 0 0\nv 0 1 0\nv -1 1 -1\nv 1 0 -1\nv 1 1 -1\nvt 0 0\nvt 1 1\nvn 0 1 0\n"
      "f 1/1/1 2/1/1 3/1/1 4/1/1\nf 2/2/1 5/2/1 6/2/1 3/2/1\n";
  const Mesh m = smooth_obj(text, {.max_smooth_angle = 91});
  EXPECT_EQ(m.positions.size(), 8u);
  for (size_t i = 0; i < m.positions.size(); ++i)
    if (m.positions[i].x == 0) {
      EXPECT_LT(glm::distance(m.normals[i], Vec3(0, 0, 1)), 1e-6f);
    }
  EXPECT_LT(glm::distance(smooth_obj(text).normals[0], Vec3(0, 1, 0)), 1e-6f);  // else the file's normals stand
}

TEST(MeshSide, max_smooth_angle_on_a_cube_and_a_sphere) {
  std::string cube =
      "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
      "f 1 4 3 2\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  const Mesh m = smooth_obj(cube, {.max_smooth_angle = 30});
  EXPECT_EQ(m.positions.size(), 24u);
  for (size_t t = 0; t < m.triangles.size(); ++t) EXPECT_EQ(m.normals[m.triangles[t].x], kit::face_normal(m, t));
  Mesh ball = make_sphere(32, 64);
  const Mesh smooth = parse_ply(kit::as_bytes(kit::ply_of(ball, false)), "ball", {.max_smooth_angle = 20});
  for (size_t i = 0; i < smooth.positions.size(); ++i)
    EXPECT_GT(glm::dot(smooth.normals[i], smooth.positions[i]), 0.999f);  // across seam and poles
}

TEST(MeshSide, opposite_faces_at_a_vertex_do_not_cancel_to_nothing) {
  const Mesh m = smooth_obj("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n");
  for (const Vec3& n : m.normals) EXPECT_EQ(std::abs(n.z), 1);
}

TEST(MeshSide, zero_area_meshes_have_unit_normals) {
  for (const float angle : {-1.0f, 30.0f}) {
    const Mesh m = smooth_obj("v 0 0 0\nv 0 0 0\nv 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 4 5\nf 4 4 4\n",
                              {.max_smooth_angle = angle});
    EXPECT_EQ(m.triangles.size(), 3u);
  }
}

}  // namespace
}  // namespace ajar
